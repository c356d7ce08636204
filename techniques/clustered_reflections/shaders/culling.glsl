// What a cluster's image leaves out: what lies outside of a plane, and the other side of its reflector.
layout(std430) readonly buffer Families { uint families[]; };  // by reflectorFamilies()

// Whether the box reaches to the inner side of a plane. False where a camera is not finite.
bool reaches(vec4 plane, vec3 centre, vec3 halfSize) {
    return dot(plane.xyz, centre) + plane.w + dot(abs(plane.xyz), halfSize) >= 0.0;
}

// Rows of the matrix to clip space: −w ≤ x, y, z ≤ w.
bool isInFrustum(mat4 rows, vec3 centre, vec3 halfSize) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!reaches(rows[3] + rows[axis], centre, halfSize)) return false;
        if (!reaches(rows[3] - rows[axis], centre, halfSize)) return false;
    }
    return true;
}

// As cluster_images.h has it; reflectors beyond the list are none of the scene's.
bool areBackToBack(uint a, uint b) {
    if (a >= uint(families.length()) || b >= uint(families.length())) return false;
    uint family = families[a], other = families[b];
    return family >> 2 == other >> 2 && family != other && (family & 3u) + (other & 3u) == 3u;
}
