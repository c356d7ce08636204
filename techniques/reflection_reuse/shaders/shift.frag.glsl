#version 450 core
// Shift, fragments ([xie2017] Sec. 5.4.2): the intermediate image of Fig. 36 C.
#include "reflection_reuse/grid_fragment.glsl"

uniform usampler2D keySurface;

layout(location = kRadianceTarget) out vec4 shifted;  // a: 1 valid, 0 invalid

void main() {
    bool isValid = !hasGrown();
    // A triangle between samples of one reflector may span another one that stands before it.
    uint reflector = texelFetch(keySurface, ivec2(gl_FragCoord.xy), 0).r & 0xFFFFu;
    if (reflector != point.reflector) discard;
    shifted = vec4(point.radiance, isValid ? 1.0 : 0.0);
}
