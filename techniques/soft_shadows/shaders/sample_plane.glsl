// The samples of depth image I and the planes that they lie on. Reads depth, triangle ids and the
// normals of the scene's triangles.
#include "soft_shadows/corners.glsl"

uniform sampler2D depthOfI;  // metres along the view axis
uniform usampler2D idOfI;
layout(std430) restrict readonly buffer Normals { vec4 normals[]; };

// The ray through pixel coordinates (x, y), in the world, reaching a depth of 1:
uniform vec3 rayOrigin;  // of (0, 0)
uniform vec3 rayStepX;
uniform vec3 rayStepY;
uniform float footprintPerDepth;  // width of a pixel at a depth of 1
uniform float grazingLimitPx;

struct Surfel {
    vec2 positionPx;
    float depth;
    uint id;  // 0: the pixel holds no sample
    vec3 normal;
};

Surfel surfelOfI(ivec2 pixel) {
    Surfel s = Surfel(vec2(pixel) + 0.5, 0.0, 0u, vec3(0.0));
    if (!isPixel(pixel)) return s;
    s.id = texelFetch(idOfI, pixel, 0).r;
    s.depth = texelFetch(depthOfI, pixel, 0).r;
    if (s.id != 0u) s.normal = normals[s.id - 1u].xyz;
    return s;
}

vec3 rayThrough(vec2 positionPx) {
    return rayOrigin + positionPx.x * rayStepX + positionPx.y * rayStepY;
}

float footprint(Surfel s) { return s.depth * footprintPerDepth; }

const float kNowhere = 1e30;  // farther than anything: the ray misses the plane

/// Depth at which the ray through positionPx meets the plane (s, n):
/// n·(depth·ray(p) − s.depth·ray(s)) = 0. A plane that slants away from the eye so steeply that it
/// ends in a horizon before the ray is met nowhere.
float depthOnPlane(Surfel s, vec2 positionPx) {
    float slantAtSample = dot(s.normal, rayThrough(s.positionPx));
    float slantHere = dot(s.normal, rayThrough(positionPx));
    // A triangle without area has no normal: it is taken to face the eye.
    if (slantAtSample == 0.0) return s.depth;
    float ratio = slantHere / slantAtSample;
    // 1e-20: no quotient becomes infinite; such a meeting is far beyond every limit.
    return ratio > 1e-20 ? s.depth / ratio : kNowhere;
}

/// The same, but no farther from the sample than the limit for grazing planes. Stays positive.
float fittedDepth(Surfel s, vec2 positionPx) {
    float reach = grazingLimitPx * footprint(s);
    return clamp(depthOnPlane(s, positionPx), s.depth - reach, s.depth + reach);
}
