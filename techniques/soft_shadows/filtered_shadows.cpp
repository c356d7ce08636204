#include "techniques/soft_shadows/filtered_shadows.h"

#include "techniques/kit/draws.h"

namespace gfxrepro::soft_shadows {
namespace {

constexpr int kGroupSize = 8;
enum TextureUnit { kShadowMapUnit = 0, kMomentUnit = 1 };
enum ImageUnit { kPositionImage = 0, kNormalImage = 1, kShareImage = 2, kMomentImage = 0 };

gl::Defines filterDefines(ShadowFilter filter) {
    gl::Defines defines{{"GROUP_SIZE", kGroupSize},
                        {"SHADOW_MAP_UNIT", kShadowMapUnit},
                        {"POSITION_IMAGE", kPositionImage},
                        {"NORMAL_IMAGE", kNormalImage},
                        {"SHARE_IMAGE", kShareImage}};
    if (filter == ShadowFilter::Variance) {
        defines["VARIANCE"] = 1;
        defines["MOMENT_UNIT"] = kMomentUnit;
    }
    return defines;
}

void dispatch(glm::ivec2 sizePx) {
    glDispatchCompute(kit::groupsFor(sizePx.x, kGroupSize), kit::groupsFor(sizePx.y, kGroupSize),
                      1);
}

}  // namespace

FilteredShadows::FilteredShadows(const gl::ShaderLibrary& shaders, ShadowFilter filter,
                                 const ShadowMapSettings& settings)
    : settings_(settings),
      shadowMap_(shaders, settings),
      filter_(shaders, {"soft_shadows/filtered_shadow.comp.glsl"}, filterDefines(filter)) {
    if (filter == ShadowFilter::Pcss) return;
    moments_ = gl::Program(shaders, {"soft_shadows/depth_moments.comp.glsl"},
                           {{"GROUP_SIZE", kGroupSize},
                            {"SHADOW_MAP_UNIT", kShadowMapUnit},
                            {"MOMENT_IMAGE", kMomentImage}});
    momentPyramid_ = gl::Texture::make2D(GL_RG32F, glm::ivec2(settings.sizePx), 0);
    momentPyramid_.setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
}

void FilteredShadows::makeMoments(const kit::View& view) {
    moments_.use();
    moments_.set("nearM", view.nearM);
    moments_.set("farM", view.farM);
    shadowMap_.shadowMap().bind(kShadowMapUnit);
    momentPyramid_.bindImage(kMomentImage, GL_WRITE_ONLY);
    dispatch(view.sizePx);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    momentPyramid_.generateMipmaps();
}

void FilteredShadows::render(const Receivers& receivers, const AreaLight& light,
                             std::span<const ShadowCaster* const> casters,
                             const gl::Texture& litShares) {
    const kit::View view = lightView(light, light.centre, settings_.sizePx);
    shadowMap_.drawShadowMap(view, casters);
    if (momentPyramid_.id() != 0) makeMoments(view);

    const glm::mat4 clipFromWorld = view.clipFromWorld();
    filter_.use();
    filter_.set("clipFromWorld", clipFromWorld);
    filter_.setIfActive("worldFromClip", glm::inverse(clipFromWorld));
    filter_.set("lightPosition", light.centre);
    filter_.set("lightForward", forwardOf(view));
    filter_.set("tangent", 1.0F / view.clipFromView[0].x);
    filter_.set("halfLight", glm::length(light.right));
    filter_.set("nearM", view.nearM);
    filter_.setIfActive("farM", view.farM);
    filter_.set("biasPerDistance", shadowMap_.biasPerDistance(view));
    shadowMap_.shadowMap().bind(kShadowMapUnit);
    if (momentPyramid_.id() != 0) momentPyramid_.bind(kMomentUnit);
    receivers.positions.bindImage(kPositionImage, GL_READ_ONLY);
    receivers.normals.bindImage(kNormalImage, GL_READ_ONLY);
    litShares.bindImage(kShareImage, GL_WRITE_ONLY);
    dispatch(receivers.view.sizePx);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
}

}  // namespace gfxrepro::soft_shadows
