#version 450 core
// Turns the counts of the runs into places: each becomes the sum of those before it; behind the
// last one the totals. One work group; each invocation takes a share of consecutive runs.

layout(local_size_x = SCAN_GROUP_SIZE) in;

layout(std430, binding = RUN_BINDING) restrict buffer Runs { uvec4 runs[]; };

uniform int runCount;

shared uvec4 shares[SCAN_GROUP_SIZE];

void main() {
    int share = int(gl_LocalInvocationID.x);
    int length = (runCount + SCAN_GROUP_SIZE - 1) / SCAN_GROUP_SIZE;
    int begin = min(share * length, runCount), end = min(begin + length, runCount);
    uvec4 sum = uvec4(0u);
    for (int i = begin; i < end; ++i) sum += runs[i];
    shares[share] = sum;
    barrier();
    uvec4 before = uvec4(0u);
    for (int i = 0; i < share; ++i) before += shares[i];
    for (int i = begin; i < end; ++i) {
        uvec4 count = runs[i];
        runs[i] = before;
        before += count;
    }
    if (share == SCAN_GROUP_SIZE - 1) runs[runCount] = before;
}
