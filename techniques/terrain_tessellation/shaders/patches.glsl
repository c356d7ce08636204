// Numbers patches: of each tile M × M of terrain, row by row, then 4 M of skirt (west, north, east,
// south rim).
const int kSurface = -1;

struct Patch {
    ivec2 origin;  // sample
    ivec2 cell;    // column and row in the tile
    int level;
    int rim;  // kSurface or the tile's side (0 west, 1 north, 2 east, 3 south) of a skirt
};

int patchSpan(int level) {
    return (BLOCKS_PER_PATCH * BLOCK_SEGMENTS) << level;
}

Patch patchOfIndex(int index, int patchesPerTile) {
    const int m = PATCHES_PER_TILE_SIDE;
    ivec4 tile = tiles[index / patchesPerTile];
    int local = index % patchesPerTile;
    Patch result;
    result.level = tile.z;
    result.rim = kSurface;
    result.cell = ivec2(local % m, local / m);
    if (local >= m * m) {
        int i = (local - m * m) % m;
        result.rim = (local - m * m) / m;
        int far = (result.rim & 2) != 0 ? m - 1 : 0;
        result.cell = (result.rim & 1) == 0 ? ivec2(far, i) : ivec2(i, far);
    }
    result.origin = tile.xy + result.cell * patchSpan(tile.z);
    return result;
}
