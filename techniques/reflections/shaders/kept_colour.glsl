// Colours that are drawn once and read again, as gbuffer.h has them.

vec3 keptColour(vec3 linear) {
    return sqrt(linear);
}

vec3 linearColour(vec3 kept) {
    return kept * kept;
}
