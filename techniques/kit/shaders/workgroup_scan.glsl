// An exclusive prefix sum over one workgroup of GROUP_SIZE invocations (Hillis and Steele 1986).

shared uint scanned[GROUP_SIZE];

/// The sum of `value` over the invocations before this one; `total` over all of them. To be called
/// by the whole workgroup.
uint exclusiveScan(uint value, out uint total) {
    uint self = gl_LocalInvocationID.x;
    barrier();  // the last call's readers are done
    scanned[self] = value;
    barrier();
    for (uint step = 1u; step < GROUP_SIZE; step *= 2u) {
        uint before = self >= step ? scanned[self - step] : 0u;
        barrier();
        scanned[self] += before;
        barrier();
    }
    total = scanned[GROUP_SIZE - 1];
    return scanned[self] - value;
}
