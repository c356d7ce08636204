// What the passes of ClusterBuilder share: [xie2017] Sec. 4.3.

// A reflector's bins; x: theta bins, y: phi bins, z: its first bin, w: bit 0: planar; from bit 1: the
// object that it is a part of, whose parts follow each other.
layout(std430) restrict buffer Reflectors { uvec4 reflectors[]; };

// How the counting sort is laid out, worked out on the device.
layout(std430) restrict buffer SortLayout {
    uint binCount;       // of all visible reflectors
    uint blockCount;     // runs of samples in row order, an invocation each
    uint blockLength;    // samples
};
