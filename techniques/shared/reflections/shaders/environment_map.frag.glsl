#version 450 core
// A face of the environment map: the diffuse colours seen from its centre.
#include "reflections/surface.glsl"

uniform vec3 eyeWorld;

layout(location = 0) out vec4 radiance;

void main() { radiance = vec4(diffuseOf(unitNormalTowards(eyeWorld)), 1.0); }
