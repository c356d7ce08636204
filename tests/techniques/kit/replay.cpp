#include "tests/techniques/kit/replay.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfxrepro::kit {

namespace {

constexpr double kSnapPx = 1.0 / 128.0;
constexpr double kRoundingPx = 1e-3;

struct Projected {
    glm::dvec2 positionPx;
    double depthM;
};

Projected projected(const View& view, const glm::dvec3& pointWorld) {
    const glm::dvec4 clip = glm::dmat4(view.clipFromView) * glm::dmat4(view.viewFromWorld) *
                            glm::dvec4(pointWorld, 1.0);
    return {(glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(view.sizePx), clip.w};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

enum class Answer { No, Yes, Unclear };

/// Whether the pixel that `point` lands in holds `id`; all pixels within rounding are asked.
Answer isHeldAt(const HostDepthImage& image, const glm::dvec3& point, std::uint32_t id) {
    const Projected there = projected(image.view, point);
    if (there.depthM <= 0.0) return Answer::No;
    int held = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::dvec2 shift(corner & 1 ? kRoundingPx : -kRoundingPx,
                               corner & 2 ? kRoundingPx : -kRoundingPx);
        const glm::ivec2 pixel(glm::floor(there.positionPx + shift));
        const bool isInside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < image.view.sizePx.x &&
                              pixel.y < image.view.sizePx.y;
        held += isInside && image.triangleId[image.indexOf(pixel)] == id ? 1 : 0;
    }
    return held == 0 ? Answer::No : held == 4 ? Answer::Yes : Answer::Unclear;
}

}  // namespace

struct Replay::Fragment {
    std::uint32_t id = 0;
    bool isCoverageClear = true;
    double depthM = 0.0, nearestM = 0.0, farthestM = 0.0;
    std::array<glm::dvec3, 5> points;  // at the centre and 1/128 px around it

    Answer isRedundant(std::span<const HostDepthImage> earlier) const {
        Answer answer = Answer::No;
        for (const HostDepthImage& image : earlier) {
            int yes = 0;
            int no = 0;
            for (const glm::dvec3& point : points) {
                const Answer held = isHeldAt(image, point, id);
                yes += held == Answer::Yes ? 1 : 0;
                no += held == Answer::No ? 1 : 0;
            }
            if (yes == 5) return Answer::Yes;
            if (no != 5) answer = Answer::Unclear;
        }
        return answer;
    }
};

Replay::Replay(const scene::Mesh& mesh, const View& view) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Triangle triangle;
        triangle.id = t + 1;
        for (int corner = 0; corner < 3; ++corner) {
            triangle.cornersWorld[corner] = mesh.positions[mesh.triangles[t][corner]];
            const Projected at = projected(view, triangle.cornersWorld[corner]);
            triangle.cornersPx[corner] = at.positionPx;
            triangle.depthsM[corner] = at.depthM;
        }
        const glm::dvec2* q = triangle.cornersPx;
        if (cross(q[1] - q[0], q[2] - q[0]) > 0.0) triangles_.push_back(triangle);
    }
}

std::vector<Replay::Fragment> Replay::fragmentsAt(const glm::dvec2& centrePx) const {
    std::vector<Fragment> fragments;
    for (const Triangle& triangle : triangles_) {
        const glm::dvec2* q = triangle.cornersPx;
        const double area = cross(q[1] - q[0], q[2] - q[0]);
        double innermost = 1e300;  // distance from the nearest edge's line, positive inside
        for (int i = 0; i < 3; ++i) {
            const glm::dvec2 edge = q[(i + 1) % 3] - q[i];
            innermost = std::min(innermost, cross(edge, centrePx - q[i]) / glm::length(edge));
        }
        if (innermost < -kSnapPx) continue;
        Fragment fragment;
        fragment.id = triangle.id;
        fragment.isCoverageClear = innermost > kSnapPx;
        fragment.nearestM = 1e300;
        constexpr glm::dvec2 kShifts[] = {{0, 0}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
        for (int k = 0; k < 5; ++k) {
            const glm::dvec2 at = centrePx + kShifts[k] * kSnapPx;
            double inverseDepth = 0.0;
            glm::dvec3 pointOverDepth(0.0);
            for (int i = 0; i < 3; ++i) {
                const glm::dvec2& b = q[(i + 1) % 3];
                const double weight =
                    cross(q[(i + 2) % 3] - b, at - b) / area / triangle.depthsM[i];
                inverseDepth += weight;
                pointOverDepth += weight * triangle.cornersWorld[i];
            }
            const double depth = 1.0 / inverseDepth;
            fragment.points[static_cast<std::size_t>(k)] = pointOverDepth * depth;
            if (k == 0) fragment.depthM = depth;
            fragment.nearestM = std::min(fragment.nearestM, depth);
            fragment.farthestM = std::max(fragment.farthestM, depth);
        }
        // What a depth buffer's own rounding may turn round.
        fragment.nearestM *= 1.0 - 1e-5;
        fragment.farthestM *= 1.0 + 1e-5;
        fragments.push_back(fragment);
    }
    std::sort(fragments.begin(), fragments.end(),
              [](const Fragment& a, const Fragment& b) { return a.depthM < b.depthM; });
    return fragments;
}

Verdict Replay::pixel(glm::ivec2 pixel, std::span<const HostDepthImage> earlier) const {
    std::vector<Fragment> rest;  // that may stay
    for (const Fragment& fragment : fragmentsAt(glm::dvec2(pixel) + 0.5)) {
        const Answer answer = fragment.isRedundant(earlier);
        if (answer == Answer::Yes) continue;
        rest.push_back(fragment);
        if (answer == Answer::Unclear) rest.back().isCoverageClear = false;
    }
    if (rest.empty()) return {true, 0, 0.0, 0.0};
    const Fragment& first = rest.front();
    bool isDecided = first.isCoverageClear;
    for (std::size_t i = 1; i < rest.size(); ++i) isDecided &= rest[i].nearestM > first.farthestM;
    const double tolerance = first.farthestM - first.nearestM;
    return {isDecided, first.id, first.depthM, tolerance};
}

}  // namespace gfxrepro::kit
