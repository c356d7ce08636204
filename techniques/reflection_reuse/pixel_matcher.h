// [xie2017] Algorithm 9: where the reflection that a key-frame sample holds goes when the eye
// moves.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "techniques/reflections/gbuffer.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflection_reuse {

/// B.1 normal and depth and B.2 mirror factor are the G-buffer's, B.3 radiance L_r and B.4 travel
/// distance r the tracer's. Where a ray left the scene, its end counts as the scene's diagonal
/// away.
/// Departure [xie2017] Sec. 5.5.1: it keeps all in two textures of four floats. Here L_r is halves;
/// what positions, and so matches, are made of is floats, too.
struct ReflectionDepthImage {
    reflections::GBuffer gbuffer;
    reflections::ReflectionTarget reflection;
    float diagonalM = 1.0F;

    ReflectionDepthImage(const kit::View& view, float sceneDiagonalM)
        : gbuffer(view), reflection(view.sizePx), diagonalM(sceneDiagonalM) {}
    std::size_t sizeBytes() const { return gbuffer.sizeBytes() + reflection.sizeBytes(); }
};

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
    std::size_t reflectiveSamples = 0, invalidSamples = 0, steps = 0;

    double meanSteps() const;
};
/// Reads back; waits for the device.
MatchingCounts countMatches(const ReflectionDepthImage& key, const Offsets& offsets);

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

  private:
    MatchingSettings settings_;
    gl::Pass pass_;
};

/// The reflection depth image on the host, for exhaustive searches.
struct HostReflectionDepthImage {
    reflections::HostGBuffer gbuffer;
    std::vector<float> distanceM;  // 0: the ray left the scene
    float diagonalM = 1.0F;

    /// R of Eq. 8: what a reflective sample shows.
    glm::vec3 reflectedPositionWorld(glm::ivec2 sample) const;
};
/// Reads back; waits for the device.
HostReflectionDepthImage readReflectionDepthImage(const ReflectionDepthImage& image);

/// From the eye to the nearest point of the ray from M, the mirror image of R in the plane of
/// candidate n, through W_n (Sec. 5.4.1). The normal may have any length.
/// Departure [xie2017] Sec. 5.4.1: the ray begins in W_n, where it leaves the mirror; to an eye
/// behind, W_n is the nearest. Begun in M, it also meets eyes between M and W_n, and candidates
/// that turn their backs to R match.
glm::vec3 missAt(const glm::vec3& candidateWorld, const glm::vec3& candidateNormal,
                 const glm::vec3& reflectedWorld, const glm::vec3& eyeWorld);
/// d(s_n, R, E): its length.
inline float matchingDistance(const glm::vec3& candidateWorld, const glm::vec3& candidateNormal,
                              const glm::vec3& reflectedWorld, const glm::vec3& eyeWorld) {
    return glm::length(missAt(candidateWorld, candidateNormal, reflectedWorld, eyeWorld));
}

/// The best candidate of all samples of the same reflector: what a search should have found.
struct BestSample {
    glm::ivec2 pixel{0};
    float distance = 0.0F;
};
BestSample bestSample(const HostReflectionDepthImage& key, glm::ivec2 sample,
                      const glm::vec3& eyeWorld);

bool isValid(const glm::vec2& offset);

struct MatchCheck {
    std::size_t checked = 0;
    std::size_t wrong = 0;  // another sample of the reflector, not next to the match, fits better
                            // than the match does where it is: between samples, of second order
};

/// At most `samples` of the valid matches, evenly spread over the image, against bestSample().
MatchCheck checkMatches(const HostReflectionDepthImage& key, const std::vector<glm::vec2>& offsets,
                        const glm::vec3& eyeWorld, int samples);

/// Of the second-order search ([xie2017] Sec. 5.5.4, outlook).
constexpr int kMaxNewtonSteps = 8;
/// Pixels. Linear extrapolation is trusted no farther.
constexpr float kLongestStep = 32.0F;
/// Share of the equations' trace that is added to their diagonal. Far below what moves a match by a
/// hundredth of a pixel; without it, reflections that do not tell two directions apart (a
/// cylinder seen from its focal line) divide by nothing.
constexpr float kDamping = 1e-5F;

/// Pixels, a power of two: how far from a sample with a match one that has lost its own is searched
/// again. What comes back into a reflector's image enters over its border, and by less a frame.
constexpr int kStartReach = 8;

/// Share of the eye's distance by which a match may miss the eye for rounding alone: positions and
/// normals are single precision. Without it a sample that has no neighbour to measure by is never
/// valid, not even where the eye has not moved.
constexpr float kRounding = 1e-5F;

}  // namespace gfxrepro::reflection_reuse
