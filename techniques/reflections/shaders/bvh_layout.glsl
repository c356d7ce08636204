// What GpuBvh builds and bvh.glsl traverses; GpuBvh has the same sizes in its static_asserts.

// A node holds the boxes of its two children, so that a visit decides about both. A child is the
// number of a node, or kLeaf | number of a leaf. The root is node 0.
struct BvhNode {
    vec3 leftMin;
    uint left;
    vec3 leftMax;
    uint right;
    vec3 rightMin;
    uint parent;  // parent << 1 | 1 for its right child; unused by the root
    vec3 rightMax;
    uint visits;  // by children on their way up
};

// A triangle in the world, in the order of the leaves.
struct BvhTriangle {
    vec3 a;
    uint triangle;  // of scene::flattened(scene)
    vec3 b;
    uint leafParent;  // of the leaf, as BvhNode::parent; no part of the triangle
    vec3 c;
    uint unused;
};

const uint kLeaf = 0x80000000u;
