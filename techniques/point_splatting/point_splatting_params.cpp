#include <fmt/format.h>

#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <string>

#include "techniques/point_splatting/point_splatting.h"

namespace gfxrepro::point_splatting {
namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Adaptive, "adaptive",
     "a filter per patch, by its points' size on the screen (Eq. 13)"},
    {Method::FullEwa, "full_ewa", "H = J V^r Jᵀ + V^h everywhere (Eq. 3)"},
    {Method::Reconstruction, "reconstruction", "the reconstruction filter alone everywhere"},
    {Method::LowPass, "low_pass", "the low-pass filter alone everywhere"},
    {Method::Sprites, "sprites", "opaque squares, as QSplat"},
    {Method::Compute, "compute", "one pixel per point, by compute shaders"},
    {Method::GlPoints, "gl_points", "one white pixel per point, by a plain draw of positions"},
};
constexpr Choice<PointStorage> kStorages[] = {
    {PointStorage::Compressed, "compressed", "8 bytes per point (table 3.1)"},
    {PointStorage::Uncompressed, "uncompressed", "60 bytes per point"},
};
enum class LevelChoice { BySize, All };
constexpr Choice<LevelChoice> kLevels[] = {
    {LevelChoice::BySize, "by_size", "the coarsest whose splats are small enough on the screen"},
    {LevelChoice::All, "all", "all points of a patch"},
};

float number(Params& params, const char* name, float fallback, const ParamSpec& spec) {
    // 0.7, not what a float makes of it, goes into manifests.
    const double written = std::stod(fmt::format("{:g}", fallback));
    return static_cast<float>(params.getDouble(name, written, spec));
}

SplatMethod splatMethod(Method method) {
    switch (method) {
        case Method::Adaptive:
            break;
        case Method::FullEwa:
            return SplatMethod::FullEwa;
        case Method::Reconstruction:
            return SplatMethod::Reconstruction;
        case Method::LowPass:
            return SplatMethod::LowPass;
        case Method::Sprites:
        case Method::Compute:
        case Method::GlPoints:
            return SplatMethod::Sprites;
    }
    return SplatMethod::Adaptive;
}

SplatSettings readSplats(Params& params) {
    SplatSettings settings;
    settings.storage = params.getEnum("storage", PointStorage::Compressed, kStorages,
                                      {"how points lie on the device"});
    settings.lowPassRadiusPx =
        number(params, "low_pass_radius_px", 1.0F,
               {"r_h: the low-pass filter's standard deviation", "pixels", 0.1, 8.0});
    settings.cutoff =
        number(params, "cutoff", 1.5F, {"where a splat ends", "standard deviations", 0.5, 4.0});
    settings.visibilityOffset =
        number(params, "visibility_offset", settings.visibilityOffset,
               {"ε: how far splats behind the front one are blended in", "radii", 0.0, 16.0});
    return settings;
}

SelectionSettings readSelection(Params& params, Method method) {
    SelectionSettings settings;
    settings.method = splatMethod(method);
    settings.cullsFrustum =
        params.getBool("cull_frustum", true, {"leaves patches outside of the view out"});
    settings.cullsCones = params.getBool("cull_cones", true, {"leaves patches that face away out"});
    settings.choosesLevels =
        params.getEnum("level", LevelChoice::BySize, kLevels, {"how much of a patch is drawn"}) ==
        LevelChoice::BySize;
    settings.targetRadiusPx =
        number(params, "target_radius_px", settings.targetRadiusPx,
               {"largest radius of a level on the screen", "pixels", 0.05, 64.0});
    settings.fineRadiusPx = number(
        params, "fine_radius_px", settings.fineRadiusPx,
        {"the same of patches that are curved, wide or at the silhouette", "pixels", 0.05, 64.0});
    settings.cMin = number(params, "c_min", settings.cMin,
                           {"below it C_η·S_proj / S_h is low-pass alone", "1", 0.0, 1e6});
    settings.cMax = number(params, "c_max", settings.cMax,
                           {"above it S_proj / S_h is reconstruction alone", "1", 0.0, 1e6});
    settings.curvedAbove = number(params, "curved_above", settings.curvedAbove,
                                  {"λ₀ / Σλ of patches that are curved", "1", 0.0, 1.0});
    settings.wideAboveRad =
        glm::radians(number(params, "wide_above_deg", glm::degrees(settings.wideAboveRad),
                            {"normal cone of patches that are wide", "°", 0.0, 180.0}));
    settings.silhouetteRad = glm::radians(
        number(params, "silhouette_deg", 20.0F,
               {"at the silhouette the view ray is so near to a right angle to the mean normal",
                "°", 0.0, 90.0}));
    settings.prefixShare = number(
        params, "progressive_share", 1.0F,
        {"of each patch's points, what has arrived: progressive transmission", "1", 0.0, 1.0});
    settings.lowPassRadiusPx = 0.0F;  // the splats'; see below
    return settings;
}

TreeSettings readTree(Params& params) {
    TreeSettings settings;
    settings.maxPatchPoints = static_cast<std::uint32_t>(
        params.getInt("patch_points_max", static_cast<int>(settings.maxPatchPoints),
                      {"a patch's most points", "points", 1, 1 << 20}));
    settings.minPatchPoints = static_cast<std::uint32_t>(
        params.getInt("patch_points_min", static_cast<int>(settings.minPatchPoints),
                      {"a subtree of so few is not cut", "points", 1, 1 << 20}));
    settings.patchConeRad =
        glm::radians(number(params, "patch_cone_deg", glm::degrees(settings.patchConeRad),
                            {"a subtree whose normals lie within is not cut", "°", 0.0, 180.0}));
    return settings;
}

ViewSettings readView(Params& params) {
    ViewSettings view;
    view.distance =
        number(params, "distance", view.distance,
               {"of the eye from the point looked at", "of the framing distance", 0.01, 1000.0});
    view.rotationRad = glm::radians(
        number(params, "rotation_deg", 0.0F,
               {"of the turntable, to which frames add up to 360°", "°", -360.0, 360.0}));
    constexpr double kCentre[] = {0.5, 0.5, 0.5};
    const std::vector<double> lookAt =
        params.getVector("look_at", kCentre, {"in the model's box", "of its size", -1.0, 2.0});
    view.lookAt = glm::vec3(glm::dvec3(lookAt[0], lookAt[1], lookAt[2]));
    return view;
}

}  // namespace

PointSplattingParams::PointSplattingParams(Params& params)
    : method(params.getEnum("method", Method::Adaptive, kMethods, {"what is measured"})),
      splats(readSplats(params)),
      selection(readSelection(params, method)),
      tree(readTree(params)),
      view(readView(params)),
      points(
          params.getInt("points", 1'000'000,
                        {"taken of a scene without points of its own", "points", 1, 100'000'000})),
      keepsModel(params.getBool("cache", true,
                                {"keeps the preprocessed model for later runs, and takes it"})),
      measuresErrors(
          params.getBool("errors", false,
                         {"compares with a supersampled image, full EWA and uncompressed points"})),
      measuresCompression(params.getBool("compression_errors", false,
                                         {"what 8 bytes per point lose, over all points"})),
      measuresSpeed(params.getBool("points_per_second", false, {"draws five more frames"})),
      showsPictures(
          params.getBool("pictures", false, {"the image, and what it is compared with"})) {
    params.finish();
    selection.lowPassRadiusPx = splats.lowPassRadiusPx;
    if (method != Method::Adaptive) {
        params.refuseGiven({"c_min", "c_max"}, "'method: adaptive'");
    }
    if (method == Method::GlPoints) {
        params.refuseGiven({"storage"}, "a method that reads compressed points");
    }
    if (method == Method::Compute || method == Method::GlPoints) {
        params.refuseGiven({"low_pass_radius_px", "cutoff", "visibility_offset"},
                           "a method of splats");
    }
    if (!selection.choosesLevels) {
        params.refuseGiven({"target_radius_px", "fine_radius_px", "curved_above", "wide_above_deg"},
                           "'level: by_size'");
    }
    if (selection.cMin > selection.cMax) {
        throw Error(params.locationOf("c_min"),
                    fmt::format("c_min {:g} is above c_max {:g}", selection.cMin, selection.cMax));
    }
    if (tree.minPatchPoints > tree.maxPatchPoints) {
        throw Error(params.locationOf("patch_points_min"),
                    fmt::format("patch_points_min {} is above patch_points_max {}",
                                tree.minPatchPoints, tree.maxPatchPoints));
    }
}

}  // namespace gfxrepro::point_splatting
