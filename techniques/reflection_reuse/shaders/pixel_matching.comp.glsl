#version 450 core
// [xie2017] Algorithm 9: for every reflective sample s of the key frame, the sample s* whose plane
// now shows the eye what s showed. Reads the key frame's G-buffer and travel distances and the
// offsets of the frame before; writes the offsets s* − s and how many steps each search took.
// The tests have the same on the host, operation by operation.
#include "reflections/gbuffer.glsl"

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

uniform sampler2D travelDistances;  // s.r, metres; 0: left the scene
uniform sampler2D previousOffsets;
layout(rg16f) restrict writeonly uniform image2D offsets;
layout(r8ui) restrict writeonly uniform uimage2D stepCounts;

uniform vec3 eyeWorld;  // E_cur
uniform float diagonalM;
uniform bool hasPrevious;
uniform int maxSteps;
uniform float silhouette;

// A sample of the key frame as the search sees it: a plane, and by how much the reflection misses
// the eye there.
struct Candidate {
    ivec2 pixel;
    float depthM;
    vec3 miss;
};

struct Search {
    Candidate at;
    int steps;
    float reachSquared;  // (the most that the miss changes from `at` to a neighbour)²
    bool isOver;         // at a minimum; else it ran out of steps
};

float squared(vec3 v) {
    return dot(v, v);
}

// Of any length: what follows needs no unit vectors, and so gives the same bits everywhere.
vec3 normalAt(ivec2 pixel) {
    return directionFromOctahedral(texelFetch(gbufferNormal, pixel, 0).rg);
}

// v, mirrored in the plane through 0 that is perpendicular to `normal`.
vec3 mirrored(vec3 v, vec3 normal) {
    return v - (2.0 * dot(v, normal) / dot(normal, normal)) * normal;
}

// R of Eq. 8. A ray that left the scene counts as ending one diagonal away.
vec3 reflectedPosition(ivec2 pixel) {
    float r = texelFetch(travelDistances, pixel, 0).r;
    if (r <= 0.0) r = diagonalM;
    vec3 position = gbufferPosition(pixel);
    vec3 view = position - gbufferEyeWorld;
    return position + (r / sqrt(squared(view))) * mirrored(view, normalAt(pixel));
}

// Sec. 5.4.1: from the eye to the nearest point of the ray from M, the mirror image of R in the
// candidate's plane, through W_n. Its length is d(s_n, R, E_cur). The ray leaves the mirror in W_n:
// else candidates that turn their backs to R match, an eye between M and W_n.
vec3 missAt(vec3 position, vec3 normal, vec3 reflected) {
    vec3 image = position + mirrored(reflected - position, normal);
    vec3 direction = position - image;
    float lengthSquared = squared(direction);
    // R in the candidate itself: no ray, only the point.
    float t = lengthSquared > 0.0 ? max(dot(eyeWorld - position, direction) / lengthSquared, 0.0) : 0.0;
    return position + t * direction - eyeWorld;
}

Candidate candidateAt(ivec2 pixel, float depthM, vec3 reflected) {
    return Candidate(pixel, depthM,
                     missAt(gbufferPositionAt(pixel, depthM), normalAt(pixel), reflected));
}
Candidate candidateAt(ivec2 pixel, vec3 reflected) {
    return candidateAt(pixel, texelFetch(gbufferDepth, pixel, 0).r, reflected);
}

bool isOnReflector(ivec2 pixel, uint reflector) {
    return all(greaterThanEqual(pixel, ivec2(0))) &&
           all(lessThan(pixel, textureSize(gbufferSurface, 0))) &&
           reflectorOf(texelFetch(gbufferSurface, pixel, 0).r) == reflector;
}

// Whether a sample next to it continues the surface: no silhouette lies between.
bool isNeighbour(Candidate from, ivec2 pixel, uint reflector, out float depthM) {
    depthM = 0.0;
    if (!isOnReflector(pixel, reflector)) return false;
    depthM = texelFetch(gbufferDepth, pixel, 0).r;
    return abs(depthM - from.depthM) <= silhouette * min(depthM, from.depthM);
}

// The best of the eight samples around where the search is, or that itself.
Candidate bestAround(Candidate at, uint reflector, vec3 reflected, out float reachSquared) {
    Candidate best = at;
    float bestSquared = squared(best.miss);
    reachSquared = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 pixel = at.pixel + ivec2(i % 3 - 1, i / 3 - 1);
        float depthM;
        if (i == 4 || !isNeighbour(at, pixel, reflector, depthM)) continue;
        Candidate candidate = candidateAt(pixel, depthM, reflected);
        reachSquared = max(reachSquared, squared(candidate.miss - at.miss));
        float distanceSquared = squared(candidate.miss);
        if (distanceSquared < bestSquared) {
            bestSquared = distanceSquared;
            best = candidate;
        }
    }
    return best;
}

// The loop of Algorithm 9. Samples beyond a silhouette are no candidates.
Search searchRings(Search search, uint reflector, vec3 reflected) {
    for (; search.steps <= maxSteps; ++search.steps) {
        Candidate best = bestAround(search.at, reflector, reflected, search.reachSquared);
        if (best.pixel == search.at.pixel) {
            search.isOver = true;
            return search;
        }
        search.at = best;
    }
    return search;
}

#if IS_SECOND_ORDER
// How the miss changes by a pixel along an axis, taken linear between neighbouring samples: their
// positions and normals both vary, so that the surface is bent. 0 where neither neighbour is of
// the surface.
vec3 missDifference(Search search, ivec2 axis, uint reflector, vec3 reflected,
                    inout float reachSquared) {
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 pixel = search.at.pixel + side * axis;
        float depthM;
        if (!isNeighbour(search.at, pixel, reflector, depthM)) continue;
        vec3 difference = candidateAt(pixel, depthM, reflected).miss - search.at.miss;
        reachSquared = max(reachSquared, squared(difference));
        sum += float(side) * difference;
        count += 1.0;
    }
    return count > 0.0 ? sum / count : sum;
}

// The Gauss-Newton step, in pixels, to where the miss vanishes.
vec2 newtonStep(inout Search search, uint reflector, vec3 reflected) {
    search.reachSquared = 0.0;
    vec3 dx = missDifference(search, ivec2(1, 0), reflector, reflected, search.reachSquared);
    vec3 dy = missDifference(search, ivec2(0, 1), reflector, reflected, search.reachSquared);
    // DAMPING keeps the equations soluble where the reflection does not tell directions apart.
    float damping = DAMPING * (dot(dx, dx) + dot(dy, dy));
    float a = dot(dx, dx) + damping, b = dot(dx, dy), c = dot(dy, dy) + damping;
    vec2 right = -vec2(dot(dx, search.at.miss), dot(dy, search.at.miss));
    float determinant = a * c - b * b;
    if (determinant <= 0.0) return vec2(0.0);
    return vec2(c * right.x - b * right.y, a * right.y - b * right.x) / determinant;
}

// Steps from sample to sample until the miss vanishes within half a pixel; rings where a step does
// not come nearer. `between` is how far from the sample the match lies.
Search searchBent(Search search, uint reflector, vec3 reflected, out vec2 between) {
    for (int i = 0; i < MAX_NEWTON_STEPS && search.steps < maxSteps; ++i) {
        vec2 delta = newtonStep(search, reflector, reflected);
        float longest = max(abs(delta.x), abs(delta.y));
        if (longest <= 0.5) {
            between = delta;
            search.isOver = true;
            return search;
        }
        delta *= min(LONGEST_STEP / longest, 1.0);
        ivec2 pixel = search.at.pixel + ivec2(floor(delta + 0.5));
        if (!isOnReflector(pixel, reflector)) break;
        Candidate candidate = candidateAt(pixel, reflected);
        if (squared(candidate.miss) >= squared(search.at.miss)) break;
        search.at = candidate;
        ++search.steps;
    }
    search = searchRings(search, reflector, reflected);
    float ringReachSquared = search.reachSquared;
    between = clamp(newtonStep(search, reflector, reflected), -0.5, 0.5);
    search.reachSquared = ringReachSquared;
    return search;
}
#endif

// Where the search begins: at the previous match, at the first frame in the sample itself. A sample
// that lost its match begins as the nearest sample does that has one, of those at START_REACH
// pixels and halves of it; far from all of them it is not searched.
bool findStart(ivec2 pixel, uint reflector, out ivec2 start) {
    start = pixel;
    if (!hasPrevious) return true;
    for (int reach = 0; reach <= START_REACH; reach = max(2 * reach, 1)) {
        for (int i = 0; i < (reach == 0 ? 1 : 9); ++i) {
            ivec2 from = pixel + reach * ivec2(i % 3 - 1, i / 3 - 1);
            if (!isOnReflector(from, reflector)) continue;
            vec2 previous = texelFetch(previousOffsets, from, 0).rg;
            if (previous.x >= INVALID_OFFSET) continue;
            ivec2 offset = ivec2(floor(previous + 0.5));
            start = pixel + offset;
            // Beyond the border it begins where the other one ended.
            if (!isOnReflector(start, reflector)) start = from + offset;
            if (!isOnReflector(start, reflector)) start = pixel;
            return true;
        }
    }
    return false;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(gbufferSurface, 0)))) return;
    uint reflector = reflectorOf(texelFetch(gbufferSurface, pixel, 0).r);
    vec2 offset = vec2(INVALID_OFFSET);
    int steps = 0;
    ivec2 start;
    if (reflector != 0u && findStart(pixel, reflector, start)) {
        vec3 reflected = reflectedPosition(pixel);
        Search search = Search(candidateAt(start, reflected), 0, 0.0, false);
        vec2 between = vec2(0.0);
#if IS_SECOND_ORDER
        search = searchBent(search, reflector, reflected, between);
#else
        search = searchRings(search, reflector, reflected);
#endif
        // Inside of the silhouette: were the surface to go on, the match would lie within a step.
        vec3 toEye = ROUNDING * (eyeWorld - gbufferPosition(search.at.pixel));
        if (search.isOver &&
            squared(search.at.miss) <= max(search.reachSquared, squared(toEye))) {
            offset = vec2(search.at.pixel - pixel) + between;
        }
        steps = search.steps;
    }
    imageStore(offsets, pixel, vec4(offset, 0.0, 0.0));
    imageStore(stepCounts, pixel, uvec4(min(steps, 255)));
}
