#version 450 core
// The share of a square light that each output sample sees, from one shadow map of its centre.
// Percentage-closer soft shadows (Fernando 2005): blockers are searched where the light's edges could
// be hidden, their mean depth gives the penumbra, whose width is filtered. With VARIANCE, both steps
// take moments of depth from a pyramid instead of taps (variance soft shadow mapping, Dong and Yang
// 2010).

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

uniform sampler2D shadowMap;  // window depth
#ifdef VARIANCE
uniform sampler2D moments;        // depth, depth², with all levels
#endif
layout(rgba32f) uniform readonly restrict image2D positions;
layout(rgba16f) uniform readonly restrict image2D normals;
layout(r32f) uniform writeonly restrict image2D litShares;

uniform mat4 clipFromWorld;
uniform mat4 worldFromClip;
uniform vec3 lightPosition;
uniform vec3 lightForward;
uniform float tangent;          // of half the map's angle: half its width at distance 1
uniform float halfLight;        // half the light's edge, metres
uniform float nearM;
uniform float farM;
uniform float biasPerDistance;  // as in shadow_test

const int kTaps = 16;  // a side

float eyeDepth(float windowDepth) {
    return 2.0 * nearM * farM / (farM + nearM - (2.0 * windowDepth - 1.0) * (farM - nearM));
}

// The receiver's plane where the ray through a texel's centre meets it. Taps compare with this depth:
// a plane does not shadow itself, however wide the filter. Grazing planes are bounded to ±half the
// receiver's distance.
float planeDepth(vec2 texcoord, vec3 position, vec3 normal, float receiverDepth) {
    vec4 h = worldFromClip * vec4(texcoord * 2.0 - 1.0, 0.0, 1.0);
    vec3 direction = h.xyz / h.w - lightPosition;
    direction /= dot(direction, lightForward);  // length 1 along the axis
    float along = dot(normal, direction);
    float depth = dot(normal, position - lightPosition) / (abs(along) < 1e-6 ? 1e-6 : along);
    // Receivers beyond the far plane (the floor) are lit where the map is empty.
    return min(clamp(depth, 0.5 * receiverDepth, 1.5 * receiverDepth), eyeDepth(1.0));
}

// Half the width, as a share of the map, within which casters at depth `blocker` hide parts of the
// light from a receiver at depth `receiver`.
float filterHalfWidth(float receiver, float blocker) {
    return halfLight * (receiver - blocker) / receiver / (2.0 * tangent * blocker);
}

#ifdef VARIANCE
// Mean and mean square of depth over a square of the map.
vec2 momentsOver(vec2 texcoord, float halfWidth) {
    float texels = max(2.0 * halfWidth * float(textureSize(moments, 0).x), 1.0);
    return textureLod(moments, texcoord, log2(texels)).rg;
}

// Chebyshev's bound on the share of depths that are at least `depth`.
float visibleShare(vec2 m, float depth) {
    if (depth <= m.x) return 1.0;
    // A variance below the square of a texel's slope is rounding.
    float variance = max(m.y - m.x * m.x, 1e-6 * depth * depth);
    return variance / (variance + (depth - m.x) * (depth - m.x));
}

float litShare(vec2 texcoord, vec3 position, vec3 normal, float receiver) {
    vec2 search = momentsOver(texcoord, filterHalfWidth(receiver, nearM));
    // The blockers' mean from the mean of all and of what is not blocked, taken at the receiver.
    float visible = visibleShare(search, receiver);
    if (visible > 0.999) return 1.0;
    float blocker = clamp((search.x - visible * receiver) / (1.0 - visible), nearM, receiver);
    return visibleShare(momentsOver(texcoord, filterHalfWidth(receiver, blocker)), receiver);
}
#else
float depthAt(vec2 texcoord) {
    ivec2 size = textureSize(shadowMap, 0);
    return texelFetch(shadowMap, clamp(ivec2(texcoord * vec2(size)), ivec2(0), size - 1), 0).r;
}

vec2 tapOffset(int i, int j) {
    return (2.0 * vec2(i, j) + 1.0) / float(kTaps) - 1.0;
}

float litShare(vec2 texcoord, vec3 position, vec3 normal, float receiver) {
    float searchWidth = filterHalfWidth(receiver, nearM);
    float blockerSum = 0.0;
    int blockers = 0;
    for (int t = 0; t < kTaps * kTaps; ++t) {
        vec2 at = texcoord + searchWidth * tapOffset(t % kTaps, t / kTaps);
        float depth = eyeDepth(depthAt(at));
        if (depth < planeDepth(at, position, normal, receiver)) {
            blockerSum += depth;
            ++blockers;
        }
    }
    if (blockers == 0) return 1.0;
    float width = filterHalfWidth(receiver, min(blockerSum / float(blockers), receiver));
    int lit = 0;
    for (int t = 0; t < kTaps * kTaps; ++t) {
        vec2 at = texcoord + width * tapOffset(t % kTaps, t / kTaps);
        if (eyeDepth(depthAt(at)) >= planeDepth(at, position, normal, receiver)) ++lit;
    }
    return float(lit) / float(kTaps * kTaps);
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(litShares)))) return;
    vec4 surface = imageLoad(positions, pixel);
    float share = 1.0;
    if (surface.w != 0.0) {
        vec3 normal = imageLoad(normals, pixel).xyz;
        float distance = dot(surface.xyz - lightPosition, lightForward);
        vec3 position = surface.xyz + normal * (biasPerDistance * distance);
        vec4 clip = clipFromWorld * vec4(position, 1.0);
        vec2 texcoord = clip.xy / clip.w * 0.5 + 0.5;
        bool isHeld = clip.w > 0.0 && all(greaterThanEqual(texcoord, vec2(0.0))) &&
                      all(lessThan(texcoord, vec2(1.0)));
        float receiver = min(dot(position - lightPosition, lightForward), eyeDepth(1.0));
        // What is turned away from the light's centre lies in its own shadow, as in shadow_test.
        if (dot(normal, surface.xyz - lightPosition) >= 0.0) {
            share = 0.0;
        } else if (isHeld) {
            share = litShare(texcoord, position, normal, receiver);
        }
    }
    imageStore(litShares, pixel, vec4(share));
}
