// Where crossings behind the grid are kept, a bit a scan line, for exact.comp.glsl and
// fill_crossings.comp.glsl: along x and y in words that are as the texels that the lines run through,
// along z 32 lines of a row in a word.

const int kSlabs = RESOLUTION / VOXELS_PER_TEXEL;

// `line`: the first voxel of the scan line.
int behindWord(int axis, ivec3 line) {
    if (axis == 2) return 2 * kSlabs * RESOLUTION + (line.y * RESOLUTION + line.x) / 32;
    return (axis * kSlabs + line.z / VOXELS_PER_TEXEL) * RESOLUTION + (axis == 0 ? line.y : line.x);
}

uint behindBits(int axis, ivec3 line) {
    return axis == 2 ? 1u << (line.x % 32) : LANE_MASK << worksheetShift(line.z);
}
