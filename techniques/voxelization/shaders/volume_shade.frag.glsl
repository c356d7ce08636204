#version 450 core
// Shades the voxels that volume_opaque found. Reads the hits and the worksheet; writes linear colour.

#include "voxelization/volume_voxels.glsl"

uniform usampler2D hits;

uniform vec3 eyeVolume;  // voxels

layout(location = 0) out vec4 color;

// The 5 × 5 × 5 voxels around one, a bit each: 5 layers of 25.
const int kReach = 2;
const uint kLayer = 0x1FFFFFFu;
const uint kNotFirst = 0x1EF7BDEu;  // columns 1 … 4 of the rows
const uint kNotLast = 0x0F7BDEFu;   // columns 0 … 3

// The normal is the mean direction to the empty voxels that are reached, through faces and within the
// neighbourhood, from where the ray came: the same for a solid and for a thin surface, whose
// occupancy gradient vanishes. `openness` is the share of the neighbourhood that is reached.
vec3 normalOfOccupancy(ivec3 voxel, ivec3 towardsEye, out float openness) {
    uint empty[5];
    for (int z = 0; z < 5; ++z) {
        empty[z] = 0u;
        for (int i = 0; i < 25; ++i) {
            ivec3 at = voxel + ivec3(i % 5, i / 5, z) - kReach;
            if (drawnVoxel(at) == 0u) empty[z] |= 1u << i;
        }
    }
    ivec3 start = towardsEye + kReach;
    uint reached[5] = uint[5](0u, 0u, 0u, 0u, 0u);
    reached[start.z] = 1u << (start.y * 5 + start.x);
    for (int sweep = 0; sweep < 8; ++sweep) {
        for (int z = 0; z < 5; ++z) {
            uint m = reached[z];
            m |= (m & kNotLast) << 1 | (m & kNotFirst) >> 1 | m << 5 | m >> 5;
            if (z > 0) m |= reached[z - 1];
            if (z < 4) m |= reached[z + 1];
            reached[z] = m & empty[z] & kLayer;
        }
    }
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int z = 0; z < 5; ++z) {
        for (int i = 0; i < 25; ++i) {
            if ((reached[z] >> i & 1u) == 0u) continue;
            vec3 offset = vec3(i % 5, i / 5, z) - float(kReach);
            sum += offset * exp(-0.25 * dot(offset, offset));
            count += 1.0;
        }
    }
    openness = count / 125.0;
    return dot(sum, sum) > 0.0 ? normalize(sum) : vec3(towardsEye);
}

void main() {
    uint hit = texelFetch(hits, ivec2(gl_FragCoord.xy), 0).r;
    if (hit == 0u) {
        color = vec4(1.0);
        return;
    }
    ivec3 voxel = ivec3(uvec3(hit, hit >> 10, hit >> 20) & 1023u);
    int axis = int(hit >> 30) - 1;
    vec3 towardsEye = normalize(eyeVolume - (vec3(voxel) + 0.5));
    ivec3 face = ivec3(0);
    face[axis] = towardsEye[axis] < 0.0 ? -1 : 1;
    uint value = drawnVoxel(voxel);
    float openness;
    vec3 normal = normalOfOccupancy(voxel, face, openness);
#if NORMALS
    normal = faceForward(decodeNormal(value), towardsEye);
#endif
    // A little of the face keeps single voxels visible.
    normal = normalize(normal + kFaceShare * vec3(face));
    // A plane leaves two fifths open; less is a crevice.
    float crevice = mix(0.55, 1.0, smoothstep(0.08, 0.40, openness));
    color = vec4(lit(albedoOf(voxel), normal, towardsEye) * crevice, 1.0);
}
