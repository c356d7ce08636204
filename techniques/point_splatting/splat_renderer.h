// Draws patches as splats in three passes: visibility, accumulation, normalization and shading.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "techniques/kit/whole_image.h"
#include "techniques/point_splatting/device_points.h"

namespace gfxrepro::point_splatting {

struct SplatSettings {
    PointStorage storage = PointStorage::Compressed;
    float lowPassRadiusPx = 0.7F;   // r_h: the pixel spacing's filter
    float cutoff = 2.0F;            // a splat ends where its exponent is −½·cutoff²
    float visibilityOffset = 1.0F;  // ε, in radii of the splat, along the view ray
    glm::vec3 lightDirectionView = kLightDirectionView;
    bool showsModes = false;  // colours by SplatMode instead of the model's
};

/// A model on the device. Each mode has passes of its own, so that it does its own work only.
/// Splats turned away from the eye are not drawn.
class SplatRenderer final : public PointRenderer {
  public:
    SplatRenderer(const gl::ShaderLibrary& shaders, const ModelFile& model,
                  const SplatSettings& settings, glm::ivec2 sizePx);
    /// Passes: `visibility`, `splats`, `normalization` (sprites: `sprites` alone). Either all
    /// patches are drawn as sprites or none.
    void render(std::span<const DrawnPatch> drawn, const PatchView& view,
                gl::Profiler& profiler) override;
    /// Alpha is 1 but at edges (sprites: everywhere); the colour is multiplied by it, as over
    /// black.
    const gl::Texture& output() const override { return output_; }
    /// RGBA16F before normalization: Σ w n in view space, and Σ w in alpha. Not of sprites.
    const gl::Texture& accumulated() const { return normalSums_; }
    std::size_t pointBytes() const override { return points_.sizeBytes(); }
    std::size_t targetBytes() const override;

  private:
    /// Of one mode; ellipses are quads, the others GL points.
    struct ModePasses {
        gl::Pass visibility, splats;
    };
    void upload(std::span<const DrawnPatch> drawn, const PatchView& view);
    /// Whether the discs of a patch are GL points of a size that the device draws.
    bool fitsGlPoints(const DrawnPatch& drawn, const PatchView& view) const;
    void drawBatches(bool isVisibility, const PatchView& view);
    void drawSprites(const PatchView& view);
    void normalize(const PatchView& view);
    void issue(const gl::Pass& pass, const Batch& batch) const;
    void setUp(const gl::Pass& pass, const PatchView& view) const;

    SplatSettings settings_;
    glm::ivec2 sizePx_;
    DevicePoints points_;
    bool hasColors_;
    std::array<ModePasses, 3> modes_;  // by SplatMode
    gl::Pass sprites_, normalization_;
    gl::Texture normalSums_, colorSums_, depth_, output_;
    gl::Framebuffer visibilityTarget_, sumTarget_, outputTarget_, spriteTarget_;

    float maxPointPx_ = 1.0F;
    std::vector<DrawnPatch> items_;
    DrawList drawList_;
    gl::Buffer quadIndices_, records_, commands_;
    gl::VertexArray drawnArray_;
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::point_splatting
