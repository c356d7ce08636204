// Transposes C × C voxels in C words: voxel j of word i changes places with voxel i of word j.
// Blocks of 16 bits, then 8, … change places down to single voxels (Warren, Hacker's Delight, Sec.
// 7-3, here with the lowest bit first): 5 rounds of 16 exchanges for bits instead of 1024 moves.

void exchange(inout uint words[VOXELS_PER_TEXEL], const int bits, const uint lowHalves) {
    const int distance = bits / VOXEL_BITS;
    for (int i = 0; i < VOXELS_PER_TEXEL / 2; ++i) {
        int upper = i / distance * 2 * distance + i % distance;
        uint difference = ((words[upper] >> bits) ^ words[upper + distance]) & lowHalves;
        words[upper] ^= difference << bits;
        words[upper + distance] ^= difference;
    }
}

void transpose(inout uint words[VOXELS_PER_TEXEL]) {
#if VOXEL_BITS <= 16
    exchange(words, 16, 0x0000FFFFu);
#endif
#if VOXEL_BITS <= 8
    exchange(words, 8, 0x00FF00FFu);
#endif
#if VOXEL_BITS == 1
    exchange(words, 4, 0x0F0F0F0Fu);
    exchange(words, 2, 0x33333333u);
    exchange(words, 1, 0x55555555u);
#endif
}
