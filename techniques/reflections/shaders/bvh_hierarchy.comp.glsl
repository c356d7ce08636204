#version 450 core
// GpuBvh: the nodes over the sorted codes, each found by itself (Karras 2012, Sec. 3 and 4). Writes
// children and parents; boxes come later.
#include "reflections/bvh_layout.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Pairs { uvec2 pairs[]; };
layout(std430) restrict buffer Nodes { BvhNode nodes[]; };
layout(std430) restrict buffer Triangles { BvhTriangle triangles[]; };

uniform int triangleCount;

// Karras's delta: leading bits that the keys of two leaves share. Equal codes are told apart by
// their places, as if these were lower bits of the key (Sec. 4). −1 outside.
int commonBits(int i, uint code, int j) {
    if (j < 0 || j >= triangleCount) return -1;
    uint other = pairs[j].x;
    return code != other ? 31 - findMSB(code ^ other) : 63 - findMSB(uint(i ^ j));
}

void link(int node, uint side, int child, bool isLeaf) {
    uint parent = (uint(node) << 1) | side;
    if (isLeaf) {
        triangles[child].leafParent = parent;
    } else {
        nodes[child].parent = parent;
    }
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= triangleCount - 1) return;
    uint code = pairs[i].x;

    // The node's leaves go from i in the direction d, as far as they share more with i than the
    // leaf on the other side does.
    int d = commonBits(i, code, i + 1) > commonBits(i, code, i - 1) ? 1 : -1;
    int outside = commonBits(i, code, i - d);
    int bound = 2;
    while (commonBits(i, code, i + bound * d) > outside) bound *= 2;
    int reach = 0;
    for (int step = bound / 2; step > 0; step /= 2) {
        if (commonBits(i, code, i + (reach + step) * d) > outside) reach += step;
    }
    int j = i + reach * d;

    // They are split behind the last leaf that shares more with i than the far end does.
    int inBoth = commonBits(i, code, j);
    int split = 0;
    for (int step = reach; step > 1;) {
        step = (step + 1) / 2;
        if (commonBits(i, code, i + (split + step) * d) > inBoth) split += step;
    }
    int gamma = i + split * d + min(d, 0);

    bool isLeftLeaf = min(i, j) == gamma, isRightLeaf = max(i, j) == gamma + 1;
    nodes[i].left = uint(gamma) | (isLeftLeaf ? kLeaf : 0u);
    nodes[i].right = uint(gamma + 1) | (isRightLeaf ? kLeaf : 0u);
    nodes[i].visits = 0u;
    link(i, 0u, gamma, isLeftLeaf);
    link(i, 1u, gamma + 1, isRightLeaf);
}
