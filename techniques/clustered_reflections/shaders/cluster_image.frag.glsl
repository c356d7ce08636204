#version 450 core
// Step 3.b of [xie2017] Algorithm 6, fragments: the diffuse colour, and whether it is the cluster's
// own reflector. Depth is the hardware's.
//
// Departure [xie2017] Sec. 4.7.4: the own reflector's surface is drawn only where it faces the camera.
// The camera stands behind it, and its back, which no ray meets, would hide what they do meet; with
// kShowsOwnBack it does.
#include "reflections/kept_colour.glsl"
#include "reflections/surface.glsl"
#include "clustered_reflections/cluster_camera.glsl"

uniform ClusterCamera camera;

layout(location = 0) out vec4 colour;

void main() {
    vec3 eyeWorld = camera.eyeWorld.xyz;
    float footprint = footprintFrom(eyeWorld);
    bool isOwn = (objects[point.object].surface & 0xFFFFu) == camera.reflector;
    bool isBack = isOwn && dot(point.normalWorld, eyeWorld - point.positionWorld) < 0.0;
    if (isBack && (camera.flags & kShowsOwnBack) == 0u) discard;
    vec3 normalWorld = unitNormalTowards(eyeWorld, footprint);
    colour = vec4(keptColour(diffuseOf(normalWorld, footprint)), isOwn ? 1.0 : 0.0);
}
