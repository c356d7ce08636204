// [xie2017] Algorithm 3 replayed on the CPU in double precision, by brute force over all triangles.
#pragma once

#include <span>

#include "techniques/kit/depth_image.h"

namespace gfxrepro::kit {

/// What a pixel must hold, or that rounding decides it.
struct Verdict {
    bool isDecided = false;
    std::uint32_t triangleId = 0;
    double depthM = 0.0;
    double depthToleranceM = 0.0;
};

/// Culls, sorts and tests the triangles at a pixel's centre against the earlier images as they were
/// drawn. Rounding decides where
///   - the centre lies within 1/128 px of a triangle's edge (rasterizers snap vertices to 1/256
///   px),
///   - the reprojected point, moved by that much on the triangle and by 1e-3 px in the image, may
///     land in pixels that say differently,
///   - two triangles' depths, moved by that much, overlap.
class Replay {
  public:
    /// Triangles of scene::flattened(), all in front of the near planes.
    Replay(const scene::Mesh& mesh, const View& view);
    Verdict pixel(glm::ivec2 pixel, std::span<const HostDepthImage> earlier) const;

  private:
    struct Triangle {
        std::uint32_t id = 0;
        glm::dvec2 cornersPx[3];
        double depthsM[3] = {};
        glm::dvec3 cornersWorld[3];
    };
    struct Fragment;
    std::vector<Fragment> fragmentsAt(const glm::dvec2& centrePx) const;
    std::vector<Triangle> triangles_;
};

}  // namespace gfxrepro::kit
