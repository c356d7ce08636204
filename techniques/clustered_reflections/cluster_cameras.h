// Step 3.a of [xie2017] Algorithm 6: a camera a cluster (Sec. 4.4).
#pragma once

#include "techniques/clustered_reflections/clustering.h"
#include "techniques/kit/view.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::clustered_reflections {

/// Bits of ClusterCamera::flags.
constexpr std::uint32_t kPlanarCluster = 1;
constexpr std::uint32_t kNoRoom = 2;       // between near and far (glossy): no image, no march
constexpr std::uint32_t kEyeBehind = 4;    // the eye is not before the fitting plane (see below)
constexpr std::uint32_t kRaysTurned = 16;  // some rays are beyond CameraSettings::maxSlope
constexpr std::uint32_t kShowsOwn = 1U << 16;      // the image has the own reflector
constexpr std::uint32_t kShowsOwnBack = 1U << 17;  // with what faces away from the camera

/// A cluster's camera as shaders/cluster_camera.glsl has it (std430). It looks along the normal of
/// the fitting plane, which is its near plane; an off-centre frustum. Geometry between samples that
/// lie behind the fitting plane and that plane is cut away, as the paper has it.
struct ClusterCamera {
    glm::mat4 clipFromWorld{1.0F};  // to the whole image
    glm::vec4 eyeWorld{0.0F};       // e_c; w: near distance (of the fitting plane from e_c)
    glm::vec4 planeNormal{0.0F};    // n_c; w: far distance from e_c
    glm::vec4 centreWorld{0.0F};    // P_c; w: f of Eq. (6)
    glm::ivec2 sizePx{0};         // w × h, not yet scaled or limited; each 1 … kMaxCameraSizePx
    std::uint32_t reflector = 0;  // whose own triangles the depth image leaves out
    std::uint32_t flags = 0;
};
static_assert(sizeof(ClusterCamera) == 128);
constexpr int kMaxCameraSizePx = 1 << 16;

struct CameraSettings {
    float diagonalM = 1.0F;  // of the scene's box: the far plane of mirrors
    reflections::LobeSettings lobe;
    float depthImageScale = 1.0F;  // of w and h (Table 17)
    /// Departure [xie2017] Sec. 4.4, step 5: a side has no more, as all images share one texture;
    /// larger ones are scaled down to it, most of all where w and h are doubled (Table 17).
    int maxSizePx = 2048;
    /// Beyond the paper: images of more texels for each of their cluster's samples are scaled down
    /// to as many. 0: as many as the paper's w × h are.
    float texelsPerSample = 0.0F;
    /// Departure [xie2017] Sec. 4.4, step 4: the steepest ray, as the tangent of its angle to n_c,
    /// that the image is made wide enough for; 8: 83°. A steeper one, or one that points away from
    /// the far plane, leaves the image at its side and takes the environment map from there on.
    /// Images for the steepest 7° would be as wide as for all others together.
    float maxSlope = 8.0F;
    /// Flags of what images show of their own reflector ([xie2017] Sec. 4.7.4), by how a cluster
    /// bends. Planar ones have nothing of themselves before their near plane.
    std::uint32_t ofConcave = 0, ofConvex = 0;
};

/// The eye's least height over a fitting plane, in scene diagonals: below it (a cluster seen
/// edge-on, or from behind, inside a hollow reflector) e_0 is put that far behind the plane
/// (kEyeBehind). A frustum of near : far = 1 : 10⁴ is about what float depths resolve.
constexpr float kLeastHeight = 1e-4F;
/// Least room between fitting plane and far plane, in scene diagonals: with less, nothing
/// (kNoRoom).
constexpr float kLeastRoom = 1e-3F;
/// Departure [xie2017] Eq. (6): f of concave clusters is at most this; it has no bound where their
/// rays meet in a point.
constexpr int kMaxShift = 16;

/// Cameras of all clusters by reductions on the device, in passes over the sorted samples:
/// 1. P_c and n_c; 2. boxes of the rays' start and end points on the fitting plane, seen from e₀:
/// f = d_n / d_f (Eq. (6)), e_c = P_c + (e₀ − P_c)·f; 3. box of both seen from e_c: the image
/// plane, and its resolution from p, the mean distance of samples that are neighbours in a row or
/// column, on the fitting plane as seen from e_c.
///
/// f of a planar reflector is 1 exactly; with kRaysTurned it is at most 1. It is raised where e_c
/// would not lie behind every sample, at 1.5 times the farthest one's distance from the plane. The
/// image's y axis is the eye's up on the plane, or its x axis the eye's left, whichever lies
/// flatter on it. Half a pixel p is left around the box. Every sum is taken in a fixed order: two
/// runs give the same bits.
class ClusterCameras {
  public:
    ClusterCameras(const gl::ShaderLibrary& shaders, const CameraSettings& settings);
    void build(const reflections::GBuffer& gbuffer, const Clusters& clusters);
    /// ClusterCamera cameras[kMaxClusters]; those beyond the cluster count are undefined.
    const gl::Buffer& cameras() const { return cameras_; }
    std::size_t sizeBytes() const;

  private:
    void setUniforms(const gl::Pass& pass, const kit::View& view) const;

    CameraSettings settings_;
    gl::Pass chunksPass_, sums_, centres_, boxes_, eyes_, wholeBoxes_, camerasPass_;
    gl::Buffer chunks_, arguments_, partials_, frames_, cameras_;
};

}  // namespace gfxrepro::clustered_reflections
