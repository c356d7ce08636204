#version 450 core
// The reconstruction filter alone, H = J V^r Jᵀ: a disc in space, a GL point that holds it on the
// screen, whose fragments find the disc by their view rays. One vertex a point.
#define VARYING out
#include "point_splatting/disc.glsl"
#include "point_splatting/drawn_point.glsl"

uniform float cutoff;
uniform float focalPx;
uniform vec2 sizePx;
#ifndef VISIBILITY
flat out vec4 normalViewWeight;
#ifdef COLORS
flat out vec3 color;
#endif
#endif

/// Half the side of a square on the screen that holds the disc. Along x a point o + R u of its edge
/// is R (u_x − u_z o_x / o_z) / z away from the centre, u at right angles to the normal.
float halfSidePx(vec3 centre, vec3 normal, float reach) {
    vec2 slope = centre.xy / centre.z;
    vec2 offPlane = normal.xy - slope * normal.z;
    vec2 most = sqrt(max(1.0 + slope * slope - offPlane * offPlane, 0.0));
    float nearest = centre.z - reach * sqrt(max(1.0 - normal.z * normal.z, 0.0));
    // A sixteenth: rasterizers round where a point lies.
    return focalPx * reach * max(most.x, most.y) / max(nearest, nearM) + 0.0625;
}

void main() {
    uint index = uint(gl_VertexID);
    SplatPoint point = eyePointAt(index);
    vec3 centre = point.position, normal = point.normal;
    float towards = dot(normal, centre);
    gl_PointSize = 1.0;
    gl_Position = kNowhere;
    // Edge-on it has no area.
    if (!(centre.z > nearM) || isTurnedAway(normal, centre) || towards == 0.0) return;
    float radius = point.radius;
#ifdef VISIBILITY
    float reach = kInscribed * cutoff;
    float depth = visibilityDepth(1.0 / centre.z, centre, radius, 0.0);
    float depthFarAway = depthNdc(0.0) + kDepthSlack;
#else
    float reach = cutoff;
    float depth = depthNdc(1.0 / centre.z);
    float depthFarAway = depthNdc(0.0);
#endif
    float halfSide = halfSidePx(centre, normal, reach * radius);
    // GL drops points whose middle leaves the window: it is moved to the edge, and the square grows.
    vec2 ndc = ndcOf(centre), middle = clamp(ndc, -1.0, 1.0);
    vec2 moved = 0.5 * abs(ndc - middle) * sizePx;
    if (any(greaterThan(moved, vec2(halfSide)))) return;
    gl_Position = vec4(middle, depthNdc(1.0 / centre.z), 1.0);
    gl_PointSize = 2.0 * (halfSide + max(moved.x, moved.y));
    discCentre = centre / radius;
    discSlope = vec4(centre.xy, normal.xy * (centre.z * centre.z / towards)) / centre.z;
    // 1 / o_z, and with it the depth, is linear in s; at s = −1 it is 0.
    discDepth = vec2(0.5 * depth + 0.5, 0.5 * (depth - depthFarAway));
#ifndef VISIBILITY
    normalViewWeight = vec4(viewOf(normal), 1.0);
#ifdef COLORS
    color = colorAt(index);
#endif
#endif
}
