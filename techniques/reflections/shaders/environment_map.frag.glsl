#version 450 core
// A face of the environment map: the diffuse colours seen from its centre.
#include "reflections/kept_colour.glsl"
#include "reflections/surface.glsl"

uniform vec3 eyeWorld;

layout(location = 0) out vec4 radiance;

void main() {
    float footprint = footprintFrom(eyeWorld);
    vec3 colour = diffuseOf(unitNormalTowards(eyeWorld, footprint), footprint);
    radiance = vec4(keptColour(colour), 1.0);
}
