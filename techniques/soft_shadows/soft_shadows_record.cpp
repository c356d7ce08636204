#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/load.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/kit/picture.h"
#include "techniques/soft_shadows/outputs.h"
#include "techniques/soft_shadows/soft_shadows.h"

namespace gfxrepro::soft_shadows {
namespace {

/// Shares of the light against samples of it. Only the sum of a pixel's errors is known.
ShadowErrors compareShares(const std::vector<float>& measured, const HostVisibilityMask& truth) {
    const std::vector<float> shares = litShares(truth);
    ShadowErrors errors;
    errors.signedIntensity.resize(shares.size());
    for (std::size_t pixel = 0; pixel < shares.size(); ++pixel) {
        errors.signedIntensity[pixel] = 256.0F * (measured[pixel] - shares[pixel]);
        const double magnitude = std::abs(errors.signedIntensity[pixel]);
        errors.intensityMean += magnitude / static_cast<double>(shares.size());
        errors.intensityMax = std::max(errors.intensityMax, magnitude);
    }
    return errors;
}

/// Window depths as seen from the light: how much of what the geometry shows the casters show, too.
struct LightViewAgreement {
    std::size_t covered = 0;  // pixels where the geometry is
    std::size_t missing = 0;  // … and the casters are farther away or nothing
    std::size_t nearer = 0;   // … and they are nearer
};

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

/// Depths lit by the slope of the depth, rows from the top; background where there is nothing.
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

}  // namespace

HostVisibilityMask SoftShadows::measuredMask() const {
    return params_.method == Method::RayTraced ? *tracedMask_ : readMask(mask_);
}

const HostVisibilityMask& SoftShadows::geometryTruth() {
    if (!geometryTruth_) {
        VisibilityMask mask = LightVisibility::makeMask(receivers_.view.sizePx, params_.lightGrid);
        const ShadowCaster* casters[] = {&*geometry_};
        visibility_->accumulate(mask, receivers_, light_, params_.lightGrid, casters);
        geometryTruth_ = readMask(mask);
    }
    return *geometryTruth_;
}

const HostVisibilityMask& SoftShadows::tracedTruth() {
    if (!tracedTruth_) {
        tracedTruth_ = traceVisibility(*tracer_, hostReceivers_, light_, params_.lightGrid);
    }
    return *tracedTruth_;
}

void SoftShadows::record(technique::Recorder& recorder) {
    recorder.metric("coverage_pct",
                    kit::percent(hostReceivers_.covered(), hostReceivers_.positions.size()), "%");
    if (params_.measuresErrors) recordErrors(recorder, "geometry", geometryTruth());
    if (params_.tracesTruth) recordErrors(recorder, "ray_traced", tracedTruth());
    if (params_.method != Method::RayTraced) {
        const ShadowCaster& caster = caster_ ? *caster_ : *geometry_;
        recorder.metric("caster_triangles", static_cast<double>(caster.triangleCount()),
                        "triangle");
    }
    if (params_.reconstructs()) recordMeshes(recorder);
    if (params_.showsPictures) recordPicture(recorder);
    if (!params_.seesFromLight) return;
    recordLightView(recorder, "inside", light_.centre);
    // As far beyond the edge as the edge is from the centre, seen from there.
    recordLightView(recorder, "outside", light_.centre + 2.0F * light_.right);
}

void SoftShadows::recordPicture(technique::Recorder& recorder) {
    const std::vector<float> shares = params_.isFiltered()
                                          ? litShares_.read<float>(GL_RED, GL_FLOAT, 1)
                                          : litShares(measuredMask());
    const image::ImageF picture = shadowPicture(hostReceivers_, shares);
    const std::vector<glm::vec3> normals(hostReceivers_.normals.begin(),
                                         hostReceivers_.normals.end());
    kit::ImageLayers layers(receivers_.view);
    layers.pointDepths(hostReceivers_.positions).normals(normals);
    const auto addErrors = [&](const HostVisibilityMask& truth, const char* name) {
        layers.errors(picture, shadowPicture(hostReceivers_, litShares(truth)), name);
    };
    if (params_.tracesTruth) {
        addErrors(tracedTruth(), "truth_ray_traced");
    } else if (params_.measuresErrors) {
        addErrors(geometryTruth(), "truth_geometry");
    }
    recorder.image("shadow", picture, layers.options());
}

void SoftShadows::recordErrors(technique::Recorder& recorder, const char* truthName,
                               const HostVisibilityMask& truth) {
    const ShadowErrors errors =
        params_.isFiltered() ? compareShares(litShares_.read<float>(GL_RED, GL_FLOAT, 1), truth)
                             : compareMasks(measuredMask(), truth);
    recorder.metric("intensity_error_mean", errors.intensityMean, "light sample", truthName);
    recorder.metric("intensity_error_max", errors.intensityMax, "light sample", truthName);
    if (!params_.isFiltered()) {
        recorder.metric("visibility_error_mean", errors.visibilityMean, "light sample", truthName);
        recorder.metric("visibility_error_max", errors.visibilityMax, "light sample", truthName);
        recorder.metric("wrongly_lit_mean", errors.wronglyLitMean, "light sample", truthName);
        recorder.metric("wrongly_dark_mean", errors.wronglyDarkMean, "light sample", truthName);
    }
    if (params_.showsPictures) {
        recorder.image(fmt::format("error_{}", truthName),
                       errorPicture(hostReceivers_, errors.signedIntensity),
                       kit::seenFrom(receivers_.view));
        recorder.image(fmt::format("truth_{}", truthName),
                       shadowPicture(hostReceivers_, litShares(truth)),
                       kit::seenFrom(receivers_.view, "shadow"));
    }
}

void SoftShadows::recordMeshes(technique::Recorder& recorder) const {
    MeshCounts total;
    for (const MeshCounts& mesh : meshCounts_) {
        total.samples += mesh.samples;
        total.triangles += mesh.triangles;
        total.bytes += mesh.bytes;
        total.fittedCorners += mesh.fittedCorners;
        total.sharedCorners += mesh.sharedCorners;
    }
    const auto ratio = [](std::uint64_t part, std::uint64_t whole) {
        return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    recorder.metric("reference_samples", static_cast<double>(total.samples), "sample");
    recorder.metric("mesh_triangles", static_cast<double>(total.triangles), "triangle");
    recorder.metric("mesh_bytes", static_cast<double>(total.bytes), "byte");
    recorder.metric("bytes_per_sample", ratio(total.bytes, total.samples), "byte");
    recorder.metric("fitted_corners_pct",
                    100.0 * ratio(total.fittedCorners, total.fittedCorners + total.sharedCorners),
                    "%");
    if (params_.simplifyTo < 1.0F) {
        recorder.metric("simplification_error", simplificationErrorM_, "m");
    }
    if (!params_.exportsMesh) return;
    const auto* caster = dynamic_cast<const ReconstructedCaster*>(caster_.get());
    if (!caster) return;
    for (std::size_t i = 0; i < caster->meshes().size(); ++i) {
        scene::savePly(recorder.artifact(fmt::format("mesh_{}.ply", i)),
                       scene::sceneOf(toWorldMesh(caster->meshes()[i])));
    }
}

// Figures 18 and 19: the casters against the geometry, seen from a point of the light and from one
// outside of it.
void SoftShadows::recordLightView(technique::Recorder& recorder, const char* name,
                                  const glm::vec3& point) const {
    const kit::View view = lightView(light_, point, params_.shadowMap.sizePx);
    const auto depthsOf = [&](const ShadowCaster& caster) {
        const ShadowCaster* casters[] = {&caster};
        visibility_->drawShadowMap(view, casters);
        return visibility_->shadowMap().read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1);
    };
    const std::vector<float> truth = depthsOf(*geometry_);
    const std::vector<float> measured = caster_ ? depthsOf(*caster_) : truth;
    LightViewAgreement agreement;
    for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
        if (truth[pixel] == 1.0F) continue;
        const float depth = eyeDepth(view, truth[pixel]);
        if (!isOfCasters(view, light_.casters, pixel, depth)) continue;
        ++agreement.covered;
        const float difference = eyeDepth(view, measured[pixel]) - depth;
        const float tolerance = toleranceAt(view, depth, params_.referenceSizePx);
        agreement.missing += measured[pixel] == 1.0F || difference > tolerance ? 1 : 0;
        agreement.nearer += difference < -tolerance ? 1 : 0;
    }
    const auto ofCovered = [&](const char* metric, std::size_t part) {
        recorder.share(metric, static_cast<double>(part), static_cast<double>(agreement.covered),
                       "pixel", name);
    };
    ofCovered("missing_pct", agreement.missing);
    ofCovered("nearer_pct", agreement.nearer);
    if (!params_.showsPictures) return;
    const std::string casters = fmt::format("casters_{}", name);
    const auto record = [&](const std::string& imageName, const std::vector<float>& windowDepths,
                            const std::string& truthOf) {
        recorder.image(imageName, depthPicture(view, windowDepths),
                       kit::ImageLayers(view).windowDepths(windowDepths).options(truthOf));
    };
    record(casters, measured, "");
    record(fmt::format("geometry_{}", name), truth, casters);
}

namespace {
std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<SoftShadows>(params);
}
}  // namespace

const technique::TechniqueInfo kSoftShadows{
    "soft_shadows", "soft shadows of a rectangular light from reconstructed depth images", create,
    outputs};

}  // namespace gfxrepro::soft_shadows
