#include "techniques/soft_shadows/filtered_shadows.h"

#include "techniques/kit/draws.h"

namespace gfxrepro::soft_shadows {
namespace {

constexpr int kGroupSize = 8;

gl::Defines filterDefines(ShadowFilter filter) {
    gl::Defines defines{{"GROUP_SIZE", kGroupSize}};
    if (filter == ShadowFilter::Variance) defines["VARIANCE"] = 1;
    return defines;
}

glm::uvec3 groupsOver(glm::ivec2 sizePx) {
    return {kit::groupsFor(sizePx.x, kGroupSize), kit::groupsFor(sizePx.y, kGroupSize), 1};
}

}  // namespace

FilteredShadows::FilteredShadows(const gl::ShaderLibrary& shaders, ShadowFilter filter,
                                 const ShadowMapSettings& settings)
    : settings_(settings),
      shadowMap_(shaders, settings),
      filter_(shaders, {"soft_shadows/filtered_shadow.comp.glsl"}, filterDefines(filter)) {
    if (filter == ShadowFilter::Pcss) return;
    moments_ =
        gl::Pass(shaders, {"soft_shadows/depth_moments.comp.glsl"}, {{"GROUP_SIZE", kGroupSize}});
    momentPyramid_ = gl::Texture::make2D(GL_RG32F, glm::ivec2(settings.sizePx), 0);
    momentPyramid_.setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
}

void FilteredShadows::makeMoments(const kit::View& view) {
    moments_.set("nearM", view.nearM);
    moments_.set("farM", view.farM);
    moments_.dispatch(groupsOver(view.sizePx),
                      {{"shadowMap", shadowMap_.shadowMap()}, {"moments", momentPyramid_}});
    momentPyramid_.generateMipmaps();
}

void FilteredShadows::render(const Receivers& receivers, const AreaLight& light,
                             std::span<const ShadowCaster* const> casters,
                             const gl::Texture& litShares) {
    const kit::View view = lightView(light, light.centre, settings_.sizePx);
    shadowMap_.drawShadowMap(view, casters);
    if (momentPyramid_.id() != 0) makeMoments(view);

    const glm::mat4 clipFromWorld = view.clipFromWorld();
    filter_.set("clipFromWorld", clipFromWorld);
    filter_.setIfActive("worldFromClip", glm::inverse(clipFromWorld));
    filter_.set("lightPosition", light.centre);
    filter_.set("lightForward", forwardOf(view));
    filter_.set("tangent", 1.0F / view.clipFromView[0].x);
    filter_.set("halfLight", glm::length(light.right));
    filter_.set("nearM", view.nearM);
    filter_.setIfActive("farM", view.farM);
    filter_.set("biasPerDistance", shadowMap_.biasPerDistance(view));
    filter_.dispatch(groupsOver(receivers.view.sizePx), {{"shadowMap", shadowMap_.shadowMap()},
                                                         {"moments", momentPyramid_},
                                                         {"positions", receivers.positions},
                                                         {"normals", receivers.normals},
                                                         {"litShares", litShares}});
}

}  // namespace gfxrepro::soft_shadows
