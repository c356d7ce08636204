#version 450 core
// 1 + cluster of each sample, from its bin; 0 where nothing reflects.

uniform usampler2D binOfSample;
layout(std430) restrict readonly buffer Bins { uint clusterOfBin[]; };

layout(location = 0) out uint clusterPlusOne;

void main() {
    uint bin = texelFetch(binOfSample, ivec2(gl_FragCoord.xy), 0).r;
    clusterPlusOne = bin == 0u ? 0u : 1u + clusterOfBin[bin - 1u];
}
