#version 450 core
// [xie2017] Sec. 4.4, step 1, over a chunk: sums of positions (from the cluster's first sample: less
// is rounded away), of normals and of what the two have in common; the least glossiness.
#include "clustered_reflections/cluster_chunks.glsl"
#include "reflections/gbuffer.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Samples { uint samples[]; };

void main() {
    uint chunk = gl_GlobalInvocationID.x;
    if (chunk >= firstChunk[clusterCount]) return;
    uint cluster = clusterOf(chunk);
    uvec2 range = samplesOf(chunk, cluster);
    vec3 origin = gbufferPosition(pixelOf(samples[ranges[cluster].x]));
    vec4 positions = vec4(0.0);
    vec3 normals = vec3(0.0);
    float glossiness = 1.0;
    for (uint i = range.x; i < range.y; ++i) {
        ivec2 pixel = pixelOf(samples[i]);
        vec3 position = gbufferPosition(pixel) - origin, normal = gbufferUnitNormal(pixel);
        positions += vec4(position, dot(position, normal));
        normals += normal;
        glossiness = min(glossiness, glossinessOf(texelFetch(gbufferSurface, pixel, 0).r));
    }
    partials[kPartials * chunk] = positions;
    partials[kPartials * chunk + 1u] = vec4(normals, glossiness);
}
