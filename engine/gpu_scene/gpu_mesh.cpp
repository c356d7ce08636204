#include "engine/gpu_scene/gpu_mesh.h"

#include "engine/core/error.h"

namespace gfxrepro::gpu_scene {

namespace {

/// Uploads an attribute, if the mesh has it, and enables it.
template <class T>
gl::Buffer upload(const std::vector<T>& values, Attribute location, gl::VertexArray& vertexArray) {
    if (values.empty()) return {};
    gl::Buffer buffer = gl::Buffer::of(values);
    vertexArray.setAttribute(location, buffer, T::length());
    return buffer;
}

}  // namespace

gl::Defines attributeDefines() {
    return {{"kPosition", static_cast<int>(kPosition)},
            {"kNormal", static_cast<int>(kNormal)},
            {"kTexcoord", static_cast<int>(kTexcoord)},
            {"kColor", static_cast<int>(kColor)}};
}

GpuMesh::GpuMesh(const scene::Mesh& mesh)
    : positions(upload(mesh.positions, kPosition, vertexArray)),
      normals(upload(mesh.normals, kNormal, vertexArray)),
      texcoords(upload(mesh.texcoords, kTexcoord, vertexArray)),
      colors(upload(mesh.colors, kColor, vertexArray)),
      indices(gl::Buffer::of(mesh.triangles)),
      triangleCount(static_cast<int>(mesh.triangles.size())) {
    static_assert(sizeof(glm::uvec3) == 3 * sizeof(GLuint));
    vertexArray.setIndices(indices);
}

void GpuMesh::draw(int first, int count) const {
    GFXREPRO_ASSERT(first >= 0 && count >= 0 && first <= triangleCount - count);
    if (count == 0) return;
    vertexArray.bind();
    const std::size_t offsetBytes = static_cast<std::size_t>(first) * sizeof(glm::uvec3);
    glDrawElements(GL_TRIANGLES, 3 * count, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(offsetBytes));
}

}  // namespace gfxrepro::gpu_scene
