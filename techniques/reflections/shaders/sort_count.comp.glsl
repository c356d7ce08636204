#version 450 core
// RadixSort, first of three passes: how often each digit occurs in each tile of pairs. Counts lie
// digit by digit, so that their scan gives places of the sorted order.

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Pairs { uvec2 pairs[]; };
layout(std430) restrict writeonly buffer Counts { uint counts[]; };

uniform uint pairCount;
uniform uint shift;

shared uint digitCounts[DIGITS];

void main() {
    uint local = gl_LocalInvocationID.x;
    digitCounts[local] = 0u;  // as many digits as invocations
    barrier();
    uint begin = gl_WorkGroupID.x * GROUP_SIZE * KEYS_PER_INVOCATION;
    for (uint k = 0u; k < KEYS_PER_INVOCATION; ++k) {
        uint place = begin + k * GROUP_SIZE + local;
        if (place < pairCount) {
            atomicAdd(digitCounts[(pairs[place].x >> shift) & (DIGITS - 1u)], 1u);
        }
    }
    barrier();
    counts[local * gl_NumWorkGroups.x + gl_WorkGroupID.x] = digitCounts[local];
}
