#version 450 core
// The visibility pass of discs: the depth at which the pixel's ray meets the disc, plus ε. Only
// as far as it is not faint: its rim blends with what lies behind.
#define VARYING in
#define DISC_FRAGMENT
#include "point_splatting/disc.glsl"
#include "point_splatting/splat_view.glsl"

uniform float cutoff;

void main() {
    DiscHit hit = discHit(gl_FragCoord.xy);
    float reach = kInscribed * cutoff;
    // `!`: NaN, of planes all but edge-on, is no hit.
    if (!(hit.distance2 <= reach * reach) || hit.inverseZ <= 0.0) discard;
    gl_FragDepth =
        0.5 * visibilityDepth(hit.inverseZ, discCentreRadius.xyz, discCentreRadius.w, 0.0) + 0.5;
}
