// All clusters' depth images in one draw: the outlook of [xie2017] Sec. 4.7.4.
#pragma once

#include "techniques/clustered_reflections/cluster_images.h"

namespace gfxrepro::clustered_reflections {

/// Images are packed side by side, objects culled for each cluster and both drawn by one multi-draw
/// indirect, an instance for each cluster that sees an object, without a read-back. Where not all
/// fit, all are scaled down by the same factor.
class AtlasPainter {
  public:
    AtlasPainter(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                 const reflections::GpuObjects& objects, const CameraSettings& settings);
    /// `counts` are Clusters::counts. Leaves cameras and places bound for the intersection.
    void draw(const reflections::GpuObjects& objects, const gl::Buffer& cameras,
              const gl::Buffer& counts, ClusterImages& target);
    /// ivec4 a cluster: x, y, width, height; width 0: no image.
    const gl::Buffer& places() const { return places_; }
    std::size_t sizeBytes() const;

    /// Of the last draw(); waits for the device.
    struct State {
        float scale = 1.0F;           // by which all images were scaled to fit
        std::uint32_t instances = 0;  // object × cluster pairs drawn
        std::uint32_t leftOut = 0;    // pairs beyond the instance list
    };
    State state() const;

  private:
    CameraSettings settings_;
    gl::Program place_, cull_, draw_;
    gl::Buffer families_, places_, order_, commands_, instances_, pieces_;
    gl::VertexArray vertexArray_;
    int commandCount_ = 0;
};

}  // namespace gfxrepro::clustered_reflections
