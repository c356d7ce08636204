// What the vertex stages of all modes begin with: a point of a drawn patch in eye space.
#include "point_splatting/decode_point.glsl"
#include "point_splatting/splat_view.glsl"

layout(location = BOX_MIN_LOCATION) in vec4 boxMinScale;  // of the drawn patch; w: radiusScale
layout(location = BOX_SIZE_LOCATION) in vec3 boxSize;

SplatPoint eyePointAt(uint index) {
    SplatPoint point = pointAt(index, boxMinScale.xyz, boxSize);
    mat3 turn = mat3(eyeFromModel);
    return SplatPoint((eyeFromModel * vec4(point.position, 1.0)).xyz, turn * point.normal,
                      turn * point.tangent, turn * point.bitangent, point.radius * boxMinScale.w);
}
