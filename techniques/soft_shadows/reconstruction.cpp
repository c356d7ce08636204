#include "techniques/soft_shadows/reconstruction.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::soft_shadows {
namespace {

constexpr int kGroupWidth = 32;
constexpr int kGroupHeight = 4;
constexpr int kCountGroupSize = 64;
/// Corners that one invocation counts in sequence; short enough for some 10⁴ invocations in a
/// megapixel, long enough that the scan over the runs costs little.
constexpr int kRunLength = 32;
static_assert(4 * kRunLength < 1 << 16, "places of vertices take 16 bits");

/// Half pixels are stored in 16 bits.
constexpr int kMaxSizePx = ((1 << 16) - 1) / 2;

gl::Defines passDefines(const ReconstructionSettings& settings) {
    return {{"MERGE_ROWS", settings.mergesRows ? 1 : 0},
            {"GROUP_WIDTH", kGroupWidth},
            {"GROUP_HEIGHT", kGroupHeight},
            {"COUNT_GROUP_SIZE", kCountGroupSize},
            {"RUN_LENGTH", kRunLength}};
}

gl::Pass pass(const gl::ShaderLibrary& shaders, const char* name,
              const ReconstructionSettings& settings) {
    const char* suffix = settings.method == Reconstruction::Hybrid ? "hybrid" : "classic";
    return {shaders,
            {fmt::format("soft_shadows/{}_{}.comp.glsl", name, suffix)},
            passDefines(settings)};
}

glm::uvec3 groupsOverCorners(glm::ivec2 cornersSize) {
    return {kit::groupsFor(cornersSize.x, kGroupWidth), kit::groupsFor(cornersSize.y, kGroupHeight),
            1};
}

/// H's pixel (x, y) must lie on the lower left corner of I's. 0.01: a hundredth of a pixel, far
/// above rounding and far below the half pixel that is asked for.
bool isHalfPixelToLowerLeft(const kit::View& offset, const kit::View& view) {
    if (offset.sizePx != view.sizePx || offset.viewFromWorld != view.viewFromWorld) return false;
    const glm::vec2 shift = glm::vec2(offset.clipFromView[2]) - glm::vec2(view.clipFromView[2]);
    const glm::vec2 shiftPx = 0.5F * shift * glm::vec2(view.sizePx);
    return glm::all(glm::lessThan(glm::abs(shiftPx + 0.5F), glm::vec2(0.01F)));
}

}  // namespace

std::size_t ReconstructedMesh::sizeBytes() const {
    return vertices.sizeBytes() + indices.sizeBytes();
}

glm::mat4 worldFromCorner(const kit::View& view) {
    glm::mat4 matrix = worldFromPixels(view);
    matrix[0] *= 0.5F;
    matrix[1] *= 0.5F;
    return matrix;
}

Reconstructor::Reconstructor(const gl::ShaderLibrary& shaders,
                             const ReconstructionSettings& settings)
    : settings_(settings),
      classify_(pass(shaders, "classify", settings)),
      count_(pass(shaders, "count", settings)),
      scan_(shaders, "uvec4", kit::PrefixSum::Total::Behind),
      emit_(pass(shaders, "emit", settings)) {}

void Reconstructor::resizeScratch(glm::ivec2 imageSizePx) {
    if (cornersSize_ == imageSizePx + 1) return;
    cornersSize_ = imageSizePx + 1;
    runsPerRow_ = (cornersSize_.x + kRunLength - 1) / kRunLength;
    flags_ = gl::Texture::make2D(GL_R16UI, cornersSize_);
    places_ = gl::Texture::make2D(GL_R32UI, cornersSize_);
    const auto runs = static_cast<std::size_t>(runsPerRow_ * cornersSize_.y);
    runs_ = gl::Buffer((runs + 1) * sizeof(glm::uvec4));
}

void Reconstructor::setGeometry(const gl::Program& program, const kit::View& view) const {
    const glm::mat4 rays = worldFromPixels(view);  // of depth 1
    program.setIfActive("imageSizePx", view.sizePx);
    program.setIfActive("rayOrigin", glm::vec3(rays[2]));
    program.setIfActive("rayStepX", glm::vec3(rays[0]));
    program.setIfActive("rayStepY", glm::vec3(rays[1]));
    program.setIfActive("footprintPerDepth", kit::footprintPerDepth(view));
    program.setIfActive("grazingLimitPx", settings_.grazingLimitPx);
    program.setIfActive("discontinuityPx", settings_.discontinuityPx);
    program.setIfActive("runsPerRow", runsPerRow_);
}

glm::uvec4 Reconstructor::countElements(const kit::View& view, const gl::Resources& images) {
    setGeometry(classify_, view);
    classify_.dispatch(groupsOverCorners(cornersSize_), images);

    const int runCount = runsPerRow_ * cornersSize_.y;
    setGeometry(count_, view);
    count_.dispatch({kit::groupsFor(runCount, kCountGroupSize), 1, 1}, images);

    scan_.run(runs_, static_cast<unsigned>(runCount));
    const std::size_t totalsAt = static_cast<std::size_t>(runCount) * sizeof(glm::uvec4);
    return runs_.read<glm::uvec4>(1, totalsAt).front();
}

void Reconstructor::emit(const ReconstructedMesh& mesh, const gl::Resources& images) {
    setGeometry(emit_, mesh.view);
    emit_.dispatch(
        groupsOverCorners(cornersSize_),
        gl::Resources{{"Vertices", mesh.vertices}, {"Indices", mesh.indices}}.with(images));
    mesh.vertices.awaitPasses(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    mesh.indices.awaitPasses(GL_ELEMENT_ARRAY_BARRIER_BIT);
}

ReconstructedMesh Reconstructor::reconstruct(const kit::DepthImage& image,
                                             const kit::DepthImage* offsetImage,
                                             const gl::Buffer& triangleNormals) {
    const kit::View& view = image.view;
    if (std::max(view.sizePx.x, view.sizePx.y) > kMaxSizePx) {
        throw UnsupportedError(
            fmt::format("a depth image of {} × {} pixels cannot be made a mesh; at most {} a side",
                        view.sizePx.x, view.sizePx.y, kMaxSizePx));
    }
    resizeScratch(view.sizePx);
    gl::Resources images = gl::Resources{}.with({{"depthOfI", image.depth},
                                                 {"idOfI", image.triangleId},
                                                 {"Normals", triangleNormals},
                                                 {"flags", flags_},
                                                 {"places", places_},
                                                 {"Runs", runs_}});
    if (settings_.method == Reconstruction::Hybrid) {
        GFXREPRO_ASSERT(offsetImage != nullptr && isHalfPixelToLowerLeft(offsetImage->view, view));
        images =
            images.with({{"depthOfH", offsetImage->depth}, {"idOfH", offsetImage->triangleId}});
    }

    const glm::uvec4 totals = countElements(view, images);
    ReconstructedMesh mesh;
    mesh.view = view;
    mesh.vertexCount = totals.x;
    mesh.triangleCount = totals.y;
    mesh.sampleCount = totals.z;
    mesh.vertices = gl::Buffer(mesh.vertexCount * sizeof(CornerVertex));
    mesh.indices = gl::Buffer(mesh.triangleCount * sizeof(glm::uvec3));
    if (mesh.triangleCount > 0) emit(mesh, images);
    return mesh;
}

gl::Buffer triangleNormals(const scene::Mesh& flattened, const gl::DeviceLimits& limits) {
    const std::size_t bytes = flattened.triangles.size() * sizeof(glm::vec4);
    if (static_cast<long long>(bytes) > limits.maxStorageBlockBytes) {
        throw UnsupportedError(
            fmt::format("the normals of {} triangles take {} bytes; the device's storage blocks "
                        "hold {}",
                        flattened.triangles.size(), bytes, limits.maxStorageBlockBytes));
    }
    std::vector<glm::vec4> normals;
    normals.reserve(flattened.triangles.size());
    for (const glm::uvec3& t : flattened.triangles) {
        // In double: the cross product of a small triangle's edges would lose digits, or all.
        const glm::dvec3 a(flattened.positions[t.x]);
        const glm::dvec3 cross = glm::cross(glm::dvec3(flattened.positions[t.y]) - a,
                                            glm::dvec3(flattened.positions[t.z]) - a);
        const double length = glm::length(cross);
        normals.emplace_back(length > 0.0 ? glm::vec3(cross / length) : glm::vec3(0.0F), 0.0F);
    }
    return gl::Buffer::of(normals);
}

scene::Mesh toWorldMesh(const ReconstructedMesh& mesh) {
    const glm::dmat4 toWorld(worldFromCorner(mesh.view));
    scene::Mesh world;
    world.name = "reconstruction";
    world.positions.reserve(mesh.vertexCount);
    for (const CornerVertex& v : mesh.vertices.read<CornerVertex>(mesh.vertexCount)) {
        const double depth = v.depthM;
        const glm::dvec4 corner(v.xHalfPx * depth, v.yHalfPx * depth, depth, 1.0);
        world.positions.emplace_back(toWorld * corner);
    }
    world.triangles = mesh.indices.read<glm::uvec3>(mesh.triangleCount);
    return world;
}

}  // namespace gfxrepro::soft_shadows
