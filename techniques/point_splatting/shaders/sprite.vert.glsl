#version 450 core
// An opaque square a point, as wide as its disc, shaded once: QSplat's way (Rusinkiewicz and Levoy
// 2000). A GL point: the whole square is lost when its centre leaves the window.
#include "point_splatting/drawn_point.glsl"
#include "point_splatting/shading.glsl"

uniform float focalPx;
flat out vec3 color;

void main() {
    uint index = uint(gl_VertexID);
    SplatPoint point = eyePointAt(index);
    vec3 centre = point.position;
    gl_PointSize = 1.0;
    gl_Position = kNowhere;
    if (!(centre.z > nearM) || isTurnedAway(point.normal, centre)) return;
    gl_Position = vec4(ndcOf(centre), depthNdc(1.0 / centre.z), 1.0);
    // A square of less than a pixel would cover no centre of one.
    gl_PointSize = max(2.0 * focalPx * point.radius / centre.z, 1.0);
#ifdef COLORS
    vec3 surface = colorAt(index);
#else
    vec3 surface = kGrey;
#endif
    vec3 toEye = normalize(vec3(-centre.xy, centre.z));
    color = shaded(surface, viewOf(point.normal), toEye);
}
