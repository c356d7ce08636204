#include "techniques/point_splatting/point_splatting.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <utility>

#include "engine/core/files.h"
#include "techniques/kit/number.h"
#include "techniques/kit/path_view.h"

namespace gfxrepro::point_splatting {
namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Adaptive, "adaptive",
     "a filter per patch, by its points' size on the screen (Eq. 13)"},
    {Method::FullEwa, "full_ewa", "H = J V^r Jᵀ + V^h everywhere (Eq. 3)"},
    {Method::Reconstruction, "reconstruction", "the reconstruction filter alone everywhere"},
    {Method::LowPass, "low_pass", "the low-pass filter alone everywhere"},
    {Method::Sprites, "sprites", "opaque squares, as QSplat"},
    {Method::PlainPoints, "plain_points",
     "one white pixel per point, by an atomic minimum of depths: the least that points cost"},
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

/// That all patches are drawn in; none: by each one's size.
std::optional<SplatMode> fixedMode(Method method) {
    switch (method) {
        case Method::Adaptive:
            break;
        case Method::FullEwa:
            return SplatMode::FullEwa;
        case Method::Reconstruction:
            return SplatMode::Reconstruction;
        case Method::LowPass:
            return SplatMode::LowPass;
        case Method::Sprites:
        case Method::PlainPoints:
            return SplatMode::Sprite;
    }
    return std::nullopt;
}

SplatSettings readSplats(Params& params) {
    SplatSettings settings;
    settings.storage = params.getEnum("storage", PointStorage::Compressed, kStorages,
                                      {"how points lie on the device"});
    settings.lowPassRadiusPx =
        kit::number(params, "low_pass_radius_px", 1.0F,
                    {"r_h: the low-pass filter's standard deviation", "pixels", 0.1, 8.0});
    settings.cutoff = kit::number(params, "cutoff", 1.5F,
                                  {"where a splat ends", "standard deviations", 0.5, 4.0});
    settings.visibilityOffset =
        kit::number(params, "visibility_offset", settings.visibilityOffset,
                    {"ε: how far splats behind the front one are blended in", "radii", 0.0, 16.0});
    return settings;
}

SelectionSettings readSelection(Params& params, Method method) {
    SelectionSettings settings;
    settings.mode = fixedMode(method);
    settings.cullsFrustum =
        params.getBool("cull_frustum", true, {"leaves patches outside of the view out"});
    settings.cullsCones = params.getBool("cull_cones", true, {"leaves patches that face away out"});
    settings.choosesLevels =
        params.getEnum("level", LevelChoice::BySize, kLevels, {"how much of a patch is drawn"}) ==
        LevelChoice::BySize;
    settings.targetRadiusPx =
        kit::number(params, "target_radius_px", settings.targetRadiusPx,
                    {"largest radius of a level on the screen", "pixels", 0.05, 64.0});
    settings.fineRadiusPx = kit::number(
        params, "fine_radius_px", settings.fineRadiusPx,
        {"the same of patches that are curved, wide or at the silhouette", "pixels", 0.05, 64.0});
    settings.cMin = kit::number(params, "c_min", settings.cMin,
                                {"below it C_η·S_proj / S_h is low-pass alone", "1", 0.0, 1e6});
    settings.cMax = kit::number(params, "c_max", settings.cMax,
                                {"above it S_proj / S_h is reconstruction alone", "1", 0.0, 1e6});
    settings.curvedAbove = kit::number(params, "curved_above", settings.curvedAbove,
                                       {"λ₀ / Σλ of patches that are curved", "1", 0.0, 1.0});
    settings.wideAboveRad =
        glm::radians(kit::number(params, "wide_above_deg", glm::degrees(settings.wideAboveRad),
                                 {"normal cone of patches that are wide", "°", 0.0, 180.0}));
    settings.silhouetteRad = glm::radians(kit::number(
        params, "silhouette_deg", 20.0F,
        {"at the silhouette the view ray is so near to a right angle to the mean normal", "°", 0.0,
         90.0}));
    settings.prefixShare = kit::number(
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
    settings.patchConeRad = glm::radians(
        kit::number(params, "patch_cone_deg", glm::degrees(settings.patchConeRad),
                    {"a subtree whose normals lie within is not cut", "°", 0.0, 180.0}));
    return settings;
}

ViewSettings readView(Params& params) {
    ViewSettings view;
    view.distance = kit::number(
        params, "distance", view.distance,
        {"of the eye from the point looked at", "of the framing distance", 0.01, 1000.0});
    view.rotationRad = glm::radians(
        kit::number(params, "rotation_deg", 0.0F,
                    {"of the turntable, to which frames add up to 360°", "°", -360.0, 360.0}));
    constexpr double kCentre[] = {0.5, 0.5, 0.5};
    const std::vector<double> lookAt =
        params.getVector("look_at", kCentre, {"in the model's box", "of its size", -1.0, 2.0});
    view.lookAt = glm::vec3(glm::dvec3(lookAt[0], lookAt[1], lookAt[2]));
    view.name = params.getText("view", "",
                               {"a path or camera of the scene, or where from to frame it, "
                                "\"AZIMUTH ELEVATION\" in degrees; none: three quarters"});
    view.towardsEye = kit::towardsEyeOf(view.name);
    if (view.towardsEye) view.name.clear();
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
      measuresErrors(params.getBool(
          "errors", false,
          {"compares with a supersampled image, full EWA, uncompressed points, and the "
           "surface itself where points were taken of one"})),
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
    if (method == Method::PlainPoints) {
        params.refuseGiven({"storage", "low_pass_radius_px", "cutoff", "visibility_offset"},
                           "a method of splats");
    }
    if (!view.name.empty()) {
        params.refuseGiven({"distance", "rotation_deg", "look_at"}, "a 'view' that frames it");
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

namespace {

/// What a camera frames; grown by a splat where all of it is not larger than one.
scene::Box framedBox(const scene::PointCloud& points) {
    scene::Box box = points.framed();
    const float radius = *std::max_element(points.radii.begin(), points.radii.end());
    if (glm::length(box.size()) < radius) {
        box.min -= radius;
        box.max += radius;
    }
    return box;
}

}  // namespace

scene::Camera turntableCamera(const scene::Box& box, float aspect, const ViewSettings& settings) {
    scene::Camera camera = settings.towardsEye
                               ? scene::framingCamera(box, aspect, *settings.towardsEye)
                               : scene::framingCamera(box, aspect);
    const glm::vec3 target = box.min + settings.lookAt * box.size();
    const glm::vec3 back = camera.position - camera.target;
    const glm::mat4 turn =
        glm::rotate(glm::mat4(1.0F), settings.rotationRad, glm::vec3(0.0F, 1.0F, 0.0F));
    camera.position = target + settings.distance * glm::vec3(turn * glm::vec4(back, 0.0F));
    camera.target = target;
    if (camera.up.y == 0.0F) camera.up = glm::vec3(turn * glm::vec4(camera.up, 0.0F));
    // Around the box, wherever in it the eye looks; the near plane a thousandth of that away at
    // least, as depths of 24 bits want.
    const float diagonal = glm::length(box.size());
    const float distance = glm::length(camera.position - box.centre());
    camera.farM = distance + diagonal;
    camera.nearM = std::max(distance - diagonal, 1e-3F * camera.farM);
    return camera;
}

PointSplatting::PointSplatting(Params& params) : params_(params) {
    if (params.isGiven("points")) pointsAt_ = params.locationOf("points");
}

void PointSplatting::requireScene(const scene::Scene& scene) const {
    const bool hasPoints = !scene.points.positions.empty();
    if (!hasPoints && scene.triangleCount() == 0) {
        throw Error("technique 'point_splatting' needs a scene with points or triangles");
    }
    if (!params_.view.name.empty()) kit::stillCamera(scene, params_.view.name, 1.0F);
    if (hasPoints && pointsAt_) {
        throw Error(*pointsAt_, "'points' needs a scene without points of its own");
    }
}

scene::PointCloud PointSplatting::takePoints(const scene::Scene& scene) {
    const bool isTextured =
        std::ranges::any_of(scene.instances, [&](const scene::Instance& instance) {
            const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
            return !mesh.texcoords.empty() && materialOf(scene, mesh).baseColorTexture >= 0;
        });
    if (isTextured && scene.points.positions.empty()) {
        fmt::print(stderr, "warning: scene '{}': its points have no colours of its textures\n",
                   scene.name);
    }
    scene::PointCloud points =
        scene.points.positions.empty()
            ? scene::sampledPoints(scene, static_cast<std::size_t>(params_.points))
            : scene.points;
    repairs_ = scene::completePoints(points);
    return points;
}

void PointSplatting::setup(technique::SetupContext& context) {
    shaders_ = &context.shaders;
    shared_ = context.shared;
    sizePx_ = context.outputSizePx;
    scene::PointCloud points = takePoints(*context.scene);
    const auto begin = std::chrono::steady_clock::now();
    model_ = params_.keepsModel
                 ? ModelFile::openOrBuild(cacheFolder() / "points", points, params_.tree)
                 : ModelFile::build(points, params_.tree);
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - begin;
    preprocessMs_ = elapsed.count();
    framedBox_ = framedBox(points);
    if (params_.measuresErrors) surface_ = std::move(points.surface);
    views_.cameras = context.scene->cameras;
    views_.paths = context.scene->paths;
    if (params_.method == Method::PlainPoints) {
        renderer_ = std::make_unique<PlainPoints>(context.shaders, *model_, sizePx_);
    } else {
        auto splats =
            std::make_unique<SplatRenderer>(context.shaders, *model_, params_.splats, sizePx_);
        splats_ = splats.get();
        renderer_ = std::move(splats);
    }
}

scene::Camera PointSplatting::cameraAt(int frame, int frameCount) const {
    ViewSettings view = params_.view;
    const glm::vec2 size(sizePx_);
    if (!view.name.empty()) {
        return kit::cameraFor(views_, view.name, frame, frameCount, size.x / size.y);
    }
    view.rotationRad +=
        glm::two_pi<float>() * static_cast<float>(frame) / static_cast<float>(frameCount);
    return turntableCamera(framedBox_, size.x / size.y, view);
}

void PointSplatting::render(technique::FrameContext& context) {
    frame_ = context.frame;
    camera_ = cameraAt(context.frame, context.frameCount);
    view_ = patchViewOf(camera_, sizePx_);
    draw(context.profiler);
}

void PointSplatting::draw(gl::Profiler& profiler) {
    {
        const gl::CpuScope scope(profiler, "selection");
        counts_ =
            selectPatches(model_->patches(), model_->levels(), view_, params_.selection, drawn_);
    }
    renderer_->render(drawn_, view_, profiler);
}

image::ImageF PointSplatting::drawnWith(const SplatSettings& splats,
                                        const SelectionSettings& selection, int scale) const {
    const glm::ivec2 sizePx = scale * sizePx_;
    SplatRenderer renderer(*shaders_, *model_, splats, sizePx);
    const PatchView view = patchViewOf(camera_, sizePx);
    std::vector<DrawnPatch> drawn;
    selectPatches(model_->patches(), model_->levels(), view, selection, drawn);
    gl::Profiler unread(false);
    renderer.render(drawn, view, unread);
    return renderer.output().readImage(4);
}

namespace {

config::Outputs outputs() {
    using config::Better;
    const auto detail = [](const char* name, const char* unit, const char* doc,
                           Better better = Better::Neither) {
        return config::MetricInfo{name, unit, doc, better, true};
    };
    return {
        {
            {"points", "point", "points of the model"},
            {"drawn_points", "point", "points drawn in a frame"},
            {"drawn_pct", "%", "points drawn in a frame, as a share of the model's"},
            {"display_psnr_db", "dB",
             "peak signal-to-noise ratio as displayed, in sRGB of 8 bits, to the truth that the "
             "pass "
             "names, over the model's pixels; 100 for equal pictures",
             Better::Higher},
            {"display_ssim", "1",
             "structural similarity as displayed, to the truth that the pass names",
             Better::Higher},
            {"display_flip", "1",
             "mean FLIP error to the truth that the pass names, over the model's pixels",
             Better::Lower},
            {"mode_pct", "%",
             "share of the drawn points that are drawn in the mode that the pass names"},
            {"selection_ms", "ms", "time to choose patches and levels", Better::Lower},
            {"drawn_points_per_second", "point/s",
             "points drawn per second, in frames that do not wait between passes", Better::Higher},
            {"model_points_per_second", "point/s",
             "points of the whole model per second, drawn or not, in the same frames",
             Better::Higher},
            {"preprocess_ms", "ms", "time to make patches and levels, or to map them from a file",
             Better::Lower, true, config::MetricInfo::Of::Either, true},
            {"patches", "patch", "patches of the model"},
            detail("patches_drawn", "patch", "patches drawn in a frame"),
            detail("patches_outside", "patch", "patches outside the view"),
            detail("patches_turned_away", "patch",
                   "patches left out because all their normals turn away"),
            detail("facing_pct", "%", "share of the model's points that face the eye"),
            detail("normals_estimated", "point", "points that came without a normal"),
            detail("radii_estimated", "point", "points that came without a radius"),
            detail("points_dropped", "point",
                   "points that are left out: doubles, and those of which no splat can be made"),
            {"point_bytes", "byte", "memory of all points on the device", Better::Lower},
            {"bytes_per_point", "byte", "memory of a point", Better::Lower},
            detail("target_bytes", "byte", "memory of the images that are drawn to", Better::Lower),
            {"arrived_bytes", "byte",
             "bytes of a stream that have arrived when the frame is drawn"},
            detail("bits_before", "bit", "bits of an attribute before compression"),
            detail("bits_after", "bit", "bits of an attribute after compression", Better::Lower),
            detail("bits_stored", "bit", "bits that an attribute takes as records are laid out",
                   Better::Lower),
            {"compression_error_mean", "%",
             "mean error by compression: of a position as a share of its patch's diagonal, of a "
             "radius as a share of itself",
             Better::Lower},
            {"compression_error_max", "%", "largest error by compression, as above", Better::Lower},
            {"compression_angle_mean", "degree",
             "mean angle by which compression turns a normal or a tangent", Better::Lower},
            {"compression_angle_max", "degree",
             "largest angle by which compression turns a normal or a tangent", Better::Lower},
            {"compression_error_of_bound", "1",
             "largest error by compression ÷ what the grid of values allows", Better::Lower},
        },
        {
            {"selection", "choosing patches and levels for the view"},
            {"points", "drawing plain points, the baseline"},
            {"sprites", "drawing a textured square for each point, the fastest mode"},
            {"visibility", "drawing the depths of the splats"},
            {"splats", "blending the splats"},
            {"normalization", "dividing sums by weights"},
            {"full_ewa", "full EWA: points in that mode, or as the truth of the same points"},
            {"reconstruction", "the mode without the low-pass filter"},
            {"low_pass", "the mode of the low-pass filter alone"},
            {"sprite", "the mode of sprites"},
            {"supersampled", "a truth with many samples per pixel"},
            {"filtered", "a truth with many samples per pixel, filtered as splats are"},
            {"uncompressed", "a truth from uncompressed points"},
            {"surface", "a truth by rays of the surface that the points were taken of"},
            {"built", "where patches and levels were made"},
            {"mapped", "where they were mapped from a file"},
            {"position", "of positions"},
            {"normal", "of normals"},
            {"tangents", "of the two tangents"},
            {"corner", "of the splat's corner"},
            {"radius", "of radii"},
            {"total", "of the whole point"},
            {"device", "of a point on the device, with what all points share"},
        },
        false,
        {"image"},
        {"display_psnr_db", "display_ssim", "display_flip", "mode_pct", "preprocess_ms",
         "bits_before", "bits_after", "bits_stored", "compression_error_mean",
         "compression_error_max", "compression_angle_mean", "compression_angle_max",
         "compression_error_of_bound"}};
}

}  // namespace

const technique::TechniqueInfo kPointSplatting{
    "point_splatting", "adaptive EWA splatting of large point models (zju2005, chapter 3)",
    technique::make<PointSplatting>, outputs};

}  // namespace gfxrepro::point_splatting
