#include "techniques/soft_shadows/shadow_casters.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "techniques/kit/draws.h"

namespace gfxrepro::soft_shadows {
namespace {

enum VertexLocation : GLuint { kHalfPxLocation = 0, kDepthLocation = 1 };

gl::Program castProgram(const gl::ShaderLibrary& shaders) {
    return {shaders, {"soft_shadows/cast_mesh.vert.glsl"}, gpu_scene::attributeDefines()};
}

gl::Program castCornersProgram(const gl::ShaderLibrary& shaders) {
    return {shaders,
            {"soft_shadows/cast_corners.vert.glsl"},
            {{"HALF_PX_LOCATION", static_cast<int>(kHalfPxLocation)},
             {"DEPTH_LOCATION", static_cast<int>(kDepthLocation)}}};
}

gl::VertexArray cornerArray(const ReconstructedMesh& mesh) {
    gl::VertexArray array;
    const GLuint id = array.id();
    glVertexArrayVertexBuffer(id, 0, mesh.vertices.id(), 0, sizeof(CornerVertex));
    glVertexArrayAttribFormat(id, kHalfPxLocation, 2, GL_UNSIGNED_SHORT, GL_FALSE, 0);
    glVertexArrayAttribFormat(id, kDepthLocation, 1, GL_FLOAT, GL_FALSE,
                              offsetof(CornerVertex, depthM));
    for (const GLuint location : {kHalfPxLocation, kDepthLocation}) {
        glVertexArrayAttribBinding(id, location, 0);
        glEnableVertexArrayAttrib(id, location);
    }
    array.setIndices(mesh.indices);
    return array;
}

}  // namespace

SceneCaster::SceneCaster(const gl::ShaderLibrary& shaders, const kit::DrawableScene& scene)
    : scene_(scene), program_(castProgram(shaders)) {}

void SceneCaster::draw(const kit::View& lightView) const {
    program_.use();
    program_.set("clipFromWorld", lightView.clipFromWorld());
    scene_.drawDepthOnly();
}

ReconstructedCaster::ReconstructedCaster(const gl::ShaderLibrary& shaders,
                                         std::vector<ReconstructedMesh> meshes)
    : meshes_(std::move(meshes)), program_(castCornersProgram(shaders)) {
    for (const ReconstructedMesh& mesh : meshes_) vertexArrays_.push_back(cornerArray(mesh));
}

void ReconstructedCaster::draw(const kit::View& lightView) const {
    glDisable(GL_CULL_FACE);  // a light may see a quad from behind
    program_.use();
    const glm::dmat4 clipFromWorld =
        glm::dmat4(lightView.clipFromView) * glm::dmat4(lightView.viewFromWorld);
    kit::FlushedDraws draws;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        const ReconstructedMesh& mesh = meshes_[i];
        program_.set("clipFromCorner",
                     glm::mat4(clipFromWorld * glm::dmat4(worldFromCorner(mesh.view))));
        vertexArrays_[i].bind();
        draws.draw(0, mesh.triangleCount, kit::drawTriangles);
    }
}

std::uint64_t ReconstructedCaster::triangleCount() const {
    std::uint64_t count = 0;
    for (const ReconstructedMesh& mesh : meshes_) count += mesh.triangleCount;
    return count;
}

MeshCaster::MeshCaster(const gl::ShaderLibrary& shaders, const scene::Mesh& mesh)
    : mesh_(mesh), program_(castProgram(shaders)) {}

void MeshCaster::draw(const kit::View& lightView) const {
    glDisable(GL_CULL_FACE);
    program_.use();
    program_.set("clipFromWorld", lightView.clipFromWorld());
    mesh_.vertexArray.bind();
    kit::FlushedDraws().draw(0, static_cast<std::uint32_t>(mesh_.triangleCount),
                             kit::drawTriangles);
}

SimplifiedMesh simplified(const scene::Mesh& mesh, const SimplificationSettings& settings) {
    SimplifiedMesh result;
    result.mesh.name = mesh.name;
    result.mesh.material = mesh.material;
    if (mesh.triangles.empty()) return result;

    static_assert(sizeof(glm::uvec3) == 3 * sizeof(unsigned) &&
                  sizeof(glm::vec3) == 3 * sizeof(float));
    const std::size_t indexCount = 3 * mesh.triangles.size();
    const std::size_t vertexCount = mesh.positions.size();
    const unsigned* indices = &mesh.triangles.front().x;
    const float* positions = &mesh.positions.front().x;

    const auto wantedTriangles = static_cast<std::size_t>(std::ceil(
        static_cast<double>(settings.triangleRatio) * static_cast<double>(mesh.triangles.size())));
    const float metresPerUnit = meshopt_simplifyScale(positions, vertexCount, sizeof(glm::vec3));
    result.mesh.triangles.resize(mesh.triangles.size());
    unsigned* out = &result.mesh.triangles.front().x;
    const std::size_t written = meshopt_simplify(
        out, indices, indexCount, positions, vertexCount, sizeof(glm::vec3),
        std::min(3 * wantedTriangles, indexCount), settings.maxErrorM / metresPerUnit,
        meshopt_SimplifyLockBorder, &result.errorM);
    result.errorM *= metresPerUnit;
    result.mesh.triangles.resize(written / 3);

    result.mesh.positions.resize(vertexCount);
    result.mesh.positions.resize(meshopt_optimizeVertexFetch(
        result.mesh.positions.data(), out, written, positions, vertexCount, sizeof(glm::vec3)));
    return result;
}

}  // namespace gfxrepro::soft_shadows
