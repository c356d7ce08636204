#version 450 core
// GpuBvh, last pass: triangles in the order of the leaves, and boxes from the leaves up. Of the two
// invocations that come to a node, the first one ends and the second one, for which both children's
// boxes are there, goes on (Karras 2012, Sec. 4).
#include "reflections/bvh_layout.glsl"
#include "reflections/bvh_scene.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Pairs { uvec2 pairs[]; };
layout(std430) coherent restrict buffer Nodes { BvhNode nodes[]; };
layout(std430) restrict buffer Triangles { BvhTriangle triangles[]; };

uniform uint triangleCount;

void main() {
    uint leaf = gl_GlobalInvocationID.x;
    if (leaf >= triangleCount) return;
    uint triangle = pairs[leaf].y;
    vec3 a, b, c;
    worldCorners(triangle, a, b, c);
    triangles[leaf].a = a;
    triangles[leaf].triangle = triangle;
    triangles[leaf].b = b;
    triangles[leaf].c = c;
    vec3 boxMin = min(min(a, b), c), boxMax = max(max(a, b), c);

    if (triangleCount == 1u) {
        // A root whose children are the same leaf: rays meet the triangle twice, to no effect.
        nodes[0] = BvhNode(boxMin, kLeaf, boxMax, kLeaf, boxMin, 0u, boxMax, 0u);
        return;
    }
    uint parent = triangles[leaf].leafParent;
    for (;;) {
        uint node = parent >> 1;
        bool isRight = (parent & 1u) != 0u;
        if (isRight) {
            nodes[node].rightMin = boxMin;
            nodes[node].rightMax = boxMax;
        } else {
            nodes[node].leftMin = boxMin;
            nodes[node].leftMax = boxMax;
        }
        // The box must be seen by whoever sees the visit, hence the first barrier; the second keeps
        // the sibling's box from being read before its visit is known.
        memoryBarrierBuffer();
        if (atomicAdd(nodes[node].visits, 1u) == 0u) return;
        memoryBarrierBuffer();
        boxMin = min(boxMin, isRight ? nodes[node].leftMin : nodes[node].rightMin);
        boxMax = max(boxMax, isRight ? nodes[node].leftMax : nodes[node].rightMax);
        if (node == 0u) return;
        parent = nodes[node].parent;
    }
}
