// [xie2017] Algorithm 9: where the reflection that a key-frame sample holds goes when the eye
// moves.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runner/gl/objects.h"
#include "runner/gl/program.h"
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
    int maxSteps = 256;  // a search that is longer is invalid: no loop of the device is unbounded
    /// Neighbours whose eye depths differ by more than this share of the nearer one lie on two
    /// sides of a reflector's silhouette.
    float silhouette = 0.05F;
};

/// Offsets of Algorithm 9, a texel a sample of the key frame.
struct Offsets {
    gl::Texture offset;  // RG16F, pixels: s* − s; kInvalidOffset where there is no match
    gl::Texture steps;   // R8UI: ring steps that the search took, at most 255
    explicit Offsets(glm::ivec2 sizePx);
    std::size_t sizeBytes() const;
};
/// Both components of an invalid offset.
constexpr float kInvalidOffset = 65504.0F;  // the largest half

class PixelMatcher {
  public:
    PixelMatcher(const gl::ShaderLibrary& shaders, const MatchingSettings& settings);
    /// For every reflective sample of `key`. The search begins at `previous` where that is valid,
    /// else at the sample itself; null: at the sample.
    void match(const ReflectionDepthImage& key, const glm::vec3& eyeWorld, const Offsets* previous,
               Offsets& result) const;

  private:
    MatchingSettings settings_;
    gl::Program program_;
};

/// The reflection depth image on the host, for the reference and exhaustive searches.
struct HostReflectionDepthImage {
    reflections::HostGBuffer gbuffer;
    std::vector<float> distanceM;
};

/// d(s_n, R, E): how far the eye is from the ray that leaves M, the mirror image of R in the plane
/// of candidate n, through W_n (Sec. 5.4.1).
float matchingDistance(const glm::vec3& candidateWorld, const glm::vec3& candidateNormal,
                       const glm::vec3& reflectedWorld, const glm::vec3& eyeWorld);

struct HostMatch {
    std::optional<glm::ivec2> offset;  // nothing: invalid
    int steps = 0;
    float distance = 0.0F;  // of the last candidate
};
/// Algorithm 9 for one sample, line by line; the search stops on equality, too, where the printed
/// one can cycle.
HostMatch matchOnHost(const HostReflectionDepthImage& key, glm::ivec2 sample,
                      const glm::vec3& eyeWorld, std::optional<glm::ivec2> previous,
                      const MatchingSettings& settings);
/// The best candidate of all samples of the same reflector: what a search should have found.
HostMatch matchExhaustively(const HostReflectionDepthImage& key, glm::ivec2 sample,
                            const glm::vec3& eyeWorld);

}  // namespace gfxrepro::reflection_reuse
