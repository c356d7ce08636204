#include "techniques/shadow_mapping/shadow_map.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"

namespace gfxrepro::shadow_mapping {
namespace {

struct DepthFormatInfo {
    GLenum glFormat;
    const char* name;
};
/// Of each DepthFormat.
constexpr DepthFormatInfo kDepthFormats[] = {{GL_DEPTH_COMPONENT16, "DEPTH16"},
                                             {GL_DEPTH_COMPONENT24, "DEPTH24"},
                                             {GL_DEPTH_COMPONENT32F, "DEPTH32F"}};

void check(const ShadowMapSettings& settings) {
    constexpr int kLargestPx = 1 << 20;  // three of them fit into an int; the device allows fewer
    if (settings.sizePx < 1 || settings.sizePx > kLargestPx) {
        throw Error(fmt::format("a shadow map of {} pixels: 1 to {}", settings.sizePx, kLargestPx));
    }
    const Bias& bias = settings.bias;
    for (const float value : {bias.constant, bias.slopeScale}) {
        if (!(value >= 0.0F && std::isfinite(value))) {
            throw Error(fmt::format("a shadow bias of {}: 0 or more, finite", value));
        }
    }
    if (settings.filter == Filter::Variance && settings.storage == Storage::Hardware) {
        throw Error(
            "variance shadow maps hold moments, which a depth texture cannot: their storage "
            "is standard");
    }
}

StepDeclaration depthMapStep(const ShadowMapSettings& settings) {
    StepDeclaration step{.step = "depth map",
                         .target = kDepthFormats[static_cast<std::size_t>(settings.format)].name,
                         .depthWrites = true};
    if (settings.storage == Storage::Standard) {
        step.target = settings.filter == Filter::Variance ? "RG32F" : "R32F";
        step.colourWrites = true;
        step.fragmentWork = true;
    }
    return step;
}

StepDeclaration shadingStep(const ShadowMapSettings& settings) {
    StepDeclaration step{.step = "shading",
                         .target = "RGBA16F",
                         .colourWrites = true,
                         .depthWrites = true,
                         .fragmentWork = true};
    const int kernel = kernelSizeOf(settings.filter);
    step.fetches = step.comparisons = kernel * kernel;
    if (settings.filter == Filter::Pcss) {
        step.fetches = step.comparisons = 2 * kernel * kernel;  // blockers, then their penumbra
    } else if (settings.storage == Storage::Hardware) {
        // The texture unit compares, and weighs the four comparisons of a filtered fetch.
        step.comparisons = 0;
        if (settings.filter == Filter::Bilinear) step.fetches = 1;
    }
    return step;
}

}  // namespace

int kernelSizeOf(Filter filter) {
    static constexpr int kSizes[] = {1, 2, kFilterTexels, 7, 1};
    return kSizes[static_cast<std::size_t>(filter)];
}

std::vector<StepDeclaration> declaredSteps(const ShadowMapSettings& settings) {
    check(settings);
    std::vector<StepDeclaration> steps{depthMapStep(settings)};
    if (settings.filter == Filter::Variance) {
        for (const char* name : {"blur along x", "blur along y"}) {
            steps.push_back({.step = name,
                             .target = "RG32F",
                             .colourWrites = true,
                             .fragmentWork = true,
                             .fetches = kFilterTexels});
        }
    }
    steps.push_back(shadingStep(settings));
    return steps;
}

void applyState(const StepDeclaration& step) {
    const GLboolean colour = step.colourWrites ? GL_TRUE : GL_FALSE;
    glColorMask(colour, colour, colour, colour);
    glDepthMask(step.depthWrites ? GL_TRUE : GL_FALSE);
    if (step.depthWrites) {
        glEnable(GL_DEPTH_TEST);
    } else {
        glDisable(GL_DEPTH_TEST);
    }
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

namespace {

gl::Program makeDepthProgram(const gl::ShaderLibrary& shaders, const StepDeclaration& step,
                             const ShadowMapSettings& settings) {
    gl::Defines defines = gpu_scene::attributeDefines();
    defines["FRAGMENT_WORK"] = step.fragmentWork ? 1 : 0;
    defines["MOMENTS"] = settings.filter == Filter::Variance ? 1 : 0;
    defines["SLOPE"] = settings.bias.slopeScale > 0.0F ? 1 : 0;
    std::vector<std::string> files{"shadow_mapping/depth_map.vert.glsl"};
    if (step.fragmentWork) files.emplace_back("shadow_mapping/depth_map.frag.glsl");
    return {shaders, files, defines};
}

/// One comparison reads a texel whose centre is at most half a texel away, PCF as many times as far
/// as its square is texels wide: with the bias of one its outer texels shade every slope.
float slopeScaleOf(const ShadowMapSettings& settings) {
    const int texels = settings.filter == Filter::Pcf ? kFilterTexels : 1;
    return settings.bias.slopeScale * static_cast<float>(texels);
}

gl::Framebuffer framebufferOf(const gl::Texture& colour, const gl::Texture* depth = nullptr) {
    const gl::Texture* colours[] = {&colour};
    return gl::Framebuffer(colours, depth);
}

}  // namespace

std::size_t ShadowMap::sizeBytes() const {
    return colour.sizeBytes() + blurred.sizeBytes() + depth.sizeBytes();
}

ShadowMapRenderer::ShadowMapRenderer(const gl::ShaderLibrary& shaders,
                                     const ShadowMapSettings& settings)
    : settings_(settings),
      steps_(declaredSteps(settings)),
      depthProgram_(makeDepthProgram(shaders, steps_.front(), settings)) {
    if (settings.filter == Filter::Variance) {
        blur_.emplace(shaders,
                      std::vector<std::string>{"kit/whole_image.vert.glsl",
                                               "shadow_mapping/blur_moments.frag.glsl"},
                      gl::Defines{{"FETCHES", kFilterTexels}});
    }
}

ShadowMap ShadowMapRenderer::makeMap(glm::ivec2 sizePx) const {
    ShadowMap map;
    map.depth = gl::Texture::make2D(
        kDepthFormats[static_cast<std::size_t>(settings_.format)].glFormat, sizePx);
    if (!steps_.front().colourWrites) {
        if (steps_.back().comparisons == 0) {
            // [zju2005] Sec. 4.3: a fetch compares, and gives 0 where the map is less.
            glTextureParameteri(map.depth.id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
            glTextureParameteri(map.depth.id(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
        }
        if (settings_.filter == Filter::Bilinear) map.depth.setFilter(GL_LINEAR, GL_LINEAR);
        map.framebuffer = gl::Framebuffer(std::span<const gl::Texture* const>(), &map.depth);
        return map;
    }
    const bool isVariance = settings_.filter == Filter::Variance;
    map.colour = gl::Texture::make2D(isVariance ? GL_RG32F : GL_R32F, sizePx);
    map.framebuffer = framebufferOf(map.colour, &map.depth);
    if (isVariance) {
        map.colour.setFilter(GL_LINEAR, GL_LINEAR);  // moments may be averaged, depths may not
        map.blurred = gl::Texture::make2D(GL_RG32F, sizePx);
        map.blurredFramebuffer = framebufferOf(map.blurred);
        map.colourFramebuffer = framebufferOf(map.colour);
    }
    return map;
}

void ShadowMapRenderer::render(const kit::DrawableScene& scene, std::span<const Light> lights) {
    if (lights.size() > kMaxLights) {
        throw Error(fmt::format("{} lights with shadows: at most {}", lights.size(), kMaxLights));
    }
    lights_.assign(lights.begin(), lights.end());
    maps_.resize(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        std::vector<LightView> views = viewsOf(lights[i], scene.bounds(), settings_.sizePx);
        const glm::ivec2 sizePx = tileCountOf(lights[i].kind) * settings_.sizePx;
        if (glm::ivec2(maps_[i].depth.size()) != sizePx) maps_[i] = makeMap(sizePx);
        maps_[i].views = std::move(views);
        drawDepth(scene, maps_[i]);
        if (blur_) blur(maps_[i]);
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
}

void ShadowMapRenderer::drawDepth(const kit::DrawableScene& scene, const ShadowMap& map) const {
    const StepDeclaration& step = steps_.front();
    applyState(step);
    map.framebuffer.bind();
    map.framebuffer.clearDepth(1.0F);
    if (step.colourWrites) map.framebuffer.clearColour(0, glm::vec4(1.0F));
    depthProgram_.use();
    const float slopeScale = slopeScaleOf(settings_);
    if (slopeScale > 0.0F) {
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(slopeScale, 0.0F);
    }
    for (const LightView& view : map.views) {
        glViewport(view.tilePx.x, view.tilePx.y, view.tileSizePx.x, view.tileSizePx.y);
        depthProgram_.set("clipFromWorld", view.clipFromWorld);
        depthProgram_.setIfActive("slopeScale", slopeScale);
        depthProgram_.setIfActive("planes", glm::vec3(view.nearM, view.farM, view.isPerspective));
        scene.drawDepthOnly();
    }
}

void ShadowMapRenderer::blur(const ShadowMap& map) const {
    const auto pass = [&](const StepDeclaration& step, const gl::Texture& from,
                          const gl::Framebuffer& to, glm::ivec2 along) {
        applyState(step);
        to.bind();
        blur_->use({{"moments", from}});
        blur_->set("along", along);
        for (const LightView& view : map.views) {
            glViewport(view.tilePx.x, view.tilePx.y, view.tileSizePx.x, view.tileSizePx.y);
            blur_->set("firstTexel", view.tilePx);
            blur_->set("lastTexel", view.tilePx + view.tileSizePx - 1);
            wholeImage_.draw();
        }
    };
    pass(steps_[1], map.colour, map.blurredFramebuffer, {1, 0});
    pass(steps_[2], map.blurred, map.colourFramebuffer, {0, 1});
}

std::size_t ShadowMapRenderer::sizeBytes() const {
    std::size_t sum = 0;
    for (const ShadowMap& map : maps_) sum += map.sizeBytes();
    return sum;
}

}  // namespace gfxrepro::shadow_mapping
