// What the passes of ClusterCameras share: the sorted samples cut into chunks of CHUNK_LENGTH, each
// of one cluster; what is worked out of a chunk (partials), and a cluster's frame.

layout(std430) restrict readonly buffer Ranges { uvec4 ranges[]; };
layout(std430) restrict buffer Chunks {
    uint clusterCount;
    uint firstChunk[];  // of each cluster; one more: all chunks
};
layout(std430) restrict buffer Partials { vec4 partials[]; };

// Coordinates in the frame: origin P_c, axes x and y on the fitting plane, z along n_c.
struct ClusterFrame {
    vec4 centre;  // P_c; w: far plane's distance from the fitting plane
    vec4 axisX;   // w: glossiness
    vec4 axisY;   // w: f of Eq. (6)
    vec4 normal;  // n_c
    vec4 eye;     // xyz: e_0, then e_c, in the frame (z negative); w: flags
};
layout(std430) restrict buffer Frames { ClusterFrame frames[]; };

const int kPartials = 3;  // a chunk

// The cluster of a chunk.
uint clusterOf(uint chunk) {
    uint low = 0u, high = clusterCount;  // firstChunk[low] <= chunk < firstChunk[high]
    while (low + 1u < high) {
        uint middle = (low + high) / 2u;
        if (firstChunk[middle] <= chunk) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Its samples: from x to before y.
uvec2 samplesOf(uint chunk, uint cluster) {
    uint first = ranges[cluster].x + (chunk - firstChunk[cluster]) * uint(CHUNK_LENGTH);
    return uvec2(first, min(first + uint(CHUNK_LENGTH), ranges[cluster].x + ranges[cluster].y));
}

ivec2 pixelOf(uint packedSample) {
    return ivec2(packedSample & 0xFFFFu, packedSample >> 16);
}

vec4 unitedBoxes(vec4 a, vec4 b) {
    return vec4(min(a.xy, b.xy), max(a.zw, b.zw));
}
// Of no point: lower corner, upper corner. Large and finite: infinities may be optimized away.
const vec4 kNoBox = vec4(1e30, 1e30, -1e30, -1e30);
