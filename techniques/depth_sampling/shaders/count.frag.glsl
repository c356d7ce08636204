#version 450 core
// Lets pixels pass that hold all of `bits`; a query counts them.

uniform usampler2D marks;

uniform uint bits;

void main() {
    if ((texelFetch(marks, ivec2(gl_FragCoord.xy), 0).r & bits) != bits) discard;
}
