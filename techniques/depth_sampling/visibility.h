// Visibility redundancy on the CPU: [xie2017] Algorithm 1 with the test of Algorithm 2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runner/raycast/ray_tracer.h"
#include "techniques/shared/depth_image.h"

namespace gfxrepro::depth_sampling {

/// A point of the scene on a known triangle.
struct SurfacePoint {
    glm::vec3 positionWorld;
    std::uint32_t triangleId;  // as in depth images
};

/// Which points of the scene images with infinitely many pixels hold; their resolution does not
/// count. Directions outside of an image's frustum count as not held.
///
/// A sequence of views stands for a sequence of images. Conventional: image j holds what is visible
/// from Vⱼ. Non-redundant: image j holds, on each ray from Vⱼ, the first point that no earlier
/// image of the sequence holds; peeled layers are the same with one view repeated.
class VisibilitySequence {
  public:
    /// `tracer` is of the scene whose flattened triangles carry the ids; both references must
    /// outlive this.
    VisibilitySequence(const raycast::RayTracer& tracer, std::vector<depth_images::View> views,
                       bool isNonRedundant);

    const std::vector<depth_images::View>& views() const { return views_; }

    /// Whether image `index` holds the point. May run on several threads at once.
    bool holds(std::size_t index, const SurfacePoint& point) const;
    /// Whether one of images [0, count) does.
    bool anyHolds(std::size_t count, const SurfacePoint& point) const;

    /// The image's sample in the direction of a pixel's centre: what Algorithm 1 leaves there.
    std::optional<SurfacePoint> sample(std::size_t index, glm::ivec2 pixel) const;

  private:
    const raycast::RayTracer* tracer_;
    std::vector<depth_images::View> views_;
    bool isNonRedundant_;
};

}  // namespace gfxrepro::depth_sampling
