#include <glm/trigonometric.hpp>

#include "techniques/soft_shadows/soft_shadows.h"

namespace gfxrepro::soft_shadows {
namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Geometry, "geometry", "shadow maps of the original geometry"},
    {Method::NonRedundant, "non_redundant",
     "meshes from non-redundant depth images of the light's corners (algorithm 5)"},
    {Method::Conventional, "conventional", "meshes from conventional depth images of the corners"},
    {Method::DepthPeeling, "depth_peeling", "meshes from layers seen from the light's centre"},
    {Method::RayTraced, "ray_traced", "a shadow ray to each light sample, on the CPU"},
    {Method::Pcss, "pcss", "percentage-closer soft shadows from the light's centre"},
    {Method::Variance, "variance", "variance soft shadows from the light's centre"},
};
constexpr Choice<Reconstruction> kReconstructions[] = {
    {Reconstruction::Hybrid, "hybrid", "a quad per sample (algorithm 4)"},
    {Reconstruction::Classic, "classic", "triangles between neighbouring samples"},
};

constexpr Choice<kit::Redundancy> kRedundancies[] = {
    {kit::Redundancy::Pixel, "pixel",
     "an earlier image holds the triangle where the sample lands (algorithm 3)"},
    {kit::Redundancy::Visibility, "visibility",
     "an earlier view sees the sample (algorithm 2), by a shadow map's test"},
};
constexpr Choice<Measured> kMeasured[] = {
    {Measured::SoftShadow, "soft_shadow", "the light's visibility"},
    {Measured::DepthAndPass, "depth_and_pass",
     "a yardstick: for each light sample a depth-only draw of the casters and a pass over the "
     "image that only writes"},
};

float number(Params& params, const char* name, double fallback, const ParamSpec& spec) {
    return static_cast<float>(params.getDouble(name, fallback, spec));
}

AreaLightSettings readLight(Params& params) {
    AreaLightSettings light;
    light.sizeRatio =
        number(params, "light_ratio", 1.0,
               {"diagonal of the square light : diagonal of the scene's box; 0 is a point", "1",
                0.0, 16.0});
    light.height =
        number(params, "light_height", 1.5,
               {"distance of the light from the centre of the box", "diagonals", 0.01, 100.0});
    light.azimuthRad = glm::radians(
        number(params, "light_azimuth_deg", 35.0,
               {"direction to the light about y, from +z towards +x", "°", -360.0, 360.0}));
    light.elevationRad = glm::radians(
        number(params, "light_elevation_deg", 60.0, {"… above the horizon", "°", -90.0, 90.0}));
    return light;
}

ReconstructionSettings readReconstruction(Params& params) {
    ReconstructionSettings settings;
    settings.method = params.getEnum("reconstruction", Reconstruction::Hybrid, kReconstructions,
                                     {"how depth images become meshes"});
    settings.discontinuityPx = number(
        params, "discontinuity", static_cast<double>(settings.discontinuityPx),
        {"depth off a sample's plane at which a corner is another surface's", "pixels", 0.0, 1e6});
    settings.grazingLimitPx = number(
        params, "grazing_limit", static_cast<double>(settings.grazingLimitPx),
        {"how far a plane-fitted corner may lie before or behind its sample", "pixels", 0.0, 1e6});
    settings.mergesRows = params.getBool("merge_rows", false,
                                         {"samples of one triangle side by side become one quad"});
    return settings;
}

}  // namespace

SoftShadowsParams::SoftShadowsParams(Params& params)
    : method(params.getEnum("method", Method::NonRedundant, kMethods, {"where shadows come from"})),
      redundancy(params.getEnum("redundancy", kit::Redundancy::Pixel, kRedundancies,
                                {"which samples non-redundant images leave out"})),
      referenceImages(params.getInt("reference_images", 4,
                                    {"depth images, or layers of depth_peeling", "images", 1, 16})),
      referenceSizePx(
          params.getInt("reference_size", 512,
                        {"side of a depth image; the thesis has 1024", "pixels", 1, 32768})),
      reconstruction(readReconstruction(params)),
      simplifyTo(number(params, "simplify_to", 1.0,
                        {"share of a mesh's triangles that simplification keeps; 1 leaves it as "
                         "reconstructed",
                         "1", 0.001, 1.0})),
      simplificationError(
          number(params, "simplification_error", 0.001,
                 {"bound on how far simplification moves the surface", "diagonals", 0.0, 1.0})),
      light(readLight(params)),
      lightGrid(params.getInt("light_grid", 8,
                              {"light samples along each edge; the thesis has 16", "1", 1, 64})),
      hasGround(params.getBool("ground", true, {"a square floor under the scene"})),
      groundSize(
          number(params, "ground_size", 1.5, {"side of the floor", "diagonals", 0.0, 100.0})),
      measured(params.getEnum("measured", Measured::SoftShadow, kMeasured, {"what is timed"})),
      measuresErrors(
          params.getBool("errors", true, {"compare with shadow maps of the original geometry"})),
      tracesTruth(params.getBool("traced_truth", false, {"compares with shadow rays, too"})),
      seesFromLight(params.getBool(
          "light_views", false,
          {"compares the casters with the geometry as seen from the light and from beside it"})),
      showsPictures(
          params.getBool("pictures", false, {"shadows, errors, and what light_views compares"})),
      exportsMesh(params.getBool("export_mesh", false, {"writes the meshes as PLY files"})) {
    shadowMap.sizePx =
        // As a depth image: the bias of one texel covers a quad that stands a pixel before its
        // surface.
        params.getInt("shadow_map_size", 512, {"side of a shadow map", "pixels", 1, 16384});
    shadowMap.biasTexels =
        number(params, "shadow_bias", 1.0,
               {"how far a receiver is moved before the test", "texels", 0.0, 1000.0});
    params.finish();
    if (!reconstructs()) {
        params.refuseGiven(
            {"reference_images", "reference_size", "reconstruction", "discontinuity",
             "grazing_limit", "merge_rows", "simplify_to", "simplification_error", "export_mesh"},
            "a method that takes depth images: non_redundant, conventional or "
            "depth_peeling");
    }
    if (method != Method::NonRedundant) {
        params.refuseGiven({"redundancy"}, "'method: non_redundant'");
    }
    if (reconstruction.method == Reconstruction::Classic) {
        params.refuseGiven({"grazing_limit", "merge_rows"}, "'reconstruction: hybrid'");
    }
    if (measured == Measured::DepthAndPass) {
        if (method == Method::RayTraced || isFiltered()) {
            throw Error(params.locationOf("measured"),
                        "'measured: depth_and_pass' needs a method that draws a shadow map for "
                        "each light sample");
        }
        params.refuseGiven({"errors", "traced_truth", "light_views", "pictures"},
                           "'measured: soft_shadow'");
        measuresErrors = false;
    }
    if (method == Method::RayTraced || isFiltered()) {
        params.refuseGiven({"light_views"},
                           "a method that draws a shadow map for each light sample");
    }
    if (method == Method::RayTraced && !measuresErrors) {
        params.refuseGiven({"shadow_map_size", "shadow_bias"},
                           "a method that draws shadow maps, or 'errors: true'");
    }
}

bool SoftShadowsParams::reconstructs() const {
    return method == Method::NonRedundant || method == Method::Conventional ||
           method == Method::DepthPeeling;
}

}  // namespace gfxrepro::soft_shadows
