#version 450 core
// Shift and warp at once, fragments: on the reflector, where the new view sees the surface. Grown
// too much or doubtful, it stays wanted and hides what is farther.
#include "reflection_reuse/grid_fragment.glsl"
#include "reflection_reuse/new_view.glsl"

layout(location = kRadianceTarget) out vec4 projected;
layout(location = kWantedTarget) out uint wanted;

void main() {
    // Weights of doubtless corners sum to 1 up to rounding.
    bool isValid = !hasGrown() && point.trust > 0.999;
    if (!isSeen(point.reflector)) discard;
    projected = vec4(point.radiance, 1.0);
    wanted = isValid ? 0u : 1u;
}
