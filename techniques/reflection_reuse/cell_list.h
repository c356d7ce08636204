// Which cells of the grid over a key frame are drawn: lists without gaps for indirect draws.
#pragma once

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflection_reuse/reflection_depth_image.h"

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

}  // namespace gfxrepro::reflection_reuse
