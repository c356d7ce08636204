#include "techniques/clustered_reflections/visible_triangles.h"

#include <algorithm>
#include <cstddef>

namespace gfxrepro::clustered_reflections {
namespace {

/// Triangles drawn in a frame: 46 MB. Views of the generated rooms have a tenth to a half of them;
/// more are counted in AtlasState::leftOut.
constexpr std::uint32_t kMostVisible = 1U << 20;

/// As glMultiDrawArraysIndirect reads it.
struct DrawCommand {
    std::uint32_t count = 0, instanceCount = 0, first = 0, baseInstance = 0;
};

gl::Defines visibleDefines(std::uint32_t draws) {
    gl::Defines defines = imageDefines();
    defines["GROUP_SIZE"] = static_cast<int>(kChunkTriangles);
    defines["TRIANGLES_PER_DRAW"] = static_cast<int>(kMostVisible / draws);
    defines["DRAWS"] = static_cast<int>(draws);
    defines["MOST_VISIBLE"] = static_cast<int>(kMostVisible);
    return defines;
}

}  // namespace

VisiblePainter::VisiblePainter(const gl::ShaderLibrary& shaders,
                               const reflections::ReflectiveScene& scene,
                               const reflections::GpuObjects& objects,
                               const CameraSettings& settings, float levelErrorPx)
    : settings_(settings),
      levelErrorPx_(levelErrorPx),
      draws_(kMostVisible / std::min(kMostVisible, objects.mostTrianglesPerDraw())),
      levels_(detailLevels(scene, levelErrorPx > 0.0F)),
      places_(shaders),
      families_(gl::Buffer::of(reflectorFamilies(scene))),
      parts_(gl::Buffer::of(levels_.parts)),
      levelRecords_(gl::Buffer::of(levels_.levels)),
      chunks_(gl::Buffer::of(levels_.chunks)),
      chunkBoxes_(levels_.chunks.size() * 2 * sizeof(glm::vec4)),
      triangles_(gl::Buffer::of(levels_.triangles)),
      cornersWorld_(levels_.triangles.size() * 3 * sizeof(glm::vec3)),
      commands_(draws_ * sizeof(DrawCommand)),
      visible_(kMostVisible * sizeof(glm::uvec2)),
      visibleCorners_(std::size_t{kMostVisible} * 3 * sizeof(glm::vec3)),
      restPoses_(objects.poses().begin(), objects.poses().end()) {
    const auto compute = [&](const char* name) {
        return gl::Pass(shaders, {name}, visibleDefines(draws_));
    };
    placeChunks_ = compute("clustered_reflections/place_chunks.comp.glsl");
    list_ = compute("clustered_reflections/list_visible.comp.glsl");
    split_ = compute("clustered_reflections/split_visible.comp.glsl");
    draw_ = gl::Pass(shaders,
                     {"clustered_reflections/visible_triangle.vert.glsl",
                      "clustered_reflections/visible_triangle.frag.glsl"},
                     visibleDefines(draws_));
    vertexArray_.setAttribute(0, visibleCorners_, 3);
    place(objects);
}

/// Corners and boxes in the world; once all are there, of the objects that move. What a frame does
/// must not depend on the one before, or times of its repeats would tell of different work.
void VisiblePainter::place(const reflections::GpuObjects& objects) {
    const bool isFirst = hasMoved_.empty();
    hasMoved_.resize(objects.objectCount(), 0);
    placeChunks_.use(gl::Resources{
        {"Triangles", triangles_},
        {"Positions", objects.positions()},
        {"Corners", cornersWorld_},
        {"ChunkBoxes", chunkBoxes_},
        {"Chunks",
         chunks_}}.with(objects.resources()));
    for (std::uint32_t i = 0; i < objects.objectCount(); ++i) {
        if (objects.poses()[i] != restPoses_[i]) hasMoved_[i] = 1;
        if (!isFirst && hasMoved_[i] == 0) continue;
        const std::uint32_t first = levels_.firstChunkOfObject[i];
        const std::uint32_t count = levels_.firstChunkOfObject[i + 1] - first;
        if (count == 0) continue;
        placeChunks_.set("firstChunk", first);
        glDispatchCompute(count, 1, 1);
    }
}

gl::Resources VisiblePainter::resources(const reflections::GpuObjects& objects,
                                        const gl::Buffer& cameras) const {
    return gl::Resources{{"Cameras", cameras},           {"Places", places()},
                         {"Triangles", triangles_},      {"Corners", cornersWorld_},
                         {"Normals", objects.normals()}, {"Texcoords", objects.texcoords()},
                         {"Colors", objects.colors()}}
        .with(objects.resources());
}

void VisiblePainter::draw(const reflections::GpuObjects& objects, const gl::Buffer& cameras,
                          const Clusters& clusters, ClusterImages& target) {
    place(objects);
    places_.place(cameras, clusters, settings_, target.sizePx());

    const gl::Resources placed = places_.resources(cameras, clusters);
    list_.set("partCount", static_cast<std::uint32_t>(levels_.parts.size()));
    list_.set("levelErrorPx", levelErrorPx_);
    list_.dispatchIndirect(places_.order(), offsetof(AtlasHeader, groups),
                           gl::Resources{{"Families", families_},
                                         {"Parts", parts_},
                                         {"Levels", levelRecords_},
                                         {"Chunks", chunks_},
                                         {"ChunkBoxes", chunkBoxes_},
                                         {"Corners", cornersWorld_},
                                         {"Visible", visible_},
                                         {"VisibleCorners", visibleCorners_}}
                               .with(objects.resources())
                               .with(placed));
    split_.dispatch({1, 1, 1}, gl::Resources{{"Commands", commands_}}.with(placed));

    visibleCorners_.awaitPasses(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    const gl::Resources drawn{{"Visible", visible_}, {"Cameras", cameras}, {"Places", places()}};
    drawInPlaces(target, draw_, drawn, vertexArray_, commands_, [&] {
        glMultiDrawArraysIndirect(GL_TRIANGLES, nullptr, static_cast<GLsizei>(draws_),
                                  sizeof(DrawCommand));
    });
}

std::size_t VisiblePainter::sizeBytes() const {
    std::size_t sum = places_.sizeBytes();
    for (const gl::Buffer* buffer :
         {&families_, &parts_, &levelRecords_, &chunks_, &chunkBoxes_, &triangles_, &cornersWorld_,
          &commands_, &visible_, &visibleCorners_}) {
        sum += buffer->sizeBytes();
    }
    return sum;
}

}  // namespace gfxrepro::clustered_reflections
