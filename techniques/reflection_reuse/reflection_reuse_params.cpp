#include "techniques/reflection_reuse/reflection_reuse_params.h"

#include <fmt/format.h>

namespace gfxrepro::reflection_reuse {
namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Reuse, "reuse", "key frames' reflections moved to where they are seen (algorithm 8)"},
    {Method::Direct, "direct", "the same by depth alone, as if they were painted on"},
    {Method::RayTraced, "ray_traced", "every sample of every frame"},
};
constexpr Choice<Tracer> kTracers[] = {
    {Tracer::Compute, "compute", "ray tracing on the same device"},
    {Tracer::Embree, "embree", "ray tracing on the CPU"},
    {Tracer::Clustered, "clustered", "clustered depth images, as clustered_reflections has them"},
};
constexpr Choice<reflections::Blend> kBlends[] = {
    {reflections::Blend::Fresnel, "fresnel", "by view, normal and reflectivity"},
    {reflections::Blend::Reflectivity, "reflectivity", "by reflectivity alone, as chapter 4"},
};
constexpr Choice<Matching> kMatchings[] = {
    {Matching::FirstOrder, "first_order", "among planes, pixel by pixel (algorithm 9)"},
    {Matching::SecondOrder, "second_order", "among bent surfaces, between pixels"},
};
constexpr Choice<Forward> kForwards[] = {
    {Forward::Grid, "grid", "a mesh over the image"},
    {Forward::Splats, "splats", "a point per pixel"},
};

constexpr Choice<Resampling> kResamplings[] = {
    {Resampling::Twice, "twice",
     "shifted in the key frame's view, then warped (Sec. 5.4.2, 5.4.3)"},
    {Resampling::Once, "once", "moved to the new view at once"},
};

float number(Params& params, const char* name, float fallback, const ParamSpec& spec) {
    return static_cast<float>(params.getDouble(name, static_cast<double>(fallback), spec));
}

ReuseSettings readReuse(Params& params) {
    ReuseSettings settings;
    settings.keyFrameThreshold = static_cast<float>(params.getDouble(
        "threshold", 0.3,
        {"share of recomputed samples above which the next frame is a key frame; 1: never", "1",
         0.0, 1.0}));
    settings.matching.matching = params.getEnum("matching", settings.matching.matching, kMatchings,
                                                {"how matches are found"});
    settings.matching.maxSteps =
        params.getInt("max_steps", settings.matching.maxSteps,
                      {"most steps of a search; a longer one finds no match", "steps", 1, 65536});
    settings.matching.widestRingPx = params.getInt(
        "widest_ring", settings.matching.widestRingPx,
        {"widest ring around a minimum in which the search looks for a better one; 1: algorithm 9",
         "pixels", 1, 64});
    const double silhouette = params.getDouble(
        "silhouette", 0.05,
        {"neighbours whose eye depths differ by more of the nearer one are not connected", "1", 0.0,
         100.0});
    settings.matching.silhouette = static_cast<float>(silhouette);
    settings.reprojection.silhouette = static_cast<float>(silhouette);
    settings.reprojection.forward = params.getEnum("forward", settings.reprojection.forward,
                                                   kForwards, {"how images are drawn forward"});
    settings.reprojection.resampling =
        params.getEnum("resampling", settings.reprojection.resampling, kResamplings,
                       {"how often reflections are resampled on their way"});
    settings.reprojection.maxGrowth = number(
        params, "max_growth", settings.reprojection.maxGrowth,
        {"how much a grid triangle's area may grow; a larger one is left out", "1", 1.0, 1e6});
    settings.reprojection.depthTolerance = static_cast<float>(params.getDouble(
        "depth_tolerance", 0.01,
        {"ε: share by which the depth of a reused sample may be off", "1", 0.0, 1.0}));
    settings.recomputesMoved = params.getBool(
        "moved_objects", false, {"recomputes what an object that moved reflects in or hides"});
    settings.seamPx = params.getInt(
        "seam_px", 0,
        {"width over which recomputed samples are mixed with reused neighbours", "pixels", 0, 64});
    return settings;
}

}  // namespace

ReuseParams::ReuseParams(Params& params)
    : method(params.getEnum("method", Method::Reuse, kMethods, {"where reflections come from"})),
      tracer(params.getEnum("tracer", Tracer::Compute, kTracers,
                            {"what traces key frames and recomputed samples"})) {
    readView(params);
    pathFrames = params.getInt(
        "path_frames", pathFrames,
        {"frames of the whole path, which give the speed along it", "frames", 1, 1000000});
    firstFrame = params.getInt("first_frame", firstFrame,
                               {"frame of the path where measuring begins", "frame", 0, 999999});
    readMotionAndSupersampling(params, 1);
    blend = params.getEnum("blend", reflections::Blend::Fresnel, kBlends,
                           {"what weighs the reflected colour"});
    reuse = readReuse(params);
    readRoughness(params);
    readTextureFilter(params);
    readGlossiness(params, "reflection_reuse");
    readRays(params);
    measuresErrors = params.getBool("errors", true, {"compares with ray tracing by Embree"});
    showsPictures = params.getBool(
        "pictures", false, {"result, truth, errors, recomputed samples, key frame, offsets"});
    exhaustiveSamples = params.getInt(
        "exhaustive_samples", 0,
        {"matches of a frame that are compared with a search of the whole reflector; 0: none",
         "samples", 0, 1000000});
    fitsRecompute = params.getBool(
        "recompute_fit", false,
        {"a line through recomputing's times over the samples, of all frames but key frames"});
    params.finish();
    reuse.isDirect = method == Method::Direct;
    if (method == Method::RayTraced) {
        params.refuseGiven({"threshold", "silhouette", "forward", "max_growth", "depth_tolerance",
                            "moved_objects", "seam_px", "recompute_fit"},
                           "'method: reuse' or 'method: direct'");
    }
    if (method != Method::Reuse) {
        params.refuseGiven(
            {"matching", "max_steps", "widest_ring", "resampling", "exhaustive_samples"},
            "'method: reuse'");
    }
    if (firstFrame >= pathFrames) {
        throw Error(params.locationOf("first_frame"),
                    fmt::format("'first_frame' is {}; the path has frames 0 … {} ('path_frames')",
                                firstFrame, pathFrames - 1));
    }
}

}  // namespace gfxrepro::reflection_reuse
