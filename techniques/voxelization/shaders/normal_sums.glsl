// Sums of normals, one a full voxel: whole numbers, so that no order of the triangles counts. Few voxels
// of a grid are full: the sums lie in a table that is found by a key, the voxel's number in the sheets
// and 1. A slot that is taken by another sends on to the next; there are at least twice as many as keys.
// A sum holds a thousand faces of a voxel.
// Defines: SLOT_SHIFT, 32 less the slots' binary logarithm.

layout(r32ui) uniform restrict readonly uimage2DArray sheet;
layout(std430) restrict buffer Sums { int sums[]; };  // of each slot key, x, y, z

const float kUnitsPerFace = 2097152.0;

void addNormal(ivec3 voxel, vec3 normalTimesArea) {
    ivec3 texel = worksheetTexel(voxel);
    if (voxelOfWord(imageLoad(sheet, texel).r, voxel.z) == 0u) return;
    ivec2 size = imageSize(sheet).xy;
    int word = (texel.z * size.y + texel.y) * size.x + texel.x;
    int key = word * VOXELS_PER_TEXEL + voxel.z % VOXELS_PER_TEXEL + 1;
    uint slot = uint(key) * 2654435769u >> SLOT_SHIFT;  // 2³² by the golden ratio
    for (;;) {
        int found = atomicCompSwap(sums[4u * slot], 0, key);
        if (found == 0 || found == key) break;
        slot = (slot + 1u) & (0xFFFFFFFFu >> SLOT_SHIFT);
    }
    ivec3 units = ivec3(round(normalTimesArea * kUnitsPerFace));
    for (uint k = 0u; k < 3u; ++k) atomicAdd(sums[4u * slot + 1u + k], units[k]);
}
