// Draws patches as splats in three passes: visibility, accumulation, normalization and shading.
#pragma once

#include <span>
#include <vector>

#include "runner/gl/objects.h"
#include "runner/gl/profiler.h"
#include "runner/gl/program.h"
#include "techniques/point_splatting/model_file.h"
#include "techniques/point_splatting/patch_selection.h"

namespace gfxrepro::point_splatting {

enum class PointStorage {
    Compressed,    // 8 bytes, decoded in the vertex stage
    Uncompressed,  // 60 bytes
};

struct SplatSettings {
    PointStorage storage = PointStorage::Compressed;
    float lowPassRadiusPx = 0.7F;   // r_h: the pixel spacing's filter
    float cutoff = 2.0F;            // a splat ends where its exponent is −½·cutoff²
    float visibilityOffset = 1.0F;  // ε, in radii of the splat, along the view ray
    glm::vec3 lightDirectionView{0.3F, 0.5F, 0.8F};
};

/// A model on the device.
class SplatRenderer {
  public:
    SplatRenderer(const gl::ShaderLibrary& shaders, const ModelFile& model,
                  const SplatSettings& settings, glm::ivec2 sizePx);
    /// Passes: `visibility`, `splats`, `normalization` (sprites: `sprites` alone).
    void render(std::span<const DrawnPatch> drawn, const PatchView& view, gl::Profiler& profiler);
    /// RGBA8 linear, alpha 1 where something was drawn.
    const gl::Texture& output() const { return output_; }
    /// Sum of the weights a pixel before normalization (R of an RGBA16F target): for tests.
    const gl::Texture& accumulated() const { return accumulated_; }
    std::size_t pointBytes() const;   // what holds the points on the device
    std::size_t targetBytes() const;  // images

  private:
    SplatSettings settings_;
    gl::Texture accumulated_, normals_, depth_, output_;
};

}  // namespace gfxrepro::point_splatting
