// The tiles of C³ voxels that hold a fragment: texelization lists each once, in any order, and
// synthesis leaves out the others. The flags, one bit a tile, tell which are listed.
// Beyond [zju2005], which merges every texel. Defines: RESOLUTION, VOXELS_PER_TEXEL.

const int kTilesAcross = RESOLUTION / VOXELS_PER_TEXEL;
const int kTileFlagWords = (kTilesAcross * kTilesAcross * kTilesAcross + 31) / 32;

layout(std430) restrict coherent buffer Tiles {
    uint tileCount;
    uint tileFlags[kTileFlagWords];
    uint tiles[];
};

void listTileOf(ivec3 voxel) {
    ivec3 at = voxel / VOXELS_PER_TEXEL;
    uint tile = uint((at.z * kTilesAcross + at.y) * kTilesAcross + at.x);
    uint flag = 1u << (tile % 32u);
    if ((tileFlags[tile / 32u] & flag) != 0u) return;
    if ((atomicOr(tileFlags[tile / 32u], flag) & flag) != 0u) return;
    tiles[atomicAdd(tileCount, 1u)] = tile;
}

// Slabs (x, y, z) of a listed tile.
ivec3 listedTile(uint index) {
    int tile = int(tiles[index]);
    return ivec3(tile % kTilesAcross, tile / kTilesAcross % kTilesAcross,
                 tile / kTilesAcross / kTilesAcross);
}
