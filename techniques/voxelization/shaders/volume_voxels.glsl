// Which voxels are drawn: those of one worksheet, or of two models together, less what is cut away.
// Their light: a headlight from the upper left, Lambert and a little gloss.

#include "voxelization/voxel_value.glsl"
#include "voxelization/worksheet.glsl"

uniform usampler2DArray sheets;
#if SECOND
uniform usampler2DArray secondSheets;
#endif

uniform ivec3 cutLow;   // voxels of the box [cutLow, cutHigh) are not drawn
uniform ivec3 cutHigh;

bool isCut(ivec3 voxel) {
    return all(greaterThanEqual(voxel, cutLow)) && all(lessThan(voxel, cutHigh));
}

// The first model's value, else the second's; 0: nothing to see.
uint drawnVoxel(ivec3 voxel) {
    uint value = loadVoxel(sheets, voxel);
#if SECOND
    if (value == 0u) value = loadVoxel(secondSheets, voxel);
#endif
#if CUT
    if (isCut(voxel)) value = 0u;
#endif
    return value;
}

#if HEAD
const vec3 kFirstColor = vec3(0.72, 0.30, 0.26);  // tissue, to stand out from the head
#else
const vec3 kFirstColor = vec3(0.62, 0.56, 0.47);  // grey-beige
#endif
const vec3 kSecondColor = vec3(0.42, 0.50, 0.60);  // grey-blue
const vec3 kCommonColor = vec3(0.80, 0.03, 0.02);  // red, as figure 2.8 marks what collides

// Whether both models fill it.
bool isCommon(ivec3 voxel) {
#if SECOND
    return loadVoxel(sheets, voxel) != 0u && loadVoxel(secondSheets, voxel) != 0u;
#else
    return false;
#endif
}

vec3 albedoOf(ivec3 voxel) {
    if (isCommon(voxel)) return kCommonColor;
#if SECOND
    if (loadVoxel(sheets, voxel) == 0u) return kSecondColor;
#endif
    return kFirstColor;
}

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
