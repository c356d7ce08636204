// A splat's shape on the screen ([zju2005] Eq. 3, 8), the readable form of which is
// tests/techniques/point_splatting/splat_math.h.
// Eye space has z the distance along the view axis; screen vectors are in pixels.

struct EyeSplat {
    vec3 centre;              // (o)
    vec3 tangent, bitangent;  // (s), (t), unit
    vec3 normal;
    float radius;  // r_k
};

/// An ellipse as the image of the unit circle: H = axes · axesᵀ.
struct SplatShape {
    mat2 axes;     // pixels
    float weight;  // of the splat's middle
};

uniform float focalPx;
uniform float lowPassRadiusPx;  // r_h
uniform vec2 slopeLimit;        // o_x / o_z and o_y / o_z beyond the window

// Eq. (8) is the map's first order at the centre, and grows with its slope without a bound: splats
// beside the eye would be smeared over the window. None that is seen has a slope beyond the window's
// edge, but for the border that slopeLimit leaves.
vec2 slopeOf(vec3 centre) { return clamp(centre.xy / centre.z, -slopeLimit, slopeLimit); }

// Splats of more pixels than this cover any window; squares of their squares stay finite.
const float kMaxRadiusPx = 16384.0;
float radiusPxOf(float radius, float distance) {
    return min(focalPx * radius / distance, kMaxRadiusPx);
}

/// f r J: Eq. (8) in pixels and radii, s and t in columns.
mat2 projectedAxes(EyeSplat splat) {
    vec2 slope = slopeOf(splat.centre);
    float radiusPx = radiusPxOf(splat.radius, splat.centre.z);
    return radiusPx * mat2(splat.tangent.xy - slope * splat.tangent.z,
                           splat.bitangent.xy - slope * splat.bitangent.z);
}

/// |f r J| from the normal: exact where the columns are nearly parallel (Eq. 9–11).
float projectedDeterminant(EyeSplat splat) {
    float radiusPx = radiusPxOf(splat.radius, splat.centre.z);
    return radiusPx * radiusPx * abs(dot(splat.normal, vec3(slopeOf(splat.centre), 1.0)));
}

/// H = J V^r Jᵀ + V^h: the Cholesky factor of H, so that the parallelogram of its columns holds the
/// ellipse with no more area than a rectangle along the ellipse's axes, without eigenvectors.
///
/// The weight is √(|J V^r Jᵀ| / |H|), which a filter of unit integral makes of a disc of height 1.
/// Departure [zju2005] Eq. (3): the printed kernel leaves out |J_k| of Zwicker et al. (2001), by
/// which a point weighs as much as the area it covers; without it small splats outweigh large ones.
SplatShape fullEwaShape(EyeSplat splat) {
    mat2 j = projectedAxes(splat);
    float determinant = projectedDeterminant(splat);
    float lowPass = lowPassRadiusPx * lowPassRadiusPx;
    float h00 = j[0].x * j[0].x + j[1].x * j[1].x + lowPass;
    float h01 = j[0].x * j[0].y + j[1].x * j[1].y;
    // |H| as a sum of positive terms: h00·h11 − h01² loses thin ellipses to cancellation.
    float trace = dot(j[0], j[0]) + dot(j[1], j[1]);
    float rootOfH = sqrt(determinant * determinant + lowPass * (trace + lowPass));
    float first = sqrt(h00);
    return SplatShape(mat2(first, h01 / first, 0.0, rootOfH / first), determinant / rootOfH);
}

/// H = V^h: the weight alone, as fullEwaShape()'s becomes for small splats. At most 1, or splats much
/// larger than the filter would overflow the sums.
float lowPassWeight(EyeSplat splat) {
    return min(projectedDeterminant(splat) / (lowPassRadiusPx * lowPassRadiusPx), 1.0);
}
