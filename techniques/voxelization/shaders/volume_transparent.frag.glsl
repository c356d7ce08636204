#version 450 core
// Blends the voxels of one slice over what lies behind: planes come back to front. [zju2005]
// Sec. 2.4.2. With HEAD, a CT/MR volume is blended plane by plane with them (figure 2.7, right). What
// two models have in common is opaque (figure 2.8).
// Reads the worksheet and the volume; writes premultiplied colour.

#include "voxelization/volume_walk.glsl"

uniform float opacity;   // of a voxel that the ray passes along an axis
uniform vec3 eyeVolume;  // voxels

layout(location = 0) out vec4 color;

#if HEAD
// Transfer function of the head phantom (phantom.h): density to colour and opacity.
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
    if (isCut(ivec3(position * vec3(SIZE)))) return vec4(0.0);
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
#endif

// Outward normal of a voxel; a thin surface of bare occupancy has none (0).
vec3 normalOf(ivec3 voxel, uint value) {
#if NORMALS
    return decodeNormal(value);
#else
    const ivec2 unit = ivec2(1, 0);
    vec3 ahead = vec3(drawnVoxel(voxel + unit.xyy) == 0u, drawnVoxel(voxel + unit.yxy) == 0u,
                      drawnVoxel(voxel + unit.yyx) == 0u);
    vec3 behind = vec3(drawnVoxel(voxel - unit.xyy) == 0u, drawnVoxel(voxel - unit.yxy) == 0u,
                       drawnVoxel(voxel - unit.yyx) == 0u);
    return ahead - behind;
#endif
}

vec3 shaded(ivec3 voxel, uint value, vec3 towardsEye) {
    vec3 normal = normalOf(voxel, value);
    if (normal == vec3(0.0)) normal = towardsEye;
    return lit(albedoOf(voxel), faceForward(normalize(normal), towardsEye), towardsEye);
}

// `below` lies under what is already there.
void blendUnder(inout vec4 above, vec3 albedo, float alpha) {
    above += (1.0 - above.a) * alpha * vec4(albedo, 1.0);
}

void main() {
    vec3 direction = rayDirection();
    vec2 slope = direction.xy / direction.z;
    float front = float(slice + (direction.z > 0.0 ? 0 : 1));
    float back = float(slice + (direction.z > 0.0 ? 1 : 0));
    vec2 entry = atPlane(slope, front);
    vec2 exit = atPlane(slope, back);
    vec3 towardsEye = -normalize(volumeFromLocal(AXIS, direction));
    float pathLength = length(vec3(slope, 1.0));  // of the ray in the slice, in voxels

    vec4 sum = vec4(0.0);
    Walk walk = beginWalk(entry, exit);
    float from = 0.0;
    for (;;) {
        float to = exitOf(walk);
        ivec3 voxel = volumeFromLocal(AXIS, ivec3(walk.cell, slice));
        uint value = drawnVoxel(voxel);
        if (value != 0u) {
            float blended = 1.0 - pow(1.0 - opacity, (to - from) * pathLength);
            float alpha = isCommon(voxel) ? 1.0 : blended;
            blendUnder(sum, shaded(voxel, value, towardsEye), alpha);
        }
        if (isLast(walk)) break;
        from = to;
        advance(walk);
    }
#if HEAD
    vec3 middle = volumeFromLocal(AXIS, vec3(0.5 * (entry + exit), float(slice) + 0.5));
    vec4 tissue = headTissue(middle / vec3(SIZE), towardsEye);
    blendUnder(sum, tissue.rgb, 1.0 - pow(1.0 - tissue.a, pathLength * 128.0 / float(SIZE.x)));
#endif
    if (sum.a == 0.0) discard;
    color = sum;
}
