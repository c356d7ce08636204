#version 450 core
// Step 1 of [xie2017] Algorithm 6: diffuse colour, normal, distance along the view axis, and what
// reflects how.
#include "reflections/kept_colour.glsl"
#include "reflections/octahedral.glsl"
#include "reflections/surface.glsl"

uniform vec3 eyeWorld;

layout(location = kDiffuseTarget) out vec4 diffuse;
layout(location = kNormalTarget) out vec2 normal;
layout(location = kDepthTarget) out float depth;
layout(location = kSurfaceTarget) out uint surface;
layout(location = kTriangleNormalTarget) out uint triangleNormal;

void main() {
    float footprint = footprintFrom(eyeWorld);
    vec3 normalWorld = unitNormalTowards(eyeWorld, footprint);
    diffuse = vec4(keptColour(diffuseOf(normalWorld, footprint)), 1.0);
    normal = octahedralFromUnit(normalWorld);
    depth = 1.0 / gl_FragCoord.w;
    triangleNormal = packSnorm2x16(octahedralFromUnit(seenSideOf(eyeWorld)));
    surface = surfaceOf(objects[point.object], point.texcoord, footprint);
}
