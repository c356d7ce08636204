#version 450 core
// Shift, fragments ([xie2017] Sec. 5.4.2): the intermediate image of Fig. 36 C.
#include "reflection_reuse/grid_fragment.glsl"

layout(binding = DOUBTFUL_UNIT) uniform usampler2D doubtful;
uniform bool hasDoubts;

layout(location = kRadianceTarget) out vec4 shifted;  // a: 1 valid, 0 invalid

void main() {
    bool isValid = !hasGrown();
    // A triangle between samples of one reflector may span another one that stands before it.
    uint reflector = texelFetch(keySurface, ivec2(gl_FragCoord.xy), 0).r & 0xFFFFu;
    if (reflector != reflectorOfPoint()) discard;
    Corners corners = corners();
    if (hasDoubts) {
        for (int i = 0; i < 3; ++i) {
            // On an edge of the triangle the corner across has no weight, up to rounding.
            bool counts = corners.weight[i] > 0.001;
            if (counts && texelFetch(doubtful, corners.pixel[i], 0).r != 0u) isValid = false;
        }
    }
    shifted = vec4(radianceOf(corners), isValid ? 1.0 : 0.0);
}
