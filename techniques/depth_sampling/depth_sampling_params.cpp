#include <fmt/format.h>

#include <glm/trigonometric.hpp>

#include "techniques/depth_sampling/depth_sampling.h"

namespace gfxrepro::depth_sampling {
namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Conventional, "conventional", "ordinary depth images: the nearest sample of a pixel"},
    {Method::NonRedundant, "non_redundant",
     "the nearest sample that no earlier image has (algorithm 1)"},
    {Method::DepthPeeling, "depth_peeling", "layers of one view"},
};
constexpr Choice<Redundancy> kRedundancies[] = {
    {Redundancy::Pixel, "pixel",
     "the earlier image's pixel has the same triangle (algorithm 3); drawn on the device"},
    {Redundancy::Visibility, "visibility",
     "visible from the earlier image's view (algorithm 2); ray cast on the CPU"},
};
constexpr Choice<Earlier> kEarlier[] = {
    {Earlier::Views, "views", "what is visible from their views, as algorithm 2 has it"},
    {Earlier::Samples, "samples", "what they hold, with what they uncovered"},
};
constexpr Choice<Placement> kPlacements[] = {
    {Placement::Fixed, "fixed", "the triangle's corners, then evenly inside of it"},
    {Placement::Automatic, "automatic", "each next view where the images so far lack most"},
};
constexpr Choice<PeeledFrom> kPeeledFrom[] = {
    {PeeledFrom::Centre, "centre", "the centre of the triangle of views"},
    {PeeledFrom::FirstView, "first_view", "V0, as figures 11 and 12 have it"},
};
constexpr Choice<kit::TriangleIds> kTriangleIds[] = {
    {kit::TriangleIds::PrimitiveId, "primitive_id", "gl_PrimitiveID"},
    {kit::TriangleIds::GeometryShader, "geometry_shader",
     "by a geometry stage, as the thesis has it"},
};
constexpr Choice<kit::DepthFormat> kDepthFormats[] = {
    {kit::DepthFormat::Unorm24, "unorm24", "24-bit integers"},
    {kit::DepthFormat::Float32, "float32", "32-bit floats, 0 at the near plane"},
    {kit::DepthFormat::ReversedFloat32, "reversed_float32", "32-bit floats, 0 at the far plane"},
};
constexpr Choice<Measured> kMeasured[] = {
    {Measured::ReferenceImages, "reference_images", "making the reference images"},
    {Measured::OutputFrame, "output_frame",
     "one output frame, and the test which of its samples the reference images have"},
};

ViewTriangleSettings readTriangle(Params& params) {
    const auto number = [&](const char* name, double fallback, const ParamSpec& spec) {
        return static_cast<float>(params.getDouble(name, fallback, spec));
    };
    ViewTriangleSettings settings;
    settings.spread = number(
        "view_spread", 0.5,
        {"side of the triangle of views, in diagonals of the scene's box", "diagonals", 0.0, 10.0});
    settings.distance =
        number("view_distance", 1.0,
               {"factor on the camera's distance from its target", "1", 0.01, 100.0});
    settings.yawRad = glm::radians(
        number("view_yaw_deg", 0.0, {"turns the camera about its target", "°", -360.0, 360.0}));
    settings.pitchRad = glm::radians(
        number("view_pitch_deg", 0.0, {"raises the camera about its target", "°", -180.0, 180.0}));
    settings.rollRad = glm::radians(number(
        "view_roll_deg", 0.0,
        {"turns the triangle of views in its plane; the views stay upright", "°", -360.0, 360.0}));
    return settings;
}

[[noreturn]] void refuse(const Params& params, const char* name, const std::string& because) {
    throw Error(params.locationOf(name), because);
}

void checkPlacement(const Params& params, const DepthSamplingParams& read) {
    if (read.placement == Placement::Fixed) {
        params.refuseGiven({"candidates"}, "'placement: automatic'");
        return;
    }
    if (read.redundancy != Redundancy::Pixel) {
        refuse(params, "placement", "'placement: automatic' needs 'redundancy: pixel'");
    }
    if (read.method == Method::DepthPeeling) {
        refuse(params, "placement",
               "'placement: automatic' chooses views; 'method: depth_peeling' has only one");
    }
    if (read.views < 2) {
        refuse(params, "views", "'placement: automatic' needs 2 views or more; found 1");
    }
    if (read.candidates < read.views) {
        refuse(params, "candidates",
               fmt::format("{} candidates are fewer than {} views", read.candidates, read.views));
    }
}

/// Rays have neither a depth buffer nor primitives.
void checkVisibility(const Params& params, const DepthSamplingParams& read) {
    if (read.redundancy == Redundancy::Pixel) {
        params.refuseGiven({"earlier"}, "'redundancy: visibility'");
        return;
    }
    params.refuseGiven({"depth_format", "triangle_ids"}, "'redundancy: pixel'");
    if (read.measured == Measured::OutputFrame) {
        refuse(params, "measured", "'measured: output_frame' needs 'redundancy: pixel'");
    }
}

void checkFrames(const Params& params, const DepthSamplingParams& read) {
    const bool hasFrames = read.measures.usefulness || read.measures.availability ||
                           read.showsPictures || read.measured == Measured::OutputFrame;
    if (hasFrames) return;
    params.refuseGiven({"frame_size", "output_frames"},
                       "'usefulness', 'availability', 'pictures' or 'measured: output_frame'");
}

}  // namespace

DepthSamplingParams::DepthSamplingParams(Params& params)
    : method(params.getEnum("method", Method::Conventional, kMethods, {"which images are taken"})),
      redundancy(params.getEnum("redundancy", Redundancy::Pixel, kRedundancies,
                                {"which samples count as captured"})),
      earlier(params.getEnum("earlier", Earlier::Views, kEarlier,
                             {"what of earlier images a non-redundant one leaves out"})),
      views(params.getInt("views", 3,
                          {"reference images, or layers of depth peeling", "images", 1,
                           kit::kMaxEarlierImages + 1})),
      placement(params.getEnum("placement", Placement::Fixed, kPlacements,
                               {"where reference images are taken"})),
      candidates(params.getInt("candidates", 16,
                               {"views to choose from (automatic)", "views", 2, kMaxCandidates})),
      peeledFrom(params.getEnum("peeled_from", PeeledFrom::Centre, kPeeledFrom,
                                {"the one view of depth_peeling"})),
      triangle(readTriangle(params)),
      triangleIds(params.getEnum("triangle_ids", kit::TriangleIds::PrimitiveId, kTriangleIds,
                                 {"where triangle ids come from"})),
      depthFormat(params.getEnum("depth_format", kit::DepthFormat::Float32, kDepthFormats,
                                 {"what the depth test compares"})),
      outputFrames(params.getInt("output_frames", 1000,
                                 {"views in the hull of the reference views", "frames", 1, 10000})),
      frameSizePx(
          params.getInt("frame_size", 0,
                        {"side of an output frame; 0: the reference images' size", "px", 0, 4096})),
      showsPictures(params.getBool("pictures", false, {"save images with what was measured"})),
      measured(
          params.getEnum("measured", Measured::ReferenceImages, kMeasured, {"what is timed"})) {
    measures.usefulness = params.getBool(
        "usefulness", false, {"count the occluded samples that an output frame needs (measure 3)"});
    measures.availability = params.getBool(
        "availability", false, {"count what reference images have of output frames (measure 4)"});
    checkPlacement(params, *this);
    checkVisibility(params, *this);
    checkFrames(params, *this);
}

}  // namespace gfxrepro::depth_sampling
