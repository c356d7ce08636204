#version 450 core
// What a cluster's image shows, a workgroup a cluster: parts of objects in its frustum, of each the
// coarsest level that is good enough, of that chunks in the frustum, of those triangles that may
// hold the middle of a texel. They are listed in the order of parts, chunks and triangles, so that
// of two at the same depth the same one is seen in every run.
#include "reflections/objects.glsl"
#include "clustered_reflections/atlas.glsl"
#include "clustered_reflections/culling.glsl"
#include "clustered_reflections/detail_levels.glsl"
#include "kit/workgroup_scan.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) readonly buffer Parts { DetailPart parts[]; };
layout(std430) readonly buffer Levels { DetailLevel levels[]; };
#include "clustered_reflections/triangle_corners.glsl"
layout(std430) writeonly buffer Visible { uvec2 visible[]; };  // triangle | own << 31, cluster
layout(std430) writeonly buffer VisibleCorners {
    float visibleCorners[];  // clip x, y, w over the near distance, of three corners
};

uniform uint partCount;
uniform float levelErrorPx;  // of a level, at most; 0: the finest

const uint kOwnTriangle = 1u << 31;
const uint kMirrored = 1u << 30;  // own, and an odd number of axes is mirrored: it winds backwards

// Rasterizers round corners to 1/256 of a pixel.
const float kRoundingPx = 1.0 / 128.0;

shared uint firsts[GROUP_SIZE];  // chunks of a part's level
shared uint starts[GROUP_SIZE];  // their places among those of all parts
shared uint ownParts[GROUP_SIZE];
shared uint seenChunks[GROUP_SIZE];  // chunk | own << 31 | mirrored << 30
shared uint marks[GROUP_SIZE / 32];
shared uint firstPlace;

// How many invocations before this one have `value`; `total` of all. To be called by all of them.
uint countBefore(bool value, out uint total) {
    uint self = gl_LocalInvocationID.x;
    barrier();  // the last call's readers are done
    if (self < GROUP_SIZE / 32u) marks[self] = 0u;
    barrier();
    if (value) atomicOr(marks[self >> 5], 1u << (self & 31u));
    barrier();
    uint before = uint(bitCount(marks[self >> 5] & ((1u << (self & 31u)) - 1u)));
    total = 0u;
    for (uint i = 0u; i < GROUP_SIZE / 32u; ++i) {
        uint ofMarks = uint(bitCount(marks[i]));
        if (i < self >> 5) before += ofMarks;
        total += ofMarks;
    }
    return before;
}

void toWorld(mat4 worldFromMesh, inout vec3 centre, inout vec3 halfSize) {
    mat3 axes = mat3(worldFromMesh);
    centre = (worldFromMesh * vec4(centre, 1.0)).xyz;
    halfSize = mat3(abs(axes[0]), abs(axes[1]), abs(axes[2])) * halfSize;
}

// The part's coarsest level whose error is small in texels, where the part is nearest.
uint levelOf(DetailPart part, mat4 rows, float nearM, vec3 centre, vec3 halfSize, mat3 axes,
             vec2 sizePx) {
    // Row x is scale · axis − shift · n: of a point at distance w, a metre aside is scale / w.
    vec3 n = rows[3].xyz;
    vec3 x = rows[0].xyz, y = rows[1].xyz;
    vec2 scale = vec2(length(x - dot(x, n) * n), length(y - dot(y, n) * n));
    float nearest = max(dot(n, centre) + rows[3].w - dot(abs(n), halfSize), nearM);
    float texelsPerMetre = 0.5 * max(scale.x * sizePx.x, scale.y * sizePx.y) / nearest;
    float metresPerMesh = max(length(axes[0]), max(length(axes[1]), length(axes[2])));
    float most = levelErrorPx / max(texelsPerMetre * metresPerMesh, 1e-30);
    uint level = part.firstLevel;
    for (uint i = 1u; i < part.levelCount; ++i) {
        if (levels[part.firstLevel + i].errorMesh <= most) level = part.firstLevel + i;
    }
    return level;
}

vec3 clipped(mat4 rows, float perNear, vec3 p) {
    vec4 at = vec4(p, 1.0);
    return vec3(dot(rows[0], at), dot(rows[1], at), dot(rows[3], at)) * perNear;
}

float cross2(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Whether a point lies in the triangle, or so near that rounding may put it there.
bool holds(vec2 p, vec2 a, vec2 b, vec2 c) {
    vec2 ab = b - a, bc = c - b, ca = a - c;
    float side = cross2(ab, ca) <= 0.0 ? 1.0 : -1.0;
    vec3 inside = side * vec3(cross2(ab, p - a), cross2(bc, p - b), cross2(ca, p - c));
    vec3 rounding = kRoundingPx * vec3(abs(ab.x) + abs(ab.y), abs(bc.x) + abs(bc.y),
                                       abs(ca.x) + abs(ca.y));
    return all(greaterThanEqual(inside, -rounding));
}

// Whether the triangle may hold the middle of a texel: by its box, which is known where no corner
// lies before the near plane; where that holds few middles, by these.
bool mayShow(vec3 a, vec3 b, vec3 c, vec2 sizePx) {
    float nearest = min(a.z, min(b.z, c.z));
    if (max(a.z, max(b.z, c.z)) < 1.0) return false;
    if (nearest < 1.0) {
        return max(max(a.x + a.z, b.x + b.z), c.x + c.z) >= 0.0 &&
               max(max(a.z - a.x, b.z - b.x), c.z - c.x) >= 0.0 &&
               max(max(a.y + a.z, b.y + b.z), c.y + c.z) >= 0.0 &&
               max(max(a.z - a.y, b.z - b.y), c.z - c.y) >= 0.0;
    }
    vec2 pa = a.xy / a.z, pb = b.xy / b.z, pc = c.xy / c.z;
    pa = (pa * 0.5 + 0.5) * sizePx;
    pb = (pb * 0.5 + 0.5) * sizePx;
    pc = (pc * 0.5 + 0.5) * sizePx;
    vec2 first = ceil(max(min(pa, min(pb, pc)) - kRoundingPx, vec2(0.0)) - 0.5);
    vec2 last = floor(min(max(pa, max(pb, pc)) + kRoundingPx, sizePx) - 0.5);
    vec2 count = last - first + 1.0;
    if (any(lessThan(count, vec2(1.0)))) return false;
    if (any(greaterThan(count, vec2(2.0)))) return true;
    for (float y = first.y; y <= last.y; ++y) {
        for (float x = first.x; x <= last.x; ++x) {
            if (holds(vec2(x, y) + 0.5, pa, pb, pc)) return true;
        }
    }
    return false;
}

void listTriangles(uint chunkAndOwn, uint cluster, mat4 rows, float perNear, vec2 sizePx,
                   vec3 eyeWorld) {
    uint self = gl_LocalInvocationID.x;
    uint chunk = chunkAndOwn & ~(kOwnTriangle | kMirrored);
    uint triangle = chunks[chunk].firstTriangle + self;
    vec3 a = vec3(0.0), b = vec3(0.0), c = vec3(0.0);
    bool isShown = false;
    if (self < chunks[chunk].triangleCount) {
        vec3 worldA = cornerOf(triangle, 0u), worldB = cornerOf(triangle, 1u);
        vec3 worldC = cornerOf(triangle, 2u);
        a = clipped(rows, perNear, worldA);
        b = clipped(rows, perNear, worldB);
        c = clipped(rows, perNear, worldC);
        isShown = mayShow(a, b, c, sizePx);
        // The own reflector where it faces the camera, as cluster_image.frag.glsl has it.
        bool showsBack = (cameras[cluster].flags & kShowsOwnBack) != 0u;
        if ((chunkAndOwn & kOwnTriangle) != 0u && !showsBack) {
            float facing = dot(cross(worldB - worldA, worldC - worldA), eyeWorld - worldA);
            isShown = isShown && ((chunkAndOwn & kMirrored) == 0u ? facing >= 0.0 : facing <= 0.0);
        }
    }
    uint total;
    uint before = countBefore(isShown, total);
    if (total == 0u) return;  // the whole workgroup
    if (self == 0u) firstPlace = atomicAdd(listedCount, total);
    barrier();
    uint place = firstPlace + before;
    if (!isShown || place >= MOST_VISIBLE) return;
    visible[place] = uvec2(triangle | (chunkAndOwn & kOwnTriangle), cluster);
    uint at = 9u * place;
    for (uint k = 0u; k < 3u; ++k) {
        visibleCorners[at + k] = a[k];
        visibleCorners[at + 3u + k] = b[k];
        visibleCorners[at + 6u + k] = c[k];
    }
}

void main() {
    uint cluster = gl_WorkGroupID.x, self = gl_LocalInvocationID.x;
    vec2 sizePx = vec2(places[cluster].zw);
    if (sizePx.x == 0.0) return;  // no image, the whole workgroup
    mat4 rows = transpose(cameras[cluster].clipFromWorld);
    float nearM = cameras[cluster].eyeWorld.w;
    bool showsOwn = (cameras[cluster].flags & kShowsOwn) != 0u;
    uint reflector = cameras[cluster].reflector;

    for (uint firstPart = 0u; firstPart < partCount; firstPart += GROUP_SIZE) {
        uvec2 seen = uvec2(0u);
        uint own = 0u;
        if (firstPart + self < partCount) {
            DetailPart part = parts[firstPart + self];
            mat4 worldFromMesh = objects[part.object].worldFromMesh;
            mat3 axes = mat3(worldFromMesh);
            vec3 centre = part.boundsCentre.xyz, halfSize = part.boundsHalfSize.xyz;
            toWorld(worldFromMesh, centre, halfSize);
            uint ofPart = objects[part.object].surface & 0xFFFFu;
            bool isOwn = ofPart == reflector;
            if (isOwn) own = kOwnTriangle | (determinant(axes) < 0.0 ? kMirrored : 0u);
            bool isLeftOut = areBackToBack(ofPart, reflector) || (isOwn && !showsOwn);
            if (!isLeftOut && isInFrustum(rows, centre, halfSize)) {
                DetailLevel level =
                    levels[levelOf(part, rows, nearM, centre, halfSize, axes, sizePx)];
                seen = uvec2(level.firstChunk, level.chunkCount);
            }
        }
        uint chunkTotal;
        uint start = exclusiveScan(seen.y, chunkTotal);
        firsts[self] = seen.x;
        starts[self] = start;
        ownParts[self] = own;
        barrier();
        for (uint firstChunk = 0u; firstChunk < chunkTotal; firstChunk += GROUP_SIZE) {
            uint slot = firstChunk + self;
            uint chunk = 0u;
            bool isSeen = false;
            if (slot < chunkTotal) {
                uint k = 0u;  // the last part that begins at this place or before
                for (uint step = GROUP_SIZE / 2u; step > 0u; step /= 2u) {
                    if (starts[k + step] <= slot) k += step;
                }
                chunk = firsts[k] + slot - starts[k];
                vec3 centre = chunks[chunk].boundsCentre.xyz;
                vec3 halfSize = chunks[chunk].boundsHalfSize.xyz;
                toWorld(objects[chunks[chunk].object].worldFromMesh, centre, halfSize);
                isSeen = isInFrustum(rows, centre, halfSize);
                chunk |= ownParts[k];
            }
            uint seenTotal;
            uint before = countBefore(isSeen, seenTotal);
            if (isSeen) seenChunks[before] = chunk;
            barrier();
            for (uint i = 0u; i < seenTotal; ++i) {
                listTriangles(seenChunks[i], cluster, rows, 1.0 / nearM, sizePx,
                              cameras[cluster].eyeWorld.xyz);
            }
            barrier();
        }
    }
}
