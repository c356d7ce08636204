// Shift and warp ([xie2017] Sec. 5.4.2–5.4.3): the key frame's reflections moved to a new view.
#pragma once

#include "runner/gl/objects.h"
#include "runner/gl/program.h"
#include "techniques/reflection_reuse/pixel_matcher.h"

namespace gfxrepro::reflection_reuse {

enum class Forward {
    Grid,    // a mesh over the image, a vertex a pixel centre: no holes
    Splats,  // a point a pixel, as Fig. 38 shows: holes that wrong surfaces fill
};

struct ReprojectionSettings {
    Forward forward = Forward::Grid;
    float maxGrowth = 16.0F;   // of a grid triangle's area; beyond, what it covers is invalid
    float silhouette = 0.05F;  // as MatchingSettings has it
    /// A warped sample is valid where its depth and the new view's agree to this share of it.
    float depthTolerance = 0.01F;
};

/// The shifted image (the intermediate image of Fig. 36 C), in the key frame's view.
struct ShiftedImage {
    gl::Texture radiance;  // RGBA16F; a: 1 valid, 0 invalid
    gl::Texture depthBuffer;
    gl::Framebuffer framebuffer;
    explicit ShiftedImage(glm::ivec2 sizePx);
    std::size_t sizeBytes() const;
};

class Reprojection {
  public:
    Reprojection(const gl::ShaderLibrary& shaders, const ReprojectionSettings& settings,
                 glm::ivec2 sizePx);
    /// The grid's vertices moved by the offsets and drawn with depth s.d + s.r; cells with an
    /// invalid corner or across a silhouette, and triangles that grow too much, write invalid.
    void shift(const ReflectionDepthImage& key, const Offsets& offsets, ShiftedImage& result);
    /// The shifted image forward to the view of `gbuffer`: radiance into `target` and, into
    /// `wanted` (R8UI), 1 where a reflective sample got nothing valid, else 0.
    void warp(const ReflectionDepthImage& key, const ShiftedImage& shifted,
              const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
              gl::Texture& wanted);
    std::size_t sizeBytes() const;

  private:
    ReprojectionSettings settings_;
};

}  // namespace gfxrepro::reflection_reuse
