#version 450 core
// [xie2017] Algorithm 5, step 3: estimates the visibility of one light sample for every output sample
// from its shadow map. Out: the sample's bit where it is seen, to be or-ed to those of the others.

uniform sampler2D shadowMap;
uniform sampler2D positions;
uniform sampler2D normals;

uniform mat4 clipFromWorld;      // of the light sample's view
uniform vec3 lightPosition;
uniform vec3 lightRight;         // unit axes of the view's image
uniform vec3 lightUp;
uniform float nearM;
uniform float farM;
uniform float texelPerDistance;  // width of a texel, metres a metre of distance
uniform float biasPerDistance;   // bias in metres a metre of distance: texels · width of a texel
uniform uint bit;

layout(location = 0) out uint seen;

// A plane may lie this many texels nearer or farther at its texel's centre: a slope of up to 22 (87°).
// Steeper ones would reach beyond their triangles, and meet the ray far away or behind the light.
const float kSteepestTexels = 16.0;

float windowDepth(float depth) {
    return 0.5 + 0.5 * (farM + nearM - 2.0 * farM * nearM / depth) / (farM - nearM);
}

/// Depth of the receiver's plane at the centre of its texel: what the shadow map holds of a plane, so
/// that planes do not shadow themselves, however they slant.
float depthAtCentre(vec3 fromLight, vec3 normal, float depth, vec2 toCentreTexels) {
    // Rays of depth 1, r = fromLight / depth through the receiver and r + s through the centre, meet
    // the plane at depth and at depth · n·r / n·(r + s).
    vec2 s = toCentreTexels * texelPerDistance;
    float slope = depth * dot(normal, s.x * lightRight + s.y * lightUp) / dot(normal, fromLight);
    float limit = kSteepestTexels * texelPerDistance;
    // 0.001: planes that the ray does not meet are left to the limit.
    return depth * clamp(1.0 / max(1.0 + slope, 0.001), 1.0 - limit, 1.0 + limit);
}

bool isLit(vec3 position, vec3 normal) {
    // A surface that is turned away from the light lies in its own shadow. A shadow map cannot tell
    // where the surface is a thin one: the side that faces the light has the same depth.
    vec3 fromLight = position - lightPosition;
    if (dot(normal, fromLight) >= 0.0) return false;
    vec4 clip = clipFromWorld * vec4(position, 1.0);
    vec2 size = vec2(textureSize(shadowMap, 0));
    vec2 texel = (clip.xy / clip.w * 0.5 + 0.5) * size;
    // What no shadow map holds is in nobody's shadow.
    if (clip.w <= 0.0 || any(lessThan(texel, vec2(0.0))) || any(greaterThanEqual(texel, size))) {
        return true;
    }
    float receiver = depthAtCentre(fromLight, normal, clip.w, floor(texel) + 0.5 - texel);
    float caster = texelFetch(shadowMap, ivec2(texel), 0).r;
    // Receivers beyond the far plane (the floor) are lit where the map is empty.
    return min(windowDepth(receiver - biasPerDistance * clip.w), 1.0) <= caster;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(positions, pixel, 0);
    bool isSeen = position.w == 0.0 || isLit(position.xyz, texelFetch(normals, pixel, 0).xyz);
    seen = isSeen ? bit : 0u;
}
