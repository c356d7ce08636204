#include "techniques/depth_sampling/ray_cast_image.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "techniques/kit/depth_image_renderer.h"

namespace gfxrepro::depth_sampling {
namespace {

glm::vec3 unitOr(const glm::vec3& vector, const glm::vec3& otherwise) {
    const float length = glm::length(vector);
    return length > 0.0F ? vector / length : otherwise;
}

/// Weights of the corners at the point of the triangle's plane nearest to `point`.
glm::dvec3 barycentricAt(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         const glm::dvec3& point) {
    const glm::dvec3 twiceArea = glm::cross(b - a, c - a);
    const double squared = glm::dot(twiceArea, twiceArea);
    if (squared == 0.0) return {1.0, 0.0, 0.0};
    const double ofB = glm::dot(glm::cross(point - a, c - a), twiceArea) / squared;
    const double ofC = glm::dot(glm::cross(b - a, point - a), twiceArea) / squared;
    return {1.0 - ofB - ofC, ofB, ofC};
}

glm::u8vec4 quantized(const glm::vec3& radiance) {
    return {glm::u8vec3(glm::clamp(radiance, 0.0F, 1.0F) * 255.0F + 0.5F), 255};
}

}  // namespace

SurfaceShading::SurfaceShading(const scene::Scene& scene) {
    // Vertices in the order of flattened(), which drops attributes that not all meshes have.
    scene::Mesh mesh = flattened(scene);
    positions_ = std::move(mesh.positions);
    triangles_ = std::move(mesh.triangles);
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& part = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const scene::Material material = materialOf(scene, part);
        const glm::mat3 toWorld = scene::normalMatrix(glm::mat3(instance.worldFromMesh));
        for (std::size_t v = 0; v < part.positions.size(); ++v) {
            normals_.push_back(part.normals.empty() ? glm::vec3(0.0F) : toWorld * part.normals[v]);
            colors_.push_back(glm::vec3(material.baseColor) *
                              (part.colors.empty() ? glm::vec3(1.0F) : part.colors[v]));
        }
        isDoubleSided_.insert(isDoubleSided_.end(), part.triangles.size(), material.isDoubleSided);
    }
}

glm::vec3 SurfaceShading::radiance(const SurfacePoint& point, const glm::vec3& eyeWorld) const {
    const std::size_t number = point.triangleId - 1;
    const glm::uvec3 t = triangles_[number];
    const glm::dvec3 a(positions_[t.x]);
    const glm::dvec3 b(positions_[t.y]);
    const glm::dvec3 c(positions_[t.z]);
    const glm::vec3 weights(barycentricAt(a, b, c, glm::dvec3(point.positionWorld)));
    const auto interpolated = [&](const std::vector<glm::vec3>& values) {
        return weights.x * values[t.x] + weights.y * values[t.y] + weights.z * values[t.z];
    };
    const glm::vec3 ofTriangle = unitOr(glm::vec3(glm::cross(b - a, c - a)), glm::vec3(0.0F));
    glm::vec3 normal = unitOr(interpolated(normals_), ofTriangle);
    if (isDoubleSided_[number] && glm::dot(normal, eyeWorld - point.positionWorld) < 0.0F) {
        normal = -normal;
    }
    const float light = std::max(glm::dot(normal, kit::kLightDirectionWorld), 0.0F);
    return interpolated(colors_) * (0.3F + 0.7F * light);
}

kit::HostDepthImage rayCastImage(const VisibilitySequence& sequence, std::size_t index,
                                 const SurfaceShading& shading) {
    kit::HostDepthImage image;
    image.view = sequence.views()[index];
    const glm::ivec2 size = image.view.sizePx;
    const auto pixelCount = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    image.shading.assign(pixelCount, glm::u8vec4(0));
    image.depthM.assign(pixelCount, 0.0F);
    image.triangleId.assign(pixelCount, 0);
    tbb::parallel_for(tbb::blocked_range<int>(0, size.y), [&](const auto& rows) {
        for (int y = rows.begin(); y < rows.end(); ++y) {
            for (int x = 0; x < size.x; ++x) {
                const auto point = sequence.sample(index, {x, y});
                if (!point) continue;
                const std::size_t at = image.indexOf({x, y});
                image.shading[at] = quantized(shading.radiance(*point, image.view.eyeWorld));
                image.depthM[at] =
                    -(image.view.viewFromWorld * glm::vec4(point->positionWorld, 1.0F)).z;
                image.triangleId[at] = point->triangleId;
            }
        }
    });
    return image;
}

}  // namespace gfxrepro::depth_sampling
