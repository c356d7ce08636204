// An exclusive prefix sum over one workgroup of GROUP_SIZE invocations (Hillis and Steele 1986).
#ifndef TYPE
#define TYPE uint
#endif

shared TYPE scanned[GROUP_SIZE];

/// The sum of `value` over the invocations before this one; `total` over all of them. To be called
/// by the whole workgroup.
TYPE exclusiveScan(TYPE value, out TYPE total) {
    uint self = gl_LocalInvocationID.x;
    barrier();  // the last call's readers are done
    scanned[self] = value;
    barrier();
    for (uint step = 1u; step < GROUP_SIZE; step *= 2u) {
        TYPE before = self >= step ? scanned[self - step] : TYPE(0u);
        barrier();
        scanned[self] += before;
        barrier();
    }
    total = scanned[GROUP_SIZE - 1];
    return scanned[self] - value;
}
