#version 450 core
// GpuRayTracer, first pass: a list of the samples that want rays, without gaps, and the arguments
// of the indirect dispatch that traces them. An invocation takes a tile of 8 × 4 samples, so that
// neighbours in the list are neighbours in the image: their rays go the same way through the BVH.
#include "reflections/gbuffer.glsl"

layout(local_size_x = LIST_GROUP_SIZE) in;

uniform usampler2D wanted;
layout(std430) restrict writeonly buffer Samples { uint samples[]; };  // x | y << 16
layout(std430) restrict buffer Arguments {
    uint groups[3];
    uint sampleCount;
};

uniform bool isChosen;  // whether `wanted` counts

ivec2 sampleOf(ivec2 tile, int place) {
    return ivec2(8, 4) * tile + ivec2(place & 7, place >> 3);
}

void main() {
    ivec2 size = textureSize(gbufferSurface, 0);
    int tilesPerRow = (size.x + 7) / 8;
    int index = int(gl_GlobalInvocationID.x);
    ivec2 tile = ivec2(index % tilesPerRow, index / tilesPerRow);
    if (4 * tile.y >= size.y) return;

    uint found = 0u;  // a bit a sample
    for (int place = 0; place < 32; ++place) {
        ivec2 pixel = sampleOf(tile, place);
        if (any(greaterThanEqual(pixel, size))) continue;
        uint surface = texelFetch(gbufferSurface, pixel, 0).r;
        if (reflectorOf(surface) == 0u) continue;
        if (isChosen && texelFetch(wanted, pixel, 0).r == 0u) continue;
        found |= 1u << place;
    }
    if (found == 0u) return;
    groups[1] = 1u;  // cleared with the counts
    groups[2] = 1u;
    // The order of tiles in the list is left to chance: each sample writes only its own pixel.
    uint count = uint(bitCount(found));
    uint begin = atomicAdd(sampleCount, count);
    atomicMax(groups[0],
              min((begin + count + TRACE_GROUP_SIZE - 1u) / TRACE_GROUP_SIZE, MAX_GROUPS));
    while (found != 0u) {
        ivec2 pixel = sampleOf(tile, findLSB(found));
        samples[begin++] = uint(pixel.x) | (uint(pixel.y) << 16);
        found &= found - 1u;
    }
}
