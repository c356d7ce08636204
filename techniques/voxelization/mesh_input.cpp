#include "techniques/voxelization/mesh_input.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"

namespace gfxrepro::voxelization {
namespace {

bool isPlain(const scene::Scene& scene) {
    return scene.instances.size() == 1 && scene.instances[0].worldFromMesh == glm::mat4(1.0F);
}

/// The scene with a colour at every vertex.
scene::Scene coloured(scene::Scene scene) {
    for (scene::Mesh& mesh : scene.meshes) {
        if (!mesh.colors.empty()) continue;
        mesh.colors.assign(mesh.positions.size(), glm::vec3(materialOf(scene, mesh).baseColor));
    }
    return scene;
}

}  // namespace

scene::Box cubicBox(const scene::Box& bounds, int resolution, int paddingVoxels) {
    const glm::vec3 size = bounds.size();
    const float longest = std::max({size.x, size.y, size.z});
    const float half = 0.5F * longest * static_cast<float>(resolution) /
                       static_cast<float>(resolution - 2 * paddingVoxels);
    return {bounds.centre() - half, bounds.centre() + half};
}

void requireVoxelizable(const scene::Scene& scene) {
    const auto refuse = [&](const std::string& found) {
        const std::string& from = scene.origin.description;
        throw Error(fmt::format(
            "scene '{}'{} has {}; allowed to voxelize: triangles that reach from one point to "
            "another",
            scene.name, from.empty() || from == scene.name ? "" : " (" + from + ")", found));
    };
    if (scene.triangleCount() == 0) {
        const std::size_t points = scene.points.positions.size();
        refuse(points == 0 ? "no triangles" : fmt::format("no triangles, but {} points", points));
    }
    scene::Box corners;  // of the triangles: points are not voxelized
    for (const scene::Instance& instance : scene.instances) {
        const scene::Box box = scene.meshes[static_cast<std::size_t>(instance.mesh)].bounds();
        for (const glm::vec3& corner : {box.min, box.max}) {
            corners.add(glm::vec3(instance.worldFromMesh * glm::vec4(corner, 1.0F)));
        }
    }
    if (corners.size() == glm::vec3(0.0F)) {
        refuse(fmt::format("all its {} vertices at one point", scene.vertexCount()));
    }
}

MeshInput::MeshInput(const scene::Scene& scene, VoxelValue value) {
    const bool needsColors = value == VoxelValue::Color;
    if (isPlain(scene))
        original_ = &scene.meshes[static_cast<std::size_t>(scene.instances[0].mesh)];
    if (!original_ || (needsColors && original_->colors.empty())) {
        original_ = nullptr;
        copy_ = scene::flattened(needsColors ? coloured(scene) : scene);
    }
}

}  // namespace gfxrepro::voxelization
