#include "tests/techniques/clustered_reflections/march_on_host.h"

#include <algorithm>
#include <cmath>

namespace gfxrepro::clustered_reflections {
namespace {

/// As in shaders/march.glsl.
constexpr float kLeaving = 1.0F / 32.0F;

/// The part of a ray inside the frustum, projected: shaders/march.glsl has the same operations.
struct ProjectedRay {
    glm::vec2 beginPx{0.0F}, deltaPx{0.0F};
    float k1 = 0.0F, k2 = 0.0F;
    int steps = 0;
};

/// Keeps of [t0, t1] what lies on the inner side of a plane, to which the ends have these signed
/// distances.
void cut(float begin, float end, float& t0, float& t1) {
    if (begin < 0.0F) t0 = end < 0.0F ? 2.0F : std::max(t0, begin / (begin - end));
    if (end < 0.0F && !(begin < 0.0F)) t1 = std::min(t1, begin / (begin - end));
}

std::optional<ProjectedRay> project(const HostMarchImage& image, const glm::vec3& beginWorld,
                                    const glm::vec3& endWorld) {
    const glm::vec4 begin = image.clipFromWorld * glm::vec4(beginWorld, 1.0F);
    const glm::vec4 end = image.clipFromWorld * glm::vec4(endWorld, 1.0F);
    const glm::vec2 size(image.sizePx);
    const glm::vec2 border = 1.0F + 1.0F / size;  // half a texel outwards
    float t0 = 0.0F, t1 = 1.0F;
    for (int axis = 0; axis < 2; ++axis) {
        cut(border[axis] * begin.w + begin[axis], border[axis] * end.w + end[axis], t0, t1);
        cut(border[axis] * begin.w - begin[axis], border[axis] * end.w - end[axis], t0, t1);
    }
    cut(begin.w + begin.z, end.w + end.z, t0, t1);
    cut(begin.w - begin.z, end.w - end.z, t0, t1);
    if (!(t0 <= t1)) return std::nullopt;

    const glm::vec4 from = begin + (end - begin) * t0;
    const glm::vec4 to = begin + (end - begin) * t1;
    if (!(from.w > 0.0F && to.w > 0.0F)) return std::nullopt;
    ProjectedRay ray;
    ray.beginPx = (glm::vec2(from) / from.w * 0.5F + 0.5F) * size;
    ray.deltaPx = (glm::vec2(to) / to.w * 0.5F + 0.5F) * size - ray.beginPx;
    ray.k1 = 1.0F / from.w;
    ray.k2 = 1.0F / to.w - ray.k1;
    const float longest = std::max(std::abs(ray.deltaPx.x), std::abs(ray.deltaPx.y));
    ray.steps = std::max(static_cast<int>(std::ceil(longest)), 1);
    return ray;
}

std::size_t texelAt(const HostMarchImage& image, const glm::vec2& positionPx) {
    const glm::ivec2 texel =
        glm::clamp(glm::ivec2(glm::floor(positionPx)), glm::ivec2(0), image.sizePx - 1);
    return static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(image.sizePx.x) +
           static_cast<std::size_t>(texel.x);
}

}  // namespace

float HostMarchImage::depthAt(const glm::vec2& positionPx) const {
    return depthM[texelAt(*this, positionPx)];
}

// [xie2017] Algorithm 7.
std::optional<MarchHit> marchOnHost(const HostMarchImage& image, const glm::vec3& beginWorld,
                                    const glm::vec3& endWorld) {
    if (image.sizePx.x <= 0 || image.sizePx.y <= 0) return std::nullopt;
    const std::optional<ProjectedRay> ray = project(image, beginWorld, endWorld);
    if (!ray) return std::nullopt;
    const float perStep = 1.0F / static_cast<float>(ray->steps);
    bool hasLeftOwn = false;
    for (int step = 0; step <= ray->steps; ++step) {
        const float u = static_cast<float>(step) * perStep;
        const glm::vec2 positionPx = ray->beginPx + u * ray->deltaPx;
        const float depthM = 1.0F / (ray->k1 + ray->k2 * u);
        const float storedM = image.depthAt(positionPx);
        const bool isBehind = storedM > 0.0F && depthM > storedM;
        hasLeftOwn |= !(storedM > 0.0F) || depthM < storedM * (1.0F - kLeaving);
        if (!isBehind) continue;
        if (hasLeftOwn || image.isOwn.empty() || image.isOwn[texelAt(image, positionPx)] == 0) {
            return MarchHit{positionPx, u, depthM, step + 1};
        }
    }
    return std::nullopt;
}

}  // namespace gfxrepro::clustered_reflections
