#include "techniques/soft_shadows/shadow_errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/error.h"
#include "techniques/kit/picture.h"

namespace gfxrepro::soft_shadows {
namespace {

/// Layer l of the bits that count: all but those beyond the last sample.
std::uint32_t validBits(int sampleCount, std::size_t layer) {
    const int rest = sampleCount - 32 * static_cast<int>(layer);
    return rest >= 32 ? 0xFFFFFFFFU : (1U << rest) - 1U;
}

std::size_t layersOf(const HostVisibilityMask& mask) {
    return static_cast<std::size_t>((mask.sampleCount + 31) / 32);
}

}  // namespace

int HostVisibilityMask::litSamples(std::size_t pixel) const {
    int lit = 0;
    for (std::size_t layer = 0; layer < layersOf(*this); ++layer) {
        lit += std::popcount(bits[layer * pixelCount() + pixel] & validBits(sampleCount, layer));
    }
    return lit;
}

std::size_t HostReceivers::covered() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(positions, [](const glm::vec4& p) { return p.w != 0.0F; }));
}

HostReceivers readReceivers(const Receivers& receivers) {
    HostReceivers host;
    host.sizePx = receivers.view.sizePx;
    const auto asVectors = [](const std::vector<float>& values) {
        std::vector<glm::vec4> vectors(values.size() / 4);
        for (std::size_t i = 0; i < vectors.size(); ++i) {
            vectors[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
        }
        return vectors;
    };
    host.positions = asVectors(receivers.positions.read<float>(GL_RGBA, GL_FLOAT, 4));
    host.normals = asVectors(receivers.normals.read<float>(GL_RGBA, GL_FLOAT, 4));
    const auto bytes = receivers.shading.read<std::uint8_t>(GL_RGBA, GL_UNSIGNED_BYTE, 4);
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
        host.shading.emplace_back(bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]);
    }
    return host;
}

HostVisibilityMask readMask(const VisibilityMask& mask) {
    HostVisibilityMask host{glm::ivec2(mask.layers.front().bits.size()), mask.sampleCount, {}};
    for (const VisibilityMask::Layer& layer : mask.layers) {
        const auto bits = layer.bits.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
        host.bits.insert(host.bits.end(), bits.begin(), bits.end());
    }
    return host;
}

HostVisibilityMask traceVisibility(const raycast::RayTracer& tracer, const HostReceivers& receivers,
                                   const AreaLight& light, int gridSize) {
    HostVisibilityMask mask{receivers.sizePx, gridSize * gridSize, {}};
    mask.bits.resize(layersOf(mask) * mask.pixelCount());
    const float offset = 1e-4F * glm::length(light.casters.size());
    tbb::parallel_for(std::size_t{0}, mask.pixelCount(), [&](std::size_t pixel) {
        const bool isSurface = receivers.positions[pixel].w != 0.0F;
        const glm::vec3 origin =
            glm::vec3(receivers.positions[pixel]) + offset * glm::vec3(receivers.normals[pixel]);
        for (int sample = 0; sample < mask.sampleCount; ++sample) {
            const glm::vec3 toLight =
                light.sample(sample % gridSize, sample / gridSize, gridSize) - origin;
            // A surface that is turned away lies in its own shadow: no ray is needed.
            const bool isTurnedAway =
                glm::dot(glm::vec3(receivers.normals[pixel]), toLight) <= 0.0F;
            if (isSurface &&
                (isTurnedAway || tracer.isOccluded(origin, toLight, 0.0F, glm::length(toLight)))) {
                continue;
            }
            mask.bits[static_cast<std::size_t>(sample / 32) * mask.pixelCount() + pixel] |=
                1U << (sample % 32);
        }
    });
    return mask;
}

ShadowErrors compareMasks(const HostVisibilityMask& measured, const HostVisibilityMask& truth) {
    GFXREPRO_ASSERT_EQ(measured.bits.size(), truth.bits.size());
    GFXREPRO_ASSERT_EQ(measured.sampleCount, truth.sampleCount);
    const std::size_t pixels = truth.pixelCount();
    const double scale = 256.0 / truth.sampleCount;
    ShadowErrors errors;
    errors.signedIntensity.resize(pixels);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        int tooBright = 0;
        int tooDark = 0;
        for (std::size_t layer = 0; layer < layersOf(truth); ++layer) {
            const std::uint32_t valid = validBits(truth.sampleCount, layer);
            const std::uint32_t a = measured.bits[layer * pixels + pixel] & valid;
            const std::uint32_t b = truth.bits[layer * pixels + pixel] & valid;
            tooBright += std::popcount(a & ~b);
            tooDark += std::popcount(b & ~a);
        }
        const double visibility = scale * (tooBright + tooDark);
        const double intensity = scale * (tooBright - tooDark);
        errors.visibilityMean += visibility;
        errors.wronglyLitMean += scale * tooBright;
        errors.wronglyDarkMean += scale * tooDark;
        errors.intensityMean += std::abs(intensity);
        errors.visibilityMax = std::max(errors.visibilityMax, visibility);
        errors.intensityMax = std::max(errors.intensityMax, std::abs(intensity));
        errors.signedIntensity[pixel] = static_cast<float>(intensity);
    }
    for (double* mean : {&errors.visibilityMean, &errors.intensityMean, &errors.wronglyLitMean,
                         &errors.wronglyDarkMean}) {
        *mean /= static_cast<double>(pixels);
    }
    return errors;
}

std::vector<float> litShares(const HostVisibilityMask& mask) {
    std::vector<float> shares(mask.pixelCount());
    for (std::size_t pixel = 0; pixel < shares.size(); ++pixel) {
        shares[pixel] =
            static_cast<float>(mask.litSamples(pixel)) / static_cast<float>(mask.sampleCount);
    }
    return shares;
}

image::ImageF shadowPicture(const HostReceivers& receivers, const std::vector<float>& litShares) {
    return kit::pictureOf(receivers.sizePx, [&](std::size_t pixel) {
        if (receivers.positions[pixel].w == 0.0F) return kit::kBackground;
        const glm::vec3 color = glm::vec3(receivers.shading[pixel]) / 255.0F;
        return color * (0.15F + 0.85F * litShares[pixel]);
    });
}

image::ImageF errorPicture(const HostReceivers& receivers,
                           const std::vector<float>& signedIntensity) {
    return kit::pictureOf(receivers.sizePx, [&](std::size_t pixel) {
        constexpr glm::vec3 kLuminance{0.2126F, 0.7152F, 0.0722F};
        const float grey =
            receivers.positions[pixel].w == 0.0F
                ? 0.0F
                : 0.25F * glm::dot(glm::vec3(receivers.shading[pixel]) / 255.0F, kLuminance);
        const float error = std::clamp(signedIntensity[pixel] / 64.0F, -1.0F, 1.0F);
        const glm::vec3 color = error > 0.0F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        return glm::mix(glm::vec3(grey), color, std::abs(error));
    });
}

}  // namespace gfxrepro::soft_shadows
