#version 450 core
// Exact rules, decided on the lattice in doubles that hold the integers exactly.
//  RULE_THIN          the voxel in which the line through the pixel's centre crosses the triangle:
//                     6-separating (Laine 2013: the target is the three unit segments through the
//                     voxel's centre, one an axis).
//  RULE_TOGGLE        as thin, but the first voxel whose centre lies behind the crossing; a crossing
//                     behind the grid goes to w = N. [zju2005] Sec. 2.2.3.
//  RULE_CONSERVATIVE  every voxel of the column whose closed cube meets the triangle.
// Sample lines that meet an edge are shifted by an infinitely small (ε, ε², ε³) in x, y, z, the same
// for the three axes: each closed surface is then crossed an even number of times, and a face on a
// voxel's centre gives all axes the same inside.
#include "voxelization/emit_voxel.glsl"
#include "voxelization/exact_triangle.glsl"

flat in uint triangleIndex;

#if VALUE != 0
layout(std430, binding = ATTRIBUTE_BINDING) restrict readonly buffer Attributes { float attributes[]; };
vec3 cornerAttribute(uint corner) {
    uint vertex = 3u * corners[3u * triangleIndex + corner];
    return vec3(attributes[vertex], attributes[vertex + 1u], attributes[vertex + 2u]);
}
#endif

// Twice the signed area of (from, to, p) in the projection.
double edgeArea(dvec2 from, dvec2 to, dvec2 p) {
    precise double area = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return area;
}

// Whether p, shifted as the head comment says, lies on the inner side of the directed edge.
bool isInside(double area, dvec2 edge) {
    if (area != 0.0) return area > 0.0;
    // du·δv − dv·δu; of the two shifts the earlier axis's is the larger: u's, but v's for y.
    if (axis == 1) return edge.x != 0.0 ? edge.x > 0.0 : edge.y < 0.0;
    return edge.y != 0.0 ? edge.y < 0.0 : edge.x > 0.0;
}

double planeValue(dvec3 normal, dvec3 offset) {
    precise double value = normal.x * offset.x + normal.y * offset.y + normal.z * offset.z;
    return value;
}

dvec3 planeNormal(dvec3 e, dvec3 f) {
    precise dvec3 normal = dvec3(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x);
    return normal;
}

uint interpolatedValue(dvec3 weights) {
#if VALUE != 0
    vec3 w = max(vec3(weights), vec3(0.0));
    w /= max(w.x + w.y + w.z, 1e-30);  // a triangle seen edge-on has no weights: its normal is 0
    return encodedValue(w.x * cornerAttribute(0u) + w.y * cornerAttribute(1u) + w.z * cornerAttribute(2u));
#else
    return encodedValue(vec3(0.0));
#endif
}

#ifndef RULE_CONSERVATIVE

// The sign of the plane's value at a point on the plane that is shifted as the head comment says.
bool isShiftedPositive(dvec3 normal) {
    dvec3 n = axis == 0 ? normal.zxy : axis == 1 ? normal.yzx : normal;
    return n.x != 0.0 ? n.x > 0.0 : n.y != 0.0 ? n.y > 0.0 : n.z > 0.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    dvec3 a = dvec3(cornerLocal(axis, triangleIndex, 0u));
    dvec3 b = dvec3(cornerLocal(axis, triangleIndex, 1u));
    dvec3 c = dvec3(cornerLocal(axis, triangleIndex, 2u));
    dvec2 p = dvec2(pixel * 256 + 128);
    dvec3 n = planeNormal(b - a, c - a);
    if (n.z == 0.0) return;  // edge-on: another axis crosses it
    double side = n.z > 0.0 ? 1.0 : -1.0;
    dvec3 areas = side * dvec3(edgeArea(b.xy, c.xy, p), edgeArea(c.xy, a.xy, p), edgeArea(a.xy, b.xy, p));
    if (!isInside(areas.x, side * (c.xy - b.xy)) || !isInside(areas.y, side * (a.xy - c.xy)) ||
        !isInside(areas.z, side * (b.xy - a.xy)))
        return;

    // The voxel of the crossing; a quotient rounded across a face is put right by the plane's sign.
    dvec2 d = p - a.xy;
    double heightUnits = a.z - (n.x * d.x + n.y * d.y) / n.z;
    int w = int(floor(heightUnits / 256.0));
    if (side * planeValue(n, dvec3(d, double(w * 256) - a.z)) > 0.0) --w;
    if (side * planeValue(n, dvec3(d, double(w * 256 + 256) - a.z)) <= 0.0) ++w;
#ifdef RULE_TOGGLE
    double behind = side * planeValue(n, dvec3(d, double(w * 256 + 128) - a.z));
    bool isBehind = behind != 0.0 ? behind > 0.0 : isShiftedPositive(side * n);
    w = clamp(isBehind ? w : w + 1, 0, RESOLUTION);
    emitVoxel(ivec3(pixel, w), LANE_MASK);
#else
    // The grid is closed: a crossing on its far face belongs to the last voxel.
    if (w == RESOLUTION && planeValue(n, dvec3(d, double(w * 256) - a.z)) == 0.0) --w;
    if (w < 0 || w >= RESOLUTION) return;
    emitVoxel(ivec3(pixel, w), interpolatedValue(areas));
#endif
}

#else

const double kHalf = 128.0;  // half a voxel

// Separating axis "edge × unit axis": the projection of the triangle against that of the cube.
bool isSeparated(dvec2 edge, dvec2 p, dvec2 q, dvec2 r) {
    double radius = kHalf * (abs(edge.x) + abs(edge.y));
    precise double s = edge.x * p.y - edge.y * p.x;
    precise double t = edge.x * q.y - edge.y * q.x;
    precise double u = edge.x * r.y - edge.y * r.x;
    return min(s, min(t, u)) > radius || max(s, max(t, u)) < -radius;
}

// Closed cube around `centre` against the closed triangle: 13 axes (Akenine-Möller 2001). Complete
// for triangles that are a segment or a point.
bool overlaps(dvec3 a, dvec3 b, dvec3 c, dvec3 n, dvec3 centre) {
    a -= centre;
    b -= centre;
    c -= centre;
    if (any(greaterThan(min(a, min(b, c)), dvec3(kHalf)))) return false;
    if (any(lessThan(max(a, max(b, c)), dvec3(-kHalf)))) return false;
    if (abs(planeValue(n, a)) > kHalf * (abs(n.x) + abs(n.y) + abs(n.z))) return false;
    dvec3 edges[3] = dvec3[3](b - a, c - b, a - c);
    for (int i = 0; i < 3; ++i) {
        if (isSeparated(edges[i].xy, a.xy, b.xy, c.xy)) return false;
        if (isSeparated(edges[i].yz, a.yz, b.yz, c.yz)) return false;
        if (isSeparated(edges[i].zx, a.zx, b.zx, c.zx)) return false;
    }
    return true;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    dvec3 a = dvec3(cornerLocal(axis, triangleIndex, 0u));
    dvec3 b = dvec3(cornerLocal(axis, triangleIndex, 1u));
    dvec3 c = dvec3(cornerLocal(axis, triangleIndex, 2u));
    dvec2 p = dvec2(pixel * 256 + 128);
    dvec3 n = planeNormal(b - a, c - a);
    int first = max((int(min(a.z, min(b.z, c.z))) - 1) >> 8, 0);
    int last = min(int(max(a.z, max(b.z, c.z))) >> 8, RESOLUTION - 1);
    if (n.z != 0.0) {
        // Heights of the plane over the pixel, one voxel of slack on both sides for the rounding.
        double centreUnits = a.z - (n.x * (p.x - a.x) + n.y * (p.y - a.y)) / n.z;
        double reachUnits = kHalf * (abs(n.x) + abs(n.y)) / abs(n.z);
        first = int(max(double(first), floor((centreUnits - reachUnits) / 256.0) - 1.0));
        last = int(min(double(last), floor((centreUnits + reachUnits) / 256.0) + 1.0));
    }
    dvec3 areas = dvec3(edgeArea(b.xy, c.xy, p), edgeArea(c.xy, a.xy, p), edgeArea(a.xy, b.xy, p));
    uint value = interpolatedValue(n.z < 0.0 ? -areas : areas);
    for (int w = first; w <= last; ++w) {
        if (overlaps(a, b, c, n, dvec3(p, double(w * 256 + 128)))) emitVoxel(ivec3(pixel, w), value);
    }
}

#endif
