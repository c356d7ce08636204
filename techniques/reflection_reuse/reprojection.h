// Shift and warp ([xie2017] Sec. 5.4.2–5.4.3): the key frame's reflections moved to a new view; or
// gathered from it.
#pragma once

#include <optional>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflection_reuse/pixel_matcher.h"

namespace gfxrepro::reflection_reuse {

/// A cell has four neighbouring pixel centres for corners and is drawn as two triangles, its
/// vertices numbered y · width + x: programs find all else by gl_VertexID. Samples on the rim, with
/// an incomplete cell at some side, are listed as points, too: the rule that gives a pixel centre
/// on an edge to one of two triangles leaves it to none where the other one is missing.
class CellList {
  public:
    /// `splitsDraws`: of a software device, which keeps every triangle of a draw until it is
    /// flushed. It reads how many there are; others draw what the device has counted.
    CellList(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx, bool splitsDraws);

    /// Once a key frame: reflective samples, and the cells with four corners of one reflector whose
    /// eye depths differ by no more than `silhouette` of the nearest.
    void classify(const reflections::GBuffer& key, float silhouette);
    enum class Validity {
        Offset,  // valid: less than kInvalidOffset
        Alpha,   // valid: a = 1
    };
    /// Lists the cells with four valid corners and the valid samples on the rim; with `onlyPoints`
    /// no cell, and every valid sample as a point.
    void list(const gl::Texture& samples, Validity validity, bool onlyPoints);
    void drawTriangles() const;
    void drawPoints() const;

    /// Of the last list(); waits for the device.
    struct Counts {
        std::uint32_t cells = 0, points = 0;
    };
    Counts counts() const;
    std::size_t sizeBytes() const;

  private:
    void draw(const gl::VertexArray& vertices, GLenum mode, std::size_t command,
              std::uint32_t count) const;

    glm::ivec2 sizePx_;
    bool splitsDraws_;
    gl::Pass classify_, list_;
    gl::Texture cells_;  // R8UI: 1 a reflective sample, 2 the cell to its upper right
    gl::Framebuffer framebuffer_;
    gl::Buffer triangles_, points_, commands_;
    gl::VertexArray triangleVertices_, pointVertices_;
    Counts drawn_;  // with splitsDraws_
    kit::WholeImage wholeImage_;
};

enum class Forward {
    Grid,    // a mesh over the image, a vertex a pixel centre: no holes
    Splats,  // a point per pixel, as Fig. 38 shows: holes that wrong surfaces fill
};

enum class Resampling {
    Twice,   // the shift makes an image in the key frame's view (Fig. 36 C), which the warp
             // resamples
    Gather,  // ours: each sample of the new view finds its place in the key frame
};

struct ReprojectionSettings {
    Forward forward = Forward::Grid;
    Resampling resampling = Resampling::Twice;
    float maxGrowth = 16.0F;   // of a grid triangle's area; beyond, what it covers is invalid
    float silhouette = 0.05F;  // as MatchingSettings has it
    /// A warped sample is valid where its depth and the new view's agree to this share of it.
    float depthTolerance = 0.01F;
    bool splitsDraws = false;  // as CellList has it, by the device
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
    /// Once a key frame, before the others: finds the cells that a mesh may bridge.
    void setKeyFrame(const ReflectionDepthImage& key);

    /// The grid's vertices moved by the offsets and drawn with depth s.d + s.r. Cells with an
    /// invalid corner or across a silhouette are left out: what no other cell covers stays invalid,
    /// as it was cleared to. Triangles that grow too much write invalid and hide what is farther.
    /// A reflection stays on its reflector.
    void shift(const ReflectionDepthImage& key, const Offsets& offsets, ShiftedImage& result);
    /// `radiance` (RGBA16F; the shifted image, or, for the direct comparator, the key frame's own)
    /// forward to the view of `gbuffer`, into `target`; and, into `wanted` (R8UI), 1 where a
    /// reflective sample got nothing valid, else 0. Distances are not known: 0.
    /// Departure [xie2017] Sec. 5.4.3: it projects by "the conventional method"; here a second
    /// grid.
    void warp(const ReflectionDepthImage& key, const gl::Texture& radiance,
              const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
              gl::Texture& wanted);
    /// In place of Algorithm 9, shift() and warp() (Resampling::Gather): for each reflective sample
    /// of `gbuffer` the place of the key frame whose reflected point lies on the sample's own
    /// mirror ray, and of several the one with the nearest point. Wanted is what has none, and what
    /// the key frame did not see itself.
    void gather(const ReflectionDepthImage& key, const reflections::GBuffer& gbuffer,
                reflections::ReflectionTarget& target, gl::Texture& wanted);
    /// 1 at every reflective sample, else 0: what a key frame traces.
    void wantAll(const reflections::GBuffer& gbuffer, gl::Texture& wanted);

    /// Of the last warp(), gather() or wantAll(); waits for the device.
    std::uint32_t reflectiveSamples() const;
    /// Of the last list made, of shift() or warp().
    const CellList& cells() const { return *cells_; }
    std::size_t sizeBytes() const;

  private:
    void drawGrid(const gl::Program& program, float pointBias);

    ReprojectionSettings settings_;
    std::optional<CellList> cells_;  // of two steps
    gl::Pass shift_, warp_, reflectedPoints_, gather_, wantAll_;
    gl::Texture depthBuffer_;  // of the warped image
    gl::Texture reflected_;    // to gather from: RGBA32F, R of Eq. 8 and the reflector
    gl::SampleQuery reflective_;
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::reflection_reuse
