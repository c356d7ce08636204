#version 450 core
// Warp, fragments ([xie2017] Sec. 5.4.3): valid where the new view sees the same surface, so that
// what was hidden from the key frame stays wanted.
#include "reflection_reuse/grid_fragment.glsl"
#include "reflection_reuse/new_view.glsl"

layout(location = kRadianceTarget) out vec4 warped;
layout(location = kWantedTarget) out uint wanted;

void main() {
    bool isUsable = !hasGrown();
    if (!isSeen(point.reflector) || !isUsable) discard;
    warped = vec4(point.radiance, 1.0);
    wanted = 0u;
}
