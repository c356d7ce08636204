#version 450 core
// EmbreeTracer, second pass of wanted samples: what the host found, into the target.
layout(local_size_x = GROUP_SIZE) in;

struct FoundSample {
    uint place;  // x + width · y
    float distanceM;
    float radiance[3];
};
layout(std430) restrict readonly buffer Samples { FoundSample samples[]; };
layout(rgba16f) uniform restrict writeonly image2D radianceImage;
layout(r32f) uniform restrict writeonly image2D distanceImage;

uniform uint count;

void main() {
    uint width = uint(imageSize(radianceImage).x);
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * GROUP_SIZE) {
        FoundSample found = samples[i];
        ivec2 pixel = ivec2(found.place % width, found.place / width);
        imageStore(radianceImage, pixel,
                   vec4(found.radiance[0], found.radiance[1], found.radiance[2], 1.0));
        imageStore(distanceImage, pixel, vec4(found.distanceM));
    }
}
