#version 450 core
// EmbreeTracer, first pass of wanted samples: from all over a G-buffer into a list, as its textures
// hold them.
#include "reflections/gbuffer.glsl"

layout(local_size_x = GROUP_SIZE) in;

struct ListedSample {
    uint surface;
    float depthM;
    float normal[2];   // octahedral
    float diffuse[3];  // kept
    uint triangleNormal;
};
layout(std430) restrict readonly buffer Places { uint places[]; };  // x + width · y
layout(std430) restrict writeonly buffer Samples { ListedSample samples[]; };

uniform uint count;

void main() {
    uint width = uint(textureSize(gbufferSurface, 0).x);
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * GROUP_SIZE) {
        ivec2 pixel = ivec2(places[i] % width, places[i] / width);
        vec2 normal = texelFetch(gbufferNormal, pixel, 0).rg;
        vec3 diffuse = texelFetch(gbufferDiffuse, pixel, 0).rgb;
        samples[i] = ListedSample(texelFetch(gbufferSurface, pixel, 0).r,
                                  texelFetch(gbufferDepth, pixel, 0).r,
                                  float[2](normal.x, normal.y),
                                  float[3](diffuse.r, diffuse.g, diffuse.b),
                                  texelFetch(gbufferTriangleNormal, pixel, 0).r);
    }
}
