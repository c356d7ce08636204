#version 450 core
// Lets pixels into the depth buffer whose marks have all bits of `among` and none of `without`: those
// that mark.frag.glsl has to test. It would discard the others itself, but llvmpipe runs a discarded
// fragment to its end.

uniform usampler2D marks;

uniform uint among;
uniform uint without;

void main() {
    uint known = texelFetch(marks, ivec2(gl_FragCoord.xy), 0).r;
    if ((known & among) != among || (known & without) != 0u) discard;
}
