#version 450 core
// RadixSort, second of three passes: each count becomes the sum of those before it. One work group;
// each invocation takes a share of consecutive counts.

layout(local_size_x = SCAN_GROUP_SIZE) in;

layout(std430, binding = COUNTS_BINDING) restrict buffer Counts { uint counts[]; };

uniform uint countCount;

shared uint shares[SCAN_GROUP_SIZE];

void main() {
    uint share = gl_LocalInvocationID.x;
    uint length = (countCount + SCAN_GROUP_SIZE - 1u) / SCAN_GROUP_SIZE;
    uint begin = min(share * length, countCount), end = min(begin + length, countCount);
    uint sum = 0u;
    for (uint i = begin; i < end; ++i) sum += counts[i];
    shares[share] = sum;
    barrier();
    uint before = 0u;
    for (uint i = 0u; i < share; ++i) before += shares[i];
    for (uint i = begin; i < end; ++i) {
        uint count = counts[i];
        counts[i] = before;
        before += count;
    }
}
