#version 450 core
// Draw commands of the listed triangles, an invocation a command.
#include "clustered_reflections/atlas.glsl"

layout(local_size_x = DRAWS) in;

struct DrawCommand {
    uint count, instanceCount, first, baseInstance;
};
layout(std430) writeonly buffer Commands { DrawCommand commands[]; };

void main() {
    uint first = gl_LocalInvocationID.x * TRIANGLES_PER_DRAW;
    uint total = min(listedCount, uint(MOST_VISIBLE));
    uint count = min(total - min(first, total), uint(TRIANGLES_PER_DRAW));
    commands[gl_LocalInvocationID.x] = DrawCommand(3u * count, 1u, 3u * first, 0u);
    if (gl_LocalInvocationID.x == 0u) {
        trianglesDrawn = total;
        leftOutCount = listedCount - total;
    }
}
