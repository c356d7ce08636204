#version 450 core
// A corner of the parallelogram around a splat's ellipse on the screen: full EWA (Eq. 3). Four
// vertices a point; the corner is the vertex's number. With VISIBILITY the parallelogram within the ellipse, at the splat's depth plus ε and
// without a fragment shader: where it hides what lies behind, the splat itself has weight.
#include "point_splatting/drawn_point.glsl"
#include "point_splatting/splat_shape.glsl"

uniform float cutoff;

#ifndef VISIBILITY
out vec2 positionInSplat;  // standard deviations
flat out vec4 normalViewWeight;
#ifdef COLORS
flat out vec3 color;
#endif
#endif

/// 1 / o_z where the splat's plane is met at `offsetPx` from its centre: linear on the screen.
float inverseZAt(EyeSplat splat, vec2 offsetPx, float footprint) {
    float z = splat.centre.z;
    float slant = dot(splat.normal, splat.centre) / z;
    // Seen edge-on the plane has no single depth; the reach bounds what 1e-4 leaves.
    slant = slant < 0.0 ? min(slant, -1e-4) : max(slant, 1e-4);
    float inverseZ = (1.0 + dot(splat.normal.xy, offsetPx) / (focalPx * slant)) / z;
    float reach = cutoff * max(splat.radius, footprint);
    return clamp(inverseZ, 1.0 / (z + reach), 1.0 / max(z - reach, nearM));
}

void main() {
    uint index = uint(gl_VertexID) >> 2;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1) * 2.0 - 1.0;
    SplatPoint point = eyePointAt(index);
    EyeSplat splat =
        EyeSplat(point.position, point.tangent, point.bitangent, point.normal, point.radius);
    gl_Position = kNowhere;
    if (!(splat.centre.z > nearM) || isTurnedAway(splat.normal, splat.centre)) return;
    SplatShape shape = fullEwaShape(splat);
    float footprint = lowPassRadiusPx * splat.centre.z / focalPx;
#ifdef VISIBILITY
    vec2 offsetPx = shape.axes * (cutoff * kInscribed * corner);
#else
    vec2 offsetPx = shape.axes * (cutoff * corner);
#endif
    float inverseZ = inverseZAt(splat, offsetPx, footprint);
    vec2 ndc = ndcOf(splat.centre) + offsetPx / focalPx * ndcPerSlope;
#ifdef VISIBILITY
    gl_Position =
        vec4(ndc, visibilityDepth(inverseZ, splat.centre, splat.radius, footprint), 1.0);
#else
    gl_Position = vec4(ndc, depthNdc(inverseZ), 1.0);
    positionInSplat = cutoff * corner;
    normalViewWeight = vec4(viewOf(splat.normal), shape.weight);
#ifdef COLORS
    color = colorAt(index);
#endif
#endif
}
