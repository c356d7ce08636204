// All clusters' depth images in one draw: the outlook of [xie2017] Sec. 4.7.4.
#pragma once

#include "techniques/clustered_reflections/image_places.h"

namespace gfxrepro::clustered_reflections {

/// Images are packed side by side, objects culled for each cluster and both drawn by one multi-draw
/// indirect, an instance for each cluster that sees an object, without a read-back. Where not all
/// fit, all are scaled down by the same factor.
class AtlasPainter {
  public:
    AtlasPainter(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                 const reflections::GpuObjects& objects, const CameraSettings& settings);
    void draw(const reflections::GpuObjects& objects, const gl::Buffer& cameras,
              const Clusters& clusters, ClusterImages& target);
    /// For the intersection.
    gl::Resources resources(const gl::Buffer& cameras) const {
        return {{"Cameras", cameras}, {"Places", places()}};
    }
    const gl::Buffer& places() const { return places_.places(); }
    std::size_t sizeBytes() const;

    /// Of the last draw(); waits for the device.
    AtlasState state() const { return places_.state(); }

  private:
    CameraSettings settings_;
    gl::Buffer families_;
    ImagePlaces places_;
    gl::Pass cull_, draw_;
    gl::Buffer commands_, instances_, pieces_;
    gl::VertexArray vertexArray_;
    int commandCount_ = 0;
};

}  // namespace gfxrepro::clustered_reflections
