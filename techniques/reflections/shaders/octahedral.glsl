// Unit vectors in two numbers of [−1, 1] (Cigolle et al. 2014, "A Survey of Efficient
// Representations for Independent Unit Vectors").

vec2 signNotZero(vec2 v) {
    return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

vec2 octahedralFromUnit(vec3 v) {
    vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    return v.z >= 0.0 ? p : (1.0 - abs(p.yx)) * signNotZero(p);
}

// Not of unit length, but the same on every device: no square root.
vec3 directionFromOctahedral(vec2 e) {
    vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (v.z < 0.0) v.xy = (1.0 - abs(v.yx)) * signNotZero(v.xy);
    return v;
}

vec3 unitFromOctahedral(vec2 e) {
    return normalize(directionFromOctahedral(e));
}
