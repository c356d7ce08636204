// [zhang2012] Eq. (2) to (4): the tessellation factor of an edge; Sec. 4.2: the culling of patches. Used
// by the control stage and by its replay; patches.cpp has it in double precision.
layout(std430) readonly buffer Blocks {
    // A block has BLOCK_FLOATS: (h_min, h_max, ε) whole and of its west, north, east and south
    // edge, then the heights of its corners: north-west, north-east, south-west, south-east.
    float blockValues[];
};
layout(std430) readonly buffer FirstBlocks {
    int firstBlocks[];  // by level
};
uniform vec4 frustumPlanes[6];  // inside: dot(plane, (p, 1)) ≥ 0; unit normals
uniform vec2 imageSize;         // pixels
uniform vec3 eye;
uniform vec2 focalPx;        // pixels per tangent, across and up
uniform float segmentPx;     // ΔS
uniform vec2 factorLimits;   // smallest, greatest
uniform float nearDistance;  // view distances below are taken as this close: greatest factor
uniform int isCulling;

int blockPlace(int level, ivec2 block) {
    int side = 1 << (LEVEL_COUNT - 1 - level);
    ivec2 inside = clamp(block, ivec2(0), ivec2(side - 1));
    return BLOCK_FLOATS * (firstBlocks[level] + inside.y * side + inside.x);
}

vec3 blockRange(int level, ivec2 block, int part) {
    int at = blockPlace(level, block) + 3 * part;
    return vec3(blockValues[at], blockValues[at + 1], blockValues[at + 2]);
}

vec3 joined(vec3 a, vec3 b) {
    return vec3(min(a.x, b.x), max(a.yz, b.yz));
}

// Eq. (2). `edge`: 0 west, 1 north, 2 east, 3 south, as gl_TessLevelOuter has them.
vec3 edgeRange(Patch p, int edge) {
    ivec2 block = p.origin / (BLOCK_SEGMENTS << p.level);
    if ((edge & 2) != 0) block += (edge & 1) == 0 ? ivec2(BLOCKS_PER_PATCH - 1, 0)
                                                  : ivec2(0, BLOCKS_PER_PATCH - 1);
    ivec2 along = (edge & 1) == 0 ? ivec2(0, 1) : ivec2(1, 0);
    vec3 range = blockRange(p.level, block, 1 + edge);
    for (int i = 1; i < BLOCKS_PER_PATCH; ++i) {
        range = joined(range, blockRange(p.level, block + i * along, 1 + edge));
    }
    return range;
}

// The height at a corner of the patch.
float cornerHeight(Patch p, ivec2 corner) {
    ivec2 block = p.origin / (BLOCK_SEGMENTS << p.level) + (BLOCKS_PER_PATCH - 1) * corner;
    return blockValues[blockPlace(p.level, block) + 15 + corner.x + 2 * corner.y];
}

// Eq. (3) and (4). The end points are named by their places on the terrain, not by the patch that
// asks, and every step is `precise`: the two patches of an edge get the same bits.
float edgeFactor(Patch p, int edge) {
    int span = patchSpan(p.level);
    ivec2 first = p.origin + ivec2(edge == 2 ? span : 0, edge == 3 ? span : 0);
    ivec2 along = (edge & 1) == 0 ? ivec2(0, span) : ivec2(span, 0);
    vec3 range = edgeRange(p, edge);
    ivec2 corner = ivec2(edge == 2 ? 1 : 0, edge == 3 ? 1 : 0);
    ivec2 next = corner + ((edge & 1) == 0 ? ivec2(0, 1) : ivec2(1, 0));
    precise float across = float(span) * ((edge & 1) == 0 ? spacing.y : spacing.x);
    precise float up = cornerHeight(p, next) - cornerHeight(p, corner);
    precise float D = sqrt(across * across + up * up);  // in space
    precise float L = max(range.y - range.x, D) + range.z;  // Eq. (3): L_AB
    // Departure [zhang2012] Eq. (4): the midpoint's height is not said; the mean of the extremes.
    precise vec3 middle = worldOf(vec2(first) + 0.5 * vec2(along), 0.5 * (range.x + range.y));
    precise float lengthPx;
#if SEGMENT == 0
    precise vec4 c = clipFromWorld * vec4(middle - vec3(0.0, 0.5 * L, 0.0), 1.0);
    precise vec4 d = clipFromWorld * vec4(middle + vec3(0.0, 0.5 * L, 0.0), 1.0);
    // An end at or behind the eye has no image.
    if (min(c.w, d.w) < nearDistance) return factorLimits.y;
    lengthPx = length((d.xy / d.w - c.xy / c.w) * 0.5 * imageSize);
#elif SEGMENT == 1
    precise vec4 centre = clipFromWorld * vec4(middle, 1.0);
    lengthPx = L * focalPx.x / max(centre.w, nearDistance);
#else
    lengthPx = L * focalPx.x / max(distance(eye, middle), nearDistance);
#endif
    precise float factor = clamp(lengthPx / segmentPx, factorLimits.x, factorLimits.y);
    return factor;
}

bool isOutside(vec3 centre, float radius) {
    for (int i = 0; i < 6; ++i) {
        if (dot(frustumPlanes[i], vec4(centre, 1.0)) < -radius) return true;
    }
    return false;
}

// The sphere about the box of the patch with its heights (a skirt's: of the rim down to `foot`).
// Departure [zhang2012] Sec. 4.2: the printed sphere, the flat patch's diagonal, loses displaced
// ground at the image's border. What lies beyond the map is never drawn, and its vertices lie on the
// rim: so do the skirts of a tile that reaches beyond, along the ground that it has.
bool isBeyondMap(Patch p) {
    bvec2 beyond = greaterThanEqual(vec2(p.origin), lastSample);
    return p.rim == kSurface ? any(beyond) : (p.rim & 1) == 0 ? beyond.y : beyond.x;
}

bool isPatchCulled(Patch p, float foot) {
    if (isBeyondMap(p)) return true;
    if (isCulling == 0) return false;
    vec2 low = min(vec2(p.origin), lastSample);
    vec2 high = min(vec2(p.origin + patchSpan(p.level)), lastSample);
    vec3 range;
    if (p.rim == kSurface) {
        ivec2 block = p.origin / (BLOCK_SEGMENTS << p.level);
        range = blockRange(p.level, block, 0);
        for (int i = 1; i < BLOCKS_PER_PATCH * BLOCKS_PER_PATCH; ++i) {
            ivec2 at = ivec2(i % BLOCKS_PER_PATCH, i / BLOCKS_PER_PATCH);
            range = joined(range, blockRange(p.level, block + at, 0));
        }
    } else {
        range = edgeRange(p, p.rim);
        range.x = foot;
        if (p.rim == 0) high.x = low.x;
        if (p.rim == 1) high.y = low.y;
        if (p.rim == 2) low.x = high.x;
        if (p.rim == 3) low.y = high.y;
    }
    vec3 a = worldOf(low, range.x), b = worldOf(high, range.y);
    return isOutside(0.5 * (a + b), 0.5 * distance(a, b));
}
