// Visibility redundancy on the CPU: [xie2017] Algorithm 1 with the test of Algorithm 2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/raycast/ray_tracer.h"
#include "engine/scene/scene.h"
#include "techniques/kit/depth_image.h"
#include "techniques/kit/view.h"

namespace gfxrepro::depth_sampling {

/// What is known of an image's samples ([xie2017] Sec. 2.3.2): bits, of a pixel without a sample
/// none.
enum Mark : std::uint32_t {
    kSample = 1,
    kRedundant = 2,   // with an earlier conventional image (measure 1)
    kOccluded = 4,    // in no conventional image that counts (measure 2)
    kUseful = 8,      // occluded, and needed by an output frame (measure 3)
    kAvailable = 16,  // of an output frame: in at least one reference image (measure 4)
};

/// Counts of samples of one reference image ([xie2017] Sec. 2.3.2). Plain counts; shares are the
/// caller's.
struct ImageCounts {
    std::uint64_t samples = 0;
    std::uint64_t redundant = 0;  // held by an earlier image of its own sequence (measure 1)
    std::uint64_t occluded = 0;   // held by no conventional image that counts (measure 2)
    std::uint64_t useful = 0;     // occluded, and needed by an output frame (measure 3)

    bool operator==(const ImageCounts&) const = default;
};

/// Of an output frame's samples, how many there are and how many at least one image has (measure
/// 4).
struct FrameCounts {
    std::uint64_t samples = 0;
    std::uint64_t available = 0;

    bool operator==(const FrameCounts&) const = default;
};

/// A point of the scene on a known triangle.
struct SurfacePoint {
    glm::vec3 positionWorld{0.0F};
    std::uint32_t triangleId = 0;  // as in depth images: 1 + index into the flattened scene
};

bool isSameView(const kit::View& a, const kit::View& b);

/// Which points of the scene images with infinitely many pixels hold; their resolution does not
/// count. What is outside of an image's frustum, before its near plane or beyond its far plane is
/// not held, and back faces neither hide nor are held (raycast::Faces::Drawn).
///
/// A sequence of views stands for a sequence of images. Conventional: image j holds what is visible
/// from Vⱼ. Non-redundant: image j holds, on each ray from Vⱼ, the first point that is visible from
/// no earlier view. Peeled layers are what one view repeated gives: layer j holds the points that
/// have j others before them.
///
/// All queries may run on several threads at once.
class VisibilitySequence {
  public:
    /// `tracer` is of the scene whose flattened triangles carry the ids; it must outlive this.
    VisibilitySequence(const raycast::RayTracer& tracer, std::vector<kit::View> views,
                       bool isNonRedundant);

    const std::vector<kit::View>& views() const { return views_; }

    /// Whether image `index` holds the point.
    bool holds(std::size_t index, const SurfacePoint& point) const;
    /// Whether one of images [0, count) does.
    bool anyHolds(std::size_t count, const SurfacePoint& point) const;

    /// Whether the point is redundant with images [0, count) as image `count` is made.
    bool isRedundant(std::size_t count, const SurfacePoint& point) const;

    /// A view from which the point is visible; view `first` is tried first (with many views a
    /// caller saves time with the answer for a point nearby; whether there is one does not depend
    /// on it).
    std::optional<std::size_t> visibleFrom(const SurfacePoint& point, std::size_t first = 0) const;

    /// The image's sample in the direction of a pixel's centre: what Algorithm 1 leaves there.
    std::optional<SurfacePoint> sample(std::size_t index, glm::ivec2 pixel) const;

  private:
    /// A point and its triangle, looked up once for all views.
    struct Target;
    Target targetOf(const SurfacePoint& point) const;
    /// From a view's near plane to a little before a point.
    struct Sight;
    std::optional<Sight> sightOf(std::size_t index, const Target& target) const;
    const std::vector<raycast::TriangleHit>& hitsBefore(const Sight& sight,
                                                        const SurfacePoint& point) const;
    bool isVisible(std::size_t index, const Target& target) const;
    bool isVisibleFromOneOf(std::size_t count, const SurfacePoint& point) const;
    bool isFirstNew(std::size_t index, const SurfacePoint& point) const;
    std::optional<std::size_t> layerOf(const SurfacePoint& point) const;

    const raycast::RayTracer* tracer_;
    std::vector<kit::View> views_;
    std::vector<glm::mat4> clipFromWorld_;  // of views_
    bool isNonRedundant_;
    bool isPeeling_;  // non-redundant, and all images have one view
};

// Depth images sampled by ray casting: the pictures of visibility redundancy.

/// What DepthImageRenderer shades with, on the CPU: interpolated normals (the triangle's where the
/// mesh has none) and the material's base colour times the vertex's. Textures are left out.
class SurfaceShading {
  public:
    explicit SurfaceShading(const scene::Scene& scene);

    /// Direct light that goes from the point towards the eye: the formula at kLightDirectionWorld.
    glm::vec3 radiance(const SurfacePoint& point, const glm::vec3& eyeWorld) const;

  private:
    std::vector<glm::vec3> positions_, normals_, colors_;  // normals: zero where there are none
    std::vector<glm::uvec3> triangles_;
    std::vector<bool> isDoubleSided_;  // by triangle
};

/// What an image of a sequence holds: sample() of each pixel, rows from the bottom; id 0 where
/// there is none.
struct ImageSamples {
    std::size_t index = 0;  // of the image
    std::vector<SurfacePoint> points;
};
ImageSamples samplesOf(const VisibilitySequence& sequence, std::size_t index);

/// `samples` as the image that `view` has of them.
kit::HostDepthImage rayCastImage(const kit::View& view, const ImageSamples& samples,
                                 const SurfaceShading& shading);

// The measures of [xie2017] Sec. 2.3.2 under the visibility definition, on the CPU.

/// Marks of the samples of an image of `sequence`, a pixel each, rows from the bottom. Occluded is
/// what the first `conventionalCount` images of `conventional` lack; the output frames are those of
/// `outputs` (both are conventional sequences; `outputs` may be empty). Measure 1 is the
/// conventional sequence measured against itself; of a non-redundant or peeled sequence no sample
/// is redundant.
std::vector<std::uint32_t> markedSamples(const VisibilitySequence& sequence,
                                         const ImageSamples& samples,
                                         const VisibilitySequence& conventional,
                                         std::size_t conventionalCount,
                                         const VisibilitySequence& outputs);
ImageCounts countsOf(std::span<const std::uint32_t> marks);

/// For every image of `outputs` (a conventional sequence: the output frames).
std::vector<FrameCounts> countAvailable(const VisibilitySequence& sequence,
                                        const VisibilitySequence& outputs);

}  // namespace gfxrepro::depth_sampling
