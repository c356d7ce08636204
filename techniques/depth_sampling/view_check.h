// Whether reference views stand where a depth image can be taken.
#pragma once

#include <span>

#include "engine/raycast/ray_tracer.h"
#include "techniques/kit/view.h"

namespace gfxrepro::depth_sampling {

/// How a sparse grid of primary rays meets a scene.
struct FirstHits {
    int all = 0;
    int ofBacks = 0;  // of triangles that are drawn from the front only
};
FirstHits firstHits(const raycast::RayTracer& tracer, const kit::View& view);

/// Throws Error, naming the view and what to change, for the first view more than half of whose
/// rays that meet anything first meet the back of a single-sided triangle. The eye is then inside
/// of a closed surface, or looks at an open one from behind: culling would show the scene without
/// what is nearest, and no measure would mean anything. A view without any hit passes.
void checkViews(const raycast::RayTracer& tracer, std::span<const kit::View> views);

}  // namespace gfxrepro::depth_sampling
