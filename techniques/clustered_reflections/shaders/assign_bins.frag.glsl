#version 450 core
// [xie2017] Sec. 4.3, step 4: (theta bin i, phi bin j, reflector k) of each reflective sample, as
// one number. Theta runs around +y from +x towards +z, phi from +y. Angles are compared by products
// with the directions of the bins' borders, correctly rounded on every device.
#include "clustered_reflections/clustering.glsl"
#include "reflections/octahedral.glsl"

uniform usampler2D surfaces;
uniform sampler2D normals;
uniform usampler2D wanted;
// (cos, sin) of border k = 1 … n − 1 between n theta bins, for n = 2, 3, … one after the other.
layout(std430) restrict readonly buffer ThetaBorders { vec2 thetaBorders[]; };
// cos · |cos| of the borders between n phi bins, in the same order.
layout(std430) restrict readonly buffer PhiBorders { float phiBorders[]; };

layout(location = 0) out uint binPlusOne;

uint firstBorder(uint bins) {
    return (bins - 1u) * (bins - 2u) / 2u;
}

bool isInSecondHalf(vec2 v) {
    return !(v.y > 0.0 || (v.y == 0.0 && v.x > 0.0));
}

// Is the angle of a at least that of b, both in [0°, 360°) from +x?
bool isAtLeast(vec2 a, vec2 b) {
    bool secondA = isInSecondHalf(a), secondB = isInSecondHalf(b);
    if (secondA != secondB) return secondA;
    return b.x * a.y >= b.y * a.x;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint reflector = texelFetch(surfaces, pixel, 0).r & 0xFFFFu;
    if (reflector == 0u || texelFetch(wanted, pixel, 0).r == 0u) {
        binPlusOne = 0u;
        return;
    }
    uvec4 record = reflectors[reflector];
    uint thetaBin = 0u, phiBin = 0u;
    // Not of unit length: square roots may differ between devices.
    vec3 normal = directionFromOctahedral(texelFetch(normals, pixel, 0).rg);
    if (normal.x != 0.0 || normal.z != 0.0) {
        uint first = firstBorder(record.x);
        for (uint k = 0u; k + 1u < record.x; ++k) {
            if (isAtLeast(normal.xz, thetaBorders[first + k])) thetaBin = k + 1u;
        }
    }
    precise float square = normal.x * normal.x + normal.y * normal.y;
    precise float lengthSquare = square + normal.z * normal.z;
    uint first = firstBorder(record.y);
    for (uint k = 0u; k + 1u < record.y; ++k) {
        if (normal.y * abs(normal.y) <= phiBorders[first + k] * lengthSquare) phiBin = k + 1u;
    }
    binPlusOne = 1u + record.z + phiBin * record.x + thetaBin;
}
