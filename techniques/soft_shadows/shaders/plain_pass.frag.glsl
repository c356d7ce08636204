#version 450 core
// A pass over the output image that only writes: what a shadow test is measured against. Out: a bit.

uniform uint bit;

layout(location = 0) out uint seen;

void main() { seen = bit; }
