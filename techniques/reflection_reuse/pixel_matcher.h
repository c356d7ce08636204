// [xie2017] Algorithm 9: where the reflection that a key-frame sample holds goes when the eye
// moves.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "techniques/reflection_reuse/reflection_depth_image.h"

namespace gfxrepro::reflection_reuse {

enum class Matching {
    FirstOrder,   // Algorithm 9: candidates are planes, a ring of 3×3 a step
    SecondOrder,  // Sec. 5.5.4, outlook: normals and positions vary between samples; the step's
                  // direction and length come from derivatives in screen space, the match lies
                  // between samples
};

struct MatchingSettings {
    Matching matching = Matching::FirstOrder;
    /// Departure [xie2017] Algorithm 9: a search that is longer is invalid, where the printed one
    /// has no end but the image's. No loop of the device is unbounded.
    int maxSteps = 256;
    /// Neighbours whose eye depths differ by more than this share of the nearer one lie on two
    /// sides of a reflector's silhouette.
    float silhouette = 0.05F;
    /// Where nothing next to it is better, a search looks at the wider square rings around, up to
    /// this; it finds its way along narrow valleys across the eight directions. 1: Algorithm 9.
    int widestRingPx = 1;
};

/// Offsets of Algorithm 9, a texel a sample of the key frame.
struct Offsets {
    gl::Texture offset;  // RG16F, pixels: s* − s; kInvalidOffset where there is no match
    gl::Texture steps;   // R8UI: steps that the search took, at most 255; 0: it ended at its start
    explicit Offsets(glm::ivec2 sizePx);
    std::size_t sizeBytes() const;
};
/// Both components of an invalid offset.
constexpr float kInvalidOffset = 65504.0F;  // the largest half

/// Over the reflective samples of a key frame.
struct MatchingCounts {
    std::uint32_t reflectiveSamples = 0;
    std::uint32_t invalidSamples = 0;
    std::uint32_t steps = 0;

    double meanSteps() const;
};

/// When is a match valid? A search moves between neighbours of one reflector that no silhouette
/// separates (MatchingSettings::silhouette), within the image. It ends at a sample that misses the
/// eye by less than its neighbours do. Where the true match lies beyond the last sample of the
/// surface, that sample still ends the search, but misses the eye by more than one step changes:
/// such ends are outside of the silhouette, and invalid. So are wrong local minima of that kind
/// within, ends at creases, and samples without a neighbour.
/// Departure [xie2017] Algorithm 9: it lets the search step onto other surfaces, where a plane that
/// has nothing to do with the reflection may draw it away, and asks at the end where it is.
class PixelMatcher {
  public:
    PixelMatcher(const gl::ShaderLibrary& shaders, const MatchingSettings& settings);
    /// For every reflective sample of `key`; the others become invalid. The search begins at the
    /// sample itself; with `previous` offsets, of the same key frame, where its own ended or else
    /// that of a near sample of the reflector, and without any of them there is none.
    /// Departure [xie2017] Algorithm 9: it begins again in the sample, and all that have left the
    /// reflector walk to its border again in each frame.
    void match(const ReflectionDepthImage& key, const glm::vec3& eyeWorld, const Offsets* previous,
               Offsets& result) const;
    /// Waits for the device.
    MatchingCounts counts(const ReflectionDepthImage& key, const Offsets& offsets) const;

  private:
    MatchingSettings settings_;
    gl::Pass pass_, countsPass_;
};

/// The reflection depth image on the host, for the reference and exhaustive searches.
struct HostReflectionDepthImage {
    reflections::HostGBuffer gbuffer;
    std::vector<float> distanceM;  // 0: the ray left the scene
    float diagonalM = 1.0F;

    /// R of Eq. 8: what a reflective sample shows.
    glm::vec3 reflectedPositionWorld(glm::ivec2 sample) const;
};
/// Reads back; waits for the device.
HostReflectionDepthImage readReflectionDepthImage(const ReflectionDepthImage& image);

/// d(s_n, R, E): how far the eye is from the ray from M, the mirror image of R in the plane of
/// candidate n, through W_n (Sec. 5.4.1). The normal may have any length.
/// Departure [xie2017] Sec. 5.4.1: the ray begins in W_n, where it leaves the mirror; to an eye
/// behind, W_n is the nearest. Begun in M, it also meets eyes between M and W_n, and candidates
/// that turn their backs to R match.
float matchingDistance(const glm::vec3& candidateWorld, const glm::vec3& candidateNormal,
                       const glm::vec3& reflectedWorld, const glm::vec3& eyeWorld);

struct HostMatch {
    std::optional<glm::vec2> offset;  // whole pixels in first order; nothing: invalid
    int steps = 0;
    float distance = 0.0F;      // of the last candidate
    glm::ivec2 end{0};          // the last candidate
    std::vector<float> passed;  // distances of all candidates that the search stood on
};
/// Algorithm 9 for one sample, line by line; the search stops on equality, too, where the printed
/// one can cycle.
HostMatch matchOnHost(const HostReflectionDepthImage& key, glm::ivec2 sample,
                      const glm::vec3& eyeWorld, std::optional<glm::vec2> previous,
                      const MatchingSettings& settings);
/// The best candidate of all samples of the same reflector: what a search should have found.
HostMatch matchExhaustively(const HostReflectionDepthImage& key, glm::ivec2 sample,
                            const glm::vec3& eyeWorld);

}  // namespace gfxrepro::reflection_reuse
