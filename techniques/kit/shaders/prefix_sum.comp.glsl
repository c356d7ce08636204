#version 450 core
// PrefixSum: each value becomes the sum of those before it; where TOTAL is set, the sum of all
// follows the last one. One work group; each invocation takes a share of consecutive values.

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict buffer Values { TYPE values[]; };

uniform uint count;

shared TYPE shares[GROUP_SIZE];

void main() {
    uint share = gl_LocalInvocationID.x;
    uint length = (count + GROUP_SIZE - 1u) / GROUP_SIZE;
    uint begin = min(share * length, count), end = min(begin + length, count);
    TYPE sum = TYPE(0u);
    for (uint i = begin; i < end; ++i) sum += values[i];
    shares[share] = sum;
    barrier();
    TYPE before = TYPE(0u);
    for (uint i = 0u; i < share; ++i) before += shares[i];
    for (uint i = begin; i < end; ++i) {
        TYPE value = values[i];
        values[i] = before;
        before += value;
    }
#if TOTAL
    if (share == GROUP_SIZE - 1u) values[count] = before;
#endif
}
