#include "techniques/reflection_reuse/cell_list.h"

#include <array>

#include "techniques/kit/draws.h"
#include "techniques/reflection_reuse/pixel_matcher.h"

namespace gfxrepro::reflection_reuse {

namespace {

constexpr int kTileWidth = 8, kTileHeight = 4;  // of list_cells.comp.glsl
constexpr int kGroupSize = 64;

/// As glDrawElementsIndirect has it: of triangles, and of points.
struct Command {
    std::uint32_t count, instanceCount, firstIndex;
    std::int32_t baseVertex;
    std::uint32_t baseInstance;
};
static_assert(sizeof(Command) == 20);
enum DrawCommand : std::size_t { kTriangleDraw = 0, kPointDraw = 1 };
constexpr std::uint32_t kIndicesPerCell = 6;

gl::Defines passDefines() {
    return {{"GROUP_SIZE", kGroupSize},
            {"INDICES_PER_CELL", kIndicesPerCell},
            {"INVALID_OFFSET", kInvalidOffset}};
}

std::size_t product(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

}  // namespace

CellList::CellList(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx, bool splitsDraws)
    : sizePx_(sizePx),
      splitsDraws_(splitsDraws),
      classify_(shaders, {"kit/whole_image.vert.glsl", "reflection_reuse/classify_cells.frag.glsl"},
                passDefines()),
      list_(shaders, {"reflection_reuse/list_cells.comp.glsl"}, passDefines()),
      cells_(gl::Texture::make2D(GL_R8UI, sizePx)),
      framebuffer_(std::array<const gl::Texture*, 1>{&cells_}),
      triangles_(kIndicesPerCell * product(sizePx - 1) * sizeof(std::uint32_t)),
      points_(product(sizePx) * sizeof(std::uint32_t)),
      commands_(2 * sizeof(Command)) {
    triangleVertices_.setIndices(triangles_);
    pointVertices_.setIndices(points_);
    commands_.clear();
}

void CellList::classify(const reflections::GBuffer& key, float silhouette) {
    classify_.set("silhouette", silhouette);
    classify_.use(key.resourcesFor(classify_));
    framebuffer_.bind();
    wholeImage_.draw();
}

void CellList::list(const gl::Texture& samples, Validity validity, bool onlyPoints) {
    commands_.clear();
    list_.set("holdsOffsets", validity == Validity::Offset ? 1 : 0);
    list_.set("onlyPoints", onlyPoints ? 1 : 0);
    const GLuint tiles =
        kit::groupsFor(sizePx_.x, kTileWidth) * kit::groupsFor(sizePx_.y, kTileHeight);
    list_.dispatch({kit::groupsFor(tiles, kGroupSize), 1, 1}, {{"cells", cells_},
                                                               {"samples", samples},
                                                               {"Triangles", triangles_},
                                                               {"Points", points_},
                                                               {"Commands", commands_}});
    triangles_.awaitPasses(GL_ELEMENT_ARRAY_BARRIER_BIT);
    points_.awaitPasses(GL_ELEMENT_ARRAY_BARRIER_BIT);
    commands_.awaitPasses(GL_COMMAND_BARRIER_BIT);
    if (splitsDraws_) drawn_ = counts();
}

void CellList::drawTriangles() const {
    draw(triangleVertices_, GL_TRIANGLES, kTriangleDraw, kIndicesPerCell * drawn_.cells);
}

void CellList::drawPoints() const {
    draw(pointVertices_, GL_POINTS, kPointDraw, drawn_.points);
}

void CellList::draw(const gl::VertexArray& vertices, GLenum mode, std::size_t command,
                    std::uint32_t count) const {
    vertices.bind();
    if (!splitsDraws_) {
        glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
        glDrawElementsIndirect(mode, GL_UNSIGNED_INT,
                               reinterpret_cast<const void*>(command * sizeof(Command)));
        glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
        return;
    }
    const std::uint32_t indices = mode == GL_POINTS ? 1 : 3;  // of a primitive
    kit::FlushedDraws(true).draw(0, count / indices, [&](std::uint32_t first, std::uint32_t some) {
        glDrawElements(mode, static_cast<GLsizei>(indices * some), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(indices * first * sizeof(std::uint32_t)));
    });
}

CellList::Counts CellList::counts() const {
    const auto commands = commands_.read<Command>(2);
    return {commands[kTriangleDraw].count / kIndicesPerCell, commands[kPointDraw].count};
}

std::size_t CellList::sizeBytes() const {
    return cells_.sizeBytes() + triangles_.sizeBytes() + points_.sizeBytes() +
           commands_.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
