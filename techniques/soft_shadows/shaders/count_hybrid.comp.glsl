#version 450 core
// Counts vertices and triangles of the hybrid mesh, run by run. Reads `flags`.
#include "soft_shadows/counts_hybrid.glsl"
#include "soft_shadows/count_runs.glsl"
