#version 450 core
// The low-pass filter alone, H = V^h: every splat is the same circle on the screen, and a GL point.
// One vertex a point, no axes. With VISIBILITY a square within the circle, at the centre's depth
// plus ε.
#include "point_splatting/decode_point.glsl"
#include "point_splatting/splat_shape.glsl"
#include "point_splatting/splat_view.glsl"

layout(location = BOX_MIN_LOCATION) in vec4 boxMinScale;  // of the drawn patch; w: radiusScale
layout(location = BOX_SIZE_LOCATION) in vec3 boxSize;

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
    SplatPoint point = pointAt(index, boxMinScale.xyz, boxSize);
    vec3 centre = (eyeFromModel * vec4(point.position, 1.0)).xyz;
    gl_PointSize = 1.0;
    if (!(centre.z > nearM)) {
        gl_Position = kNowhere;
        return;
    }
    vec3 normal = mat3(eyeFromModel) * point.normal;
    if (isTurnedAway(normal, centre)) {
        gl_Position = kNowhere;
        return;
    }
    vec2 ndc = ndcOf(centre);
    float radius = point.radius * boxMinScale.w;
#ifdef VISIBILITY
    float footprint = lowPassRadiusPx * centre.z / focalPx;
    gl_Position = vec4(ndc, visibilityDepth(1.0 / centre.z, centre, radius, footprint), 1.0);
    // Half as wide as the disc: neighbours are nearer than that, and where they are farther apart than
    // the least square, points behind would shine through. At most the square within the circle; at
    // least a pixel's centre.
    vec2 sides = 2.0 * kInscribed * cutoff * vec2(lowPassRadiusPx, splatRadiusPx);
    gl_PointSize = max(clamp(cutoff * radiusPxOf(radius, centre.z), sides.x, sides.y), 1.0);
#else
    gl_Position = vec4(ndc, depthNdc(1.0 / centre.z), 1.0);
    gl_PointSize = 2.0 * cutoff * lowPassRadiusPx;
    centrePx = (0.5 * ndc + 0.5) * sizePx;
    EyeSplat splat = EyeSplat(centre, vec3(0.0), vec3(0.0), normal, radius);
    normalViewWeight = vec4(viewOf(normal), lowPassWeight(splat));
#ifdef COLORS
    color = colorAt(index);
#endif
#endif
}
