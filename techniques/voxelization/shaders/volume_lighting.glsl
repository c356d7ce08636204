// Light of the drawn voxels: a headlight from the upper left, Lambert and a little gloss.

#include "voxelization/volume_occupancy.glsl"

uniform vec3 light;  // unit, towards it

const float kAmbient = 0.22;
const float kFaceShare = 0.25;

vec3 faceForward(vec3 normal, vec3 towardsEye) {
    return dot(normal, towardsEye) < 0.0 ? -normal : normal;
}

vec3 lit(vec3 albedo, vec3 normal, vec3 towardsEye) {
    float diffuse = max(dot(normal, light), 0.0);
    float gloss = pow(max(dot(normal, normalize(light + towardsEye)), 0.0), 24.0);
    return albedo * (kAmbient + (1.0 - kAmbient) * diffuse) + 0.06 * gloss * diffuse;
}
