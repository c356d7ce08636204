#version 450 core
// Counting sort of the samples by bin, first part: how many of each bin a block has.
#define COUNTS 1
#include "clustered_reflections/sort_samples.glsl"
