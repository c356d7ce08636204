// A pixel's view ray against a splat's disc (Botsch et al. 2004): what the reconstruction filter alone
// needs, with neither tangents nor Eq. (8), and in perspective where that is of first order.

flat VARYING vec4 discCentreRadius;  // eye space; w: r_k
flat VARYING vec2 discSlant;         // n.xy · o_z / (n · o)

uniform vec2 slopePerPx;  // the view ray of gl_FragCoord: (slopePerPx · xy + slopeAtZero, 1)
uniform vec2 slopeAtZero;

#ifdef DISC_FRAGMENT
struct DiscHit {
    float distance2;  // from the centre, in squared radii
    float inverseZ;   // 1 / o_z of the point hit; 0 or less: the plane is met behind the eye
};

DiscHit discHit(vec2 fragCoord) {
    vec3 centre = discCentreRadius.xyz;
    // With the ray through the centre plus `away`, no difference of nearly equal points is taken:
    // the ray meets the plane at depth o_z / (1 + s).
    vec2 away = slopePerPx * fragCoord + slopeAtZero - centre.xy / centre.z;
    float s = dot(discSlant, away);
    vec3 fromCentre = (vec3(centre.z * away, 0.0) - s * centre) / (1.0 + s) / discCentreRadius.w;
    return DiscHit(dot(fromCentre, fromCentre), (1.0 + s) / centre.z);
}
#endif
