#version 450 core
// Lists the cells with four valid corners as two triangles each, and the valid samples on the rim,
// and counts them in the commands that draw them (cleared before).
// An invocation takes a tile of 8 × 4 samples and their upper right cells, so that neighbours in the
// list share vertices.

layout(local_size_x = GROUP_SIZE) in;

uniform usampler2D cells;  // of classify_cells.frag.glsl
uniform sampler2D samples;
uniform bool holdsOffsets;  // `samples` does; else a = 1 is valid
uniform bool onlyPoints;

layout(std430) restrict writeonly buffer Triangles { uint triangles[]; };
layout(std430) restrict writeonly buffer Points { uint points[]; };
struct Command {
    uint count, instanceCount, firstIndex;
    int baseVertex;
    uint baseInstance;
};
layout(std430) restrict buffer Commands { Command triangleDraw, pointDraw; };

bool isValid(ivec2 pixel) {
    vec4 texel = texelFetch(samples, pixel, 0);
    return holdsOffsets ? texel.x < INVALID_OFFSET : texel.a == 1.0;
}

void main() {
    ivec2 size = textureSize(cells, 0);
    int tilesPerRow = (size.x + 7) / 8;
    int index = int(gl_GlobalInvocationID.x);
    ivec2 first = ivec2(8, 4) * ivec2(index % tilesPerRow, index / tilesPerRow);
    if (first.y >= size.y) return;

    // Rows y = −1 … 4 of the tile, a bit a column: bit x + 1 for x = −1 … 8.
    uint valid[6], bridged[6];
    for (int row = 0; row < 6; ++row) {
        valid[row] = 0u;
        bridged[row] = 0u;
        for (int bit = 0; bit < 10; ++bit) {
            ivec2 pixel = first + ivec2(bit, row) - 1;
            if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) continue;
            uint cell = texelFetch(cells, pixel, 0).r;
            if (cell == 0u || !isValid(pixel)) continue;
            valid[row] |= 1u << bit;
            if (cell == 3u) bridged[row] |= 1u << bit;
        }
    }
    uint drawn[5];
    for (int row = 0; row < 5; ++row) {
        drawn[row] = onlyPoints ? 0u
                                : bridged[row] & valid[row] >> 1 & valid[row + 1] &
                                      valid[row + 1] >> 1;
    }
    const uint kOwn = 0x1FEu;  // bits of x = 0 … 7
    uint rim[4];
    uint newCells = 0u, newPoints = 0u;
    for (int y = 0; y < 4; ++y) {
        uint above = drawn[y + 1], below = drawn[y];
        rim[y] = valid[y + 1] & ~(above & above << 1 & below & below << 1) & kOwn;
        newCells += uint(bitCount(above & kOwn));
        newPoints += uint(bitCount(rim[y]));
    }
    uint at = 0u, pointAt = 0u;
    if (newCells > 0u) {
        at = atomicAdd(triangleDraw.count, INDICES_PER_CELL * newCells);
        triangleDraw.instanceCount = 1u;
    }
    if (newPoints > 0u) {
        pointAt = atomicAdd(pointDraw.count, newPoints);
        pointDraw.instanceCount = 1u;
    }
    for (int y = 0; y < 4; ++y) {
        uint rowStart = uint((first.y + y) * size.x + first.x);
        for (uint found = drawn[y + 1] & kOwn; found != 0u; found &= found - 1u) {
            uint corner = rowStart + uint(findLSB(found)) - 1u;
            uint upper = corner + uint(size.x);
            triangles[at] = corner;
            triangles[at + 1u] = corner + 1u;
            triangles[at + 2u] = upper;
            triangles[at + 3u] = corner + 1u;
            triangles[at + 4u] = upper + 1u;
            triangles[at + 5u] = upper;
            at += INDICES_PER_CELL;
        }
        for (uint found = rim[y]; found != 0u; found &= found - 1u) {
            points[pointAt++] = rowStart + uint(findLSB(found)) - 1u;
        }
    }
}
