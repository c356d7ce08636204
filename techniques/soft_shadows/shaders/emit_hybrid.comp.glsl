#version 450 core
// [xie2017] Algorithm 4: writes the vertices at each corner and the quad of each sample. Reads what
// classify and count found, I and H.
#include "soft_shadows/sample_plane.glsl"
#include "soft_shadows/counts_hybrid.glsl"
#include "soft_shadows/mesh_out.glsl"

layout(local_size_x = GROUP_WIDTH, local_size_y = GROUP_HEIGHT) in;

uniform sampler2D depthOfH;

/// The vertex of pixel's corner k: H's sample or its own.
uint vertexAt(ivec2 pixel, int k) {
    ivec2 corner = pixel + kCornerOfPixel[k];
    uint bits = imageLoad(flags, corner).r;
    uint vertex = firstVertexAt(corner);
    if ((sharersOf(bits) >> k & 1u) != 0u) return vertex;
    uint fittedBefore = fittedOf(bits) & ((1u << k) - 1u);
    return vertex + sharedVertices(bits) + bitCount(fittedBefore);
}

void main() {
    ivec2 corner = ivec2(gl_GlobalInvocationID.xy);
    if (!isCorner(corner)) return;
    uint bits = imageLoad(flags, corner).r;
    if (bits == 0u) return;

    uint vertex = firstVertexAt(corner);
    if (sharersOf(bits) != 0u) {
        writeVertex(vertex++, 2 * corner, texelFetch(depthOfH, corner, 0).r);
    }
    for (uint left = fittedOf(bits); left != 0u; left &= left - 1u) {
        Surfel s = surfelOfI(corner - kCornerOfPixel[findLSB(left)]);
        writeVertex(vertex++, 2 * corner, fittedDepth(s, vec2(corner)));
    }

    if ((samplesAround(bits) & 1u) == 0u) return;  // pixel (x, y) holds no sample
    ivec2 first = corner;
    if (joinsLeft(first)) return;
    ivec2 last = first;  // of the samples that the quad stands for
    while (joinsLeft(last + ivec2(1, 0))) ++last.x;
    uint c0 = vertexAt(first, 0), c1 = vertexAt(last, 1), c2 = vertexAt(last, 2),
         c3 = vertexAt(first, 3);
    uint triangle = firstTriangleAt(corner);
    writeTriangle(triangle, c0, c1, c2);
    writeTriangle(triangle + 1u, c2, c3, c0);
}
