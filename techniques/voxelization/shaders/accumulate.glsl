// Puts a voxel's value into a worksheet. Any order of the calls gives the same sheet: bits are
// OR-ed, values take the largest.
// Departure [zju2005] Sec. 2.3.2: the thesis adds the bit by alpha blending, which carries into the
// next voxel when a voxel is hit twice; image atomics do not.
// Defines: ACCUMULATE_OR or ACCUMULATE_MAX.

layout(r32ui) uniform restrict coherent uimage2DArray sheet;

void accumulate(ivec3 local, uint value) {
    ivec3 texel = worksheetTexel(local);
    int shift = worksheetShift(local.z);
#if defined(ACCUMULATE_OR)
#ifdef TABLES
    imageAtomicOr(sheet, texel, lookedUpPlace(value, local.z));
#else
    imageAtomicOr(sheet, texel, value << shift);
#endif
#elif VOXEL_BITS == 32
    imageAtomicMax(sheet, texel, value);
#else
    uint known = imageLoad(sheet, texel).r;
    while (((known >> shift) & LANE_MASK) < value) {
        uint wanted = (known & ~(LANE_MASK << shift)) | value << shift;
        uint found = imageAtomicCompSwap(sheet, texel, known, wanted);
        if (found == known) break;
        known = found;
    }
#endif
}
