#include "techniques/reflection_reuse/reprojection.h"

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

namespace {

enum Target { kRadianceTarget = 0, kWantedTarget = 1 };

/// Points mend the rim of the grid: they fall back by this share of their depth, so that they only
/// show where the grid leaves a gap, and not half a pixel beside their place on a slope. Larger
/// shares would let what is farther show through.
constexpr float kPointBias = 0.01F;

gl::Defines reprojectionDefines() {
    return {{"kRadianceTarget", static_cast<int>(kRadianceTarget)},
            {"kWantedTarget", static_cast<int>(kWantedTarget)},
            {"DAMPING", kDamping},
            {"ROUNDING", kRounding},
            {"LONGEST_STEP", kLongestStep}};
}

/// What vertices carry (grid_vertex.glsl).
gl::Resources carried(const ReflectionDepthImage& key, const gl::Texture& radiance) {
    return {{"radiance", radiance},
            {"keyDepth", key.gbuffer.depth},
            {"keySurface", key.gbuffer.surface}};
}

}  // namespace

ShiftedImage::ShiftedImage(glm::ivec2 sizePx)
    : radiance(gl::Texture::make2D(GL_RGBA16F, sizePx)),
      depthBuffer(gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx)),
      framebuffer(std::array<const gl::Texture*, 1>{&radiance}, &depthBuffer) {}

std::size_t ShiftedImage::sizeBytes() const {
    return radiance.sizeBytes() + depthBuffer.sizeBytes();
}

Reprojection::Reprojection(const gl::ShaderLibrary& shaders, const ReprojectionSettings& settings,
                           glm::ivec2 sizePx)
    : settings_(settings) {
    const auto passOf = [&](const char* vertices, const char* fragments) {
        return gl::Pass(shaders, {vertices, fragments}, reprojectionDefines());
    };
    constexpr const char* kWhole = "kit/whole_image.vert.glsl";
    wantAll_ = passOf(kWhole, "reflection_reuse/want_all.frag.glsl");
    if (settings.resampling == Resampling::Gather) {
        reflectedPoints_ = passOf(kWhole, "reflection_reuse/reflected_points.frag.glsl");
        gather_ = passOf(kWhole, "reflection_reuse/gather.frag.glsl");
        reflected_ = gl::Texture::make2D(GL_RGBA32F, sizePx);
        return;
    }
    cells_.emplace(shaders, sizePx, settings.splitsDraws);
    shift_ = passOf("reflection_reuse/shift.vert.glsl", "reflection_reuse/shift.frag.glsl");
    warp_ = passOf("reflection_reuse/warp.vert.glsl", "reflection_reuse/warp.frag.glsl");
    depthBuffer_ = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx);
}

void Reprojection::setKeyFrame(const ReflectionDepthImage& key) {
    if (cells_) {
        cells_->classify(key.gbuffer, settings_.silhouette);
        return;
    }
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 1>{&reflected_});
    framebuffer.bind();
    reflectedPoints_.set("missDistance", key.diagonalM);
    reflectedPoints_.use(gl::Resources{{"distanceM", key.reflection.distance}}.with(
        key.gbuffer.resourcesFor(reflectedPoints_)));
    wholeImage_.draw();
}

void Reprojection::drawGrid(const gl::Program& program, float pointBias) {
    kit::setNearestWins();  // no culling: reflections in a hollow turn over
    program.set("isPoints", 0);
    program.set("pointBias", 0.0F);
    cells_->drawTriangles();
    program.set("isPoints", 1);
    program.set("pointBias", settings_.forward == Forward::Grid ? pointBias : 0.0F);
    cells_->drawPoints();
}

void Reprojection::shift(const ReflectionDepthImage& key, const Offsets& offsets,
                         ShiftedImage& result) {
    cells_->list(offsets.offset, CellList::Validity::Offset, settings_.forward == Forward::Splats);
    result.framebuffer.clearColour(kRadianceTarget, glm::vec4(0.0F));
    result.framebuffer.clearDepth(1.0F);
    result.framebuffer.bind();
    shift_.set("missDistance", key.diagonalM);
    // Eye depths end at the far plane; objects that move may carry hits beyond the scene's diagonal
    // at rest.
    shift_.set("longestPath", key.gbuffer.view.farM + 2.0F * key.diagonalM);
    shift_.set("maxGrowth", settings_.maxGrowth);
    shift_.use(carried(key, key.reflection.radiance)
                   .with({{"distanceM", key.reflection.distance}, {"offsets", offsets.offset}}));
    drawGrid(shift_, kPointBias);
}

void Reprojection::warp(const ReflectionDepthImage& key, const gl::Texture& radiance,
                        const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
                        gl::Texture& wanted) {
    cells_->list(radiance, CellList::Validity::Alpha, settings_.forward == Forward::Splats);
    wantAll(gbuffer, wanted);
    target.distance.clearToZero();
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 2>{&target.radiance, &wanted},
                                      &depthBuffer_);
    framebuffer.clearDepth(1.0F);
    framebuffer.bind();
    warp_.set("clipFromKeyPixels", glm::mat4(glm::dmat4(gbuffer.view.clipFromView) *
                                             glm::dmat4(gbuffer.view.viewFromWorld) *
                                             glm::dmat4(kit::worldFromPixels(key.gbuffer.view))));
    warp_.set("maxGrowth", settings_.maxGrowth);
    warp_.set("depthTolerance", settings_.depthTolerance);
    warp_.use(carried(key, radiance).with(gbuffer.resourcesFor(warp_)));
    // z/w = a + b/w: what is kPointBias farther on the same ray has b / (1 + kPointBias).
    const float b = gbuffer.view.clipFromView[3].z;
    drawGrid(warp_, b / (1.0F + kPointBias) - b);
}

void Reprojection::gather(const ReflectionDepthImage& key, const reflections::GBuffer& gbuffer,
                          reflections::ReflectionTarget& target, gl::Texture& wanted) {
    wanted.clearToZero();
    target.distance.clearToZero();
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 2>{&target.radiance, &wanted});
    framebuffer.bind();
    gather_.set("keyClipFromWorld", key.gbuffer.view.clipFromWorld());
    gather_.set("depthTolerance", settings_.depthTolerance);
    gather_.use(gl::Resources{{"keyReflected", reflected_},
                              {"keyRadiance", key.reflection.radiance},
                              {"keyDepth", key.gbuffer.depth}}
                    .with(gbuffer.resourcesFor(gather_)));
    reflective_.begin();
    wholeImage_.draw();
    reflective_.end();
}

void Reprojection::wantAll(const reflections::GBuffer& gbuffer, gl::Texture& wanted) {
    wanted.clearToZero();
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 1>{&wanted});
    framebuffer.bind();
    wantAll_.use(gbuffer.resourcesFor(wantAll_));
    reflective_.begin();
    wholeImage_.draw();
    reflective_.end();
}

std::uint32_t Reprojection::reflectiveSamples() const {
    return static_cast<std::uint32_t>(reflective_.result());
}

std::size_t Reprojection::sizeBytes() const {
    return cells_ ? cells_->sizeBytes() + depthBuffer_.sizeBytes() : reflected_.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
