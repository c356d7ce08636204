// The environment map as a fallback.
#include "reflections/kept_colour.glsl"

uniform samplerCube environmentMap;

vec3 radianceFrom(vec3 direction) {
    return linearColour(textureLod(environmentMap, direction, 0.0).rgb);
}
