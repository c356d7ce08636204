// Closest hits by the BVH that GpuBvh builds and binds.
#include "reflections/bvh_layout.glsl"

layout(std430) restrict readonly buffer BvhNodes { BvhNode bvhNodes[]; };
layout(std430) restrict readonly buffer BvhTriangles { BvhTriangle bvhTriangles[]; };

struct RayHit {
    float t;           // in lengths of the direction
    vec2 barycentric;  // weights of the triangle's vertices 1 and 2
    uint triangle;     // of scene::flattened(scene)
    uint leaf;         // into bvhTriangles
};

// Where a ray enters a box; infinity if it misses. Along an axis with direction 0 the inverse is a
// large number, not infinity, as 0 · infinity would not be a number.
float boxEntry(vec3 boxMin, vec3 boxMax, vec3 origin, vec3 inverse, float tMin, float tMax) {
    vec3 toMin = (boxMin - origin) * inverse, toMax = (boxMax - origin) * inverse;
    vec3 near = min(toMin, toMax), far = max(toMin, toMax);
    float entry = max(max(near.x, near.y), max(near.z, tMin));
    float exit = min(min(far.x, far.y), min(far.z, tMax));
    // Above 1 + 2·(3 roundings of 2^-24): the entry and the exit of a box may be rounded past each
    // other, and a ray lost that meets a triangle in it (Ize 2013, "Robust BVH Ray Traversal").
    const float kRounding = 1.0000005;
    return entry <= exit * kRounding ? entry : uintBitsToFloat(0x7F800000u);
}

// The triangle's sides as Plücker coordinates against the ray (as Embree's robust mode): an edge
// that two triangles share gives both the same number up to the sign, so that no ray slips between
// them. A ray through the edge may meet both; the one whose t is less, or that was visited first, is
// reported. Triangles are met from both sides; those without area never: t is then not a number.
void meetTriangle(uint leaf, vec3 origin, vec3 direction, float tMin, inout RayHit hit) {
    BvhTriangle triangle = bvhTriangles[leaf];
    vec3 a = triangle.a - origin, b = triangle.b - origin, c = triangle.c - origin;
    vec3 ca = c - a, ab = a - b, bc = b - c;
    float ofB = dot(cross(ca, c + a), direction);  // weights, up to one factor
    float ofC = dot(cross(ab, a + b), direction);
    float ofA = dot(cross(bc, b + c), direction);
    float sum = ofA + ofB + ofC;
    // A rounding's worth of the sum, so that a ray on an edge counts: compilers may fuse the terms of
    // the three sides differently, and the number is then not the neighbour's to the last bit.
    float slack = 1.1920929e-7 * abs(sum);
    if (min(min(ofA, ofB), ofC) < -slack && max(max(ofA, ofB), ofC) > slack) return;
    vec3 normal = cross(ab, ca);
    float t = dot(a, normal) / dot(direction, normal);
    if (!(t > tMin && t < hit.t)) return;
    hit = RayHit(t, clamp(vec2(ofB, ofC) / sum, 0.0, 1.0), triangle.triangle, leaf);
}

// The nearest hit in (tMin, tMax), if any.
bool closestHit(vec3 origin, vec3 direction, float tMin, float tMax, out RayHit hit) {
    // A branch's length is below the number of different leading-bit counts on it: 30 of the codes,
    // and 32 of the places of equal codes. Each level leaves at most one node on the stack: it
    // cannot run over.
    uint stack[64];
    int size = 0;
    // 1e-20 m: a direction's component that moves no ray; its inverse times any distance is finite.
    vec3 inverse = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    hit = RayHit(tMax, vec2(0.0), 0xFFFFFFFFu, 0u);
    uint node = 0u;
    for (;;) {
        uint next = 0u;
        bool isNext = false;
        if ((node & kLeaf) != 0u) {
            meetTriangle(node & ~kLeaf, origin, direction, tMin, hit);
        } else {
            BvhNode n = bvhNodes[node];
            float left = boxEntry(n.leftMin, n.leftMax, origin, inverse, tMin, hit.t);
            float right = boxEntry(n.rightMin, n.rightMax, origin, inverse, tMin, hit.t);
            bool isLeft = !isinf(left), isRight = !isinf(right);
            isNext = isLeft || isRight;
            bool isLeftFirst = isLeft && (!isRight || left <= right);
            next = isLeftFirst ? n.left : n.right;
            if (isLeft && isRight) stack[size++] = isLeftFirst ? n.right : n.left;
        }
        if (!isNext) {
            if (size == 0) break;
            next = stack[--size];
        }
        node = next;
    }
    return hit.triangle != 0xFFFFFFFFu;
}
