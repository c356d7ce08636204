#include "techniques/terrain_tessellation/terrain_measures.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace gfxrepro::terrain_tessellation {
namespace {

/// Whether a pixel up to `reachPx` away, across, up or askew, meets the condition.
template <class Condition>
bool anyNear(const DepthMap& map, glm::ivec2 pixel, int reachPx, const Condition& condition) {
    for (int dy = -reachPx; dy <= reachPx; ++dy) {
        for (int dx = -reachPx; dx <= reachPx; ++dx) {
            const glm::ivec2 at = pixel + glm::ivec2(dx, dy);
            if (map.contains(at) && condition(at)) return true;
        }
    }
    return false;
}

/// Marks background of `drawn` that is none of a hole: the truth has background there, too, or
/// beside it, the image ends, or no terrain is drawn above.
std::vector<std::uint8_t> soundBackground(const DepthMap& drawn, const DepthMap& truth) {
    const glm::ivec2 last = drawn.view.sizePx - 1;
    std::vector<std::uint8_t> marks(drawn.depthM.size());
    for (int x = 0; x <= last.x; ++x) {
        bool isBelowTerrain = false;
        for (int y = last.y; y >= 0; --y) {
            isBelowTerrain = isBelowTerrain || drawn.isCovered({x, y});
            if (drawn.isCovered({x, y})) continue;
            const bool isOnRim = x == 0 || y == 0 || x == last.x || y == last.y;
            marks[drawn.indexOf({x, y})] =
                isOnRim || !isBelowTerrain ||
                anyNear(truth, {x, y}, 1, [&](glm::ivec2 at) { return !truth.isCovered(at); });
        }
    }
    return marks;
}

}  // namespace

HeightErrors heightErrors(const DepthMap& drawn, const DepthMap& truth,
                          const std::function<float(float x, float z)>& heightAt,
                          const std::function<void()>& afterRow) {
    // k of [zhang2012] Eq. (1), in pixels a metre at a depth of one metre.
    const double pixelsPerRadian =
        0.5 * static_cast<double>(drawn.view.clipFromView[1].y) * drawn.view.sizePx.y;
    HeightErrors errors;
    for (int y = 0; y < drawn.view.sizePx.y; ++y) {
        for (int x = 0; x < drawn.view.sizePx.x; ++x) {
            if (!drawn.isCovered({x, y}) || !truth.isCovered({x, y})) continue;
            const float depthM = drawn.depthM[drawn.indexOf({x, y})];
            const glm::vec3 point = kit::unproject(drawn.view, glm::vec2(x, y) + 0.5F, depthM);
            const double errorM = std::abs(double{point.y} - double{heightAt(point.x, point.z)});
            const double errorPx = errorM * pixelsPerRadian / depthM;
            ++errors.pixels;
            errors.meanM += errorM;
            errors.meanPx += errorPx;
            errors.maxM = std::max(errors.maxM, errorM);
            errors.maxPx = std::max(errors.maxPx, errorPx);
        }
        afterRow();
    }
    if (errors.pixels > 0) {
        errors.meanM /= static_cast<double>(errors.pixels);
        errors.meanPx /= static_cast<double>(errors.pixels);
    }
    return errors;
}

std::vector<std::uint8_t> crackMarks(const DepthMap& drawn, const DepthMap& truth) {
    GFXREPRO_ASSERT(drawn.view.sizePx == truth.view.sizePx);
    // Coarser ground has another outline: it opens bays of up to three pixels beside the truth's.
    constexpr int kReachPx = 2;
    const std::vector<std::uint8_t> sound = soundBackground(drawn, truth);
    const auto isSound = [&](glm::ivec2 at) { return sound[drawn.indexOf(at)] != 0; };
    std::vector<std::uint8_t> marks;
    marks.reserve(sound.size());
    for (int y = 0; y < drawn.view.sizePx.y; ++y) {
        for (int x = 0; x < drawn.view.sizePx.x; ++x) {
            marks.push_back(!drawn.isCovered({x, y}) && !anyNear(drawn, {x, y}, kReachPx, isSound));
        }
    }
    return marks;
}

std::size_t markedCount(const std::vector<std::uint8_t>& marks) {
    return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), std::uint8_t{1}));
}

image::ImageF withMarks(const image::ImageF& picture, const std::vector<std::uint8_t>& marks) {
    image::ImageF marked = picture;
    for (int y = 0; y < marked.height(); ++y) {
        for (int x = 0; x < marked.width(); ++x) {
            const auto row = static_cast<std::size_t>(marked.height() - 1 - y);
            const bool isMarked =
                marks[row * static_cast<std::size_t>(marked.width()) + static_cast<std::size_t>(x)];
            for (int c = 0; c < marked.channels(); ++c) {
                float& value = marked.at(x, y, c);
                value = isMarked ? (c == 0 ? 1.0F : 0.0F) : 0.6F * value;
            }
        }
    }
    return marked;
}

}  // namespace gfxrepro::terrain_tessellation
