#version 450 core
// [xie2017] Sec. 4.3, step 2: how many samples each reflector has. An invocation walks down a strip
// of one column and adds once for every run of one reflector.

layout(local_size_x = GROUP_SIZE) in;

uniform usampler2D surfaces;
uniform usampler2D wanted;
layout(std430) restrict buffer Areas { uint areas[]; };

void main() {
    ivec2 size = textureSize(surfaces, 0);
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, STRIP_LENGTH);
    if (pixel.x >= size.x) return;
    int end = min(pixel.y + STRIP_LENGTH, size.y);
    uint reflector = 0u, run = 0u;
    for (; pixel.y < end; ++pixel.y) {
        uint here = texelFetch(surfaces, pixel, 0).r & 0xFFFFu;
        if (texelFetch(wanted, pixel, 0).r == 0u) here = 0u;
        if (here != reflector) {
            if (reflector != 0u) atomicAdd(areas[reflector], run);
            reflector = here;
            run = 0u;
        }
        ++run;
    }
    if (reflector != 0u) atomicAdd(areas[reflector], run);
}
