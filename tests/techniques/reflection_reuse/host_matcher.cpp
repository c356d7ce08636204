#include "tests/techniques/reflection_reuse/host_matcher.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/core/error.h"

namespace gfxrepro::reflection_reuse {

namespace {

struct Candidate {
    glm::ivec2 pixel{0};
    float depthM = 0.0F;
    glm::vec3 miss{0.0F};
};

float squared(const glm::vec3& v) {
    return glm::dot(v, v);
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

    /// Whether a sample next to it continues the surface: no silhouette lies between.
    bool isNeighbour(glm::ivec2 pixel) const {
        if (!isOnReflector(pixel)) return false;
        const float depth = gbuffer_.depthM[gbuffer_.indexOf(pixel)];
        return std::abs(depth - at_.depthM) <= settings_.silhouette * std::min(depth, at_.depthM);
    }

    glm::ivec2 startOf(const std::optional<glm::vec2>& previous) const {
        if (!previous) return sample_;
        const glm::ivec2 start = sample_ + glm::ivec2(glm::floor(*previous + 0.5F));
        return isOnReflector(start) ? start : sample_;
    }

    Candidate bestAround() {
        Candidate best = at_;
        float bestSquared = squared(at_.miss);
        reachSquared_ = 0.0F;
        for (int i = 0; i < 9; ++i) {
            const glm::ivec2 pixel = at_.pixel + glm::ivec2(i % 3 - 1, i / 3 - 1);
            if (i == 4 || !isNeighbour(pixel)) continue;
            const Candidate candidate = candidateAt(pixel);
            reachSquared_ = std::max(reachSquared_, squared(candidate.miss - at_.miss));
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
            const Candidate best = bestAround();
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

HostMatch matchOnHost(const HostReflectionDepthImage& key, glm::ivec2 sample,
                      const glm::vec3& eyeWorld, std::optional<glm::vec2> previous,
                      const MatchingSettings& settings) {
    GFXREPRO_ASSERT(key.gbuffer.isReflective(key.gbuffer.indexOf(sample)));
    return Search(key, sample, eyeWorld, settings).run(previous);
}

}  // namespace gfxrepro::reflection_reuse
