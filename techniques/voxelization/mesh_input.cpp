#include "techniques/voxelization/mesh_input.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::voxelization {
namespace {

bool isPlain(const scene::Scene& scene) {
    return scene.instances.size() == 1 && scene.instances[0].worldFromMesh == glm::mat4(1.0F);
}

}  // namespace

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

MeshInput::MeshInput(const scene::Scene& scene) {
    if (isPlain(scene)) {
        original_ = &scene.meshes[static_cast<std::size_t>(scene.instances[0].mesh)];
    } else {
        copy_ = scene::flattened(scene);
    }
}

LatticeMesh snapped(const scene::Mesh& mesh, const scene::Box& box, const GridShape& shape) {
    const glm::dvec3 origin(box.min);
    const int axis = shape.longestAxis();
    const double unitsPerMetre = static_cast<double>(shape.longest()) * kLatticePerVoxel /
                                 (glm::dvec3(box.max) - origin)[axis];
    const double limit = static_cast<double>(kMaxExtentVoxels) * kLatticePerVoxel;
    LatticeMesh result{.positions = {}, .triangles = mesh.triangles};
    result.positions.reserve(mesh.positions.size());
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec3 p = glm::floor((glm::dvec3(position) - origin) * unitsPerMetre + 0.5);
        const double farthest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        if (!(farthest <= limit)) {
            throw Error(fmt::format(
                "vertex {} lies {:.0f} voxels from the grid's corner; the exact rules allow {}",
                result.positions.size(), farthest / kLatticePerVoxel, kMaxExtentVoxels));
        }
        result.positions.emplace_back(p);
    }
    return result;
}

glm::vec3 clipFromWorldScale(const scene::Box& box, const GridShape& shape) {
    const auto n = static_cast<float>(shape.longest());
    return 2.0F / box.size()[shape.longestAxis()] * (n / glm::vec3(shape.size));
}

bool isWide(const scene::Mesh& mesh, const scene::Box& box, const GridShape& shape) {
    const glm::vec3 size = mesh.bounds().size();
    const float voxels = static_cast<float>(shape.longest()) / box.size()[shape.longestAxis()];
    const float margin = 1.0F;  // corners are rounded to the lattice
    return voxels * std::max({size.x, size.y, size.z}) + margin > kIntegerExtentVoxels;
}

namespace {

constexpr std::size_t kTrianglesPerChunk = 1 << 15;

/// A run of triangles: the axis of each, and how many there are of each axis.
struct Chunk {
    std::array<std::size_t, 3> counts{};
    std::array<std::uint8_t, kTrianglesPerChunk> axes;
};

}  // namespace

Axis dominantAxis(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 area = glm::abs(glm::cross(b - a, c - a));
    if (area.z >= area.x && area.z >= area.y) return Axis::Z;
    return area.y >= area.x ? Axis::Y : Axis::X;
}

void splitByAxis(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 AxisSplit& split) {
    std::vector<Chunk> chunks((triangles.size() + kTrianglesPerChunk - 1) / kTrianglesPerChunk);
    const auto trianglesOf = [&](std::size_t chunk) {
        const std::size_t first = chunk * kTrianglesPerChunk;
        return triangles.subspan(first, std::min(kTrianglesPerChunk, triangles.size() - first));
    };
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Chunk& chunk = chunks[c];
        std::size_t i = 0;
        for (const glm::uvec3& t : trianglesOf(c)) {
            const Axis axis = dominantAxis(positions[t.x], positions[t.y], positions[t.z]);
            chunk.axes[i++] = static_cast<std::uint8_t>(axis);
            ++chunk.counts[static_cast<std::size_t>(axis)];
        }
    });

    // Turn the counts into the place of each chunk's first triangle of an axis.
    std::size_t next = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = next;
        for (Chunk& chunk : chunks) next += std::exchange(chunk.counts[axis], next);
        split.ranges[axis] = {static_cast<int>(first), static_cast<int>(next - first)};
    }

    split.triangles.resize(triangles.size());
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Chunk& chunk = chunks[c];
        std::size_t i = 0;
        for (const glm::uvec3& t : trianglesOf(c)) {
            split.triangles[chunk.counts[chunk.axes[i++]]++] = t;
        }
    });
}

namespace {

void checkFits(const char* what, std::size_t sizeBytes, const gl::DeviceLimits& limits) {
    if (static_cast<long long>(sizeBytes) > limits.maxStorageBlockBytes) {
        throw UnsupportedError(
            fmt::format("the mesh's {} take {} bytes; the device's storage "
                        "blocks hold {}",
                        what, sizeBytes, limits.maxStorageBlockBytes));
    }
}

gl::Buffer attributesOf(const MeshRequest& request) {
    if (request.settings.grid.value == VoxelValue::Occupancy) return gl::Buffer(1);
    if (!request.mesh.normals.empty()) return gl::Buffer::of(request.mesh.normals);
    return gl::Buffer::of(scene::vertexNormals(request.mesh));
}

}  // namespace

DeviceMesh::DeviceMesh(const MeshRequest& request, const AxisSplit& split,
                       const gl::DeviceLimits& limits)
    : attributes(attributesOf(request)),
      triangles(gl::Buffer::of(split.triangles)),
      ranges(split.ranges) {
    if (request.isExact()) {
        checkFits("positions", request.mesh.positions.size() * sizeof(glm::ivec3), limits);
        checkFits("triangles", request.mesh.triangles.size() * sizeof(glm::uvec3), limits);
        const GridShape& shape = request.layout().shape();
        positions = gl::Buffer::of(snapped(request.mesh, request.box, shape).positions);
        return;
    }
    positions = gl::Buffer::of(request.mesh.positions);
    vertexArray.setAttribute(gpu_scene::kPosition, positions, 3);
    if (request.hasValues()) vertexArray.setAttribute(gpu_scene::kNormal, attributes, 3);
    vertexArray.setIndices(triangles);
}

void DeviceMesh::update(const AxisSplit& split) {
    triangles.write(std::span<const glm::uvec3>(split.triangles));
    ranges = split.ranges;
}

gl::Resources DeviceMesh::resources() const {
    return {{"Positions", positions}, {"Attributes", attributes}, {"Triangles", triangles}};
}

void DeviceMesh::drawIndexed(TriangleRange range) const {
    vertexArray.bind();
    kit::FlushedDraws().draw(static_cast<std::uint32_t>(range.first),
                             static_cast<std::uint32_t>(range.count), kit::drawTriangles);
}

std::size_t DeviceMesh::sizeBytes() const {
    return positions.sizeBytes() + attributes.sizeBytes() + triangles.sizeBytes();
}

namespace {

gl::Defines drawDefines(const MeshRequest& request, DrawTarget target) {
    gl::Defines defines = request.layout().defines();
    defines.merge(gpu_scene::attributeDefines());
    defines["VALUE"] = static_cast<int>(request.settings.grid.value);
    defines["RECORD_WORDS"] = request.hasValues() ? 2 : 1;
    if (target != DrawTarget::FragmentList) {
        defines["EMIT_INTO_GRID"] = 1;
        defines[request.hasValues() ? "ACCUMULATE_MAX" : "ACCUMULATE_OR"] = 1;
    }
    if (target == DrawTarget::GridSlice) defines["SLICED"] = 1;
    return defines;
}

}  // namespace

MeshDraw::MeshDraw(const gl::ShaderLibrary& shaders, const MeshRequest& request, DrawTarget target)
    : pass_(shaders, {"voxelization/rasterized.vert.glsl", "voxelization/rasterized.frag.glsl"},
            drawDefines(request, target)),
      framebuffer_(
          gl::Framebuffer::withoutAttachments(glm::ivec2(request.layout().shape().longest()))),
      shape_(request.layout().shape()),
      boxCentreWorld_(request.box.centre()),
      clipFromWorldScale_(clipFromWorldScale(request.box, shape_)),
      drawsAllAxes_(request.isSolid()) {}

void MeshDraw::draw(const DeviceMesh& mesh, Axis axis) const {
    framebuffer_.bind();  // one for all: another would end what was drawn
    const glm::ivec3 size = localFromVolume(axis, shape_.size);
    glViewport(0, 0, size.x, size.y);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    pass_.set("axis", static_cast<int>(axis));
    pass_.set("boxCentreWorld", boxCentreWorld_);
    pass_.set("clipFromWorldScale", clipFromWorldScale_);
    mesh.drawIndexed(drawsAllAxes_ ? mesh.allTriangles()
                                   : mesh.ranges[static_cast<std::size_t>(axis)]);
}

}  // namespace gfxrepro::voxelization
