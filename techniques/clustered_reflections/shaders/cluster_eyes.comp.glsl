#version 450 core
// [xie2017] Sec. 4.4, step 3.b, a workgroup a cluster: f = d_n / d_f (Eq. (6)) and e_c.
#include "clustered_reflections/cluster_camera.glsl"
#include "clustered_reflections/cluster_chunks.glsl"

layout(local_size_x = GROUP_SIZE) in;

uniform float leastHeight;

shared vec4 startBoxes[GROUP_SIZE];
shared vec4 endBoxes[GROUP_SIZE];
shared float behind[GROUP_SIZE];

float diagonalOf(vec4 box) {
    return length(box.zw - box.xy);
}

void main() {
    uint cluster = gl_WorkGroupID.x, self = gl_LocalInvocationID.x;
    vec4 starts = kNoBox, ends = kNoBox;
    float farthestBehind = 0.0;
    for (uint c = firstChunk[cluster] + self; c < firstChunk[cluster + 1u]; c += GROUP_SIZE) {
        starts = unitedBoxes(starts, partials[kPartials * c]);
        ends = unitedBoxes(ends, partials[kPartials * c + 1u]);
        farthestBehind = min(farthestBehind, partials[kPartials * c + 2u].x);
    }
    startBoxes[self] = starts;
    endBoxes[self] = ends;
    behind[self] = farthestBehind;
    barrier();
    if (self != 0u) return;
    for (uint i = 1u; i < GROUP_SIZE; ++i) {
        starts = unitedBoxes(starts, startBoxes[i]);
        ends = unitedBoxes(ends, endBoxes[i]);
        farthestBehind = min(farthestBehind, behind[i]);
    }

    ClusterFrame frame = frames[cluster];
    frame.normal.w = farthestBehind;
    if ((floatBitsToUint(frame.eye.w) & kPlanarCluster) == 0u) {
        float near = diagonalOf(starts), far = diagonalOf(ends);
        // A single sample has no extent, and neither have rays that meet in one point.
        float f = near > 0.0 && far > 0.0 ? min(near / far, float(MAX_SHIFT)) : 1.0;
        // e_c lies behind every sample: at least half as far again as the farthest.
        float least = max(1.5 * -farthestBehind, leastHeight) / -frame.eye.z;
        frame.axisY.w = max(f, least);
        // Departure [xie2017] Sec. 4.4, step 3: as printed, e_0 + (P_c − e_0)·f would put a plane's
        // eye (f = 1) at P_c; the text asks for e_0. In the frame P_c is the origin.
        frame.eye.xyz *= frame.axisY.w;
    }
    frames[cluster] = frame;
}
