#include "tests/techniques/soft_shadows/reference_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "engine/raycast/ray_tracer.h"
#include "tests/support/grid.h"
#include "tests/techniques/soft_shadows/reconstruction_fixture.h"

namespace gfxrepro::soft_shadows {

using kit::HostDepthImage;
using kit::View;

namespace {

bool isPixel(const View& view, glm::ivec2 p) {
    return p.x >= 0 && p.y >= 0 && p.x < view.sizePx.x && p.y < view.sizePx.y;
}

std::uint32_t idAt(const HostDepthImage& image, glm::ivec2 p) {
    return isPixel(image.view, p) ? image.triangleId[image.indexOf(p)] : 0;
}

glm::dvec3 forwardOf(const View& view) {
    return -glm::dvec3(view.viewFromWorld[0].z, view.viewFromWorld[1].z, view.viewFromWorld[2].z);
}

HostDepthImage traceImage(const raycast::RayTracer& tracer, const View& view) {
    HostDepthImage image = emptyImage(view);
    for (const auto [y, x] : test::grid(view.sizePx.y, view.sizePx.x)) {
        const glm::vec3 ray = rayThrough(view, glm::vec2(x, y) + 0.5F);
        const auto hit = tracer.closestHit(view.eyeWorld, ray);
        if (!hit) continue;
        const std::size_t at = image.indexOf({x, y});
        image.depthM[at] =
            hit->distance * static_cast<float>(glm::dot(glm::dvec3(ray), forwardOf(view)));
        image.triangleId[at] = hit->triangle + 1;
    }
    return image;
}

}  // namespace

HostDepthImage emptyImage(const View& view) {
    const auto pixels = static_cast<std::size_t>(view.sizePx.x * view.sizePx.y);
    return {view, std::vector<glm::u8vec4>(pixels), std::vector<float>(pixels),
            std::vector<std::uint32_t>(pixels)};
}

ImagePair emptyPair(glm::ivec2 sizePx) {
    return {emptyImage(viewOf(originCamera(), sizePx)),
            emptyImage(viewOf(originCamera(), sizePx, glm::vec2(-0.5F)))};
}

ImagePair traceImages(const scene::Mesh& mesh, const scene::Camera& camera, glm::ivec2 sizePx) {
    const raycast::RayTracer tracer(scene::sceneOf(mesh));
    return {traceImage(tracer, viewOf(camera, sizePx)),
            traceImage(tracer, viewOf(camera, sizePx, glm::vec2(-0.5F)))};
}

scene::Camera originCamera() {
    return scene::Camera{.verticalFovRad = 1.57079633F, .nearM = 0.1F, .farM = 100.0F};
}

namespace reference {

std::vector<glm::vec3> normalsOf(const scene::Mesh& mesh) {
    std::vector<glm::vec3> normals;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        normals.emplace_back(glm::normalize(glm::cross(b - a, c - a)));
    }
    return normals;
}

double footprintM(const View& view, double depthM) {
    const double tanHalfWidth = 1.0 / static_cast<double>(view.clipFromView[0].x);
    return 2.0 * tanHalfWidth * depthM / view.sizePx.x;
}

std::optional<double> depthOnPlane(const HostDepthImage& image, glm::ivec2 pixel,
                                   std::span<const glm::vec3> normals, glm::dvec2 positionPx) {
    const View& view = image.view;
    const glm::dvec3 eye(view.eyeWorld);
    const glm::dvec3 n(normals[idAt(image, pixel) - 1]);
    const glm::dvec3 point(image.pointWorld(pixel));
    // A point on the ray at a depth of 1.
    const glm::dvec3 ray = glm::dvec3(unproject(view, glm::vec2(positionPx), 1.0F)) - eye;
    const double depth = glm::dot(n, point - eye) / glm::dot(n, ray);
    if (!(depth > 0.0) || depth > 1e20) return std::nullopt;
    return depth;
}

std::vector<Quad> hybridQuads(const HostDepthImage& image, const HostDepthImage& offset,
                              std::span<const glm::vec3> normals,
                              const ReconstructionSettings& settings) {
    constexpr glm::ivec2 kCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    std::vector<Quad> quads;
    for (const auto [y, x] : test::grid(image.view.sizePx.y, image.view.sizePx.x)) {
        const glm::ivec2 pixel(x, y);
        const std::uint32_t id = idAt(image, pixel);
        if (id == 0) continue;
        const double sampleDepth = image.depthM[image.indexOf(pixel)];
        const double footprint = footprintM(image.view, sampleDepth);
        Quad quad{pixel, {}};
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::ivec2 position = pixel + kCorners[k];
            const auto plane = depthOnPlane(image, pixel, normals, position);
            const std::uint32_t sharedId = idAt(offset, position);
            if (sharedId != 0) {
                const double shared = offset.depthM[offset.indexOf(position)];
                if (sharedId == id ||
                    (plane && std::abs(shared - *plane) <= settings.discontinuityPx * footprint)) {
                    quad.corners[k] = {position, shared, true};
                    continue;
                }
            }
            const double reach = settings.grazingLimitPx * footprint;
            const double far = sampleDepth + reach;
            quad.corners[k] = {position, std::clamp(plane.value_or(far), sampleDepth - reach, far),
                               false};
        }
        quads.push_back(quad);
    }
    return quads;
}

bool areJoined(const HostDepthImage& image, glm::ivec2 a, glm::ivec2 b,
               std::span<const glm::vec3> normals, const ReconstructionSettings& settings) {
    const std::uint32_t idA = idAt(image, a), idB = idAt(image, b);
    if (idA == 0 || idB == 0) return false;
    if (idA == idB) return true;
    const auto isOnPlaneOf = [&](glm::ivec2 s, glm::ivec2 other) {
        const double footprint = footprintM(image.view, image.depthM[image.indexOf(s)]);
        const auto plane = depthOnPlane(image, s, normals, glm::dvec2(other) + 0.5);
        return plane && std::abs(image.depthM[image.indexOf(other)] - *plane) <=
                            settings.discontinuityPx * footprint;
    };
    return isOnPlaneOf(a, b) || isOnPlaneOf(b, a);
}

Shape shapeOf(std::span<const glm::uvec3> triangles, std::size_t vertexCount) {
    std::set<std::pair<unsigned, unsigned>> edges;
    std::vector<unsigned> parent(vertexCount);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](unsigned v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const glm::uvec3& t : triangles) {
        for (int i = 0; i < 3; ++i) {
            const unsigned a = t[i], b = t[(i + 1) % 3];
            edges.emplace(std::min(a, b), std::max(a, b));
            parent[root(a)] = root(b);
        }
    }
    Shape shape;
    for (unsigned v = 0; v < vertexCount; ++v) shape.parts += root(v) == v ? 1 : 0;
    shape.euler = static_cast<long>(vertexCount) - static_cast<long>(edges.size()) +
                  static_cast<long>(triangles.size());
    return shape;
}

}  // namespace reference
}  // namespace gfxrepro::soft_shadows
