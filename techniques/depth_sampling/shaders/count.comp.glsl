#version 450 core
// Adds the number of pixels whose marks hold all of `bits` to `Counter`. One thread a column of
// ROWS_PER_THREAD pixels, one atomic addition a work group.

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

layout(r32ui, binding = MARK_IMAGE) readonly uniform uimage2D marks;
layout(std430, binding = COUNTER_BINDING) buffer Counter {
    uint count;
};

uniform uint bits;

shared uint groupCount;

void main() {
    if (gl_LocalInvocationIndex == 0u) groupCount = 0u;
    barrier();
    ivec2 sizePx = imageSize(marks);
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, ROWS_PER_THREAD);
    uint found = 0u;
    if (first.x < sizePx.x) {
        for (int y = first.y; y < min(first.y + ROWS_PER_THREAD, sizePx.y); ++y) {
            if ((imageLoad(marks, ivec2(first.x, y)).r & bits) == bits) ++found;
        }
    }
    if (found != 0u) atomicAdd(groupCount, found);
    barrier();
    if (gl_LocalInvocationIndex == 0u && groupCount != 0u) atomicAdd(count, groupCount);
}
