#include "techniques/depth_sampling/view_check.h"

#include <fmt/format.h>

namespace gfxrepro::depth_sampling {

namespace {

bool isDoubleSided(const scene::Scene& scene, const raycast::Hit& hit) {
    const int mesh = scene.instances[hit.instance].mesh;
    const int material = scene.meshes[static_cast<std::size_t>(mesh)].material;
    return material >= 0 && scene.materials[static_cast<std::size_t>(material)].isDoubleSided;
}

}  // namespace

FirstHits firstHits(const scene::Scene& scene, const raycast::RayTracer& tracer,
                    const depth_images::View& view) {
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
            const bool isBack = glm::dot(hit->geometricNormal, direction) > 0.0F;
            if (isBack && !isDoubleSided(scene, *hit)) ++hits.ofBacks;
        }
    }
    return hits;
}

void checkViews(const scene::Scene& scene, const raycast::RayTracer& tracer,
                std::span<const depth_images::View> views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        const FirstHits hits = firstHits(scene, tracer, views[i]);
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
