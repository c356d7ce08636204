// What the passes of the compute splatter share: the points of a chunk, one an invocation and step,
// and the pixel that each falls into.
#include "point_splatting/decode_point.glsl"
#include "point_splatting/splat_view.glsl"

layout(local_size_x = GROUP_SIZE) in;

/// Points of one patch that a work group draws.
struct Chunk {
    uint first, count, padding0, padding1;
    vec4 boxMin, boxSize;
};
layout(std430) restrict readonly buffer Chunks { Chunk chunks[]; };
uniform uint firstChunk;
uniform vec2 sizePx;

const int kOutside = -1;

/// The number of the pixel, rows from the bottom; kOutside for points beyond the view or turned away.
int pixelOf(vec3 centre, vec3 normal) {
    if (!(centre.z > nearM) || isTurnedAway(normal, centre)) return kOutside;
    vec2 position = (0.5 * ndcOf(centre) + 0.5) * sizePx;
    if (any(lessThan(position, vec2(0.0))) || any(greaterThanEqual(position, sizePx))) {
        return kOutside;
    }
    ivec2 pixel = ivec2(position);
    return pixel.y * int(sizePx.x) + pixel.x;
}

/// What a pass does with a point that falls into a pixel.
void takePoint(uint index, vec3 centre, vec3 normal, int pixel);

void main() {
    Chunk chunk = chunks[firstChunk + gl_WorkGroupID.x];
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += uint(GROUP_SIZE)) {
        SplatPoint point = pointAt(chunk.first + i, chunk.boxMin.xyz, chunk.boxSize.xyz);
        vec3 centre = (eyeFromModel * vec4(point.position, 1.0)).xyz;
        vec3 normal = mat3(eyeFromModel) * point.normal;
        int pixel = pixelOf(centre, normal);
        if (pixel != kOutside) takePoint(chunk.first + i, centre, normal, pixel);
    }
}
