// Where crossings behind the grid are kept, a bit a scan line, for exact.comp.glsl and
// fill_crossings.comp.glsl: along x and y in words that are as the texels that the lines run through,
// along z 32 lines of a row in a word.

// `line`: the first voxel of the scan line.
int behindWord(int axis, ivec3 line) {
    int slab = line.z / VOXELS_PER_TEXEL;
    if (axis == 0) return slab * SIZE.y + line.y;
    if (axis == 1) return kSlabs * SIZE.y + slab * SIZE.x + line.x;
    return kSlabs * (SIZE.x + SIZE.y) + line.y * ((SIZE.x + 31) / 32) + line.x / 32;
}

uint behindBits(int axis, ivec3 line) {
    return axis == 2 ? 1u << (line.x % 32) : LANE_MASK << worksheetShift(line.z);
}
