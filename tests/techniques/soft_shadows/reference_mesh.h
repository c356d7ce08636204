// Reconstructions on the CPU, sample by sample and in world space, as the definitions read.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "techniques/kit/depth_image.h"
#include "techniques/soft_shadows/reconstruction.h"

namespace gfxrepro::soft_shadows::reference {

/// By triangle; unit.
std::vector<glm::vec3> normalsOf(const scene::Mesh& mesh);

/// Width of a pixel at a depth.
double footprintM(const kit::View& view, double depthM);

/// Where the ray through a position meets the plane of a pixel's sample; nothing where it does not.
std::optional<double> depthOnPlane(const kit::HostDepthImage& image, glm::ivec2 pixel,
                                   std::span<const glm::vec3> normals, glm::dvec2 positionPx);

struct Corner {
    glm::ivec2 positionPx{0};
    double depthM = 0.0;
    bool isShared = false;  // H's sample there
};
struct Quad {
    glm::ivec2 pixel{0};
    std::array<Corner, 4> corners;  // counter-clockwise from the lower left
};

/// [xie2017] Algorithm 4: a quad per sample, in row order.
std::vector<Quad> hybridQuads(const kit::HostDepthImage& image, const kit::HostDepthImage& offset,
                              std::span<const glm::vec3> normals,
                              const ReconstructionSettings& settings);

/// Whether no discontinuity lies between two samples of one image.
bool areJoined(const kit::HostDepthImage& image, glm::ivec2 a, glm::ivec2 b,
               std::span<const glm::vec3> normals, const ReconstructionSettings& settings);

/// Euler characteristic and the number of parts that hang together by vertices: equal for a mesh
/// that consists of discs.
struct Shape {
    long euler = 0;
    long parts = 0;
};
Shape shapeOf(std::span<const glm::uvec3> triangles, std::size_t vertexCount);

}  // namespace gfxrepro::soft_shadows::reference
