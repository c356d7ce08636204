#version 450 core
// Step 3.c.iii of [xie2017] Algorithm 6, and the mean over the samples of an output pixel.
#include "reflections/gbuffer.glsl"

layout(binding = REFLECTED_UNIT) uniform sampler2D reflected;  // rgb_n
uniform int supersampling;
uniform int showsReflectionOnly;
uniform bool hasFresnel;

layout(location = 0) out vec4 color;

// Schlick's approximation, s being what is reflected head-on ([xie2017] Sec. 5.4.3).
float fresnel(ivec2 pixel, float s) {
    vec3 toEye = normalize(gbufferEyeWorld - gbufferPosition(pixel));
    float cosine = clamp(dot(gbufferUnitNormal(pixel), toEye), 0.0, 1.0);
    return s + (1.0 - s) * pow(1.0 - cosine, 5.0);
}

vec3 sampleColor(ivec2 pixel) {
    vec3 diffuse = showsReflectionOnly != 0 ? vec3(0.0) : texelFetch(gbufferDiffuse, pixel, 0).rgb;
    uint surface = texelFetch(gbufferSurface, pixel, 0).r;
    // What reflects nothing has no reflected colour: its texel is undefined.
    if (reflectorOf(surface) == 0u) return diffuse;
    float share = reflectivityOf(surface);
    if (showsReflectionOnly != 0) {
        share = 1.0;
    } else if (hasFresnel) {
        share = fresnel(pixel, share);
    }
    return mix(diffuse, texelFetch(reflected, pixel, 0).rgb, share);
}

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * supersampling;
    vec3 sum = vec3(0.0);
    for (int y = 0; y < supersampling; ++y) {
        for (int x = 0; x < supersampling; ++x) sum += sampleColor(first + ivec2(x, y));
    }
    color = vec4(sum / float(supersampling * supersampling), 1.0);
}
