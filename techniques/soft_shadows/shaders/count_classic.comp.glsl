#version 450 core
// Counts vertices and triangles of the classic mesh, run by run. Reads `flags`.
#include "soft_shadows/counts_classic.glsl"
#include "soft_shadows/count_runs.glsl"
