// What a pass that traces sample by sample reads of which, and writes: a ReflectionTarget.
#include "reflections/environment.glsl"
#include "reflections/gbuffer.glsl"
#include "reflections/lobe.glsl"

uniform usampler2D wanted;
uniform bool hasWanted;

layout(location = 0) out vec4 radiance;
layout(location = 1) out float distanceM;

// Whether a sample reflects and is wanted.
bool isTraced(ivec2 pixel, uint surface) {
    return reflectorOf(surface) != 0u && (!hasWanted || texelFetch(wanted, pixel, 0).r != 0u);
}
