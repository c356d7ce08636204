#version 450 core
// Step 1, standard storage ([zju2005] Sec. 4.2.1 (2)): writes z/w, 0 at the near plane and 1 at the
// far plane. Moments: depth along the axis as a share of near … far, and its square.

in vec2 clipZW;

#if MOMENTS
uniform vec3 planes;  // near, far, 1: perspective
layout(location = 0) out vec2 moments;
#else
#if SLOPE
uniform float slopeScale;
#endif
layout(location = 0) out float depth;
#endif

void main() {
    // Departure [zju2005] Sec. 4.2.1: GL's clip z begins at −w.
    float z = 0.5 * clipZW.x / clipZW.y + 0.5;
#if MOMENTS
    float d = planes.z != 0.0 ? (clipZW.y - planes.x) / (planes.y - planes.x) : z;
    vec2 slope = vec2(dFdx(d), dFdy(d));
    // The texel holds a piece of a plane: the variance of d over it, for a Gaussian of half a texel
    // ([Donnelly and Lauritzen 2006] Sec. 4.1).
    moments = vec2(d, d * d + 0.25 * dot(slope, slope));
#elif SLOPE
    // The same shift as glPolygonOffset gives to the depth test. The thesis has none.
    depth = min(z + slopeScale * max(abs(dFdx(z)), abs(dFdy(z))), 1.0);
#else
    depth = z;
#endif
}
