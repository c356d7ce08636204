#version 450 core
// Recompute, last part ([xie2017] Algorithm 8): traced samples into the reprojected ones. The device
// counts the fragments that remain.

uniform usampler2D wanted;
uniform sampler2D traced;
uniform sampler2D tracedDistance;

layout(location = 0) out vec4 radiance;
layout(location = 1) out float distanceM;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(wanted, pixel, 0).r == 0u) discard;
    radiance = vec4(texelFetch(traced, pixel, 0).rgb, 1.0);
    distanceM = texelFetch(tracedDistance, pixel, 0).r;
}
