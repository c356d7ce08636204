// What the bits of a voxel say: a quantised normal, for voxels of VOXEL_BITS (8, 16 or 32) bits.
// 0 is empty; no normal gives 0. The host has the same codes in
// tests/techniques/voxelization/voxel_value.h.

const uvec2 kNormalLevels = VOXEL_BITS == 8 ? uvec2(15u) : VOXEL_BITS == 16 ? uvec2(255u) : uvec2(65535u, 32767u);

vec2 signNotZero(vec2 v) { return vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0); }

// Octahedral, odd numbers of levels so that the axes are exact.
uint encodeNormal(vec3 normal) {
    float sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    vec3 n = sum > 0.0 ? normal / sum : vec3(0.0, 0.0, 1.0);
    vec2 octahedral = n.z < 0.0 ? (1.0 - abs(n.yx)) * signNotZero(n.xy) : n.xy;
    uvec2 q = uvec2(floor(clamp(octahedral * 0.5 + 0.5, 0.0, 1.0) * vec2(kNormalLevels - 1u) + 0.5));
    return VOXEL_BITS == 32 ? 0x80000000u | q.y << 16 | q.x : 1u + q.y * kNormalLevels.x + q.x;
}

vec3 decodeNormal(uint code) {
    uvec2 q = VOXEL_BITS == 32 ? uvec2(code & 0xFFFFu, (code >> 16) & 0x7FFFu)
                               : uvec2((code - 1u) % kNormalLevels.x, (code - 1u) / kNormalLevels.x);
    vec2 p = vec2(q) / vec2(kNormalLevels - 1u) * 2.0 - 1.0;
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * signNotZero(p);
    return normalize(n);
}
