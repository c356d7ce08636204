// Steps 2 and 3 of [xie2017] Algorithm 6, as a tracer of reflections.
#pragma once

#include <optional>
#include <vector>

#include "techniques/clustered_reflections/cluster_cameras.h"
#include "techniques/clustered_reflections/cluster_images.h"
#include "techniques/clustered_reflections/clustering.h"
#include "techniques/clustered_reflections/visible_triangles.h"

namespace gfxrepro::clustered_reflections {

/// How a ray goes through a depth image (march.glsl).
enum class March {
    Linear,        // Algorithm 7: a texel per step along the longer axis
    Hierarchical,  // the same samples, but those in tiles that are nearer than all that the tile
                   // holds are stepped over, by a pyramid of nearest depths: the same hits
};

/// How the clusters' depth images are drawn.
enum class ImageDrawing {
    OneByOne,  // the thesis: a cluster's image is drawn, used and overwritten by the next
    Visible,   // all side by side, of the triangles that may be seen; shaded where rays meet them
    None,      // not at all: clusters and their cameras alone, nothing is reflected
};

/// What rays see of the reflector that they leave: [xie2017] Sec. 4.7.4.
enum class OwnReflector {
    WholeScene,      // first way: rays meet an image of the whole scene, bent or not
    ConcaveDiffuse,  // second way: concave clusters are detected, and show the diffuse colour where
                     // their rays meet their own reflector; other images leave it out
};

struct ClusteredSettings {
    Clustering clustering = Clustering::NormalBins;
    BinSettings bins;
    CameraSettings camera;
    ImageDrawing drawing = ImageDrawing::OneByOne;
    /// Visible: how far, in texels, a simplified object may lie from itself; 0: none is simplified.
    float levelErrorPx = 0.0F;
    March march = March::Linear;
    OwnReflector ownReflector = OwnReflector::ConcaveDiffuse;
    /// As the thesis has it: images that show the own reflector show its back, too, which no ray
    /// meets. Ours leave it out.
    bool showsOwnBack = false;
};

/// The texture of the images: 34 MB, so that a frame of 1024² samples holds less than the 87 MB of
/// [xie2017] Sec. 4.7.1, G-buffer and target included.
constexpr glm::ivec2 kImagesSizePx(2048);

/// Passes, named as Table 14: `first_pass_and_clustering` (the caller draws the G-buffer under the
/// same name), `cluster_cameras`, `depth_images`, `intersection`.
class ClusteredTracer final : public reflections::ReflectionTracer {
  public:
    ClusteredTracer(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                    const reflections::GpuObjects& objects, const reflections::EnvironmentMap& map,
                    const ClusteredSettings& settings, glm::ivec2 sizePx);

    void update(const reflections::GpuObjects& objects, gl::Profiler&) override {
        objects_ = &objects;
    }
    void trace(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
               reflections::ReflectionTarget& target, gl::Profiler& profiler) override;
    std::size_t sizeBytes() const override;
    std::size_t frameBufferBytes() const override { return images_.sizeBytes(); }

    /// Of the last trace(); these read back and wait for the device.
    int clusterCount() const;
    std::vector<ClusterCamera> cameras() const;
    const Clusters& clusters() const { return builder_.clusters(); }
    /// What the images of the last trace() were drawn with, all together; nothing where there are
    /// none.
    struct Drawn {
        std::uint64_t triangles = 0, texels = 0;
        std::uint64_t leftOut = 0;  // triangles for which there was no room
    };
    Drawn drawn() const;
    /// Samples whose mirror ray took the environment map ([xie2017] Fig. 28), a byte a sample, rows
    /// from the bottom. Glossy samples never do: what is missing shows their diffuse colour.
    std::vector<std::uint8_t> environmentSamples() const;

  private:
    void drawVisible(const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
                     gl::Profiler& profiler);
    void drawOneByOne(const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
                      gl::Profiler& profiler);
    /// Its samples, between the drawing of its image and of the next: `range` is its entry of
    /// Clusters::ranges.
    void intersectCluster(std::uint32_t cluster, const glm::uvec4& range,
                          const gl::Resources& resources,
                          reflections::ReflectionTarget& target) const;

    ClusteredSettings settings_;
    const reflections::GpuObjects* objects_;  // of the last update()
    const reflections::EnvironmentMap& map_;
    ClusterBuilder builder_;
    ClusterCameras clusterCameras_;
    ClusterImages images_;
    gl::Pass intersection_;
    gl::Texture environmentSamples_;  // R8UI: 1 where a mirror ray took the environment map
    kit::WholeImage wholeImage_;
    std::optional<VisiblePainter> visible_;
    std::optional<OneByOnePainter> oneByOne_;
    // One by one:
    gl::Buffer places_;
    std::vector<glm::ivec4> sizes_;  // of the last frame's images: 0, 0, width, height
    std::uint64_t trianglesDrawn_ = 0;
};

}  // namespace gfxrepro::clustered_reflections
