// Glossy reflection ([xie2017] Sec. 4.6), as reflection_tracer.h has it.

uniform int lobeRays;  // 0: by the lobe's width
uniform float lobeMaxHalfAngle;
uniform float lobeFarExponent;
uniform float lobeDiagonal;

int raysOf(float glossiness) {
    if (glossiness <= 0.0) return 1;
    return lobeRays > 0 ? lobeRays : int(round(mix(8.0, 49.0, glossiness)));
}

// Ray `index` of `count` on a Vogel spiral, even in solid angle.
vec3 lobeDirection(vec3 mirrorDirection, float glossiness, int index, int count) {
    if (glossiness <= 0.0) return mirrorDirection;
    const float kGoldenAngle = 2.39996323;
    float cosine = 1.0 - (float(index) + 0.5) / float(count) * (1.0 - cos(glossiness * lobeMaxHalfAngle));
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float angle = kGoldenAngle * float(index);
    // A frame around the direction (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    vec3 n = mirrorDirection;
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    vec3 tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    return normalize(cosine * n + sine * (cos(angle) * tangent + sin(angle) * bitangent));
}

float farPlane(float glossiness) {
    return lobeDiagonal * pow(1.0 - glossiness, lobeFarExponent);
}

// Weight of a hit; glossy reflections end at the far plane, mirrors do not.
float fadeOf(float glossiness, float distance) {
    if (glossiness <= 0.0) return 1.0;
    return clamp(3.0 * (1.0 - distance / farPlane(glossiness)), 0.0, 1.0);
}
