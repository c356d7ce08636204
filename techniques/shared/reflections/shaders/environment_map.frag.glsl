#version 450 core
// A face of the environment map: the diffuse colours seen from its centre.
#include "reflections/surface.glsl"

uniform vec3 eyeWorld;

layout(location = 0) out vec4 radiance;

void main() {
    float footprint = footprintFrom(eyeWorld);
    radiance = vec4(diffuseOf(unitNormalTowards(eyeWorld, footprint), footprint), 1.0);
}
