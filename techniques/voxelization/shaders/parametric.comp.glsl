#version 450 core
// Writes out the samples of a parametric surface, for its bounds and the gaps between them. Run once,
// at setup.

layout(local_size_x = 64) in;

#include "voxelization/parametric.glsl"

layout(std430) writeonly buffer Points {
    float points[];  // x, y, z a sample, world space
};

void main() {
    int index = int(gl_GlobalInvocationID.x);
    if (index >= SAMPLES_U * SAMPLES_V) return;
    vec3 point = surfaceAt(parameterOf(index));
    for (int i = 0; i < 3; ++i) points[3 * index + i] = point[i];
}
