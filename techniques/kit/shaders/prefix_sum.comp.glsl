#version 450 core
// PrefixSum: each value becomes the sum of those before it; where TOTAL is set, the sum of all
// follows the last one. One work group; each invocation takes a share of consecutive values.
#include "kit/workgroup_scan.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict buffer Values { TYPE values[]; };

uniform uint count;

void main() {
    uint share = gl_LocalInvocationID.x;
    uint length = (count + GROUP_SIZE - 1u) / GROUP_SIZE;
    uint begin = min(share * length, count), end = min(begin + length, count);
    TYPE sum = TYPE(0u);
    for (uint i = begin; i < end; ++i) sum += values[i];
    TYPE total, before = exclusiveScan(sum, total);
    for (uint i = begin; i < end; ++i) {
        TYPE value = values[i];
        values[i] = before;
        before += value;
    }
#if TOTAL
    if (share == 0u) values[count] = total;
#endif
}
