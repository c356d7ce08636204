#include "techniques/soft_shadows/light_visibility.h"

#include "engine/gpu_scene/gpu_mesh.h"

namespace gfxrepro::soft_shadows {
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
                                 const ShadowMapSettings& settings)
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

}  // namespace gfxrepro::soft_shadows
