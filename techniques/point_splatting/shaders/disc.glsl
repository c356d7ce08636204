// A pixel's view ray against a splat's disc (Botsch et al. 2004): what the reconstruction filter alone
// needs, with neither tangents nor Eq. (8), and in perspective where that is of first order.
//
// The ray through slope + away, where slope = o.xy / o_z is that of the centre, meets the disc's plane
// at depth o_z / (1 + s), s = n.xy · away · o_z / (n · o): no difference of nearly equal points.

flat VARYING vec3 discCentre;  // in radii, eye space
flat VARYING vec4 discSlope;   // slope; n.xy · o_z / (n · o)
flat VARYING vec2 discDepth;   // in the window: of the centre, and what it grows by over s

#ifdef DISC_FRAGMENT
uniform vec2 slopePerPx;  // the view ray of gl_FragCoord: (slopePerPx · xy + slopeAtZero, 1)
uniform vec2 slopeAtZero;

struct DiscHit {
    bool isWithin;
    float distance2;  // from the centre, in squared radii
    float depth;      // in the window
};

DiscHit discHit(vec2 fragCoord, float reach) {
    vec2 away = slopePerPx * fragCoord + slopeAtZero - discSlope.xy;
    float s = dot(discSlope.zw, away);
    vec3 fromCentre = (vec3(discCentre.z * away, 0.0) - s * discCentre) / (1.0 + s);
    float distance2 = dot(fromCentre, fromCentre);
    // From s = −1 on the plane is met behind the eye. NaN, of planes all but edge-on, is no hit.
    return DiscHit(distance2 <= reach * reach && s > -1.0, distance2,
                   discDepth.x + s * discDepth.y);
}
#endif
