#version 450 core
// Counting sort, last part: every sample to its place.
#define COUNTS 0
#include "clustered_reflections/sort_samples.glsl"
