// Step 3.b of [xie2017] Algorithm 6: the scene drawn from cluster cameras.
#pragma once

#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "techniques/clustered_reflections/cluster_cameras.h"
#include "techniques/clustered_reflections/clustering.h"
#include "techniques/reflections/gpu_objects.h"

namespace gfxrepro::clustered_reflections {

/// What the passes of step 3 share.
gl::Defines imageDefines();
/// Those, and what passes that shade surfaces ask of the scene.
gl::Defines shadedImageDefines(const reflections::ReflectiveScene& scene);

/// Levels above the depth image: tiles of 4, 8, 16 and 32 texels a side. (Tiles of 2 would cost
/// more memory than all others and skip next to nothing.)
constexpr int kPyramidLevels = 4;
constexpr int kLargestTilePx = 2 << kPyramidLevels;

/// What a texel keeps beside its depth.
enum class TexelContent {
    Colours,    // reflections::keptColour() of the diffuse colour; a: own reflector
    Triangles,  // R32UI, the triangle (VisiblePainter); bit 31: own reflector
};

/// The texture that holds one cluster's image, or those of all. 8 bytes a texel, 1/3 more with the
/// pyramid. The depth buffer holds near distance / z: the hardware's own depth, reversed and with
/// the far plane at infinity, so that no second target keeps what the march compares.
class ClusterImages {
  public:
    ClusterImages(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx, bool hasPyramid,
                  TexelContent content = TexelContent::Colours);

    /// Clears texels [0, sizePx) and makes ready for drawing into them.
    void beginDrawing(glm::ivec2 sizePx) const;
    /// Back to the defaults that other passes take for granted; makes the pyramid of [0, sizePx).
    void endDrawing(glm::ivec2 sizePx);
    /// For shaders that include intersect.glsl.
    gl::Resources resources() const;

    glm::ivec2 sizePx() const { return glm::ivec2(colour_.size()); }
    const gl::Texture& colour() const { return colour_; }  // TexelContent
    const gl::Texture& depth() const { return depth_; }    // near distance / z; 0: nothing there
    std::size_t sizeBytes() const;

  private:
    bool hasPyramid_;
    TexelContent content_;
    /// A level of the pyramid: read by itself while the next one is drawn.
    struct Level {
        gl::Texture nearest;
        gl::Framebuffer framebuffer;
    };

    gl::Texture colour_, depth_, nearest_;
    gl::Framebuffer framebuffer_;
    std::vector<Level> levels_;  // of nearest_
    gl::Pass pyramid_;
    gl::VertexArray none_;
};

/// w × h of the image of a cluster of `samples` as it is drawn: scaled (Table 17), no larger than
/// the limits, at least a texel. (0, 0): no image. shaders/place_images.comp.glsl has the same.
glm::ivec2 imageSizePx(const ClusterCamera& camera, const CameraSettings& settings,
                       std::uint32_t samples);

/// Whether two parts of one object bend to different sides, as in- and outside of a bowl do: they
/// lie back to back, and what leaves the one does not meet the other. shaders/culling.glsl has the
/// same.
///
/// Departure [xie2017] Algorithm 6, step 3.b: images of the one leave out the other, which lies as
/// near behind them as a wall is thin, and curved surfaces rise before a near plane.
constexpr bool areBackToBack(std::uint32_t family, std::uint32_t other) {
    return wholeOf(family) == wholeOf(other) && family != other &&
           (family & 3U) + (other & 3U) == 3U;
}

/// The thesis's way: a cluster's image at the texture's origin, objects culled on the CPU.
class OneByOnePainter {
  public:
    OneByOnePainter(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene);
    /// Returns how many triangles were drawn.
    std::uint64_t draw(const reflections::GpuObjects& objects, const ClusterCamera& camera,
                       glm::ivec2 sizePx, ClusterImages& target);
    /// Objects in the frustum, without the own reflector unless the camera shows it, and without
    /// what lies back to back with it.
    std::vector<std::uint32_t> objectsSeen(const reflections::GpuObjects& objects,
                                           const ClusterCamera& camera) const;

  private:
    std::vector<std::uint32_t> reflectorOfObject_, trianglesOfObject_, families_;
    std::vector<std::uint8_t> isPlain_;  // by object: drawn by plainPass_
    gl::Pass pass_, plainPass_;          // which samples no texture
};

}  // namespace gfxrepro::clustered_reflections
