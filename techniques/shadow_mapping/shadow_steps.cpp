#include "techniques/shadow_mapping/shadow_steps.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"

namespace gfxrepro::shadow_mapping {
namespace {

void check(const ShadowMapSettings& settings) {
    constexpr int kLargestPx = 1 << 20;  // three of them fit into an int; the device allows fewer
    if (settings.sizePx < 1 || settings.sizePx > kLargestPx) {
        throw Error(fmt::format("a shadow map of {} pixels: 1 to {}", settings.sizePx, kLargestPx));
    }
    const Bias& bias = settings.bias;
    for (const float value : {bias.constant, bias.slopeScale, bias.normalOffsetTexels}) {
        if (!(value >= 0.0F && std::isfinite(value))) {
            throw Error(fmt::format("a shadow bias of {}: 0 or more, finite", value));
        }
    }
    if (settings.filter != Filter::Variance) return;
    if (settings.storage == Storage::Hardware) {
        throw Error(
            "variance shadow maps hold moments, which a depth texture cannot: their storage "
            "is standard");
    }
    if (settings.blurTexels < 1 || settings.blurTexels % 2 == 0) {
        throw Error(fmt::format("a blur over {} texels: an odd number", settings.blurTexels));
    }
}

std::string nameOf(DepthFormat format) {
    switch (format) {
        case DepthFormat::Unorm16:
            return "DEPTH16";
        case DepthFormat::Unorm24:
            return "DEPTH24";
        case DepthFormat::Float32:
            return "DEPTH32F";
    }
    return "";
}

StepDeclaration depthMapStep(const ShadowMapSettings& settings) {
    StepDeclaration step{
        .step = "depth map", .target = nameOf(settings.format), .depthWrites = true};
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
    switch (filter) {
        case Filter::Nearest:
        case Filter::Variance:
            return 1;
        case Filter::Bilinear:
            return 2;
        case Filter::Pcf3:
            return 3;
        case Filter::Pcf5:
            return 5;
        case Filter::Pcf7:
        case Filter::Pcss:
            return 7;
    }
    return 1;
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
                             .fetches = settings.blurTexels});
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

}  // namespace gfxrepro::shadow_mapping
