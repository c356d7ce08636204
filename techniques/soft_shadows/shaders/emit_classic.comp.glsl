#version 450 core
// The classic mesh: writes the vertex of each sample in use and the triangles of each cell. Reads
// what classify and count found, and I's depth.
#include "soft_shadows/counts_classic.glsl"
#include "soft_shadows/mesh_out.glsl"

layout(local_size_x = GROUP_WIDTH, local_size_y = GROUP_HEIGHT) in;

uniform sampler2D depthOfI;

void main() {
    ivec2 corner = ivec2(gl_GlobalInvocationID.xy);
    if (!isCorner(corner)) return;
    ivec2 pixel = corner;
    if (isUsed(pixel)) {
        writeVertex(firstVertexAt(corner), 2 * pixel + 1, texelFetch(depthOfI, pixel, 0).r);
    }

    // From the highest bit: of both triangles of a cell, that of samples 0, 1 and 2 comes first.
    uint triangle = firstTriangleAt(corner);
    uint triangles = trianglesOf(imageLoad(flags, corner).r);
    while (triangles != 0u) {
        int left = findMSB(triangles);  // the sample left out
        triangles &= ~(1u << left);
        uint v[3];
        for (int j = 0; j < 3; ++j) {
            v[j] = firstVertexAt(corner - kCornerOfPixel[(left + 1 + j) & 3]);
        }
        writeTriangle(triangle++, v[0], v[1], v[2]);
    }
}
