#include "techniques/reflection_reuse/cell_list.h"

#include <array>

#include "techniques/reflection_reuse/pixel_matcher.h"

namespace gfxrepro::reflection_reuse {

namespace {

/// llvmpipe keeps every triangle of a draw until it is flushed.
constexpr std::uint32_t kPrimitivesPerDraw = 1U << 16;
constexpr int kTileWidth = 8, kTileHeight = 4;  // of list_cells.comp.glsl
constexpr int kGroupSize = 64;

enum Storage : unsigned { kTriangles = 0, kPoints = 1, kCounts = 2, kCommands = 3 };
enum Unit : unsigned { kCellsUnit = 0, kSamplesUnit = 1, kGBufferUnit = 2 };

/// As glDrawElementsIndirect has it.
struct Command {
    std::uint32_t count, instanceCount, firstIndex;
    std::int32_t baseVertex;
    std::uint32_t baseInstance;
};
static_assert(sizeof(Command) == 20);
static_assert(sizeof(CellList::Counts) == 8);

gl::Defines passDefines() {
    return {{"CELLS_UNIT", static_cast<int>(kCellsUnit)},
            {"SAMPLES_UNIT", static_cast<int>(kSamplesUnit)},
            {"GBUFFER_UNIT", static_cast<int>(kGBufferUnit)},
            {"TRIANGLES_BINDING", static_cast<int>(kTriangles)},
            {"POINTS_BINDING", static_cast<int>(kPoints)},
            {"COUNTS_BINDING", static_cast<int>(kCounts)},
            {"COMMANDS_BINDING", static_cast<int>(kCommands)},
            {"GROUP_SIZE", kGroupSize},
            {"PRIMITIVES_PER_DRAW", kPrimitivesPerDraw},
            {"INVALID_OFFSET", kInvalidOffset}};
}

std::size_t product(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

std::size_t drawsFor(std::size_t primitives) {
    return (primitives + kPrimitivesPerDraw - 1) / kPrimitivesPerDraw;
}

int ceilDivided(int count, int size) {
    return (count + size - 1) / size;
}

}  // namespace

CellList::CellList(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx)
    : sizePx_(sizePx),
      triangleDraws_(drawsFor(2 * product(sizePx - 1))),
      pointDraws_(drawsFor(product(sizePx))),
      classify_(shaders,
                {"reflections/whole_image.vert.glsl", "reflection_reuse/classify_cells.frag.glsl"},
                passDefines()),
      list_(shaders, {"reflection_reuse/list_cells.comp.glsl"}, passDefines()),
      split_(shaders, {"reflection_reuse/split_draws.comp.glsl"}, passDefines()),
      cells_(gl::Texture::make2D(GL_R8UI, sizePx)),
      framebuffer_(std::array<const gl::Texture*, 1>{&cells_}),
      triangles_(6 * product(sizePx - 1) * sizeof(std::uint32_t)),
      points_(product(sizePx) * sizeof(std::uint32_t)),
      counts_(sizeof(Counts)),
      commands_((triangleDraws_ + pointDraws_) * sizeof(Command)) {
    triangleVertices_.setIndices(triangles_);
    pointVertices_.setIndices(points_);
    counts_.clear();
}

void CellList::classify(const reflections::GBuffer& key, float silhouette) {
    classify_.use();
    key.bind(classify_, kGBufferUnit);
    classify_.set("silhouette", silhouette);
    framebuffer_.bind();
    wholeImage_.draw();
}

void CellList::list(const gl::Texture& samples, Validity validity, bool onlyPoints) {
    counts_.clear();
    cells_.bind(kCellsUnit);
    samples.bind(kSamplesUnit);
    triangles_.bindStorage(kTriangles);
    points_.bindStorage(kPoints);
    counts_.bindStorage(kCounts);
    commands_.bindStorage(kCommands);
    list_.use();
    list_.set("holdsOffsets", validity == Validity::Offset ? 1 : 0);
    list_.set("onlyPoints", onlyPoints ? 1 : 0);
    const int tiles = ceilDivided(sizePx_.x, kTileWidth) * ceilDivided(sizePx_.y, kTileHeight);
    glDispatchCompute(static_cast<GLuint>(ceilDivided(tiles, kGroupSize)), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    split_.use();
    split_.set("triangleDraws", static_cast<unsigned>(triangleDraws_));
    glDispatchCompute(static_cast<GLuint>(triangleDraws_ + pointDraws_), 1, 1);
    glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

void CellList::drawTriangles() const {
    draw(triangleVertices_, GL_TRIANGLES, 0, triangleDraws_);
}

void CellList::drawPoints() const {
    draw(pointVertices_, GL_POINTS, triangleDraws_, pointDraws_);
}

void CellList::draw(const gl::VertexArray& vertices, GLenum mode, std::size_t firstCommand,
                    std::size_t commandCount) const {
    vertices.bind();
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
    for (std::size_t i = firstCommand; i < firstCommand + commandCount; ++i) {
        glDrawElementsIndirect(mode, GL_UNSIGNED_INT,
                               reinterpret_cast<const void*>(i * sizeof(Command)));
        glFlush();
    }
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

CellList::Counts CellList::counts() const {
    return counts_.read<Counts>(1).front();
}

std::size_t CellList::sizeBytes() const {
    return cells_.sizeBytes() + triangles_.sizeBytes() + points_.sizeBytes() + counts_.sizeBytes() +
           commands_.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
