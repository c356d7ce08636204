// The environment map as a fallback. The includer defines ENVIRONMENT_UNIT.
#include "reflections/kept_colour.glsl"

layout(binding = ENVIRONMENT_UNIT) uniform samplerCube environmentMap;

vec3 radianceFrom(vec3 direction) {
    return linearColour(textureLod(environmentMap, direction, 0.0).rgb);
}
