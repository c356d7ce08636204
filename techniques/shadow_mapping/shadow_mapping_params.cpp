#include <glm/trigonometric.hpp>

#include "techniques/shadow_mapping/shadow_mapping.h"

namespace gfxrepro::shadow_mapping {
namespace {

constexpr Choice<Storage> kMethods[] = {
    {Storage::Standard, "standard", "depths in a float colour texture, compared in the shader"},
    {Storage::Hardware, "hardware", "a depth texture, compared by the texture unit"},
};
constexpr Choice<FilterKind> kFilters[] = {
    {FilterKind::Nearest, "nearest", "one comparison"},
    {FilterKind::Bilinear, "bilinear", "four comparisons, weighted"},
    {FilterKind::Pcf, "pcf", "the mean of filter_size² comparisons"},
    {FilterKind::Pcss, "pcss", "percentage-closer soft shadows"},
    {FilterKind::Variance, "variance", "variance shadow maps, blurred"},
};
constexpr Choice<LightKind> kLightKinds[] = {
    {LightKind::Spot, "spot", "one perspective map around the scene"},
    {LightKind::Directional, "directional", "one orthographic map around the scene"},
    {LightKind::Point, "point", "six maps, the sides of a cube"},
};
constexpr Choice<LightPlace> kLightPlaces[] = {
    {LightPlace::Orbit, "orbit", "around the scene's box, evenly over the azimuth"},
    {LightPlace::Scene, "scene", "the scene's own lights, in their order"},
};
constexpr Choice<DepthFormat> kFormats[] = {
    {DepthFormat::Unorm16, "unorm16", "D16"},
    {DepthFormat::Unorm24, "unorm24", "D24"},
    {DepthFormat::Float32, "float32", "32-bit float"},
};

float number(Params& params, const char* name, double fallback, const ParamSpec& spec) {
    return static_cast<float>(params.getDouble(name, fallback, spec));
}

Filter filterOf(FilterKind kind, int size) {
    switch (kind) {
        case FilterKind::Nearest:
            return Filter::Nearest;
        case FilterKind::Bilinear:
            return Filter::Bilinear;
        case FilterKind::Pcf:
            return size == 3 ? Filter::Pcf3 : size == 5 ? Filter::Pcf5 : Filter::Pcf7;
        case FilterKind::Pcss:
            return Filter::Pcss;
        case FilterKind::Variance:
            break;
    }
    return Filter::Variance;
}

void readLights(Params& params, ShadowMappingParams& p) {
    p.lightKind = params.getEnum("light_kind", LightKind::Spot, kLightKinds, {"of all lights"});
    p.lightPlace =
        params.getEnum("light_place", LightPlace::Orbit, kLightPlaces, {"where lights stand"});
    p.lightCount = params.getInt("lights", 1, {"number of lights", "lights", 1, kMaxLights});
    p.lightDistance = number(params, "light_distance", 1.2,
                             {"from the centre of the scene's box", "diagonals", 0.0, 100.0});
    p.azimuthRad = glm::radians(
        number(params, "light_azimuth_deg", -40.0,
               {"direction to the first light about y, from +z towards +x", "°", -360.0, 360.0}));
    p.elevationRad = glm::radians(
        number(params, "light_elevation_deg", 50.0, {"… above the horizon", "°", -90.0, 90.0}));
    p.lightSize = number(params, "light_size", 0.02,
                         {"diameter of the lights, for pcss", "diagonals", 0.0, 10.0});
}

void refuseUnread(const Params& params, FilterKind filter, const ShadowMappingParams& p) {
    if (filter != FilterKind::Pcf && filter != FilterKind::Variance) {
        params.refuseGiven({"filter_size"}, "'filter: pcf' or 'filter: variance'");
    }
    if (filter != FilterKind::Pcss) params.refuseGiven({"light_size"}, "'filter: pcss'");
    if (p.lightPlace == LightPlace::Scene) {
        params.refuseGiven({"light_distance", "light_azimuth_deg", "light_elevation_deg"},
                           "'light_place: orbit'");
    }
    if (p.lightKind == LightKind::Directional) {
        params.refuseGiven({"light_distance"}, "'light_kind: spot' or 'light_kind: point'");
    }
    if (p.isStatic) params.refuseGiven({"yardstick"}, "'static: false'");
    if (!p.measuresErrors) params.refuseGiven({"edge_texels"}, "'errors: true'");
    if (filter == FilterKind::Variance) {
        if (p.maps.storage == Storage::Hardware) {
            throw Error(params.locationOf("filter"),
                        "'filter: variance' needs 'method: standard': moments are colours");
        }
        params.refuseGiven({"compare_methods"}, "a filter that both methods have");
    }
}

}  // namespace

ShadowMappingParams::ShadowMappingParams(Params& params) {
    maps.storage =
        params.getEnum("method", Storage::Hardware, kMethods, {"how depths are compared"});
    const FilterKind filter =
        params.getEnum("filter", FilterKind::Nearest, kFilters, {"how comparisons are filtered"});
    const int filterSize = params.getInt(
        "filter_size", 5, {"side of the square of texels; 3, 5 or 7", "texels", 3, 7});
    if (filterSize % 2 == 0) {
        throw Error(params.locationOf("filter_size"),
                    "filter_size: " + std::to_string(filterSize) + " is even; allowed: 3, 5 or 7");
    }
    maps.filter = filterOf(filter, filterSize);
    maps.blurTexels = filterSize;
    maps.sizePx =
        params.getInt("shadow_map_size", 1024,
                      {"side of a shadow map; a point light has six of them", "pixels", 16, 16384});
    maps.format = params.getEnum("depth_format", DepthFormat::Unorm24, kFormats,
                                 {"of the depth test; of the map where it is hardware's"});
    maps.bias.constant =
        number(params, "bias", 0.0005,
               {"ε: how much is taken from the receiver's window depth", "1", 0.0, 1.0});
    maps.bias.slopeScale = number(
        params, "slope_bias", 1.0,
        {"how many times the caster's change of depth from texel to texel is added to the bias",
         "1", 0.0, 100.0});
    maps.bias.normalOffsetTexels =
        number(params, "normal_bias", 0.0,
               {"how far the receiver is moved along its normal", "texels", 0.0, 100.0});
    readLights(params, *this);
    isStatic = params.getBool("static", false, {"the maps are drawn once and used again"});
    measuresErrors = params.getBool("errors", false, {"compares with shadow rays"});
    edgeTexels = number(
        params, "edge_texels", 1.5,
        {"an error so near a true edge, and half the filter, is the edge's", "texels", 0.0, 100.0});
    comparesMethods =
        params.getBool("compare_methods", false, {"compares with the other method's shadows"});
    drawsYardstick =
        params.getBool("yardstick", false,
                       {"draws the maps again, depth alone and without a bias: yardstick_pass"});
    showsPictures = params.getBool("pictures", false, {"the image, the truth, classes of errors"});
    params.finish();
    refuseUnread(params, filter, *this);
}

float ShadowMappingParams::edgeReachTexels() const {
    const int size = maps.filter == Filter::Variance ? maps.blurTexels : kernelSizeOf(maps.filter);
    return edgeTexels + 0.5F * static_cast<float>(size - 1);
}

}  // namespace gfxrepro::shadow_mapping
