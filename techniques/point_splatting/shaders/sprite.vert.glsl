#version 450 core
// An opaque square a point, as wide as its disc, shaded once: QSplat's way (Rusinkiewicz and Levoy
// 2000). A GL point: the whole square is lost when its centre leaves the window.
#include "point_splatting/decode_point.glsl"
#include "point_splatting/shading.glsl"
#include "point_splatting/splat_view.glsl"

layout(location = BOX_MIN_LOCATION) in vec4 boxMinScale;  // of the drawn patch; w: radiusScale
layout(location = BOX_SIZE_LOCATION) in vec3 boxSize;

uniform float focalPx;
flat out vec3 color;

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
    gl_Position = vec4(ndcOf(centre), depthNdc(1.0 / centre.z), 1.0);
    // A square of less than a pixel would cover no centre of one.
    gl_PointSize = max(2.0 * focalPx * point.radius * boxMinScale.w / centre.z, 1.0);
#ifdef COLORS
    vec3 surface = colorAt(index);
#else
    vec3 surface = kGrey;
#endif
    vec3 toEye = normalize(vec3(-centre.xy, centre.z));
    color = shaded(surface, viewOf(normal), toEye);
}
