#include "techniques/reflection_reuse/pixel_matcher.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::reflection_reuse {

namespace {

constexpr int kMatchGroupSize = 8;
constexpr int kRowLength = 16;  // samples that one invocation counts

static_assert(sizeof(MatchingCounts) == 12, "as matching_counts.comp.glsl has it");

gl::Defines matchingDefines(const MatchingSettings& settings) {
    return {{"GROUP_SIZE", kMatchGroupSize},
            {"INVALID_OFFSET", kInvalidOffset},
            {"IS_SECOND_ORDER", settings.matching == Matching::SecondOrder ? 1 : 0},
            {"MAX_NEWTON_STEPS", kMaxNewtonSteps},
            {"LONGEST_STEP", kLongestStep},
            {"DAMPING", kDamping},
            {"ROUNDING", kRounding},
            {"START_REACH", kStartReach}};
}

gl::Defines countsDefines() {
    return {{"GROUP_SIZE", kMatchGroupSize},
            {"ROW_LENGTH", kRowLength},
            {"INVALID_OFFSET", kInvalidOffset}};
}

}  // namespace

Offsets::Offsets(glm::ivec2 sizePx)
    : offset(gl::Texture::make2D(GL_RG16F, sizePx)), steps(gl::Texture::make2D(GL_R8UI, sizePx)) {
    // Halves hold whole numbers up to here.
    GFXREPRO_ASSERT(sizePx.x <= 2048 && sizePx.y <= 2048);
}

std::size_t Offsets::sizeBytes() const {
    return offset.sizeBytes() + steps.sizeBytes();
}

double MatchingCounts::meanSteps() const {
    return reflectiveSamples > 0 ? static_cast<double>(steps) / reflectiveSamples : 0.0;
}

PixelMatcher::PixelMatcher(const gl::ShaderLibrary& shaders, const MatchingSettings& settings)
    : settings_(settings),
      pass_(shaders, {"reflection_reuse/pixel_matching.comp.glsl"}, matchingDefines(settings)),
      countsPass_(shaders, {"reflection_reuse/matching_counts.comp.glsl"}, countsDefines()) {}

void PixelMatcher::match(const ReflectionDepthImage& key, const glm::vec3& eyeWorld,
                         const Offsets* previous, Offsets& result) const {
    const glm::ivec2 sizePx = key.gbuffer.view.sizePx;
    GFXREPRO_ASSERT(glm::ivec2(result.offset.size()) == sizePx);
    GFXREPRO_ASSERT(previous != &result);
    GFXREPRO_ASSERT(previous == nullptr || glm::ivec2(previous->offset.size()) == sizePx);
    pass_.set("hasPrevious", previous != nullptr ? 1 : 0);
    pass_.set("eyeWorld", eyeWorld);
    pass_.set("diagonalM", key.diagonalM);
    pass_.set("maxSteps", settings_.maxSteps);
    pass_.set("silhouette", settings_.silhouette);
    pass_.set("widestRingPx", settings_.widestRingPx);
    // Without previous offsets the distances stand in.
    const gl::Texture& distance = key.reflection.distance;
    pass_.dispatch(
        {kit::groupsFor(sizePx.x, kMatchGroupSize), kit::groupsFor(sizePx.y, kMatchGroupSize), 1},
        gl::Resources{{"travelDistances", distance},
                      {"previousOffsets", previous ? previous->offset : distance},
                      {"offsets", result.offset},
                      {"stepCounts", result.steps}}
            .with(key.gbuffer.resourcesFor(pass_)));
}

MatchingCounts PixelMatcher::counts(const ReflectionDepthImage& key, const Offsets& offsets) const {
    const glm::ivec2 sizePx = key.gbuffer.view.sizePx;
    const gl::Buffer sums = gl::Buffer::of(std::span<const MatchingCounts>({MatchingCounts{}}));
    const GLuint rowPieces = kit::groupsFor(sizePx.x, kRowLength);
    countsPass_.dispatch(
        {kit::groupsFor(rowPieces, kMatchGroupSize), kit::groupsFor(sizePx.y, kMatchGroupSize), 1},
        gl::Resources{{"offsets", offsets.offset}, {"stepCounts", offsets.steps}, {"Counts", sums}}
            .with(key.gbuffer.resourcesFor(countsPass_)));
    return sums.read<MatchingCounts>(1).front();
}

HostReflectionDepthImage readReflectionDepthImage(const ReflectionDepthImage& image) {
    return {readGBuffer(image.gbuffer), image.reflection.distance.read<float>(GL_RED, GL_FLOAT, 1),
            image.diagonalM};
}

namespace {

struct Candidate {
    glm::ivec2 pixel{0};
    float depthM = 0.0F;
    glm::vec3 miss{0.0F};
};

float squared(const glm::vec3& v) {
    return glm::dot(v, v);
}

/// v, mirrored in the plane through 0 that is perpendicular to `normal`.
glm::vec3 mirrored(const glm::vec3& v, const glm::vec3& normal) {
    return v - (2.0F * glm::dot(v, normal) / glm::dot(normal, normal)) * normal;
}

/// From the eye to the nearest point of the ray from M that leaves the mirror in W_n.
glm::vec3 missAt(const glm::vec3& position, const glm::vec3& normal, const glm::vec3& reflected,
                 const glm::vec3& eyeWorld) {
    const glm::vec3 image = position + mirrored(reflected - position, normal);
    const glm::vec3 direction = position - image;
    const float lengthSquared = squared(direction);
    // R in the candidate itself: no ray, only the point.
    const float t = lengthSquared > 0.0F
                        ? std::max(glm::dot(eyeWorld - position, direction) / lengthSquared, 0.0F)
                        : 0.0F;
    return position + t * direction - eyeWorld;
}

/// The samples of the square ring `reach` pixels around 0, row by row.
glm::ivec2 onRing(int i, int reach) {
    const int width = 2 * reach + 1;
    if (i < width) return {i - reach, -reach};
    if (i >= 8 * reach - width) return {i - 8 * reach + reach + 1, reach};
    const int between = i - width;
    return {between % 2 == 0 ? -reach : reach, between / 2 - reach + 1};
}

/// One search, for one sample of the key frame.
class Search {
  public:
    Search(const HostReflectionDepthImage& key, glm::ivec2 sample, const glm::vec3& eyeWorld,
           const MatchingSettings& settings)
        : gbuffer_(key.gbuffer),
          settings_(settings),
          eyeWorld_(eyeWorld),
          sample_(sample),
          reflector_(key.gbuffer.reflectorAt(sample)),
          reflected_(key.reflectedPositionWorld(sample)) {}

    HostMatch run(const std::optional<glm::vec2>& previous) {
        standOn(candidateAt(startOf(previous)));
        if (settings_.matching == Matching::SecondOrder) {
            searchBent();
        } else {
            searchRings();
        }
        match_.end = at_.pixel;
        match_.distance = std::sqrt(squared(at_.miss));
        // Inside of the silhouette: were the surface to go on, the match would lie within a step.
        const glm::vec3 toEye = kRounding * (eyeWorld_ - gbuffer_.positionWorld(at_.pixel));
        if (isOver_ && squared(at_.miss) <= std::max(reachSquared_, squared(toEye))) {
            match_.offset = glm::vec2(at_.pixel - sample_) + between_;
        }
        return match_;
    }

  private:
    Candidate candidateAt(glm::ivec2 pixel) const {
        const std::size_t index = gbuffer_.indexOf(pixel);
        const glm::vec3 normal =
            reflections::directionFromOctahedral(gbuffer_.normalOctahedral[index]);
        return {pixel, gbuffer_.depthM[index],
                missAt(gbuffer_.positionWorld(pixel), normal, reflected_, eyeWorld_)};
    }

    void standOn(const Candidate& candidate) {
        at_ = candidate;
        match_.passed.push_back(std::sqrt(squared(candidate.miss)));
    }

    bool isOnReflector(glm::ivec2 pixel) const { return gbuffer_.reflectorAt(pixel) == reflector_; }

    /// Whether a sample, `reach` steps away, continues the surface: no silhouette lies between.
    bool isNeighbour(glm::ivec2 pixel, int reach = 1) const {
        if (!isOnReflector(pixel)) return false;
        const float depth = gbuffer_.depthM[gbuffer_.indexOf(pixel)];
        return std::abs(depth - at_.depthM) <=
               static_cast<float>(reach) * settings_.silhouette * std::min(depth, at_.depthM);
    }

    glm::ivec2 startOf(const std::optional<glm::vec2>& previous) const {
        if (!previous) return sample_;
        const glm::ivec2 start = sample_ + glm::ivec2(glm::floor(*previous + 0.5F));
        return isOnReflector(start) ? start : sample_;
    }

    Candidate bestOfRing(int reach, float& reachSquared) const {
        Candidate best = at_;
        float bestSquared = squared(at_.miss);
        reachSquared = 0.0F;
        for (int i = 0; i < 8 * reach; ++i) {
            const glm::ivec2 pixel = at_.pixel + onRing(i, reach);
            if (!isNeighbour(pixel, reach)) continue;
            const Candidate candidate = candidateAt(pixel);
            reachSquared = std::max(reachSquared, squared(candidate.miss - at_.miss));
            const float distanceSquared = squared(candidate.miss);
            if (distanceSquared < bestSquared) {
                bestSquared = distanceSquared;
                best = candidate;
            }
        }
        return best;
    }

    void searchRings() {
        for (; match_.steps <= settings_.maxSteps; ++match_.steps) {
            Candidate best = bestOfRing(1, reachSquared_);
            for (int reach = 2; reach <= settings_.widestRingPx && best.pixel == at_.pixel;
                 ++reach) {
                float ignored = 0.0F;
                best = bestOfRing(reach, ignored);
            }
            if (best.pixel == at_.pixel) {
                isOver_ = true;
                return;
            }
            standOn(best);
        }
    }

    glm::vec3 missDifference(glm::ivec2 axis) {
        glm::vec3 sum(0.0F);
        float count = 0.0F;
        for (int side = -1; side <= 1; side += 2) {
            const glm::ivec2 pixel = at_.pixel + side * axis;
            if (!isNeighbour(pixel)) continue;
            const glm::vec3 difference = candidateAt(pixel).miss - at_.miss;
            reachSquared_ = std::max(reachSquared_, squared(difference));
            sum += static_cast<float>(side) * difference;
            count += 1.0F;
        }
        return count > 0.0F ? sum / count : sum;
    }

    /// The Gauss-Newton step, in pixels, to where the miss vanishes.
    glm::vec2 newtonStep() {
        reachSquared_ = 0.0F;
        const glm::vec3 dx = missDifference({1, 0});
        const glm::vec3 dy = missDifference({0, 1});
        const float damping = kDamping * (glm::dot(dx, dx) + glm::dot(dy, dy));
        const float a = glm::dot(dx, dx) + damping, b = glm::dot(dx, dy),
                    c = glm::dot(dy, dy) + damping;
        const glm::vec2 right = -glm::vec2(glm::dot(dx, at_.miss), glm::dot(dy, at_.miss));
        const float determinant = a * c - b * b;
        if (determinant <= 0.0F) return glm::vec2(0.0F);
        return glm::vec2(c * right.x - b * right.y, a * right.y - b * right.x) / determinant;
    }

    void searchBent() {
        for (int i = 0; i < kMaxNewtonSteps && match_.steps < settings_.maxSteps; ++i) {
            glm::vec2 delta = newtonStep();
            const float longest = std::max(std::abs(delta.x), std::abs(delta.y));
            if (longest <= 0.5F) {
                between_ = delta;
                isOver_ = true;
                return;
            }
            delta *= std::min(kLongestStep / longest, 1.0F);
            const glm::ivec2 pixel = at_.pixel + glm::ivec2(glm::floor(delta + 0.5F));
            if (!isOnReflector(pixel)) break;
            const Candidate candidate = candidateAt(pixel);
            if (squared(candidate.miss) >= squared(at_.miss)) break;
            standOn(candidate);
            ++match_.steps;
        }
        searchRings();
        const float ringReachSquared = reachSquared_;
        between_ = glm::clamp(newtonStep(), -0.5F, 0.5F);
        reachSquared_ = ringReachSquared;
    }

    const reflections::HostGBuffer& gbuffer_;
    const MatchingSettings& settings_;
    glm::vec3 eyeWorld_;
    glm::ivec2 sample_;
    int reflector_;
    glm::vec3 reflected_;

    Candidate at_;
    HostMatch match_;
    glm::vec2 between_{0.0F};    // of the match from the last candidate
    float reachSquared_ = 0.0F;  // (the most that the miss changes to a neighbour)²
    bool isOver_ = false;
};

}  // namespace

glm::vec3 HostReflectionDepthImage::reflectedPositionWorld(glm::ivec2 sample) const {
    const std::size_t index = gbuffer.indexOf(sample);
    const float r = distanceM[index] > 0.0F ? distanceM[index] : diagonalM;
    const glm::vec3 position = gbuffer.positionWorld(sample);
    const glm::vec3 view = position - gbuffer.view.eyeWorld;
    const glm::vec3 normal = reflections::directionFromOctahedral(gbuffer.normalOctahedral[index]);
    return position + (r / std::sqrt(squared(view))) * mirrored(view, normal);
}

float matchingDistance(const glm::vec3& candidateWorld, const glm::vec3& candidateNormal,
                       const glm::vec3& reflectedWorld, const glm::vec3& eyeWorld) {
    return std::sqrt(squared(missAt(candidateWorld, candidateNormal, reflectedWorld, eyeWorld)));
}

HostMatch matchOnHost(const HostReflectionDepthImage& key, glm::ivec2 sample,
                      const glm::vec3& eyeWorld, std::optional<glm::vec2> previous,
                      const MatchingSettings& settings) {
    GFXREPRO_ASSERT(key.gbuffer.isReflective(key.gbuffer.indexOf(sample)));
    return Search(key, sample, eyeWorld, settings).run(previous);
}

HostMatch matchExhaustively(const HostReflectionDepthImage& key, glm::ivec2 sample,
                            const glm::vec3& eyeWorld) {
    const reflections::HostGBuffer& gbuffer = key.gbuffer;
    const glm::vec3 reflected = key.reflectedPositionWorld(sample);
    HostMatch match;
    match.distance = std::numeric_limits<float>::infinity();
    for (int y = 0; y < gbuffer.view.sizePx.y; ++y) {
        for (int x = 0; x < gbuffer.view.sizePx.x; ++x) {
            const std::size_t index = gbuffer.indexOf({x, y});
            if (gbuffer.reflector(index) != gbuffer.reflectorAt(sample)) continue;
            const float distance = matchingDistance(
                gbuffer.positionWorld({x, y}), gbuffer.normalWorld[index], reflected, eyeWorld);
            if (distance >= match.distance) continue;
            match.distance = distance;
            match.end = {x, y};
        }
    }
    match.offset = glm::vec2(match.end - sample);
    return match;
}

namespace {

/// How far the eye is missed between samples: position and normal are linear between the four
/// around. Nothing where one of them is not of the reflector.
std::optional<float> distanceBetween(const HostReflectionDepthImage& key, const glm::vec2& place,
                                     glm::ivec2 sample, const glm::vec3& eyeWorld) {
    const reflections::HostGBuffer& gbuffer = key.gbuffer;
    const glm::vec2 low = glm::floor(place), fraction = place - low;
    glm::vec3 position(0.0F), normal(0.0F);
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const glm::vec2 near = glm::mix(1.0F - fraction, fraction, glm::vec2(corner));
        if (near.x * near.y == 0.0F) continue;
        const glm::ivec2 pixel = glm::ivec2(low) + corner;
        if (gbuffer.reflectorAt(pixel) != gbuffer.reflectorAt(sample)) return std::nullopt;
        position += near.x * near.y * gbuffer.positionWorld(pixel);
        normal += near.x * near.y * gbuffer.normalWorld[gbuffer.indexOf(pixel)];
    }
    return matchingDistance(position, normal, key.reflectedPositionWorld(sample), eyeWorld);
}

bool isWrong(const HostReflectionDepthImage& key, glm::ivec2 sample, const glm::vec2& offset,
             const glm::vec3& eyeWorld, const MatchingSettings& settings) {
    // A search from the match ends there, and says its distance.
    const HostMatch found = matchOnHost(key, sample, eyeWorld, offset, settings);
    const HostMatch best = matchExhaustively(key, sample, eyeWorld);
    if (!found.offset || !best.offset) return false;
    const glm::ivec2 apart = glm::abs(found.end - best.end);
    // A match of second order lies between samples, and so is measured there.
    const float distance = std::min(
        found.distance, distanceBetween(key, glm::vec2(sample) + *found.offset, sample, eyeWorld)
                            .value_or(found.distance));
    return std::max(apart.x, apart.y) > 1 && best.distance < distance;
}

}  // namespace

bool isValid(const glm::vec2& offset) {
    return offset.x != kInvalidOffset;
}

MatchCheck checkMatches(const HostReflectionDepthImage& key, const std::vector<glm::vec2>& offsets,
                        const glm::vec3& eyeWorld, const MatchingSettings& settings, int samples) {
    std::vector<std::size_t> valid;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (key.gbuffer.isReflective(i) && isValid(offsets[i])) valid.push_back(i);
    }
    MatchCheck check;
    check.checked = std::min(valid.size(), static_cast<std::size_t>(samples));
    const auto width = static_cast<std::size_t>(key.gbuffer.view.sizePx.x);
    std::atomic<std::size_t> wrong = 0;
    tbb::parallel_for(std::size_t{0}, check.checked, [&](std::size_t i) {
        const std::size_t index = valid[i * valid.size() / check.checked];
        const glm::ivec2 sample(static_cast<int>(index % width), static_cast<int>(index / width));
        if (isWrong(key, sample, offsets[index], eyeWorld, settings)) ++wrong;
    });
    check.wrong = wrong;
    return check;
}

}  // namespace gfxrepro::reflection_reuse
