#version 450 core
// The low-pass filter alone, H = V^h: every splat is the same circle on the screen, and a GL point.
// One vertex a point, no axes. With VISIBILITY a square within the circle, at the centre's depth
// plus ε.
#include "point_splatting/drawn_point.glsl"
#include "point_splatting/splat_shape.glsl"

uniform float cutoff;
#ifdef VISIBILITY
uniform float splatRadiusPx;  // r_h, of which lowPassRadiusPx is the share that hides in any case
#else
uniform vec2 sizePx;

flat out vec2 centrePx;
flat out vec4 normalViewWeight;
#ifdef COLORS
flat out vec3 color;
#endif
#endif

void main() {
    uint index = uint(gl_VertexID);
    SplatPoint point = eyePointAt(index);
    vec3 centre = point.position;
    gl_PointSize = 1.0;
    gl_Position = kNowhere;
    if (!(centre.z > nearM) || isTurnedAway(point.normal, centre)) return;
    vec2 ndc = ndcOf(centre);
#ifdef VISIBILITY
    float footprint = lowPassRadiusPx * centre.z / focalPx;
    gl_Position = vec4(ndc, visibilityDepth(1.0 / centre.z, centre, point.radius, footprint), 1.0);
    // Half as wide as the disc: neighbours are nearer than that, and where they are farther apart than
    // the least square, points behind would shine through. At most the square within the circle; at
    // least a pixel's centre.
    vec2 sides = 2.0 * kInscribed * cutoff * vec2(lowPassRadiusPx, splatRadiusPx);
    gl_PointSize = max(clamp(cutoff * radiusPxOf(point.radius, centre.z), sides.x, sides.y), 1.0);
#else
    gl_Position = vec4(ndc, depthNdc(1.0 / centre.z), 1.0);
    gl_PointSize = 2.0 * cutoff * lowPassRadiusPx;
    centrePx = (0.5 * ndc + 0.5) * sizePx;
    EyeSplat splat = EyeSplat(centre, vec3(0.0), vec3(0.0), point.normal, point.radius);
    normalViewWeight = vec4(viewOf(point.normal), lowPassWeight(splat));
#ifdef COLORS
    color = colorAt(index);
#endif
#endif
}
