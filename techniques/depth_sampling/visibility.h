// Visibility redundancy on the CPU: [xie2017] Algorithm 1 with the test of Algorithm 2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/raycast/ray_tracer.h"
#include "techniques/kit/view.h"

namespace gfxrepro::depth_sampling {

/// A point of the scene on a known triangle.
struct SurfacePoint {
    glm::vec3 positionWorld{0.0F};
    std::uint32_t triangleId = 0;  // as in depth images: 1 + index into the flattened scene
};

/// What a non-redundant image is tested against.
enum class Earlier {
    Views,    // what is visible from the earlier views: [xie2017] Algorithm 2 by the letter
    Samples,  // what the earlier images hold, with what they uncovered
};

bool isSameView(const kit::View& a, const kit::View& b);

/// Which points of the scene images with infinitely many pixels hold; their resolution does not
/// count. What is outside of an image's frustum, before its near plane or beyond its far plane is
/// not held, and back faces neither hide nor are held (raycast::Faces::Drawn).
///
/// A sequence of views stands for a sequence of images. Conventional: image j holds what is visible
/// from Vⱼ. Non-redundant: image j holds, on each ray from Vⱼ, the first point that no earlier
/// image of the sequence holds or, by Earlier::Views, that is not visible from an earlier view.
/// Peeled layers are the same with one view repeated, always against what the layers before hold.
///
/// All queries may run on several threads at once.
class VisibilitySequence {
  public:
    /// `tracer` is of the scene whose flattened triangles carry the ids; it must outlive this.
    VisibilitySequence(const raycast::RayTracer& tracer, std::vector<kit::View> views,
                       bool isNonRedundant, Earlier earlier = Earlier::Samples);

    const std::vector<kit::View>& views() const { return views_; }

    /// Whether image `index` holds the point.
    bool holds(std::size_t index, const SurfacePoint& point) const;
    /// Whether one of images [0, count) does.
    bool anyHolds(std::size_t count, const SurfacePoint& point) const;

    /// Whether the point is redundant with images [0, count) as image `count` is made.
    bool isRedundant(std::size_t count, const SurfacePoint& point) const;

    /// An image from whose view the point is visible; image `first` is tried first (with many
    /// images a caller saves time with the answer for a point nearby; whether there is one does not
    /// depend on it).
    std::optional<std::size_t> visibleFrom(const SurfacePoint& point, std::size_t first = 0) const;

    /// The image's sample in the direction of a pixel's centre: what Algorithm 1 leaves there.
    std::optional<SurfacePoint> sample(std::size_t index, glm::ivec2 pixel) const;

  private:
    /// From an image's near plane to a little before a point.
    struct Sight;
    std::optional<Sight> sightOf(std::size_t index, const SurfacePoint& point) const;
    bool isVisible(std::size_t index, const SurfacePoint& point) const;
    bool isReached(std::size_t index, const SurfacePoint& point) const;
    bool isLastOfItsView(std::size_t index, std::size_t count) const {
        return nextOfView_[index] >= count;
    }

    const raycast::RayTracer* tracer_;
    std::vector<kit::View> views_;
    std::vector<std::size_t> nextOfView_;  // the next image of the same view, or views_.size()
    bool isNonRedundant_;
    Earlier earlier_;
    bool isPeeling_;  // all images have one view
};

}  // namespace gfxrepro::depth_sampling
