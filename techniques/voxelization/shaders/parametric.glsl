// A parametric surface evaluated at the points of a grid over its domain (formula_surface.h).

#include "voxelization/formula.glsl"

#pragma snippet formulas

uniform vec4 domain;  // u0, v0, u1, v1

vec3 surfaceAt(vec2 uv) {
    return vec3(formulaX(uv.x, uv.y), formulaY(uv.x, uv.y), formulaZ(uv.x, uv.y));
}

// Sample `index` of SAMPLES_U × SAMPLES_V, row by row; the first and the last lie on the domain's
// border.
vec2 parameterOf(int index) {
    vec2 t = vec2(index % SAMPLES_U, index / SAMPLES_U) / vec2(SAMPLES_U - 1, SAMPLES_V - 1);
    return mix(domain.xy, domain.zw, t);
}
