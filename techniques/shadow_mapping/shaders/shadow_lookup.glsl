// Shadow terms: 0 in shadow, 1 lit. Every comparison and filter of step 2.
// COMPARES_IN_SHADER 1: the map holds numbers, the shader compares; 0: a fetch compares by itself.
// KERNEL: texels compared along one axis. FILTER: one of the kFilter… numbers.
// T is (u·w, v·w, z·w, w): [zju2005] Sec. 4.3, with ε already taken off z.

#if COMPARES_IN_SHADER
#define ShadowMap sampler2D
#else
#define ShadowMap sampler2DShadow
#endif

struct LightView {
    vec4 tile;               // first and last texel of the view's tile in the map
    float texelPerDistance;  // width of a texel in metres where w is 1
    float nearM;
    float farM;
    float isPerspective;     // 1 or 0
    float lightSize;         // metres (parallel rays: metres a metre)
};

/// The face of a cube that a direction from the light meets: +x −x +y −y +z −z.
int cubeFace(vec3 fromLight) {
    vec3 a = abs(fromLight);
    if (a.x >= a.y && a.x >= a.z) return fromLight.x > 0.0 ? 0 : 1;
    if (a.y >= a.z) return fromLight.y > 0.0 ? 2 : 3;
    return fromLight.z > 0.0 ? 4 : 5;
}

/// Whether the view's tile holds the point. What no map holds is in nobody's shadow.
bool isHeld(vec4 T, vec2 mapSize, LightView view) {
    vec2 texel = T.xy / T.w * mapSize;
    return T.w > 0.0 && all(greaterThanEqual(texel, view.tile.xy)) &&
           all(lessThan(texel, view.tile.zw + 1.0));
}

ivec2 inTile(ivec2 texel, LightView view) {
    return clamp(texel, ivec2(view.tile.xy), ivec2(view.tile.zw));
}

/// [zju2005] Sec. 4.3: if (z/w > depth in the map) ShadowTerm = 0; else ShadowTerm = 1.
float compared(ShadowMap map, ivec2 texel, float z) {
#if COMPARES_IN_SHADER
    return z > texelFetch(map, texel, 0).r ? 0.0 : 1.0;
#else
    return textureLod(map, vec3((vec2(texel) + 0.5) / vec2(textureSize(map, 0)), z), 0.0);
#endif
}

/// One texel.
float nearestTerm(ShadowMap map, vec4 T, LightView view) {
#if COMPARES_IN_SHADER
    ivec2 texel = ivec2(T.xy / T.w * vec2(textureSize(map, 0)));
    return compared(map, inTile(texel, view), T.z / T.w);
#else
    return textureProjLod(map, T, 0.0);  // tex2DProj
#endif
}

/// The four texels around the point, compared and then weighed by how near they are.
float bilinearTerm(ShadowMap map, vec4 T, LightView view) {
#if COMPARES_IN_SHADER
    float z = T.z / T.w;
    vec2 at = T.xy / T.w * vec2(textureSize(map, 0)) - 0.5;
    ivec2 texel = ivec2(floor(at));
    vec2 weight = at - floor(at);
    float lowerLeft = compared(map, inTile(texel, view), z);
    float lowerRight = compared(map, inTile(texel + ivec2(1, 0), view), z);
    float upperLeft = compared(map, inTile(texel + ivec2(0, 1), view), z);
    float upperRight = compared(map, inTile(texel + ivec2(1, 1), view), z);
    return mix(mix(lowerLeft, lowerRight, weight.x), mix(upperLeft, upperRight, weight.x),
               weight.y);
#else
    return textureProjLod(map, T, 0.0);  // the sampler filters
#endif
}

/// Percentage-closer filtering: the mean of KERNEL × KERNEL comparisons.
float pcfTerm(ShadowMap map, vec4 T, LightView view) {
    ivec2 centre = ivec2(T.xy / T.w * vec2(textureSize(map, 0)));
    float lit = 0.0;
    for (int y = -(KERNEL / 2); y <= KERNEL / 2; ++y) {
        for (int x = -(KERNEL / 2); x <= KERNEL / 2; ++x) {
            lit += compared(map, inTile(centre + ivec2(x, y), view), T.z / T.w);
        }
    }
    return lit / float(KERNEL * KERNEL);
}

#if FILTER == kFilterPcss
/// Metres along the view's axis from window z.
float axisDepth(float z, LightView view) {
    float n = view.nearM, f = view.farM;
    return view.isPerspective != 0.0 ? n * f / (f - z * (f - n)) : n + z * (f - n);
}

/// Half the width, in texels, of where casters at `blocker` hide parts of the light from `receiver`:
/// (receiver − blocker) / blocker · light, at the receiver ([Fernando 2005]), seen from the light.
float penumbraTexels(float receiver, float blocker, LightView view) {
    float half_ = 0.5 * view.lightSize * max(receiver - blocker, 0.0) / view.texelPerDistance;
    return view.isPerspective != 0.0 ? half_ / (receiver * blocker) : half_;
}

/// Offset of tap (i, j) in a square of half width 1.
vec2 tapOffset(int tap) {
    return (2.0 * vec2(tap % KERNEL, tap / KERNEL) + 1.0) / float(KERNEL) - 1.0;
}

float pcssTerm(ShadowMap map, vec4 T, LightView view) {
    float z = T.z / T.w;
    vec2 at = T.xy / T.w * vec2(textureSize(map, 0));
    float receiver = axisDepth(z, view);
    // Blockers can be as near to the light as the near plane.
    float search = penumbraTexels(receiver, view.nearM, view);
    float sum = 0.0, blockers = 0.0;
    for (int tap = 0; tap < KERNEL * KERNEL; ++tap) {
        ivec2 texel = inTile(ivec2(floor(at + search * tapOffset(tap))), view);
        float depth = texelFetch(map, texel, 0).r;
        if (z > depth) {
            sum += axisDepth(depth, view);
            blockers += 1.0;
        }
    }
    if (blockers == 0.0) return 1.0;
    float width = penumbraTexels(receiver, sum / blockers, view);
    float lit = 0.0;
    for (int tap = 0; tap < KERNEL * KERNEL; ++tap) {
        ivec2 texel = inTile(ivec2(floor(at + width * tapOffset(tap))), view);
        lit += compared(map, texel, z);
    }
    return lit / float(KERNEL * KERNEL);
}
#endif

#if FILTER == kFilterVariance
// A variance below this is rounding: 32-bit moments of depths up to 1 are known to about 1e-7.
const float kLeastVariance = 1e-6;

/// Chebyshev's bound on the share of the texels that are not nearer than the receiver
/// ([Donnelly and Lauritzen 2006] Eq. (5)). ε is taken off as a share of near … far.
float varianceTerm(ShadowMap map, vec4 T, LightView view, float epsilon) {
    vec2 lowest = view.tile.xy + 0.5, highest = view.tile.zw + 0.5;
    vec2 size = vec2(textureSize(map, 0));
    vec2 at = clamp(T.xy / T.w * size, lowest, highest) / size;
    vec2 moments = textureLod(map, at, 0.0).rg;
    float depth = view.isPerspective != 0.0 ? (T.w - view.nearM) / (view.farM - view.nearM) - epsilon
                                            : T.z / T.w;
    depth = min(depth, 1.0);
    if (depth <= moments.x) return 1.0;
    float variance = max(moments.y - moments.x * moments.x, kLeastVariance);
    float difference = depth - moments.x;
    return variance / (variance + difference * difference);
}
#endif

float shadowTerm(ShadowMap map, vec4 T, LightView view, float epsilon) {
    if (!isHeld(T, vec2(textureSize(map, 0)), view)) return 1.0;
    // [zju2005] Sec. 4.3: T.z ← T.z − ε T.w. Beyond the far plane the map can hold nothing nearer
    // than 1 that is behind the receiver: compared there.
    T.z = min(T.z - epsilon * T.w, T.w);
#if FILTER == kFilterNearest
    return nearestTerm(map, T, view);
#elif FILTER == kFilterBilinear
    return bilinearTerm(map, T, view);
#elif FILTER == kFilterPcss
    return pcssTerm(map, T, view);
#elif FILTER == kFilterVariance
    return varianceTerm(map, T, view, epsilon);
#else
    return pcfTerm(map, T, view);
#endif
}
