#version 450 core
// Samples an implicit surface f(x, y, z) = 0 on the slices of the grid and writes the worksheet, one
// invocation a texel: C voxels along z. [zju2005] Sec. 2.4.1 (1).
// Reads the formula (snippet); writes every texel of `sheets` that holds voxels.

layout(local_size_x = 8, local_size_y = 8) in;

#include "voxelization/formula.glsl"
#include "voxelization/voxel_value.glsl"
#include "voxelization/worksheet.glsl"

#pragma snippet formula

layout(r32ui) writeonly uniform uimage2DArray sheets;

uniform vec3 boxMin;      // world space
uniform float voxelSize;  // world units

// f at a point of the lattice of half voxels, so that neighbours see the same value on their common
// face, bit for bit: only then the surface separates. Negative inside.
float sampleAt(ivec3 halfVoxels) {
    precise vec3 p = boxMin + vec3(halfVoxels) * (0.5 * voxelSize);
    return formula(p.x, p.y, p.z);
}

// Value of a full voxel; the gradient points outwards.
uint valueOf(vec3 gradient) {
#if NORMALS
    return encodeNormal(gradient);
#else
    return 1u;
#endif
}

// The target of the surface rule is a voxel's crosshair: the three unit segments through its centre
// along the axes (Laine 2013). It is met when the samples at the centre and the six ends differ in
// sign. Voxels that share a face share that sample: no path through faces leads past the surface.
uint surfaceVoxel(ivec3 voxel, float below, float above) {
    ivec3 centre = 2 * voxel + 1;
    float ends[6] = float[6](sampleAt(centre - ivec3(1, 0, 0)), sampleAt(centre + ivec3(1, 0, 0)),
                             sampleAt(centre - ivec3(0, 1, 0)), sampleAt(centre + ivec3(0, 1, 0)),
                             below, above);
    float here = sampleAt(centre);
    bool reachesOutside = here >= 0.0;
    bool reachesInside = here <= 0.0;
    for (int i = 0; i < 6; ++i) {  // a sample that is not a number is on neither side
        reachesOutside = reachesOutside || ends[i] >= 0.0;
        reachesInside = reachesInside || ends[i] <= 0.0;
    }
    if (!reachesOutside || !reachesInside) return 0u;
    return valueOf(vec3(ends[1] - ends[0], ends[3] - ends[2], ends[5] - ends[4]));
}

uint solidVoxel(ivec3 voxel) {
    ivec3 centre = 2 * voxel + 1;
    if (!(sampleAt(centre) <= 0.0)) return 0u;
#if NORMALS
    ivec2 step = ivec2(1, 0);
    return valueOf(vec3(sampleAt(centre + step.xyy) - sampleAt(centre - step.xyy),
                        sampleAt(centre + step.yxy) - sampleAt(centre - step.yxy),
                        sampleAt(centre + step.yyx) - sampleAt(centre - step.yyx)));
#else
    return valueOf(vec3(0.0));
#endif
}

void main() {
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    int slab = int(gl_GlobalInvocationID.z);
    if (any(greaterThanEqual(column, SIZE.xy))) return;
    uint word = 0u;
#if !SOLID
    float below = sampleAt(ivec3(2 * column + 1, 2 * slab * VOXELS_PER_TEXEL));
#endif
    for (int lane = 0; lane < slicesOf(slab); ++lane) {
        ivec3 voxel = ivec3(column, slab * VOXELS_PER_TEXEL + lane);
#if SOLID
        uint value = solidVoxel(voxel);
#else
        float above = sampleAt(ivec3(2 * column + 1, 2 * voxel.z + 2));
        uint value = surfaceVoxel(voxel, below, above);
        below = above;
#endif
        word |= value << worksheetShift(voxel.z);
    }
    imageStore(sheets, worksheetPatch(slab) + ivec3(column, 0), uvec4(word));
}
