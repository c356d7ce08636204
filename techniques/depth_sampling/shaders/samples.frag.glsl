#version 450 core
// Lets pixels pass that hold a sample; a query counts them.

uniform usampler2D sampleTriangleIds;

void main() {
    if (texelFetch(sampleTriangleIds, ivec2(gl_FragCoord.xy), 0).r == 0u) discard;
}
