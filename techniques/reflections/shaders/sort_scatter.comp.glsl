#version 450 core
// RadixSort, last of three passes: each tile puts its pairs where the scanned counts say. Every
// invocation has consecutive pairs and a counter a digit of its own, so pairs of one digit keep
// their order: the sort is stable.

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Pairs { uvec2 pairs[]; };
layout(std430) restrict writeonly buffer SortedPairs { uvec2 sortedPairs[]; };
layout(std430) restrict readonly buffer Counts { uint counts[]; };

uniform uint pairCount;
uniform uint shift;

// Rows of digits, columns of invocations. One more column than there are invocations: both the
// walk along a row and that down a column then spread over the banks of shared memory.
const uint kRow = GROUP_SIZE + 1u;
shared uint places[DIGITS * kRow];

void main() {
    uint local = gl_LocalInvocationID.x;
    for (uint i = 0u; i < GROUP_SIZE; ++i) places[local * kRow + i] = 0u;
    barrier();

    uint begin = (gl_WorkGroupID.x * GROUP_SIZE + local) * KEYS_PER_INVOCATION;
    uint end = min(begin + KEYS_PER_INVOCATION, pairCount);
    for (uint i = begin; i < end; ++i) {
        ++places[((pairs[i].x >> shift) & (DIGITS - 1u)) * kRow + local];
    }
    barrier();

    // Counts of one digit to places, an invocation a digit.
    uint place = counts[local * gl_NumWorkGroups.x + gl_WorkGroupID.x];
    for (uint i = 0u; i < GROUP_SIZE; ++i) {
        uint count = places[local * kRow + i];
        places[local * kRow + i] = place;
        place += count;
    }
    barrier();

    for (uint i = begin; i < end; ++i) {
        uvec2 pair = pairs[i];
        uint at = ((pair.x >> shift) & (DIGITS - 1u)) * kRow + local;
        sortedPairs[places[at]] = pair;
        ++places[at];
    }
}
