// A cluster's camera, as cluster_cameras.h has it.

struct ClusterCamera {
    mat4 clipFromWorld;  // to the whole image
    vec4 eyeWorld;       // e_c; w: near distance
    vec4 planeNormal;    // n_c; w: far distance from e_c
    vec4 centreWorld;    // P_c; w: f of Eq. (6)
    ivec2 sizePx;        // w × h, not yet scaled or limited
    uint reflector;
    uint flags;
};

const uint kPlanarCluster = 1u;
const uint kNoRoom = 2u;      // between near and far: no image, no march
const uint kEyeBehind = 4u;   // the eye is not before the fitting plane
const uint kRaysTurned = 16u;  // rays beyond the greatest slope: they leave the image at its side
