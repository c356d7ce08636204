// All clusters' depth images, of the triangles that they show and with nothing shaded: beyond
// [xie2017], Sec. 4.7.4 of which only asks for images that are cheaper to draw.
#pragma once

#include "techniques/clustered_reflections/detail_levels.h"
#include "techniques/clustered_reflections/image_places.h"

namespace gfxrepro::clustered_reflections {

/// Images lie side by side as in the atlas, and keep which triangle each texel shows. What is drawn
/// is listed on the device, without a read-back: for each cluster, of the parts in its frustum the
/// coarsest level whose error is below `levelErrorPx` texels (0: the finest); of that, chunks in
/// the frustum; of those, triangles whose box holds the middle of a texel. Surfaces are seen from
/// both sides, as meshes need not wind, so that nothing is culled for its direction but the back of
/// the own reflector, as in cluster_image.frag.glsl.
class VisiblePainter {
  public:
    VisiblePainter(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                   const reflections::GpuObjects& objects, const CameraSettings& settings,
                   float levelErrorPx);
    void draw(const reflections::GpuObjects& objects, const gl::Buffer& cameras,
              const Clusters& clusters, ClusterImages& target);
    std::size_t sizeBytes() const;

    /// Of the last draw(); waits for the device.
    AtlasState state() const { return places_.state(); }
    const gl::Buffer& places() const { return places_.places(); }
    /// For the intersection.
    gl::Resources resources(const reflections::GpuObjects& objects,
                            const gl::Buffer& cameras) const;

  private:
    void place(const reflections::GpuObjects& objects);

    CameraSettings settings_;
    float levelErrorPx_;
    std::uint32_t draws_;  // of what is listed
    DetailLevels levels_;
    ImagePlaces places_;
    gl::Pass placeChunks_, list_, split_, draw_;
    gl::Buffer families_, parts_, levelRecords_, chunks_, chunkBoxes_;
    gl::Buffer triangles_, cornersWorld_;  // by triangle of all levels
    gl::Buffer commands_, visible_, visibleCorners_;
    gl::VertexArray vertexArray_;
    std::vector<glm::mat4>
        restPoses_;  // that of setup: objects that never leave it are placed once
    std::vector<std::uint8_t> hasMoved_;  // since then, by object
};

}  // namespace gfxrepro::clustered_reflections
