#include "techniques/voxelization/device_mesh.h"

#include <fmt/format.h>

#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"
#include "techniques/voxelization/lattice.h"

namespace gfxrepro::voxelization {
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
    if (request.settings.value == VoxelValue::Color) return gl::Buffer::of(request.mesh.colors);
    if (request.settings.value == VoxelValue::Occupancy) return gl::Buffer(1);
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
        const int resolution = request.settings.layout.resolution();
        positions = gl::Buffer::of(snapped(request.mesh, request.box, resolution).positions);
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

}  // namespace gfxrepro::voxelization
