#version 450 core
// The visibility pass of discs: the depth at which the pixel's ray meets the disc, plus ε. Only
// as far as it is not faint: its rim blends with what lies behind.
#define VARYING in
#define DISC_FRAGMENT
#include "point_splatting/disc.glsl"
#include "point_splatting/splat_view.glsl"

uniform float cutoff;

void main() {
    DiscHit hit = discHit(gl_FragCoord.xy, kInscribed * cutoff);
    if (!hit.isWithin) discard;
    gl_FragDepth = hit.depth;
}
