#include "techniques/clustered_reflections/cluster_atlas.h"

#include <algorithm>

#include "engine/core/error.h"

namespace gfxrepro::clustered_reflections {
namespace {

/// Pairs of an object and a cluster that sees it; 8 MiB. All pairs of 512 objects and as many
/// clusters as there may be; more of both is counted in AtlasState::leftOut.
constexpr std::size_t kMostInstances = std::size_t{1} << 21;

/// An instance is cluster << 20 | object.
constexpr std::uint32_t kMostObjects = 1U << 20;
static_assert(kMaxClusters <= 1 << 12);

/// As glMultiDrawElementsIndirect reads it.
struct ElementsCommand {
    std::uint32_t count = 0, instanceCount = 0, firstIndex = 0, baseVertex = 0, baseInstance = 0;
};

}  // namespace

AtlasPainter::AtlasPainter(const gl::ShaderLibrary& shaders,
                           const reflections::ReflectiveScene& scene,
                           const reflections::GpuObjects& objects, const CameraSettings& settings)
    : settings_(settings), families_(gl::Buffer::of(reflectorFamilies(scene))), places_(shaders) {
    GFXREPRO_ASSERT(objects.objectCount() < kMostObjects);
    gl::Defines defines = shadedImageDefines(scene);
    defines["ATLAS"] = 1;
    cull_ = gl::Pass(shaders, {"clustered_reflections/cull_objects.comp.glsl"}, defines);
    draw_ = gl::Pass(shaders,
                     {"clustered_reflections/cluster_image.vert.glsl",
                      "clustered_reflections/cluster_image.frag.glsl"},
                     defines);

    const std::uint32_t most = objects.mostTrianglesPerDraw();
    std::vector<ElementsCommand> commands;
    std::vector<glm::uvec2> pieces;  // an object's first command and how many
    for (const reflections::Object& object : scene.objects()) {
        const auto first = static_cast<std::uint32_t>(commands.size());
        for (std::uint32_t done = 0; done < object.triangleCount; done += most) {
            const std::uint32_t count = std::min(object.triangleCount - done, most);
            commands.push_back({3 * count, 0, 3 * (object.firstTriangle + done), 0, 0});
        }
        pieces.emplace_back(first, static_cast<std::uint32_t>(commands.size()) - first);
    }
    commandCount_ = static_cast<int>(commands.size());
    commands_ = gl::Buffer::of(commands);
    pieces_ = gl::Buffer::of(pieces);
    const std::size_t pairs = std::size_t{objects.objectCount()} * kMaxClusters;
    instances_ = gl::Buffer(std::min(pairs, kMostInstances) * sizeof(std::uint32_t));
    vertexArray_ = objects.makeVertexArray(instances_);
}

void AtlasPainter::draw(const reflections::GpuObjects& objects, const gl::Buffer& cameras,
                        const Clusters& clusters, ClusterImages& target) {
    places_.place(cameras, clusters, settings_, target.sizePx());
    cull_.dispatch({objects.objectCount(), 1, 1}, gl::Resources{{"Commands", commands_},
                                                                {"Pieces", pieces_},
                                                                {"Instances", instances_},
                                                                {"Families", families_}}
                                                      .with(objects.resources())
                                                      .with(places_.resources(cameras, clusters)));

    instances_.awaitPasses(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    const gl::Resources drawn = resources(cameras).with(objects.resources());
    drawInPlaces(target, draw_, drawn, vertexArray_, commands_, [&] {
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, commandCount_,
                                    sizeof(ElementsCommand));
    });
}

std::size_t AtlasPainter::sizeBytes() const {
    return places_.sizeBytes() + commands_.sizeBytes() + instances_.sizeBytes() +
           pieces_.sizeBytes() + families_.sizeBytes();
}

}  // namespace gfxrepro::clustered_reflections
