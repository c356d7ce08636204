// [xie2017] Algorithm 7: a ray against a depth image, as march_test.cpp has it. MARCH is 0
// for a texel a step, 1 for stepping over whole tiles whose content lies behind the ray.
//
// The image holds nearM / z, z being the distance along the axis, and 0 where nothing is: linear in
// the image, as 1 / (k1 + k2·u) is the ray's z, so that both are compared without a division, and
// "behind" is "smaller". Texels are numbered in the whole texture; the image begins at originPx.
//
// Departure [xie2017] Sec. 4.7.4: the cluster's own reflector, where the image shows it, counts once
// the ray has been in front of something by kLeaving: before, it has not left the surface that it
// starts from.

struct MarchImage {
    mat4 clipFromWorld;  // clip w: z; clip z from −w to w
    ivec2 originPx;
    ivec2 sizePx;
    float nearM;
};

struct MarchHit {
    vec2 positionPx;  // in the image, where the ray first is behind
    vec2 metPx;       // where it meets the surface, at most a step before
    float fraction;   // u of positionPx
    float along;      // where on the way from begin to end, 0 … 1, it meets the surface
    int steps;        // that were looked at, of a miss too
    vec2 beforePx;    // a step before positionPx: the ray is not behind what is there
};

// The includer reads its image. storedAt: nearM / z of a texel. isOwnAt: whether the texel shows
// the cluster's own reflector. nearestIn: the largest storedAt of the texels of a tile, or more;
// level 1 … MARCH_LEVELS with tiles of 4, 8, 16, … texels a side.
float storedAt(ivec2 texel);
bool isOwnAt(ivec2 texel);
float nearestIn(ivec2 tile, int level);

// Keeps of [t.x, t.y] what lies on the inner side of a plane, to which the ends have these signed
// distances.
void cut(float begin, float end, inout vec2 t) {
    if (begin < 0.0) t.x = end < 0.0 ? 2.0 : max(t.x, begin / (begin - end));
    if (end < 0.0 && !(begin < 0.0)) t.y = min(t.y, begin / (begin - end));
}

// Part of the distance. Less, and a ray is taken to have left its own surface where that slopes
// within a texel; more, and near parts of a bowl are not seen.
const float kLeaving = 1.0 / 32.0;

struct ProjectedRay {
    vec2 beginPx, deltaPx;
    float k1, k2;  // times nearM
    int steps;
    vec2 kept;  // of the way from begin to end
};

bool project(MarchImage image, vec3 beginWorld, vec3 endWorld, out ProjectedRay ray) {
    vec4 begin = image.clipFromWorld * vec4(beginWorld, 1.0);
    vec4 end = image.clipFromWorld * vec4(endWorld, 1.0);
    vec2 size = vec2(image.sizePx);
    // Half a texel outwards: the outermost rays run along the edge.
    vec2 border = 1.0 + 1.0 / size;
    vec2 t = vec2(0.0, 1.0);
    cut(border.x * begin.w + begin.x, border.x * end.w + end.x, t);
    cut(border.x * begin.w - begin.x, border.x * end.w - end.x, t);
    cut(border.y * begin.w + begin.y, border.y * end.w + end.y, t);
    cut(border.y * begin.w - begin.y, border.y * end.w - end.y, t);
    cut(begin.w + begin.z, end.w + end.z, t);
    cut(begin.w - begin.z, end.w - end.z, t);
    ray.kept = t;
    if (!(t.x <= t.y)) return false;  // nothing is left

    vec4 from = begin + (end - begin) * t.x;
    vec4 to = begin + (end - begin) * t.y;
    if (!(from.w > 0.0 && to.w > 0.0)) return false;
    ray.beginPx = (from.xy / from.w * 0.5 + 0.5) * size;
    ray.deltaPx = (to.xy / to.w * 0.5 + 0.5) * size - ray.beginPx;
    ray.k1 = image.nearM / from.w;
    ray.k2 = image.nearM / to.w - ray.k1;
    // Clipped, it crosses the image once; the bound ends the march should rounding say otherwise.
    float longest = min(max(abs(ray.deltaPx.x), abs(ray.deltaPx.y)), 2.0 * max(size.x, size.y));
    ray.steps = max(int(ceil(longest)), 1);
    return true;
}

// The texel of a sample, in the whole texture.
ivec2 texelOf(MarchImage image, ProjectedRay ray, float u) {
    ivec2 texel = ivec2(floor(ray.beginPx + u * ray.deltaPx));
    return image.originPx + clamp(texel, ivec2(0), image.sizePx - 1);
}

// What the image shows at a place, between texels where they belong to one surface: nearM / z is
// linear on a plane. Where they differ by more than a quarter they do not: the nearest texel.
float storedBetween(MarchImage image, vec2 positionPx) {
    vec2 place = clamp(positionPx, vec2(0.5), vec2(image.sizePx) - 0.5) - 0.5;
    ivec2 first = image.originPx + ivec2(place);
    ivec2 last = min(first + 1, image.originPx + image.sizePx - 1);
    vec4 texels = vec4(storedAt(first), storedAt(ivec2(last.x, first.y)),
                       storedAt(ivec2(first.x, last.y)), storedAt(last));
    vec2 weight = fract(place);
    float least = min(min(texels.x, texels.y), min(texels.z, texels.w));
    float most = max(max(texels.x, texels.y), max(texels.z, texels.w));
    vec2 rows = mix(texels.xz, texels.yw, weight.x);
    if (least > 0.75 * most) return mix(rows.x, rows.y, weight.y);
    vec2 columns = weight.x < 0.5 ? texels.xz : texels.yw;
    return weight.y < 0.5 ? columns.x : columns.y;
}

MarchHit hitAt(MarchImage image, ProjectedRay ray, int step, int steps) {
    float perStep = 1.0 / float(ray.steps);
    float u = float(step) * perStep;
    float before = max(u - perStep, 0.0);
    vec2 positionPx = ray.beginPx + u * ray.deltaPx;
    // Between this sample and the one before the ray meets the surface, both taken as straight.
    vec2 beforePx = ray.beginPx + before * ray.deltaPx;
    float behind = storedBetween(image, positionPx) - (ray.k1 + ray.k2 * u);
    float inFront = ray.k1 + ray.k2 * before - storedBetween(image, beforePx);
    float met = behind > 0.0 && inFront >= 0.0 ? mix(before, u, inFront / (inFront + behind)) : u;
    // From the image back to the ray, perspective undone.
    float kEnd = ray.k1 + ray.k2;
    float along = met * kEnd / ((1.0 - met) * ray.k1 + met * kEnd);
    return MarchHit(positionPx, ray.beginPx + met * ray.deltaPx, u,
                    mix(ray.kept.x, ray.kept.y, along), steps, beforePx);
}

#if MARCH == 0

bool march(MarchImage image, vec3 beginWorld, vec3 endWorld, out MarchHit hit) {
    ProjectedRay ray;
    hit.steps = 0;
    if (image.sizePx.x <= 0 || !project(image, beginWorld, endWorld, ray)) return false;
    float perStep = 1.0 / float(ray.steps);
    bool hasLeftOwn = false;
    for (int step = 0; step <= ray.steps; ++step) {
        float u = float(step) * perStep;
        ivec2 texel = texelOf(image, ray, u);
        float stored = storedAt(texel);
        float k = ray.k1 + ray.k2 * u;
        bool isBehind = k < stored;
        if (isBehind && (hasLeftOwn || !isOwnAt(texel))) {
            hit = hitAt(image, ray, step, step + 1);
            return true;
        }
        hasLeftOwn = hasLeftOwn || k * (1.0 - kLeaving) > stored;
    }
    hit.steps = ray.steps + 1;
    return false;
}

#else

// The last sample from `step` on whose texel lies in the same tile. Positions grow or fall with u,
// in floating point too, so that all between two samples of one tile lie in it.
int lastInTile(MarchImage image, ProjectedRay ray, int step, ivec2 tile, int shift) {
    vec2 edge = vec2(((tile + ivec2(greaterThan(ray.deltaPx, vec2(0.0)))) << shift) -
                     image.originPx);
    // Steps to the edge; an axis along which the ray does not move never gets there.
    vec2 most = vec2(float(ray.steps));
    vec2 steps = clamp((edge - ray.beginPx) / ray.deltaPx * most, vec2(0.0), most);
    if (ray.deltaPx.x == 0.0) steps.x = most.x;
    if (ray.deltaPx.y == 0.0) steps.y = most.y;
    int last = clamp(int(min(steps.x, steps.y)), step, ray.steps);
    // Rounding, or an edge that is met just at a sample: a sample fewer, or none.
    float perStep = 1.0 / float(ray.steps);
    for (int attempt = 0; attempt < 2 && last > step; ++attempt) {
        if ((texelOf(image, ray, float(last) * perStep) >> shift) == tile) return last;
        --last;
    }
    return (texelOf(image, ray, float(last) * perStep) >> shift) == tile ? last : step;
}

bool march(MarchImage image, vec3 beginWorld, vec3 endWorld, out MarchHit hit) {
    const int kFewSteps = 8;  // rays of a few texels, as all of a planar reflector, skip nothing
    ProjectedRay ray;
    hit.steps = 0;
    if (image.sizePx.x <= 0 || !project(image, beginWorld, endWorld, ray)) return false;
    float perStep = 1.0 / float(ray.steps);
    bool hasLeftOwn = false;
    int level = ray.steps < kFewSteps ? 0 : 1;
    for (int step = 0; step <= ray.steps;) {
        float u = float(step) * perStep;
        ivec2 texel = texelOf(image, ray, u);
        float k = ray.k1 + ray.k2 * u;
        ++hit.steps;
        if (level == 0) {
            float stored = storedAt(texel);
            bool isBehind = k < stored;
            if (isBehind && (hasLeftOwn || !isOwnAt(texel))) {
                hit = hitAt(image, ray, step, hit.steps);
                return true;
            }
            hasLeftOwn = hasLeftOwn || k * (1.0 - kLeaving) > stored;
            ++step;
            // Up again where a tile begins; a ray that stays near a surface stays low.
            if (ray.steps >= kFewSteps && (step & 3) == 0) level = 1;
            continue;
        }
        ivec2 tile = texel >> (level + 1);
        int last = lastInTile(image, ray, step, tile, level + 1);
        float farthest = min(k, ray.k1 + ray.k2 * (float(last) * perStep));
        float nearest = nearestIn(tile, level);
        // Whether it leaves its own surface in this tile is found texel by texel, as without tiles.
        bool leaves = hasLeftOwn || farthest * (1.0 - kLeaving) > nearest;
        if (farthest < nearest || !leaves) {
            --level;
        } else {
            hasLeftOwn = true;
            step = last + 1;
            level = min(level + 1, MARCH_LEVELS);
        }
    }
    return false;
}

#endif
