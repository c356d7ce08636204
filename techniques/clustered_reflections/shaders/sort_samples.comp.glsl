#version 450 core
// Counting sort, last part: every sample to its place. An invocation a block, as in count_bins: it
// meets its samples in row order, and its entries of the matrix say where the next of a bin goes.
#include "clustered_reflections/clustering.glsl"

layout(local_size_x = GROUP_SIZE) in;

uniform usampler2D binOfSample;
layout(std430) restrict buffer Matrix { uint matrix[]; };
layout(std430) restrict readonly buffer Pieces { uint pieces[]; };
layout(std430) restrict writeonly buffer Samples { uint samples[]; };

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
                piece = pieces[entry / uint(PIECE_LENGTH)];
                next = piece + matrix[entry];
            }
        }
        if (bin != 0u) samples[next++] = uint(pixel.x) | uint(pixel.y) << 16;
        if (++pixel.x == size.x) pixel = ivec2(0, pixel.y + 1);
    }
}
