// The view of a splat pass, and depths on the screen.

uniform mat4 eyeFromModel;       // rigid; z is the distance along the view axis
uniform vec2 ndcPerSlope;        // x_ndc = ndcPerSlope.x · o_x / o_z + ndcOffset.x
uniform vec2 ndcOffset;
uniform vec2 depthFromInverseZ;  // z_ndc = x / o_z + y
uniform float nearM;

// What is not drawn: beyond the clip volume.
const vec4 kNowhere = vec4(2.0, 2.0, 2.0, 1.0);

vec2 ndcOf(vec3 centre) { return centre.xy / centre.z * ndcPerSlope + ndcOffset; }

float depthNdc(float inverseZ) { return depthFromInverseZ.x * inverseZ + depthFromInverseZ.y; }

// Splats turned away are not drawn, as patches are not that the selection culls: beyond an outline
// their far ends would show, lit from the wrong side. 0.1: those that reach around it stay.
bool isTurnedAway(vec3 normal, vec3 centre) { return dot(normal, centre) > 0.1 * length(centre); }

/// Of an eye-space direction: in view space z points to the eye.
vec3 viewOf(vec3 direction) { return direction * vec3(1.0, 1.0, -1.0); }

#ifdef VISIBILITY
// Half the side of the square within the unit circle.
const float kInscribed = 0.70710678;

uniform float visibilityOffset;  // in radii

// A splat's own fragments must pass the test against the depth that it left itself: the two passes
// interpolate over quads of different sizes, which differ by some units of 2⁻²⁴ in window depth.
const float kDepthSlack = 1e-6;

/// ε, the splats' offset along the view ray: a factor of distances, and here of 1 / o_z its inverse.
/// A splat that the filter makes wider than its disc reaches as far along slanting surfaces.
float visibilityDepth(float inverseZ, vec3 centre, float radius, float footprint) {
    float offset = visibilityOffset * max(radius, footprint);
    return depthNdc(inverseZ / (1.0 + offset / length(centre))) + kDepthSlack;
}
#endif
