#version 450 core
#extension GL_ARB_gpu_shader_int64 : enable
// Exact rules: reads the lattice mesh, writes the grid; of crossings a sheet an axis, each in the
// grid's layout. No rasterizer decides anything.
// A work group lists those of its CHUNK triangles that have pixels, and then walks these, an
// invocation a triangle and axis: most triangles have none. Where they are more than SMALL_PIXELS,
// they are cut into parts, each of which is a work group's in the pass that follows (LARGE).
#include "voxelization/exact_rules.glsl"

layout(local_size_x = GROUP_SIZE) in;

// The pixels, `size` of them from `first` on, that the rule may take of a triangle.
void findPixels(ivec3 a, ivec3 b, ivec3 c, out ivec2 first, out ivec2 size) {
    ivec2 low = min(a.xy, min(b.xy, c.xy));
    ivec2 high = max(a.xy, max(b.xy, c.xy));
    ivec2 last = localFromVolume(axis, SIZE).xy - 1;
#ifdef RULE_CONSERVATIVE
    first = max((low - 1) >> 8, ivec2(0));  // closed pixels that touch [low, high]
    size = min(high >> 8, last) - first + 1;
#else
    first = max((low + 127) >> 8, ivec2(0));  // pixels whose centre lies in [low, high]
    size = min((high - 128) >> 8, last) - first + 1;
#endif
}

// A triangle and axis of the list or of a part: its pixels begin, begin + step, … before `end`.
void walk(uint entry, int begin, int end, int step) {
    axis = int(entry & 3u);
    triangle = entry >> 2;
    ivec3 a = localFromVolume(axis, cornerAt(0u));
    ivec3 b = localFromVolume(axis, cornerAt(1u));
    ivec3 c = localFromVolume(axis, cornerAt(2u));
    ivec2 first, size;
    findPixels(a, b, c, first, size);
    end = min(end, size.x * size.y);
    whole3 normal = planeNormal(whole3(b) - whole3(a), whole3(c) - whole3(a));
    for (int i = begin; i < end; i += step) {
        ivec2 pixel = first + ivec2(i % size.x, i / size.x);
        fillColumn(pixel, whole2(pixel * 256 + 128), whole3(a), whole3(b), whole3(c), normal);
    }
}

uniform uint partCapacity;

#ifdef LARGE

layout(std430) restrict readonly buffer Parts {
    uint partCount;
    uint padding;
    uvec2 parts[];
};

void main() {
    uint count = min(partCount, partCapacity);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        int begin = int(parts[i].y) * PART_PIXELS;
        walk(parts[i].x, begin + int(gl_LocalInvocationIndex), begin + PART_PIXELS, GROUP_SIZE);
    }
}

#else

uniform uint triangleCount;
#ifdef RULE_CONSERVATIVE
uniform uint firstOfY;  // triangles before are projected along x
uniform uint firstOfZ;
#endif

// What comes beyond the capacity is counted, not stored. A part: the entry, as of the list, and the
// part's number.
layout(std430) restrict buffer Parts {
    uint partCount;
    uint padding;
    uvec2 parts[];
};

shared uint listed;
shared uint list[3 * CHUNK];  // 4 · triangle + axis

void listOnAxis(ivec3 a, ivec3 b, ivec3 c) {
    ivec2 first, size;
    findPixels(localFromVolume(axis, a), localFromVolume(axis, b), localFromVolume(axis, c), first, size);
    if (size.x <= 0 || size.y <= 0) return;
    uint entry = 4u * triangle + uint(axis);
    int pixels = size.x * size.y;
    if (pixels <= SMALL_PIXELS) {
        list[atomicAdd(listed, 1u)] = entry;
        return;
    }
    uint count = uint((pixels + PART_PIXELS - 1) / PART_PIXELS);
    uint at = atomicAdd(partCount, count);
    for (uint i = 0u; i < count; ++i) {
        if (at + i < partCapacity) parts[at + i] = uvec2(entry, i);
    }
}

#if defined(RULE_CONSERVATIVE) && !defined(SUM_NORMALS)
// A triangle whose box meets one voxel, or one row of them, meets each of these: it is in one piece.
bool fillRow(ivec3 a, ivec3 b, ivec3 c) {
    ivec3 first = (min(a, min(b, c)) - 1) >> 8;
    ivec3 last = max(a, max(b, c)) >> 8;
    ivec3 step = min(last - first, ivec3(1));
    if (step.x + step.y + step.z > 1) return false;
    first = max(first, ivec3(0));
    last = min(last, SIZE - 1);
    ivec3 length = last - first;
    int steps = any(lessThan(length, ivec3(0))) ? -1 : length.x + length.y + length.z;
    for (int i = 0; i <= steps; ++i) accumulate(first + i * step, LANE_MASK);
    return true;
}
#endif

void listTriangle() {
    ivec3 a = cornerAt(0u);
    ivec3 b = cornerAt(1u);
    ivec3 c = cornerAt(2u);
#ifdef RULE_CONSERVATIVE
#ifndef SUM_NORMALS
    if (fillRow(a, b, c)) return;
#endif
    axis = triangle < firstOfY ? 0 : triangle < firstOfZ ? 1 : 2;
    listOnAxis(a, b, c);
#else
    for (axis = 0; axis < 3; ++axis) listOnAxis(a, b, c);
#endif
}

void main() {
    for (uint base = gl_WorkGroupID.x * CHUNK; base < triangleCount; base += gl_NumWorkGroups.x * CHUNK) {
        if (gl_LocalInvocationIndex == 0u) listed = 0u;
        barrier();
        uint end = min(base + CHUNK, triangleCount);
        for (triangle = base + gl_LocalInvocationIndex; triangle < end; triangle += GROUP_SIZE) listTriangle();
        barrier();
        for (uint i = gl_LocalInvocationIndex; i < listed; i += GROUP_SIZE) walk(list[i], 0, SMALL_PIXELS, 1);
        barrier();
    }
}

#endif
