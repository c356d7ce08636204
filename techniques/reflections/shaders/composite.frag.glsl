#version 450 core
// Step 3.c.iii of [xie2017] Algorithm 6, or the blend of Sec. 5.4.3, and the mean over the samples
// of an output pixel.
#include "reflections/gbuffer.glsl"

uniform sampler2D reflected;  // rgb_n
uniform int supersampling;
uniform int showsReflectionOnly;
uniform int hasFresnel;

layout(location = 0) out vec4 color;

float shareOf(ivec2 pixel, uint surface) {
    if (showsReflectionOnly != 0) return 1.0;
    float headOn = reflectivityOf(surface);
    if (hasFresnel == 0) return headOn;
    vec3 toEye = normalize(gbufferEyeWorld - gbufferPosition(pixel));
    // Interpolated normals may turn away from the eye at silhouettes.
    float grazing = 1.0 - clamp(dot(toEye, gbufferUnitNormal(pixel)), 0.0, 1.0);
    return headOn + (1.0 - headOn) * pow(grazing, 5.0);  // Schlick
}

vec3 sampleColor(ivec2 pixel) {
    vec3 diffuse = showsReflectionOnly != 0 ? vec3(0.0) : gbufferDiffuseAt(pixel);
    uint surface = texelFetch(gbufferSurface, pixel, 0).r;
    // What reflects nothing has no reflected colour: its texel is undefined.
    if (reflectorOf(surface) == 0u) return diffuse;
    return mix(diffuse, texelFetch(reflected, pixel, 0).rgb, shareOf(pixel, surface));
}

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * supersampling;
    vec3 sum = vec3(0.0);
    for (int y = 0; y < supersampling; ++y) {
        for (int x = 0; x < supersampling; ++x) sum += sampleColor(first + ivec2(x, y));
    }
    color = vec4(sum / float(supersampling * supersampling), 1.0);
}
