#version 450 core
// Counting sort of the samples by bin, first part: how many of each bin a block has. An invocation a
// block: it alone writes its column of the matrix, so that no order depends on chance.
#include "clustered_reflections/clustering.glsl"

layout(local_size_x = GROUP_SIZE) in;

uniform usampler2D binOfSample;
layout(std430) restrict buffer Matrix { uint matrix[]; };  // bin by bin

void main() {
    uint block = gl_GlobalInvocationID.x;
    if (block >= blockCount) return;
    ivec2 size = textureSize(binOfSample, 0);
    int at = int(block * blockLength), end = min(at + int(blockLength), size.x * size.y);
    ivec2 pixel = ivec2(at % size.x, at / size.x);
    uint bin = 0u, run = 0u;
    for (; at < end; ++at) {
        uint here = texelFetch(binOfSample, pixel, 0).r;
        if (here != bin) {
            if (bin != 0u) matrix[(bin - 1u) * blockCount + block] += run;
            bin = here;
            run = 0u;
        }
        ++run;
        if (++pixel.x == size.x) pixel = ivec2(0, pixel.y + 1);
    }
    if (bin != 0u) matrix[(bin - 1u) * blockCount + block] += run;
}
