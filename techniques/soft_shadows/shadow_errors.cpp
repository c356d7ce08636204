#include "techniques/soft_shadows/shadow_errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "techniques/kit/depth_image_renderer.h"
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

/// Distance along the view's axis from window depth.
float eyeDepth(const kit::View& view, float windowDepth) {
    const float ndc = 2.0F * windowDepth - 1.0F;
    return 2.0F * view.nearM * view.farM /
           (view.farM + view.nearM - ndc * (view.farM - view.nearM));
}

/// Whether what a pixel shows lies in the casters' box: no view has to hold the floor.
bool isOfCasters(const kit::View& view, const scene::Box& casters, std::size_t pixel, float depth) {
    const auto width = static_cast<std::size_t>(view.sizePx.x);
    const glm::vec2 position(static_cast<float>(pixel % width), static_cast<float>(pixel / width));
    const glm::vec3 point = kit::unproject(view, position + 0.5F, depth);
    // Half the way down to the floor: window depths are rounded.
    const float margin = 5e-4F * glm::length(casters.size());
    return glm::all(glm::greaterThan(point, casters.min - margin)) &&
           glm::all(glm::lessThan(point, casters.max + margin));
}

/// Two texels of distance: less is the resolution of the reference images.
float toleranceAt(const kit::View& view, float depth, int referenceSizePx) {
    return 2.0F * 2.0F * depth / (view.clipFromView[0].x * static_cast<float>(referenceSizePx));
}

/// The triangle that the eye sees at a point of the picture.
unsigned triangleSeen(const raycast::RayTracer& tracer, const glm::vec3& eye,
                      const glm::vec3& point) {
    const auto hit = tracer.closestHit(
        eye, point - eye, 0.0F, std::numeric_limits<float>::infinity(), raycast::Faces::Drawn);
    return hit ? hit->flattenedTriangle : raycast::kNoTriangle;
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
    return {receivers.view.sizePx, receivers.view.eyeWorld,
            receivers.positions.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1),
            receivers.normals.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1),
            receivers.shading.read<glm::u8vec4>(GL_RGBA, GL_UNSIGNED_BYTE, 1)};
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
    const float offset = 1e-5F * glm::length(light.casters.size());
    tbb::parallel_for(std::size_t{0}, mask.pixelCount(), [&](std::size_t pixel) {
        const bool isSurface = receivers.positions[pixel].w != 0.0F;
        const glm::vec3 origin(receivers.positions[pixel]);
        const unsigned own =
            isSurface ? triangleSeen(tracer, receivers.eyeWorld, origin) : raycast::kNoTriangle;
        for (int sample = 0; sample < mask.sampleCount; ++sample) {
            const glm::vec3 toLight =
                light.sample(sample % gridSize, sample / gridSize, gridSize) - origin;
            // A surface that is turned away lies in its own shadow: no ray is needed.
            const bool isTurnedAway =
                glm::dot(glm::vec3(receivers.normals[pixel]), toLight) <= 0.0F;
            if (isSurface &&
                (isTurnedAway || tracer.isOccluded(origin, toLight, offset, glm::length(toLight),
                                                   raycast::Faces::All, own))) {
                continue;
            }
            mask.bits[static_cast<std::size_t>(sample / 32) * mask.pixelCount() + pixel] |=
                1U << (sample % 32);
        }
    });
    return mask;
}

VisibilityErrors compareMasks(const HostVisibilityMask& measured, const HostVisibilityMask& truth) {
    GFXREPRO_ASSERT_EQ(measured.bits.size(), truth.bits.size());
    GFXREPRO_ASSERT_EQ(measured.sampleCount, truth.sampleCount);
    const std::size_t pixels = truth.pixelCount();
    const double scale = 256.0 / truth.sampleCount;
    VisibilityErrors errors;
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

VisibilityErrors compareShares(const std::vector<float>& measured,
                               const HostVisibilityMask& truth) {
    const std::vector<float> shares = litShares(truth);
    VisibilityErrors errors;
    errors.signedIntensity.resize(shares.size());
    for (std::size_t pixel = 0; pixel < shares.size(); ++pixel) {
        errors.signedIntensity[pixel] = 256.0F * (measured[pixel] - shares[pixel]);
        const double magnitude = std::abs(errors.signedIntensity[pixel]);
        errors.intensityMean += magnitude / static_cast<double>(shares.size());
        errors.intensityMax = std::max(errors.intensityMax, magnitude);
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

LightViewAgreement compareDepths(const kit::View& view, const scene::Box& casters,
                                 const std::vector<float>& truth,
                                 const std::vector<float>& measured, int referenceSizePx) {
    LightViewAgreement agreement;
    for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
        if (truth[pixel] == 1.0F) continue;
        const float depth = eyeDepth(view, truth[pixel]);
        if (!isOfCasters(view, casters, pixel, depth)) continue;
        ++agreement.covered;
        const float difference = eyeDepth(view, measured[pixel]) - depth;
        const float tolerance = toleranceAt(view, depth, referenceSizePx);
        agreement.missing += measured[pixel] == 1.0F || difference > tolerance ? 1 : 0;
        agreement.nearer += difference < -tolerance ? 1 : 0;
    }
    return agreement;
}

image::ImageF depthPicture(const kit::View& view, const std::vector<float>& windowDepths) {
    const glm::ivec2 size = view.sizePx;
    const auto depthAt = [&](int x, int y) {
        x = std::min(x, size.x - 1);
        y = std::min(y, size.y - 1);
        return windowDepths[static_cast<std::size_t>(y * size.x + x)];
    };
    const auto pointAt = [&](int x, int y) {
        return kit::unproject(view, glm::vec2(x, y) + 0.5F, eyeDepth(view, depthAt(x, y)));
    };
    return kit::pictureOf(size, [&](std::size_t pixel) {
        const int x = static_cast<int>(pixel) % size.x, y = static_cast<int>(pixel) / size.x;
        if (depthAt(x, y) >= 1.0F) return kit::kBackground;
        const glm::vec3 normal =
            glm::cross(pointAt(x + 1, y) - pointAt(x, y), pointAt(x, y + 1) - pointAt(x, y));
        const float length = glm::length(normal);
        const float lit =
            length > 0.0F ? std::abs(glm::dot(normal, kit::kLightDirectionWorld)) / length : 0.0F;
        return glm::vec3(0.15F + 0.7F * lit);
    });
}

}  // namespace gfxrepro::soft_shadows
