#version 450 core
// Turns the counts of list_cells.comp.glsl into indirect draws of at most PRIMITIVES_PER_DRAW
// primitives each: first those of triangles, then those of points. A work group a draw.

layout(local_size_x = 1) in;

layout(std430, binding = COUNTS_BINDING) restrict readonly buffer Counts {
    uint cellCount;
    uint pointCount;
};
struct Command {
    uint count, instanceCount, firstIndex;
    int baseVertex;
    uint baseInstance;
};
layout(std430, binding = COMMANDS_BINDING) restrict writeonly buffer Commands {
    Command commands[];
};

uniform uint triangleDraws;

void main() {
    uint draw = gl_WorkGroupID.x;
    bool isTriangles = draw < triangleDraws;
    uint indicesEach = isTriangles ? 3u : 1u;
    uint total = isTriangles ? 2u * cellCount : pointCount;
    uint begin = (isTriangles ? draw : draw - triangleDraws) * PRIMITIVES_PER_DRAW;
    uint count = min(max(total, begin) - begin, PRIMITIVES_PER_DRAW);
    commands[draw] = Command(indicesEach * count, 1u, indicesEach * begin, 0, 0u);
}
