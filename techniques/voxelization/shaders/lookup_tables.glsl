// Look-up textures: that of bits from makeBitTable(), the others of worksheet_method.cpp. A texel's four bytes are the channels of the thesis's
// sheets; telling them apart takes an instruction here, as the sheets are of one channel.
// [zju2005] Sec. 2.3.2. Defines: VOXEL_BITS, LANE_MASK.

uniform usampler2D bitOfByte;
uniform usampler2D powerOfTwo;
uniform usampler2D xFromZ;
uniform usampler2D yFromZ;

// (1) The value of the voxel that begins at a bit of a byte of its texel.
uint lookedUpVoxel(uint word, uint byteInTexel, uint bitInByte) {
    uint fromByte = word >> (8u * byteInTexel);
#if VOXEL_BITS == 1
    return texelFetch(bitOfByte, ivec2(fromByte & 255u, bitInByte), 0).r;
#else
    return fromByte & LANE_MASK;
#endif
}

// (2) A voxel's value at its place in a texel's word, else zeros; w along the sheet's axis.
uint lookedUpPlace(uint value, int w) {
#if VOXEL_BITS == 1
    uint power = texelFetch(powerOfTwo, ivec2(w % 8, 0), 0).r;
    return value * power << (w % 32 / 8 * 8);
#else
    return value << (w % (32 / VOXEL_BITS) * VOXEL_BITS);
#endif
}
