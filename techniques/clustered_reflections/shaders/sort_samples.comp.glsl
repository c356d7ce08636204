#version 450 core
// The parts of the counting sort that read samples: the first (COUNTS 1), how many of each bin a block
// has, and the last (0), every sample to its place. An invocation a block, which meets its samples in
// row order: it alone writes its column of the matrix, so that no order depends on chance.
#include "clustered_reflections/clustering.glsl"

layout(local_size_x = GROUP_SIZE) in;

uniform usampler2D binOfSample;
layout(std430) restrict buffer Matrix { uint matrix[]; };  // bin by bin
#if !COUNTS
layout(std430) restrict readonly buffer Pieces { uint pieces[]; };
layout(std430) restrict writeonly buffer Samples { uint samples[]; };
#endif

void main() {
    uint block = gl_GlobalInvocationID.x;
    if (block >= blockCount) return;
    ivec2 size = textureSize(binOfSample, 0);
    int at = int(block * blockLength), end = min(at + int(blockLength), size.x * size.y);
    ivec2 pixel = ivec2(at % size.x, at / size.x);
    uint bin = 0u, entry = 0u, piece = 0u, next = 0u;
    for (; at < end; ++at) {
        uint here = texelFetch(binOfSample, pixel, 0).r;
        if (here != bin) {
            if (bin != 0u) matrix[entry] = next - piece;
            bin = here;
            if (bin != 0u) {
                entry = (bin - 1u) * blockCount + block;
#if !COUNTS
                piece = pieces[entry / uint(PIECE_LENGTH)];
#endif
                next = piece + matrix[entry];
            }
        }
#if !COUNTS
        if (bin != 0u) samples[next] = uint(pixel.x) | uint(pixel.y) << 16;
#endif
        ++next;
        if (++pixel.x == size.x) pixel = ivec2(0, pixel.y + 1);
    }
    if (bin != 0u) matrix[entry] = next - piece;
}
