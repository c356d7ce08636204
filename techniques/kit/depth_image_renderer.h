// Conventional, non-redundant and peeled depth images: one renderer, three uses.
#pragma once

#include <compare>
#include <map>
#include <span>

#include "techniques/kit/depth_image.h"
#include "techniques/kit/drawable_scene.h"

namespace gfxrepro::kit {

/// Where a fragment's triangle id comes from.
enum class TriangleIds {
    PrimitiveId,     // gl_PrimitiveID in the fragment stage
    GeometryShader,  // handed on by a geometry stage, as the thesis has it
};

/// By which definition a sample is redundant with an earlier view ([xie2017] Sec. 2.2.1).
enum class Redundancy {
    Pixel,       // Algorithm 3: the earlier image holds its triangle where it lands
    Visibility,  // Algorithm 2: the earlier view sees it, by the depths of its conventional image
};

/// At most this many earlier images can be tested against: with the base colours sixteen textures,
/// as many as a stage of every OpenGL 4.5 takes.
constexpr int kMaxEarlierImages = 15;

/// Light of every depth image: colour · (0.3 + 0.7 · max(N·L, 0)), N turned towards the eye for
/// double-sided triangles; no shadows.
constexpr glm::vec3 kLightDirectionWorld{0.397F, 0.794F, 0.461F};  // towards the light

/// The first `count` of a list of images, as the renderer takes them.
std::vector<const DepthImage*> firstOf(const std::vector<DepthImage>& images, std::size_t count);

/// [xie2017] Algorithm 1 with the pixel test of Algorithm 3 in the fragment stage. The fragment
/// that stays in a pixel is the nearest one whose triangle no earlier image holds at the pixel
/// where the fragment lands in it.
class DepthImageRenderer {
  public:
    /// What of an image is drawn: all, or depths and ids alone, which leaves its shading undefined.
    enum class Content { All, Samples };

    DepthImageRenderer(const gl::ShaderLibrary& shaders, TriangleIds ids, DepthFormat format);

    DepthImage makeImage(const View& view) const { return {view, format_}; }

    /// Clears `target` and draws `scene` from its view.
    ///   - conventional image: `earlier` is empty
    ///   - non-redundant image i: `earlier` is I₀ … Iᵢ₋₁
    ///   - peeled layer i: as non-redundant, all images having one view
    ///   - non-redundant by visibility: `earlier` is conventional images of the views before
    void render(const DrawableScene& scene, DepthImage& target,
                std::span<const DepthImage* const> earlier = {},
                Redundancy redundancy = Redundancy::Pixel, Content content = Content::All);

  private:
    /// What the pass for an image is made for; the rest is uniforms.
    struct Variant {
        int earlierCount = 0;
        Redundancy redundancy = Redundancy::Pixel;
        bool hasTextures = false;
        bool isAlphaTested = false;
        bool hasFlatParts = false;
        bool isShaded = true;
        auto operator<=>(const Variant&) const = default;
    };
    const gl::Pass& passFor(const Variant& variant);

    const gl::ShaderLibrary& shaders_;
    TriangleIds ids_;
    DepthFormat format_;
    std::map<Variant, gl::Pass> passes_;
};

}  // namespace gfxrepro::kit
