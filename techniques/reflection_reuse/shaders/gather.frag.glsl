#version 450 core
// Ours, in place of Algorithm 9, shift and warp ([xie2017] Sec. 5.4): for each reflective sample of
// the new view the place of the key frame whose reflected point R lies on the sample's own mirror
// ray. Reads the new view's G-buffer and the key frame's R, radiance and depth; writes the radiance
// at the place, and 1 where there is none. The device counts the fragments that remain.
#include "reflections/gbuffer.glsl"

uniform sampler2D keyReflected;  // of reflected_points.frag.glsl
uniform sampler2D keyRadiance;
uniform sampler2D keyDepth;
uniform mat4 keyClipFromWorld;
uniform float depthTolerance;  // share of the depth

// A search that is longer finds nothing.
const int kMaxSteps = 24;
// Places between a found one and the sample's own surface that are asked for a nearer point.
const float kMostBetween = 8.0;
// Of a pixel's change: how far a place may miss the ray. Twice as much recomputes less and errs more.
const float kMostMissed = 0.5;
// Share of the distance along the ray by which samples next to a place may differ that show the same
// surface. Where others, beyond an edge, weigh more than kMostOther of the four, which side the ray
// meets is not known, and the sample is traced.
const float kSameSurface = 0.1;
const float kMostOther = 0.25;
// An angle that no point before the ray's origin has.
const float kBehind = 100.0;

layout(location = kRadianceTarget) out vec4 radiance;
layout(location = kWantedTarget) out uint wanted;

// A sample of the key frame as the mirror ray sees it: by how much its R misses the ray, across it,
// as an angle, and how far along the ray R is.
struct Candidate {
    ivec2 pixel;
    vec2 miss;
    float along;
};

struct Match {
    Candidate at;
    vec2 between;  // pixels from there
    mat2 change;   // of the miss, by a pixel along either axis
    bool isValid;
};

float reflector;
vec3 origin, direction, across, upright;  // of the mirror ray, unit

float squared(vec2 v) {
    return dot(v, v);
}

// False: of another reflector or of none.
bool candidateAt(ivec2 pixel, out Candidate found) {
    ivec2 size = textureSize(keyReflected, 0);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) return false;
    vec4 texel = texelFetch(keyReflected, pixel, 0);
    vec3 to = texel.xyz - origin;
    float along = dot(to, direction);
    vec2 miss = vec2(dot(to, across), dot(to, upright));
    // Behind the ray's origin any miss is larger than before it.
    found = Candidate(pixel, along > 0.0 ? miss / along : kBehind * normalize(miss), along);
    return texel.w == reflector;
}

// By a pixel along an axis: of the two sides the one where the miss changes less. On the other one
// there may be an edge of what is reflected.
vec2 changeAlong(Candidate at, ivec2 axis) {
    vec2 change = vec2(0.0);
    float least = 3.4e38;
    for (int side = -1; side <= 1; side += 2) {
        Candidate beside;
        if (!candidateAt(at.pixel + side * axis, beside)) continue;
        vec2 difference = float(side) * (beside.miss - at.miss);
        if (squared(difference) >= least) continue;
        least = squared(difference);
        change = difference;
    }
    return change;
}

// The Gauss-Newton step, in pixels, to where the miss vanishes.
vec2 newtonStep(Match match) {
    mat2 turned = transpose(match.change);
    mat2 square = turned * match.change;
    // DAMPING keeps the equations soluble where the reflection does not tell directions apart.
    float damping = DAMPING * (square[0].x + square[1].y);
    if (damping <= 0.0) return vec2(0.0);
    return -inverse(square + mat2(damping)) * (turned * match.at.miss);
}

// Steps from sample to sample until the miss vanishes within half a pixel, or one does not come
// nearer: what a search by rings finds from there errs more than it saves.
Match search(Candidate start) {
    Match match = Match(start, vec2(0.0), mat2(0.0), false);
    int steps = 0;
    for (; steps < kMaxSteps; ++steps) {
        match.change =
            mat2(changeAlong(match.at, ivec2(1, 0)), changeAlong(match.at, ivec2(0, 1)));
        vec2 delta = newtonStep(match);
        float longest = max(abs(delta.x), abs(delta.y));
        match.between = clamp(delta, -0.5, 0.5);
        if (longest <= 0.5) break;
        delta *= min(LONGEST_STEP / longest, 1.0);
        Candidate next;
        if (!candidateAt(match.at.pixel + ivec2(floor(delta + 0.5)), next) ||
            squared(next.miss) >= squared(match.at.miss)) {
            break;
        }
        match.at = next;
    }
    float most = kMostMissed * kMostMissed * max(squared(match.change[0]), squared(match.change[1]));
    // ROUNDING keeps a sample valid that has no neighbour to measure by.
    match.isValid = steps < kMaxSteps && squared(match.at.miss + match.change * match.between) <=
                                             max(most, ROUNDING * ROUNDING);
    return match;
}

// Whether the key frame sees the sample's own surface: beside what hides it, much is hidden that
// its ray could meet. The depths of four samples around bound the surface's own there.
bool isSeen(vec2 ownPlace, float depth, out Candidate own) {
    if (!candidateAt(ivec2(floor(ownPlace)), own)) return false;
    float nearest = 3.4e38, farthest = 0.0;
    for (int i = 0; i < 4; ++i) {
        Candidate corner;
        if (!candidateAt(ivec2(floor(ownPlace - 0.5)) + ivec2(i & 1, i >> 1), corner)) continue;
        float found = texelFetch(keyDepth, corner.pixel, 0).r;
        nearest = min(nearest, found);
        farthest = max(farthest, found);
    }
    return depth >= nearest * (1.0 - depthTolerance) && depth <= farthest * (1.0 + depthTolerance);
}

// Of several places on the ray the nearest R counts. The key frame sees the ray as a line from the
// sample's own surface to what it meets; a nearer point that it meets lies between. There what the
// key frame sees changes from beyond the ray to before it.
bool findNearer(vec2 ownPlace, Match found, out Candidate nearer) {
    vec2 way = vec2(found.at.pixel) + 0.5 - ownPlace;
    vec2 beyond = -(found.change * way);
    int count = int(min(max(abs(way.x), abs(way.y)), kMostBetween));
    for (int i = 1; i < count; ++i) {
        vec2 place = ownPlace + way * (float(i) / float(count));
        if (candidateAt(ivec2(floor(place)), nearer) && dot(nearer.miss, beyond) < 0.0 &&
            nearer.along > 0.0 && nearer.along < found.at.along) {
            return true;
        }
    }
    return false;
}

// The radiance at a match, bilinear, and in a the weight; at an edge of what is reflected: 0.
vec4 radianceAt(Match match) {
    vec2 place = vec2(match.at.pixel) + match.between;
    ivec2 low = ivec2(floor(place));
    vec2 fraction = place - vec2(low);
    vec4 sum = vec4(0.0);
    float other = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 near = mix(1.0 - fraction, fraction, vec2(corner));
        float weight = near.x * near.y;
        Candidate beside;
        if (weight == 0.0 || !candidateAt(low + corner, beside)) continue;
        if (abs(beside.along - match.at.along) > kSameSurface * match.at.along) {
            other += weight;
            continue;
        }
        sum += weight * vec4(texelFetch(keyRadiance, beside.pixel, 0).rgb, 1.0);
    }
    return other > kMostOther ? vec4(0.0) : sum;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint own = reflectorOf(texelFetch(gbufferSurface, pixel, 0).r);
    if (own == 0u) discard;
    reflector = float(own);
    origin = gbufferPosition(pixel);
    direction = gbufferMirrorDirection(origin, gbufferUnitNormal(pixel));
    across = normalize(abs(direction.x) < 0.7 ? vec3(0.0, direction.z, -direction.y)
                                              : vec3(-direction.z, 0.0, direction.x));
    upright = cross(direction, across);
    radiance = vec4(0.0);
    wanted = 1u;

    vec4 clip = keyClipFromWorld * vec4(origin, 1.0);
    if (clip.w <= 0.0) return;
    vec2 ownPlace = (0.5 * clip.xy / clip.w + 0.5) * vec2(textureSize(keyReflected, 0));
    Candidate start, nearer;
    if (!isSeen(ownPlace, clip.w, start)) return;
    Match best = search(start);
    if (findNearer(ownPlace, best, nearer)) {
        Match other = search(nearer);
        if (other.isValid && (!best.isValid || other.at.along < best.at.along)) best = other;
    }
    if (!best.isValid) return;
    radiance = radianceAt(best);
    if (radiance.a == 0.0) return;
    radiance = vec4(radiance.rgb / radiance.a, 1.0);
    wanted = 0u;
}
