// Step 3.a of [xie2017] Algorithm 6: a camera a cluster (Sec. 4.4).
#pragma once

#include <vector>

#include "techniques/clustered_reflections/clustering.h"
#include "techniques/shared/reflections/reflection_tracer.h"
#include "techniques/shared/view.h"

namespace gfxrepro::clustered_reflections {

/// A cluster's camera as shaders/cluster_camera.glsl has it (std430). It looks along the normal of
/// the fitting plane, which is its near plane; an off-centre frustum.
struct ClusterCamera {
    glm::mat4 clipFromWorld{1.0F};  // to the whole image
    glm::vec4 eyeWorld{0.0F};       // e_c; w: near distance, of the fitting plane from e_c
    glm::vec4 planeNormal{0.0F};    // n_c; w: far distance from e_c
    glm::vec4 centreWorld{0.0F};    // P_c; w: f of Eq. (6)
    glm::ivec2 sizePx{0};           // w × h, not yet scaled or limited
    std::uint32_t reflector = 0;    // whose own triangles the depth image leaves out
    std::uint32_t flags = 0;        // bit 0: planar; bit 1: no room between near and far: no image
};

struct CameraSettings {
    float diagonalM = 1.0F;  // of the scene's box: the far plane of mirrors
    reflections::LobeSettings lobe;
    float depthImageScale = 1.0F;  // of w and h (Table 17)
    int maxSizePx = 2048;          // a side; larger images are scaled down to it
};

/// Cameras of all clusters by reductions on the device, in passes over the sorted samples:
/// 1. P_c and n_c; 2. boxes of the rays' start and end points on the fitting plane, seen from e₀:
/// f = d_n / d_f (Eq. (6)), e_c = P_c + (e₀ − P_c)·f; 3. box of both seen from e_c: the image
/// plane, and its resolution from p, the mean distance of consecutive samples on the fitting plane.
class ClusterCameras {
  public:
    ClusterCameras(const gl::ShaderLibrary& shaders, const CameraSettings& settings);
    void build(const reflections::GBuffer& gbuffer, const Clusters& clusters);
    /// ClusterCamera cameras[kMaxClusters]; those beyond the cluster count are undefined.
    const gl::Buffer& cameras() const { return cameras_; }
    std::size_t sizeBytes() const;

  private:
    CameraSettings settings_;
    gl::Buffer cameras_;
};

/// The camera of samples by the same formulas in double precision: what the device must give.
ClusterCamera cameraOnHost(const reflections::HostGBuffer& gbuffer,
                           const std::vector<glm::ivec2>& samples, bool isPlanar,
                           const CameraSettings& settings);

}  // namespace gfxrepro::clustered_reflections
