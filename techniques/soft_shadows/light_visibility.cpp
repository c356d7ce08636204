#include "techniques/soft_shadows/light_visibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::soft_shadows {
namespace {

/// Of the box's diagonal: what comes nearer to the plane of a view's eye would need half of space.
constexpr float kLeastDepth = 0.05F;

}  // namespace

glm::vec3 AreaLight::at(const glm::vec2& position) const {
    return centre + halfEdge * (position.x * axes[0] + position.y * axes[1]);
}

glm::vec3 AreaLight::corner(int index) const {
    constexpr glm::vec2 kCorners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    return at(kCorners[index]);
}

glm::vec3 AreaLight::sample(int i, int j, int n) const {
    return at((2.0F * glm::vec2(i, j) + 1.0F) / static_cast<float>(n) - 1.0F);
}

AreaLight makeAreaLight(const scene::Box& casters, const AreaLightSettings& settings) {
    const float diagonal = glm::length(casters.size());
    const glm::vec3 toLight(std::sin(settings.azimuthRad) * std::cos(settings.elevationRad),
                            std::sin(settings.elevationRad),
                            std::cos(settings.azimuthRad) * std::cos(settings.elevationRad));
    // Two edges are horizontal, and across the azimuth also of a light overhead.
    const glm::vec3 right(std::cos(settings.azimuthRad), 0.0F, -std::sin(settings.azimuthRad));
    // A square of diagonal d has half edges of d / √8.
    return {casters.centre() + settings.height * diagonal * toLight,
            glm::mat3(right, glm::cross(toLight, right), toLight),
            settings.sizeRatio * diagonal / std::sqrt(8.0F), casters, settings.viewFrame};
}

kit::View lightView(const AreaLight& light, const glm::vec3& point, int sizePx) {
    const scene::Box& box = light.casters;
    const float diagonal = glm::length(box.size());
    glm::mat3 axes = light.axes;
    if (light.viewFrame == LightViewFrame::Aimed) {
        axes[2] = glm::normalize(point - box.centre());
        axes[0] = glm::normalize(glm::cross(light.axes[1], axes[2]));
        axes[1] = glm::cross(axes[2], axes[0]);
    }
    float nearest = std::numeric_limits<float>::infinity();
    float farthest = 0.0F;
    glm::vec2 least(std::numeric_limits<float>::infinity());  // tangents that hold every corner
    glm::vec2 most = -least;
    for (int index = 0; index < 8; ++index) {
        const glm::vec3 offset = glm::transpose(axes) * (box.corner(index) - point);
        const float depth = -offset.z;
        if (depth < kLeastDepth * diagonal) {
            throw Error(fmt::format(
                "the scene's box comes within {:.3g} m of the plane of the light's view from "
                "({:.3g}, {:.3g}, {:.3g}), at least {:.3g} are needed (a twentieth of its "
                "diagonal): raise light_height",
                depth, point.x, point.y, point.z, kLeastDepth * diagonal));
        }
        const glm::vec2 tangents = glm::vec2(offset) / depth;
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
        least = glm::min(least, tangents);
        most = glm::max(most, tangents);
    }
    if (light.viewFrame == LightViewFrame::Aimed) {
        most = glm::max(most, -least);
        least = -most;
    }
    const glm::vec2 middle = 0.5F * (least + most);
    const float half = 0.5F * std::max(most.x - least.x, most.y - least.y) *
                       static_cast<float>(sizePx) /
                       std::max(1.0F, static_cast<float>(sizePx) - 4.0F);
    kit::View view;
    view.eyeWorld = point;
    view.viewFromWorld = glm::translate(glm::mat4(glm::transpose(axes)), -point);
    view.sizePx = glm::ivec2(sizePx);
    view.nearM = std::max(nearest - 0.01F * diagonal, 0.002F * diagonal);
    view.farM = farthest + 0.01F * diagonal;
    const glm::vec2 low = view.nearM * (middle - half), high = view.nearM * (middle + half);
    view.clipFromView = glm::frustum(low.x, high.x, low.y, high.y, view.nearM, view.farM);
    return view;
}

namespace {

void setDepthState() {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace

glm::vec3 forwardOf(const kit::View& view) {
    return -glm::vec3(glm::transpose(view.viewFromWorld)[2]);
}

Receivers renderReceivers(const gl::ShaderLibrary& shaders, const kit::DrawableScene& scene,
                          const kit::View& view) {
    const gl::Pass pass(shaders,
                        {"soft_shadows/receivers.vert.glsl", "soft_shadows/receivers.frag.glsl"},
                        gpu_scene::attributeDefines());
    Receivers receivers{view, gl::Texture::make2D(GL_RGBA32F, view.sizePx),
                        gl::Texture::make2D(GL_RGBA16F, view.sizePx),
                        gl::Texture::make2D(GL_RGBA8, view.sizePx)};
    const gl::Texture depth = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, view.sizePx);
    const gl::Texture* colours[] = {&receivers.positions, &receivers.normals, &receivers.shading};
    const gl::Framebuffer framebuffer(colours, &depth);
    framebuffer.bind();
    for (int attachment = 0; attachment < 3; ++attachment) {
        framebuffer.clearColour(attachment, glm::vec4(0.0F));
    }
    framebuffer.clearDepth(1.0F);
    setDepthState();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    pass.set("clipFromWorld", view.clipFromWorld());
    pass.set("eyeWorld", view.eyeWorld);
    scene.draw(pass, {});
    return receivers;
}

LightVisibility::LightVisibility(const gl::ShaderLibrary& shaders,
                                 const SampleMapSettings& settings)
    : settings_(settings),
      shadowMap_(gl::Texture::make2D(GL_DEPTH_COMPONENT32F, glm::ivec2(settings.sizePx))),
      framebuffer_(std::span<const gl::Texture* const>(), &shadowMap_),
      test_(shaders, {"kit/whole_image.vert.glsl", "soft_shadows/shadow_test.frag.glsl"}),
      plainPass_(shaders, {"kit/whole_image.vert.glsl", "soft_shadows/plain_pass.frag.glsl"}) {}

VisibilityMask LightVisibility::makeMask(glm::ivec2 sizePx, int gridSize) {
    VisibilityMask mask;
    mask.sampleCount = gridSize * gridSize;
    for (int first = 0; first < mask.sampleCount; first += 32) {
        VisibilityMask::Layer layer;
        layer.bits = gl::Texture::make2D(GL_R32UI, sizePx);
        const gl::Texture* target[] = {&layer.bits};
        layer.framebuffer = gl::Framebuffer(target);
        mask.layers.push_back(std::move(layer));
    }
    return mask;
}

void LightVisibility::accumulate(VisibilityMask& mask, const Receivers& receivers,
                                 const AreaLight& light, int gridSize,
                                 std::span<const ShadowCaster* const> casters) const {
    for (VisibilityMask::Layer& layer : mask.layers) layer.bits.clearToZero();
    for (int j = 0; j < gridSize; ++j) {
        for (int i = 0; i < gridSize; ++i) {
            const kit::View view = lightView(light, light.sample(i, j, gridSize), settings_.sizePx);
            drawShadowMap(view, casters);
            test(mask, j * gridSize + i, receivers, view);
        }
    }
}

void LightVisibility::drawMapsAndPlainPasses(VisibilityMask& mask, const AreaLight& light,
                                             int gridSize,
                                             std::span<const ShadowCaster* const> casters) const {
    for (int sample = 0; sample < mask.sampleCount; ++sample) {
        drawShadowMap(lightView(light, light.sample(sample % gridSize, sample / gridSize, gridSize),
                                settings_.sizePx),
                      casters);
        plainPass_.use();
        plainPass_.set("bit", 1U << (sample % 32));
        drawBits(mask, sample);
    }
}

void LightVisibility::drawShadowMap(const kit::View& lightView,
                                    std::span<const ShadowCaster* const> casters) const {
    framebuffer_.bind();
    setDepthState();
    framebuffer_.clearDepth(1.0F);
    for (const ShadowCaster* caster : casters) caster->draw(lightView);
}

float LightVisibility::biasPerDistance(const kit::View& lightView) const {
    return settings_.biasTexels * kit::footprintPerDepth(lightView);
}

void LightVisibility::test(VisibilityMask& mask, int sample, const Receivers& receivers,
                           const kit::View& lightView) const {
    test_.set("clipFromWorld", lightView.clipFromWorld());
    test_.set("lightPosition", lightView.eyeWorld);
    test_.set("biasPerDistance", biasPerDistance(lightView));
    const glm::mat4 axes = glm::transpose(lightView.viewFromWorld);
    test_.set("lightRight", glm::vec3(axes[0]));
    test_.set("lightUp", glm::vec3(axes[1]));
    test_.set("texelPerDistance", kit::footprintPerDepth(lightView));
    test_.set("nearM", lightView.nearM);
    test_.set("farM", lightView.farM);
    test_.set("bit", 1U << (sample % 32));
    test_.use({{"shadowMap", shadowMap_},
               {"positions", receivers.positions},
               {"normals", receivers.normals}});
    drawBits(mask, sample);
}

/// A fragment of the program in use for every pixel; the bits that it puts out are added.
void LightVisibility::drawBits(VisibilityMask& mask, int sample) const {
    mask.layers[static_cast<std::size_t>(sample / 32)].framebuffer.bind();
    // Bits gather without being read: faster than images in a compute pass on llvmpipe.
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(GL_OR);
    wholeImage_.draw();
    glDisable(GL_COLOR_LOGIC_OP);
}

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
                                 const SampleMapSettings& settings)
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
    filter_.set("halfLight", light.halfEdge);
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
