// What the exact rules fill of a column of voxels, decided on the lattice in integers of 64 bits: with
// differences of 20 bits what is largest here, the plane's normal times one, has less than 63. A
// lattice that is wider, or a device without them, takes doubles.
//  RULE_THIN          the voxel in which the line through the pixel's centre crosses the triangle:
//                     6-separating (Laine 2013: the target is the three unit segments through the
//                     voxel's centre, one an axis).
//  RULE_TOGGLE        as thin, but the first voxel whose centre lies behind the crossing; a crossing
//                     behind the grid goes to w = its size. [zju2005] Sec. 2.2.3.
//  RULE_CONSERVATIVE  every voxel of the column whose closed cube meets the triangle, or comes as near to
//                     it as half a lattice unit: that is how far the mesh as given may lie from its
//                     corners on the lattice.
// Sample lines that meet an edge are shifted by an infinitely small (ε, ε², ε³) in x, y, z, the same
// for the three axes: each closed surface is then crossed an even number of times, and a face on a
// voxel's centre gives all axes the same inside.
// With SUM_NORMALS the voxels that are full get the normals of what the conservative rule finds in them.
#include "voxelization/worksheet.glsl"
#if defined(RULE_TOGGLE)
#include "voxelization/crossings.glsl"
#elif defined(SUM_NORMALS)
#include "voxelization/normal_sums.glsl"
#else
#include "voxelization/accumulate.glsl"
#endif

#if defined(WIDE_LATTICE) || !defined(GL_ARB_gpu_shader_int64)
#define whole double
#define whole2 dvec2
#define whole3 dvec3
#else
#define whole int64_t
#define whole2 i64vec2
#define whole3 i64vec3
#endif

// 256 units a voxel.
layout(std430) restrict readonly buffer Positions { int lattice[]; };
layout(std430) restrict readonly buffer Triangles { uint corners[]; };

int axis;  // of projection: 0 x, 1 y, 2 z
uint triangle;

ivec3 cornerAt(uint corner) {
    uint vertex = 3u * corners[3u * triangle + corner];
    return ivec3(lattice[vertex], lattice[vertex + 1u], lattice[vertex + 2u]);
}

#ifdef RULE_TOGGLE
layout(r32ui) uniform restrict coherent uimage2DArray sheetX;
layout(r32ui) uniform restrict coherent uimage2DArray sheetY;
layout(r32ui) uniform restrict coherent uimage2DArray sheet;
layout(std430) restrict buffer Behind { uint behind[]; };

void toggle(ivec3 local) {
    if (local.z == localFromVolume(axis, SIZE).z) {
        ivec3 line = volumeFromLocal(axis, ivec3(local.xy, 0));
        atomicXor(behind[behindWord(axis, line)], behindBits(axis, line));
        return;
    }
    ivec3 voxel = volumeFromLocal(axis, local);
    ivec3 texel = worksheetTexel(voxel);
    uint bits = LANE_MASK << worksheetShift(voxel.z);
    if (axis == 0) imageAtomicXor(sheetX, texel, bits);
    if (axis == 1) imageAtomicXor(sheetY, texel, bits);
    if (axis == 2) imageAtomicXor(sheet, texel, bits);
}
#endif

// Twice the signed area of (from, to, p) in the projection.
whole edgeArea(whole2 from, whole2 to, whole2 p) {
    precise whole area = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return area;
}

// Whether p, shifted as the head comment says, lies on the inner side of the directed edge.
bool isInside(whole area, whole2 edge) {
    if (area != 0) return area > 0;
    // du·δv − dv·δu; of the two shifts the earlier axis's is the larger: u's, but v's for y.
    if (axis == 1) return edge.x != 0 ? edge.x > 0 : edge.y < 0;
    return edge.y != 0 ? edge.y < 0 : edge.x > 0;
}

whole planeValue(whole3 normal, whole3 offset) {
    precise whole value = normal.x * offset.x + normal.y * offset.y + normal.z * offset.z;
    return value;
}

whole3 planeNormal(whole3 e, whole3 f) {
    precise whole3 normal = whole3(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x);
    return normal;
}

#ifndef RULE_CONSERVATIVE

// The sign of the plane's value at a point on the plane that is shifted as the head comment says.
bool isShiftedPositive(whole3 normal) {
    whole3 n = axis == 0 ? normal.zxy : axis == 1 ? normal.yzx : normal;
    return n.x != 0 ? n.x > 0 : n.y != 0 ? n.y > 0 : n.z > 0;
}

void fillColumn(ivec2 pixel, whole2 p, whole3 a, whole3 b, whole3 c, whole3 n) {
    if (n.z == 0) return;  // edge-on: another axis crosses it
    whole side = n.z > 0 ? whole(1) : whole(-1);
    whole3 areas = side * whole3(edgeArea(b.xy, c.xy, p), edgeArea(c.xy, a.xy, p), edgeArea(a.xy, b.xy, p));
    if (!isInside(areas.x, side * (c.xy - b.xy)) || !isInside(areas.y, side * (a.xy - c.xy)) ||
        !isInside(areas.z, side * (b.xy - a.xy)))
        return;

    // The voxel of the crossing; a quotient rounded across a face is put right by the plane's sign.
    whole2 d = p - a.xy;
    float heightUnits = float(a.z) - float(n.x * d.x + n.y * d.y) / float(n.z);
    int w = int(floor(heightUnits / 256.0));
    if (side * planeValue(n, whole3(d, whole(w * 256) - a.z)) > 0) --w;
    if (side * planeValue(n, whole3(d, whole(w * 256 + 256) - a.z)) <= 0) ++w;
    int size = localFromVolume(axis, SIZE).z;
#ifdef RULE_TOGGLE
    whole behindCentre = side * planeValue(n, whole3(d, whole(w * 256 + 128) - a.z));
    bool isBehind = behindCentre != 0 ? behindCentre > 0 : isShiftedPositive(side * n);
    toggle(ivec3(pixel, clamp(isBehind ? w : w + 1, 0, size)));
#else
    // The grid is closed: a crossing on its far face belongs to the last voxel.
    if (w == size && planeValue(n, whole3(d, whole(w * 256) - a.z)) == 0) --w;
    if (w < 0 || w >= size) return;
    accumulate(volumeFromLocal(axis, ivec3(pixel, w)), LANE_MASK);
#endif
}

#else

const whole kHalf = whole(128);  // half a voxel

// Half a voxel and half a lattice unit, times `s`. Whole numbers are compared with it: a half is dropped.
whole reachOf(whole s) { return kHalf * s + s / 2; }

// Separating axis "edge × unit axis": the projection of the triangle against that of the cube.
bool isSeparated(whole2 edge, whole2 p, whole2 q, whole2 r) {
    whole radius = reachOf(abs(edge.x) + abs(edge.y));
    precise whole s = edge.x * p.y - edge.y * p.x;
    precise whole t = edge.x * q.y - edge.y * q.x;
    precise whole u = edge.x * r.y - edge.y * r.x;
    return min(s, min(t, u)) > radius || max(s, max(t, u)) < -radius;
}

bool isSeparated(whole3 edge, whole3 a, whole3 b, whole3 c) {
    return isSeparated(edge.xy, a.xy, b.xy, c.xy) || isSeparated(edge.yz, a.yz, b.yz, c.yz) ||
           isSeparated(edge.zx, a.zx, b.zx, c.zx);
}

// Cube around `centre` against the closed triangle: 13 axes (Akenine-Möller 2001). Complete for
// triangles that are a segment or a point. A corner lies on the lattice: it is within reach of a face
// of the cube where it is in the closed cube.
bool overlaps(whole3 a, whole3 b, whole3 c, whole3 n, whole3 centre) {
    a -= centre;
    b -= centre;
    c -= centre;
    if (any(greaterThan(min(a, min(b, c)), whole3(kHalf)))) return false;
    if (any(lessThan(max(a, max(b, c)), whole3(-kHalf)))) return false;
    if (abs(planeValue(n, a)) > reachOf(abs(n.x) + abs(n.y) + abs(n.z))) return false;
    // No array of edges: NVIDIA's compiler (580.159) stops at an index into one of 64-bit integers.
    return !isSeparated(b - a, a, b, c) && !isSeparated(c - b, a, b, c) && !isSeparated(a - c, a, b, c);
}

#ifdef SUM_NORMALS

layout(std430) restrict readonly buffer Attributes { float attributes[]; };

vec3 cornerNormal(uint corner) {
    uint vertex = 3u * corners[3u * triangle + corner];
    return vec3(attributes[vertex], attributes[vertex + 1u], attributes[vertex + 2u]);
}

// What only touches the voxel counts for this much of a voxel's face: no voxel is without a normal.
const float kLeastArea = 1.0 / 32768.0;

// The triangle's normal times its area within the voxel, in faces of a voxel, but for two things: of the
// triangle that share is taken which its box has in the voxel (of the column's heights where they are
// fewer), and the normal in the middle of that. Corners and heights are given from the voxel's middle;
// to cut the triangle takes more than twenty times as long on llvmpipe.
vec3 normalWithin(vec3 a, vec3 b, vec3 c, vec3 n, float low, float high) {
    vec3 from = min(a, min(b, c));
    vec3 to = max(a, max(b, c));
    from.z = max(from.z, low);
    to.z = min(to.z, high);
    vec3 inFrom = clamp(from, -128.0, 128.0);
    vec3 inTo = clamp(to, -128.0, 128.0);
    vec3 shares = mix((inTo - inFrom) / max(to - from, 1.0), vec3(1.0), lessThan(to - from, vec3(1.0)));
    float area = length(n) / (2.0 * 256.0 * 256.0) * shares.x * shares.y * shares.z;
    vec2 p = 0.5 * (inFrom.xy + inTo.xy);
    vec2 ea = a.xy - p, eb = b.xy - p, ec = c.xy - p;
    vec3 weights = vec3(eb.x * ec.y - eb.y * ec.x, ec.x * ea.y - ec.y * ea.x, ea.x * eb.y - ea.y * eb.x);
    weights = max(n.z < 0.0 ? -weights : weights, vec3(1e-6));
    weights *= max(area, kLeastArea) / (weights.x + weights.y + weights.z);
    return weights.x * cornerNormal(0u) + weights.y * cornerNormal(1u) + weights.z * cornerNormal(2u);
}

#endif

void fillColumn(ivec2 pixel, whole2 p, whole3 a, whole3 b, whole3 c, whole3 n) {
    int first = max((int(min(a.z, min(b.z, c.z))) - 1) >> 8, 0);
    int last = min(int(max(a.z, max(b.z, c.z))) >> 8, localFromVolume(axis, SIZE).z - 1);
    float low = -1e30, high = 1e30;  // of the plane over the pixel
    if (n.z != 0) {
        // Heights of the plane over the pixel, times |n.z|; one voxel of slack on both sides for the rounding.
        whole across = n.x * (p.x - a.x) + n.y * (p.y - a.y);
        whole centre = a.z * abs(n.z) - (n.z > 0 ? across : -across);
        whole reach = reachOf(abs(n.x) + abs(n.y));
        float voxel = 256.0 * float(abs(n.z));
        low = float(centre - reach) / voxel;
        high = float(centre + reach) / voxel;
        first = int(max(float(first), floor(low) - 1.0));
        last = int(min(float(last), floor(high) + 1.0));
    }
    for (int w = first; w <= last; ++w) {
        whole3 middle = whole3(p, whole(w * 256 + 128));
        if (!overlaps(a, b, c, n, middle)) continue;
        ivec3 voxel = volumeFromLocal(axis, ivec3(pixel, w));
#ifdef SUM_NORMALS
        vec2 heights = (vec2(low, high) - (float(w) + 0.5)) * 256.0;
        addNormal(voxel, normalWithin(vec3(a - middle), vec3(b - middle), vec3(c - middle), vec3(n), heights.x, heights.y));
#else
        accumulate(voxel, LANE_MASK);
#endif
    }
}

#endif
