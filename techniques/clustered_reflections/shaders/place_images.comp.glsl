#version 450 core
// Places the images of all clusters in the atlas: sorted by height, then in rows of shelves, each as
// high as its first image. When they do not fit, all are scaled down: every invocation walks the
// shelves with a scale of its own, and the largest that fits is taken. One workgroup; the walk is
// over a list of images, some hundreds, in shared memory.
#define ATLAS_ACCESS coherent
#include "clustered_reflections/atlas.glsl"

const uint kThreads = 256u;
layout(local_size_x = kThreads) in;

layout(std430) readonly buffer Ranges { uvec4 ranges[]; };  // first sample, count, reflector, flags

uniform ivec2 atlasSizePx;
uniform float texelsPerSample;  // at most; 0: as many as the cameras say
uniform float depthImageScale;
uniform int maxSizePx;

// Of neighbouring scales; the last of 256 is 1/600, with which any 4096 images fit.
const float kScaleStep = 0.975;

shared uint sorted[kMaxClusters];  // width | height << 16
shared uint firstThatFits;

// As imageSizePx() of cluster_images.h.
ivec2 wantedSize(uint cluster) {
    ivec2 size = cameras[cluster].sizePx;
    if ((cameras[cluster].flags & kNoRoom) != 0u || size.x <= 0 || size.y <= 0) return ivec2(0);
    float scale = min(depthImageScale, float(maxSizePx) / float(max(size.x, size.y)));
    if (texelsPerSample > 0.0) {
        float most = texelsPerSample * float(ranges[cluster].y);
        scale = min(scale, sqrt(most / (float(size.x) * float(size.y))));
    }
    return clamp(ivec2(ceil(vec2(size) * scale)), ivec2(1), ivec2(maxSizePx));
}

ivec2 scaledSize(uint sizes, float scale) {
    ivec2 size = ivec2(sizes & 0xFFFFu, sizes >> 16);
    if (size.x == 0 || scale == 1.0) return size;
    return max(ivec2(vec2(size) * scale), ivec2(1));
}

// Walks the shelves; whether all fit.
bool place(uint count, float scale, bool isFinal) {
    ivec2 at = ivec2(0);
    int shelfHeight = 0;
    for (uint i = 0u; i < count; ++i) {
        ivec2 size = scaledSize(sorted[i], scale);
        ivec2 room = (size + PLACE_STEP_PX - 1) / PLACE_STEP_PX * PLACE_STEP_PX;
        if (at.x + room.x > atlasSizePx.x) {
            at = ivec2(0, at.y + shelfHeight);
            shelfHeight = 0;
        }
        shelfHeight = max(shelfHeight, room.y);
        if (at.y + shelfHeight > atlasSizePx.y) return false;
        if (isFinal) places[order[i]] = ivec4(at, size);
        at.x += room.x;
    }
    return true;
}

void main() {
    uint thread = gl_LocalInvocationID.x;
    uint count = min(clusterCount, uint(kMaxClusters));
    if (thread == 0u) firstThatFits = kThreads - 1u;
    for (uint i = thread; i < count; i += kThreads) places[i] = ivec4(ivec2(0), wantedSize(i));
    memoryBarrierBuffer();
    barrier();

    // Its rank is the number of images before it: higher ones, and those as high of a lower number.
    for (uint i = thread; i < count; i += kThreads) {
        ivec2 size = places[i].zw;
        uint rank = 0u;
        for (uint j = 0u; j < count; ++j) {
            int height = places[j].w;
            if (height > size.y || (height == size.y && j < i)) ++rank;
        }
        sorted[rank] = uint(size.x) | uint(size.y) << 16;
        order[rank] = i;
    }
    memoryBarrierBuffer();
    barrier();

    float scale = thread == 0u ? 1.0 : pow(kScaleStep, float(thread));
    if (place(count, scale, false)) atomicMin(firstThatFits, thread);
    barrier();
    if (thread == firstThatFits) {
        place(count, scale, true);
        atlasScale = scale;
        listedCount = 0u;
        leftOutCount = 0u;
        trianglesDrawn = 0u;
        clusterGroups[0] = count;
        clusterGroups[1] = 1u;
        clusterGroups[2] = 1u;
    }
}
