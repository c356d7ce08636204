#version 450 core
// [xie2017] Sec. 4.3, steps 3 and 4: the number of visible objects that reflect and the bins of each
// of their parts, from their areas. One workgroup; an invocation takes reflectors that follow each other.
#include "clustered_reflections/clustering.glsl"
#include "kit/workgroup_scan.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Areas { uint areas[]; };
layout(std430) restrict writeonly buffer Bins { uint reflectorOfBin[]; };
layout(std430) restrict writeonly buffer Counts { uint clusterCount, sampleCount, visibleCount; };

uniform int reflectorCount;
uniform vec2 maxBins;  // theta's and phi's
uniform float exponent;
uniform float gain;
uniform int pixelCount;

// As binsOf() of clustering.cpp; `scale` is a_R / n_v.
uvec2 binsOf(float scale) {
    return uvec2(clamp(floor(maxBins * pow(scale * gain, exponent) + 0.5), vec2(1.0), maxBins));
}

// Whether no part of the same object before it is visible.
bool isFirstVisiblePart(int r) {
    if (areas[r] == 0u) return false;
    uint whole = reflectors[r].w >> 1;
    for (int before = r - 1; before > 0 && reflectors[before].w >> 1 == whole; --before) {
        if (areas[before] > 0u) return false;
    }
    return true;
}

void main() {
    int self = int(gl_LocalInvocationID.x);
    int share = (reflectorCount + GROUP_SIZE - 1) / GROUP_SIZE;
    int first = 1 + self * share, end = min(first + share, reflectorCount + 1);

    uint visible = 0u, area = 0u;
    for (int r = first; r < end; ++r) {
        visible += isFirstVisiblePart(r) ? 1u : 0u;
        area += areas[r];
    }
    uint allVisible, total;
    exclusiveScan(visible, allVisible);
    exclusiveScan(area, total);

    uint bins = 0u;
    for (int r = first; r < end; ++r) {
        uvec2 grid = uvec2(areas[r] > 0u ? 1u : 0u);
        if (areas[r] > 0u && (reflectors[r].w & 1u) == 0u) {
            grid = binsOf(float(areas[r]) / (float(total) * float(allVisible)));
        }
        reflectors[r].xyz = uvec3(grid, bins);
        bins += grid.x * grid.y;
    }
    uint allBins;
    uint firstBin = exclusiveScan(bins, allBins);
    for (int r = first; r < end; ++r) {
        reflectors[r].z += firstBin;
        uvec4 record = reflectors[r];
        for (uint b = 0u; b < record.x * record.y; ++b) reflectorOfBin[record.z + b] = uint(r);
    }

    if (self == 0) {
        visibleCount = allVisible;
        sampleCount = total;
        binCount = allBins;
        // As many blocks as the matrix of counts has columns for.
        blockCount = min(uint(MAX_BLOCKS), uint(MATRIX_ENTRIES) / max(allBins, 1u));
        blockLength = (uint(pixelCount) + blockCount - 1u) / blockCount;
    }
}
