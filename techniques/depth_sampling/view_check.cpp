#include "techniques/depth_sampling/view_check.h"

#include <fmt/format.h>

namespace gfxrepro::depth_sampling {

namespace {

/// Whether the nearest surface on the ray is drawn. A thin sheet of two single-sided triangles is
/// met at both at once, in any order; 1e-5: their distances differ by rounding.
bool isDrawn(const raycast::RayTracer& tracer, const glm::vec3& eye, const glm::vec3& direction,
             const raycast::Hit& nearest) {
    const auto drawn = tracer.closestHit(eye, direction, 0.0F, nearest.distance * (1.0F + 1e-5F),
                                         raycast::Faces::Drawn);
    return drawn.has_value();
}

}  // namespace

FirstHits firstHits(const raycast::RayTracer& tracer, const kit::View& view) {
    constexpr int kRays = 32;  // each way: a tenth of a second for 16 views, and no thin miss
    FirstHits hits;
    for (int y = 0; y < kRays; ++y) {
        for (int x = 0; x < kRays; ++x) {
            const glm::vec2 at = (glm::vec2(x, y) + 0.5F) / static_cast<float>(kRays);
            const glm::vec3 direction = rayThrough(view, at * glm::vec2(view.sizePx));
            // From the eye, not from the near plane: a surface in between makes the eye an inside.
            const std::optional<raycast::Hit> hit = tracer.closestHit(view.eyeWorld, direction);
            if (!hit) continue;
            ++hits.all;
            if (!isDrawn(tracer, view.eyeWorld, direction, *hit)) ++hits.ofBacks;
        }
    }
    return hits;
}

void checkViews(const raycast::RayTracer& tracer, std::span<const kit::View> views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        const FirstHits hits = firstHits(tracer, views[i]);
        if (2 * hits.ofBacks <= hits.all) continue;
        const glm::vec3& eye = views[i].eyeWorld;
        throw Error(fmt::format(
            "view {} at ({:.4g}, {:.4g}, {:.4g}) is inside of geometry or looks at an open surface "
            "from behind: {} of {} rays that meet the scene meet the back of a single-sided "
            "triangle first; change 'view_distance', 'view_spread', 'view_yaw_deg' or "
            "'view_pitch_deg', or make the material double-sided",
            i, eye.x, eye.y, eye.z, hits.ofBacks, hits.all));
    }
}

}  // namespace gfxrepro::depth_sampling
