// Visibility masks on the host: by shadow rays, and compared.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/soft_shadows/light_visibility.h"

namespace gfxrepro::soft_shadows {

struct HostReceivers {
    glm::ivec2 sizePx{0};
    glm::vec3 eyeWorld{0.0F};
    std::vector<glm::vec4> positions, normals;  // as in Receivers, rows from the bottom
    std::vector<glm::u8vec4> shading;

    /// Pixels that show a surface.
    std::size_t covered() const;
};

/// As VisibilityMask, layer by layer, rows from the bottom.
struct HostVisibilityMask {
    glm::ivec2 sizePx{0};
    int sampleCount = 0;
    std::vector<std::uint32_t> bits;

    std::size_t pixelCount() const {
        return static_cast<std::size_t>(sizePx.x) * static_cast<std::size_t>(sizePx.y);
    }
    std::size_t sizeBytes() const { return bits.size() * sizeof(std::uint32_t); }
    /// Light samples that a pixel sees.
    int litSamples(std::size_t pixel) const;
};

HostReceivers readReceivers(const Receivers& receivers);
HostVisibilityMask readMask(const VisibilityMask& mask);

/// The same bits by shadow rays. No shadow map and no bias: the triangle that a pixel shows casts
/// no shadow on it, and rays begin 10⁻⁵ of the casters' diagonal away. On all cores.
HostVisibilityMask traceVisibility(const raycast::RayTracer& tracer, const HostReceivers& receivers,
                                   const AreaLight& light, int gridSize);

/// Errors of a mask against the truth ([xie2017] Sec. 3.4.2), mean and maximum over all pixels of
/// the output image, background included, in light samples of 256 whatever their true number.
struct VisibilityErrors {
    double visibilityMean = 0.0, visibilityMax = 0.0;  // wrong samples
    double intensityMean = 0.0, intensityMax = 0.0;    // |wrongly lit − wrongly dark|
    double wronglyLitMean = 0.0, wronglyDarkMean = 0.0;
    std::vector<float> signedIntensity;  // a pixel: wrongly lit − wrongly dark
};
VisibilityErrors compareMasks(const HostVisibilityMask& measured, const HostVisibilityMask& truth);
/// Shares of the light against samples of it. Only the sum of a pixel's errors is known.
VisibilityErrors compareShares(const std::vector<float>& measured, const HostVisibilityMask& truth);

/// The share of the light that each pixel sees, 0 … 1.
std::vector<float> litShares(const HostVisibilityMask& mask);

/// The shadowed image: surface colour · (0.15 + 0.85 · share), rows from the top; no cosine, so
/// that the picture shows visibility alone.
image::ImageF shadowPicture(const HostReceivers& receivers, const std::vector<float>& litShares);

/// As figure 16: green where too bright, red where too dark, over the darkened surface; an error of
/// 64 light samples has the full colour.
image::ImageF errorPicture(const HostReceivers& receivers,
                           const std::vector<float>& signedIntensity);

/// Window depths as seen from the light: how much of what the geometry shows the casters show, too.
struct LightViewAgreement {
    std::size_t covered = 0;  // pixels where the geometry is
    std::size_t missing = 0;  // … and the casters are farther away or nothing
    std::size_t nearer = 0;   // … and they are nearer
};

/// Of the geometry and the casters, where the geometry lies in the casters' box. Casters count as
/// off by more than two texels of reference images of `referenceSizePx`².
LightViewAgreement compareDepths(const kit::View& view, const scene::Box& casters,
                                 const std::vector<float>& truth,
                                 const std::vector<float>& measured, int referenceSizePx);

/// Depths lit by the slope of the depth, rows from the top; background where there is nothing.
image::ImageF depthPicture(const kit::View& view, const std::vector<float>& windowDepths);

}  // namespace gfxrepro::soft_shadows
