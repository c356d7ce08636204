#version 450 core
// [xie2017] Algorithm 4, the test of corners: for each corner, which of the four samples around it
// may take H's sample there. Reads I, H and the normals; writes `flags`.
#include "soft_shadows/sample_plane.glsl"

layout(local_size_x = GROUP_WIDTH, local_size_y = GROUP_HEIGHT) in;

uniform sampler2D depthOfH;
uniform usampler2D idOfH;
// Bit k: the pixel that this is corner k of holds a sample. Bit 4 + k: the corner is valid for it.
// Bit 8 + k: H's sample there is of the same triangle.
layout(r16ui) uniform restrict writeonly uimage2D flags;

uniform float discontinuityPx;

void main() {
    ivec2 corner = ivec2(gl_GlobalInvocationID.xy);
    if (!isCorner(corner)) return;
    float sharedDepth = 0.0;
    uint sharedId = 0u;  // also beyond H's last row and column: the corner is missing
    if (isPixel(corner)) {
        sharedDepth = texelFetch(depthOfH, corner, 0).r;
        sharedId = texelFetch(idOfH, corner, 0).r;
    }
    uint bits = 0u;
    for (int k = 0; k < 4; ++k) {
        Surfel s = surfelOfI(corner - kCornerOfPixel[k]);
        // Two samples of one triangle have no discontinuity between them, however it slants.
        bool isOfTriangle = s.id != 0u && sharedId == s.id;
        bool isContinuous = isOfTriangle || abs(sharedDepth - depthOnPlane(s, vec2(corner))) <=
                                                discontinuityPx * footprint(s);
        bool isSample = s.id != 0u;
        bool isValid = isSample && sharedId != 0u && isContinuous;
        bits |= ((isSample ? 1u : 0u) | (isValid ? 16u : 0u) | (isOfTriangle ? 256u : 0u)) << k;
    }
    imageStore(flags, corner, uvec4(bits));
}
