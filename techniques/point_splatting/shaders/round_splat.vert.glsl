#version 450 core
// The low-pass filter alone, H = V^h: every splat is the same circle on the screen, and a GL point.
// One vertex a point, no axes. With VISIBILITY the square of r_h at the centre's depth plus ε, for
// which no normal is decoded.
#include "point_splatting/decode_point.glsl"
#include "point_splatting/splat_shape.glsl"
#include "point_splatting/splat_view.glsl"

layout(location = BOX_MIN_LOCATION) in vec4 boxMinScale;  // of the drawn patch; w: radiusScale
layout(location = BOX_SIZE_LOCATION) in vec3 boxSize;

#ifndef VISIBILITY
uniform float cutoff;
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
    vec2 ndc = ndcOf(centre);
    float radius = point.radius * boxMinScale.w;
#ifdef VISIBILITY
    float footprint = lowPassRadiusPx * centre.z / focalPx;
    gl_Position = vec4(ndc, visibilityDepth(1.0 / centre.z, centre, radius, footprint), 1.0);
    gl_PointSize = max(2.0 * lowPassRadiusPx, 1.0);  // at least one pixel's centre
#else
    gl_Position = vec4(ndc, depthNdc(1.0 / centre.z), 1.0);
    gl_PointSize = 2.0 * cutoff * lowPassRadiusPx;
    centrePx = (0.5 * ndc + 0.5) * sizePx;
    vec3 normal = mat3(eyeFromModel) * point.normal;
    EyeSplat splat = EyeSplat(centre, vec3(0.0), vec3(0.0), normal, radius);
    normalViewWeight = vec4(shadedNormal(normal, centre), lowPassWeight(splat));
#ifdef COLORS
    color = colorAt(index);
#endif
#endif
}
