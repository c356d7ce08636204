#include "techniques/soft_shadows/simplified.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

namespace gfxrepro::soft_shadows {

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
