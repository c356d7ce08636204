#version 450 core
// What the normals of a voxel add up to becomes its value: their mean, nearly by area. Reads the table of
// normal_sums.glsl, an invocation a slot; in the grid the bits of each full voxel are set.
#include "voxelization/voxel_value.glsl"
#include "voxelization/worksheet.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(r32ui) uniform restrict coherent uimage2DArray sheet;
layout(std430) restrict readonly buffer Sums { int sums[]; };

void main() {
    uint slot = gl_GlobalInvocationID.x;
    int key = sums[4u * slot];
    if (key == 0) return;
    ivec2 size = imageSize(sheet).xy;
    int word = (key - 1) / VOXELS_PER_TEXEL;
    ivec3 texel = ivec3(word % size.x, word / size.x % size.y, word / size.x / size.y);
    int shift = worksheetShift((key - 1) % VOXELS_PER_TEXEL);
    uint code = encodeNormal(vec3(sums[4u * slot + 1u], sums[4u * slot + 2u], sums[4u * slot + 3u]));
    imageAtomicAnd(sheet, texel, ~(LANE_MASK << shift) | code << shift);
}
