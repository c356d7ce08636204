#include "techniques/clustered_reflections/reflection_params.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <glm/trigonometric.hpp>
#include <set>
#include <string>

#include "engine/core/error.h"
#include "techniques/reflections/reflector_rule.h"

namespace gfxrepro::clustered_reflections {
namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Clustered, "clustered", "clustered depth images (algorithm 6)"},
    {Method::EnvironmentMap, "environment_map", "one environment map of the scene"},
    {Method::ScreenSpace, "screen_space", "rays marched through what the eye sees"},
    {Method::RayTraced, "ray_traced",
     "ray tracing on the same device, its hierarchy rebuilt each frame"},
    {Method::Embree, "embree", "ray tracing on the CPU, its hierarchy rebuilt each frame"},
};
constexpr Choice<Clustering> kClusterings[] = {
    {Clustering::NormalBins, "normal_bins", "bins of the normal's spherical coordinates"},
    {Clustering::KdTree, "kd_tree", "splits by position and normal, largest first"},
};
constexpr Choice<ImageDrawing> kDrawings[] = {
    {ImageDrawing::OneByOne, "one_by_one", "a cluster's image is overwritten by the next one's"},
    {ImageDrawing::Atlas, "atlas", "all images side by side, by one multi-draw"},
    {ImageDrawing::Visible, "visible",
     "all images side by side, of the triangles that may be seen, shaded where rays meet them"},
    {ImageDrawing::None, "none",
     "nothing is drawn, clusters and their occlusion errors are counted"},
};
constexpr Choice<March> kMarches[] = {
    {March::Linear, "linear", "a texel per step (algorithm 7)"},
    {March::Hierarchical, "hierarchical", "over a pyramid of nearest depths"},
};
constexpr Choice<OwnReflector> kOwnReflectors[] = {
    {OwnReflector::WholeScene, "whole_scene",
     "the first way of Sec. 4.7.4: images are of the whole scene"},
    {OwnReflector::ConcaveDiffuse, "concave_diffuse",
     "the second way, which it recommends: concave clusters show their own reflector's diffuse "
     "colour"},
    {OwnReflector::LeftOut, "left_out", "a reflector is left out of its own images"},
};

float number(Params& params, const char* name, double fallback, const ParamSpec& spec) {
    return static_cast<float>(params.getDouble(name, fallback, spec));
}

void readLobe(Params& params, reflections::LobeSettings& lobe) {
    lobe.maxHalfAngleRad =
        glm::radians(number(params, "lobe_half_angle_deg", 34.4,
                            {"half angle of the cone of rays at glossiness 1", "°", 0.0, 90.0}));
    lobe.farExponent =
        number(params, "far_exponent", static_cast<double>(lobe.farExponent),
               {"e of the distance where reflections of glossiness g end: diagonal · (1 − g)^e",
                "1", 0.0, 64.0});
}

BinSettings readBins(Params& params) {
    BinSettings bins;
    bins.maxThetaBins = params.getInt(
        "theta_bins", bins.maxThetaBins,
        {"most bins of a reflector's normals, by their angle around y", "bins", 1, 64});
    bins.maxPhiBins =
        params.getInt("phi_bins", bins.maxPhiBins,
                      {"most bins of a reflector's normals, by their angle from y", "bins", 1, 64});
    bins.exponent = number(params, "bin_exponent", static_cast<double>(bins.exponent),
                           {"e of the share of the most bins that a reflector gets: (a_R / n_v · "
                            "bin_gain)^e, at most 1",
                            "1", 0.0, 8.0});
    bins.gain =
        number(params, "bin_gain", static_cast<double>(bins.gain),
               {"factor on the number of bins: the more, the finer the clusters", "1", 1e-6, 1e6});
    bins.leastSamples =
        params.getInt("least_samples", bins.leastSamples,
                      {"clusters of fewer samples join a neighbour on the same reflector",
                       "samples", 1, 1 << 20});
    return bins;
}

ClusteredSettings readClustered(Params& params) {
    ClusteredSettings settings;
    settings.clustering = params.getEnum("clustering", Clustering::NormalBins, kClusterings,
                                         {"how samples become clusters"});
    settings.bins = readBins(params);
    settings.drawing = params.getEnum("depth_images", ImageDrawing::OneByOne, kDrawings,
                                      {"how the clusters' depth images are drawn"});
    settings.march = params.getEnum("march", March::Linear, kMarches,
                                    {"how a ray is followed through a depth image"});
    settings.camera.depthImageScale =
        number(params, "depth_image_scale", 1.0,
               {"factor on the width and height of the depth images", "1", 0.01, 16.0});
    settings.camera.texelsPerSample =
        number(params, "texels_per_sample", 0.0,
               {"most texels of a depth image for each sample of its cluster; 0: as many as the "
                "samples' distances ask for",
                "texels", 0.0, 4096.0});
    settings.levelErrorPx =
        number(params, "level_error_px", 0.0,
               {"how far an object may be simplified, in texels of the depth image; 0: not at all",
                "texels", 0.0, 64.0});
    settings.ownReflector =
        params.getEnum("own_reflector", OwnReflector::ConcaveDiffuse, kOwnReflectors,
                       {"what rays of a cluster see of the reflector that they leave"});
    settings.showsOwnBack = params.getBool(
        "own_back", false,
        {"images that show the own reflector show its back, too, as the thesis has it; no ray "
         "meets it"});
    return settings;
}

}  // namespace

void ReflectionParams::requireScene(const scene::Scene& scene) const {
    FrameSettings::requireScene(scene);
    if (errorsOf.empty()) return;
    const std::set<std::string> names = reflections::reflectorNames(scene, reflectors);
    if (names.contains(errorsOf)) return;
    throw Error(fmt::format("the scene has no reflector '{}' ('errors_of'); reflectors: {}",
                            errorsOf, fmt::join(names, ", ")));
}

ReflectionParams::ReflectionParams(Params& params)
    : method(
          params.getEnum("method", Method::Clustered, kMethods, {"where reflections come from"})) {
    readView(params);
    readMotionAndSupersampling(params, 2);
    readRays(params);
    readLobe(params, lobe);
    clustered = readClustered(params);
    readGlossiness(params, "clustered_reflections");
    readRoughness(params);
    reflectors.splitsParts = params.getBool(
        "reflector_parts", true,
        {"smooth parts of an object are reflectors of their own: foot and shell, in- and outside"});
    readTextureFilter(params);
    thickness =
        number(params, "thickness", 0.02,
               {"of what the eye sees, for rays that pass behind it", "diagonals", 0.0, 10.0});
    measuresErrors = params.getBool("errors", true, {"compares with ray tracing by Embree"});
    errorsOf = params.getText("errors_of", "",
                              {"a reflector, by its mesh's name: occlusion errors of it alone"});
    convergedRays =
        params.getInt("converged_rays", 0,
                      {"rays of a second truth of glossy samples, which has as many whatever the "
                       "picture has; 0: none",
                       "rays", 0, 4096});
    showsPictures = params.getBool("pictures", false, {"result, truth, errors, clusters"});
    params.finish();
    if (method != Method::Clustered) {
        params.refuseGiven(
            {"clustering", "theta_bins", "phi_bins", "bin_exponent", "bin_gain", "least_samples",
             "depth_images", "march", "depth_image_scale", "texels_per_sample", "level_error_px",
             "own_reflector", "own_back", "errors_of"},
            "'method: clustered'");
    }
    if (clustered.ownReflector == OwnReflector::LeftOut) {
        params.refuseGiven({"own_back"}, "an 'own_reflector' that is not left_out");
    }
    if (!measuresErrors) params.refuseGiven({"converged_rays", "errors_of"}, "'errors: true'");
    if (clustered.clustering != Clustering::NormalBins) {
        params.refuseGiven({"least_samples"}, "'clustering: normal_bins'");
    }
    if (!drawsReflections()) {
        params.refuseGiven(
            {"march", "depth_image_scale", "texels_per_sample", "converged_rays", "pictures"},
            "'depth_images' other than none");
        showsPictures = false;  // nor where they are only offered
    }
    if (clustered.drawing != ImageDrawing::Visible) {
        params.refuseGiven({"level_error_px"}, "'depth_images: visible'");
    }
    if (method != Method::ScreenSpace) {
        params.refuseGiven({"thickness"}, "'method: screen_space'");
    }
}

}  // namespace gfxrepro::clustered_reflections
