#version 450 core
// The classic mesh: for each cell of four neighbouring samples, which triangles it holds. A cell
// goes by the corner that lies in its middle. Reads I and the normals; writes `flags`.
#include "soft_shadows/sample_plane.glsl"

layout(local_size_x = GROUP_WIDTH, local_size_y = GROUP_HEIGHT) in;

// Bit k: there is the triangle of the three samples other than that whose corner k this is. Bit 4:
// pixel (x, y) holds a sample.
layout(r16ui) uniform restrict writeonly uimage2D flags;

uniform float discontinuityPx;

bool isOnPlaneOf(Surfel s, Surfel other) {
    return abs(other.depth - depthOnPlane(s, other.positionPx)) <= discontinuityPx * footprint(s);
}

/// No discontinuity lies between two samples. Of two planes one is enough: a surface that bends is
/// met by that of its less grazing side.
bool areJoined(Surfel a, Surfel b) {
    if (a.id == 0u || b.id == 0u) return false;
    return a.id == b.id || isOnPlaneOf(a, b) || isOnPlaneOf(b, a);
}

void main() {
    ivec2 corner = ivec2(gl_GlobalInvocationID.xy);
    if (!isCorner(corner)) return;
    Surfel s[4];
    for (int k = 0; k < 4; ++k) s[k] = surfelOfI(corner - kCornerOfPixel[k]);
    bool j01 = areJoined(s[0], s[1]), j12 = areJoined(s[1], s[2]), j23 = areJoined(s[2], s[3]),
         j30 = areJoined(s[3], s[0]), j02 = areJoined(s[0], s[2]), j13 = areJoined(s[1], s[3]);
    // The cell is split along one diagonal: along 0–2 unless 1–3 gives more triangles.
    uint along02 = (j01 && j12 && j02 ? 8u : 0u) | (j23 && j30 && j02 ? 2u : 0u);
    uint along13 = (j12 && j23 && j13 ? 1u : 0u) | (j30 && j01 && j13 ? 4u : 0u);
    uint bits = bitCount(along13) > bitCount(along02) ? along13 : along02;
    if (s[0].id != 0u) bits |= 16u;
    imageStore(flags, corner, uvec4(bits));
}
