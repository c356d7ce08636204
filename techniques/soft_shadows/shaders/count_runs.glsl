// Counts what each run of corners brings to the mesh (countsAt, of the including file). One
// invocation walks one run: writes its totals into `runs` and, a corner, how many vertices (low
// half) and triangles (high half) stand before it in its run into `places`.
#define PLACES_ACCESS writeonly
#include "soft_shadows/places.glsl"

layout(local_size_x = COUNT_GROUP_SIZE) in;

void main() {
    int run = int(gl_GlobalInvocationID.x);
    if (run >= runsPerRow * (imageSizePx.y + 1)) return;
    ivec2 first = ivec2(run % runsPerRow * RUN_LENGTH, run / runsPerRow);
    int end = min(first.x + RUN_LENGTH, imageSizePx.x + 1);
    uvec4 total = uvec4(0u);
    for (ivec2 corner = first; corner.x < end; ++corner.x) {
        imageStore(places, corner, uvec4(total.x | total.y << 16));
        total += countsAt(corner);
    }
    runs[run] = total;
}
