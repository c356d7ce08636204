// Transfer function of the head phantom (phantom.h): density to colour and opacity.

#include "voxelization/volume_lighting.glsl"

uniform sampler3D head;  // outward normal · 0.5 + 0.5, density

// 1 between `low` and `high`, falling to 0 over `width` beside them.
float band(float x, float low, float high, float width) {
    return smoothstep(low - width, low, x) * (1.0 - smoothstep(high, high + width, x));
}

// Lit colour and the opacity of 1/128 of the box's edge, at a position of the box in [0, 1]³.
vec4 headTissue(vec3 position, vec3 towardsEye) {
    vec4 data = texture(head, position);
    bool isOutside = any(lessThan(position, vec3(0.0))) || any(greaterThan(position, vec3(1.0)));
    if (isOutside || data.a < 0.05) return vec4(0.0);
#if CUT
    if (isCut(ivec3(position * float(RESOLUTION)))) return vec4(0.0);
#endif
    // Skin is where the density rises from air; soft tissue, fluid, brain, bone follow.
    float skin = band(data.a, 0.10, 0.22, 0.05);
    float soft = band(data.a, 0.28, 0.40, 0.04);
    float bone = smoothstep(0.68, 0.80, data.a);
    float alpha = 0.09 * skin + 0.004 * soft + 0.02 * bone;
    if (alpha < 0.0005) return vec4(0.0);
    vec3 albedo = (0.09 * skin * vec3(0.80, 0.56, 0.44) + 0.004 * soft * vec3(0.70, 0.35, 0.30) +
                   0.02 * bone * vec3(0.85, 0.82, 0.72)) / alpha;
    vec3 normal = data.xyz * 2.0 - 1.0;
    if (dot(normal, normal) < 0.01) return vec4(albedo * 0.6, alpha);
    return vec4(lit(albedo, faceForward(normalize(normal), towardsEye), towardsEye), alpha);
}
