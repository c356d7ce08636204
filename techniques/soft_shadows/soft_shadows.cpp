#include "techniques/soft_shadows/soft_shadows.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/trigonometric.hpp>

#include "engine/core/error.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/number.h"
#include "techniques/kit/path_view.h"
#include "techniques/kit/percent.h"
#include "techniques/kit/picture.h"
#include "techniques/kit/requirements.h"

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

constexpr Choice<LightViewFrame> kLightViewFrames[] = {
    {LightViewFrame::Parallel, "parallel", "image planes parallel to the light, frusta off centre"},
    {LightViewFrame::Aimed, "aimed", "each looks at the centre of the scene's box"},
};
constexpr Choice<kit::Redundancy> kRedundancies[] = {
    {kit::Redundancy::Pixel, "pixel",
     "an earlier image holds the triangle where the sample lands (algorithm 3)"},
    {kit::Redundancy::Visibility, "visibility",
     "an earlier view sees the sample (algorithm 2), by a shadow map's test"},
};
constexpr Choice<Timed> kTimed[] = {
    {Timed::SoftShadow, "soft_shadow", "the light's visibility"},
    {Timed::DepthAndPass, "depth_and_pass",
     "a yardstick: for each light sample a depth-only draw of the casters and a pass over the "
     "image that only writes"},
};

AreaLightSettings readLight(Params& params) {
    AreaLightSettings light;
    light.sizeRatio =
        kit::number(params, "light_ratio", 1.0F,
                    {"diagonal of the square light : diagonal of the scene's box; 0 is a point",
                     "1", 0.0, 16.0});
    light.height =
        kit::number(params, "light_height", 1.5F,
                    {"distance of the light from the centre of the box", "diagonals", 0.01, 100.0});
    light.azimuthRad = glm::radians(
        kit::number(params, "light_azimuth_deg", 35.0F,
                    {"direction to the light about y, from +z towards +x", "°", -360.0, 360.0}));
    light.elevationRad = glm::radians(kit::number(params, "light_elevation_deg", 60.0F,
                                                  {"… above the horizon", "°", -90.0, 90.0}));
    light.viewFrame = params.getEnum("light_view_frame", LightViewFrame::Parallel, kLightViewFrames,
                                     {"how the views from the light's points stand"});
    return light;
}

ReconstructionSettings readReconstruction(Params& params) {
    ReconstructionSettings settings;
    settings.method = params.getEnum("reconstruction", Reconstruction::Hybrid, kReconstructions,
                                     {"how depth images become meshes"});
    settings.discontinuityPx = kit::number(
        params, "discontinuity", settings.discontinuityPx,
        {"depth off a sample's plane at which a corner is another surface's", "pixels", 0.0, 1e6});
    settings.grazingLimitPx = kit::number(
        params, "grazing_limit", settings.grazingLimitPx,
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
      simplifyTo(
          kit::number(params, "simplify_to", 1.0F,
                      {"share of a mesh's triangles that simplification keeps; 1 leaves it as "
                       "reconstructed",
                       "1", 0.001, 1.0})),
      simplificationError(kit::number(
          params, "simplification_error", 0.001F,
          {"bound on how far simplification moves the surface", "diagonals", 0.0, 1.0})),
      view(params.getText("view", "",
                          {"a path of the scene, seen from its middle, a camera, \"X Y Z > X Y Z\" "
                           "from and to, or where from to "
                           "frame it, \"AZIMUTH ELEVATION\" in degrees; none: its first camera"})),
      light(readLight(params)),
      lightGrid(params.getInt("light_grid", 8,
                              {"light samples along each edge; the thesis has 16", "1", 1, 64})),
      hasGround(params.getBool("ground", true, {"a square floor under the scene"})),
      groundSize(
          kit::number(params, "ground_size", 1.5F, {"side of the floor", "diagonals", 0.0, 100.0})),
      measured(params.getEnum("measured", Timed::SoftShadow, kTimed, {"what is timed"})),
      measuresErrors(
          params.getBool("errors", true, {"compare with shadow maps of the original geometry"})),
      tracesTruth(params.getBool("traced_truth", false, {"compares with shadow rays, too"})),
      seesFromLight(params.getBool(
          "light_views", false,
          {"compares the casters with the geometry as seen from the light and from beside it"})),
      showsPictures(
          params.getBool("pictures", false, {"shadows, errors, and what light_views compares"})) {
    shadowMap.sizePx =
        // As a depth image: the bias of one texel covers a quad that stands a pixel before its
        // surface.
        params.getInt("shadow_map_size", 512, {"side of a shadow map", "pixels", 1, 16384});
    shadowMap.biasTexels =
        kit::number(params, "shadow_bias", 1.0F,
                    {"how far a receiver is moved before the test", "texels", 0.0, 1000.0});
    params.finish();
    if (!reconstructs()) {
        params.refuseGiven({"reference_images", "reference_size", "reconstruction", "discontinuity",
                            "grazing_limit", "merge_rows", "simplify_to", "simplification_error"},
                           "a method that takes depth images: non_redundant, conventional or "
                           "depth_peeling");
    }
    if (method != Method::NonRedundant) {
        params.refuseGiven({"redundancy"}, "'method: non_redundant'");
    }
    if (reconstruction.method == Reconstruction::Classic) {
        params.refuseGiven({"grazing_limit", "merge_rows"}, "'reconstruction: hybrid'");
    }
    if (measured == Timed::DepthAndPass) {
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

namespace {

/// A floor under the box, below whatever floor the scene has.
void addGround(scene::Scene& scene, float sizeInDiagonals) {
    const scene::Box box = scene.bounds();
    const float diagonal = glm::length(box.size());
    const float half = 0.5F * sizeInDiagonals * diagonal;
    const float y = box.min.y - 1e-3F * diagonal;
    const glm::vec3 c = box.centre();
    scene::Mesh ground;
    ground.name = "ground";
    ground.positions = {{c.x - half, y, c.z + half},
                        {c.x + half, y, c.z + half},
                        {c.x + half, y, c.z - half},
                        {c.x - half, y, c.z - half}};
    ground.normals.assign(4, glm::vec3(0, 1, 0));
    ground.triangles = {{0, 1, 2}, {0, 2, 3}};
    ground.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back({.name = "ground", .baseColor = {0.55F, 0.52F, 0.47F, 1.0F}});
    scene.instances.push_back({.mesh = static_cast<int>(scene.meshes.size())});
    scene.meshes.push_back(std::move(ground));
}

/// Errors of a picture without a surface would be 0.
void requireReceivers(const HostReceivers& receivers, const scene::Camera& camera) {
    if (receivers.covered() > 0) return;
    const glm::vec3& eye = camera.position;
    throw Error(
        fmt::format("the picture shows no surface: from ({:g}, {:g}, {:g}) nothing of the scene or "
                    "its ground is in view; change the scene's camera",
                    eye.x, eye.y, eye.z));
}

}  // namespace

SoftShadows::SoftShadows(Params& params) : params_(params) {}

void SoftShadows::requireScene(const scene::Scene& scene) const {
    kit::requireTriangles(scene, "soft_shadows");
    kit::stillCamera(scene, params_.view, 1.0F);
}

void SoftShadows::setup(technique::SetupContext& context) {
    shaders_ = &context.shaders;
    shared_ = context.shared;
    scene_ = *context.scene;
    light_ = makeAreaLight(scene_.bounds(), params_.light);
    for (int corner = 0; corner < 4; ++corner) {
        lightView(light_, light_.corner(corner), 64);
        if (params_.hasGround && light_.corner(corner).y < light_.casters.min.y) {
            throw Error(
                "the light reaches below the floor: raise light_height or light_elevation_deg, "
                "lower light_ratio, or 'ground: false'");
        }
    }
    const glm::vec2 size(context.outputSizePx);
    const scene::Camera camera = kit::stillCamera(scene_, params_.view, size.x / size.y);
    if (params_.hasGround) addGround(scene_, params_.groundSize);

    drawable_.emplace(scene_);
    geometry_.emplace(context.shaders, *drawable_);
    receivers_ =
        renderReceivers(context.shaders, *drawable_, kit::viewOf(camera, context.outputSizePx));
    hostReceivers_ = readReceivers(receivers_);
    requireReceivers(hostReceivers_, camera);
    mask_ = LightVisibility::makeMask(context.outputSizePx, params_.lightGrid);
    if (params_.method == Method::RayTraced || params_.tracesTruth) tracer_.emplace(scene_);
    visibility_.emplace(context.shaders, params_.shadowMap);
    if (params_.isFiltered()) {
        filtered_.emplace(
            context.shaders,
            params_.method == Method::Pcss ? ShadowFilter::Pcss : ShadowFilter::Variance,
            params_.shadowMap);
        litShares_ = FilteredShadows::makeShares(context.outputSizePx);
    }
    if (!params_.reconstructs()) return;
    triangleNormals_ = triangleNormals(scene::flattened(scene_), context.device.limits());
    renderer_.emplace(context.shaders, kit::TriangleIds::PrimitiveId, kit::DepthFormat::Float32);
    reconstructor_.emplace(context.shaders, params_.reconstruction);
    makeReferenceTargets();
}

std::vector<glm::vec3> SoftShadows::referencePoints() const {
    std::vector<glm::vec3> points;
    for (int i = 0; i < params_.referenceImages; ++i) {
        if (params_.method == Method::DepthPeeling) {
            points.push_back(light_.centre);
        } else if (i < 4) {
            points.push_back(light_.corner(i));
        } else {
            // Beyond the four of the thesis: inside the light, in the order of the 4 × 4 samples
            // that are farthest from those before (a bit-reversed walk).
            constexpr glm::ivec2 kInside[] = {{2, 2}, {0, 2}, {2, 0}, {1, 1}, {3, 1}, {1, 3},
                                              {3, 3}, {0, 1}, {1, 0}, {2, 3}, {3, 2}, {2, 1}};
            const glm::ivec2 cell = kInside[i - 4];
            points.push_back(light_.sample(cell.x, cell.y, 4));
        }
    }
    return points;
}

void SoftShadows::makeReferenceTargets() {
    const bool isHybrid = params_.reconstruction.method == Reconstruction::Hybrid;
    for (const glm::vec3& point : referencePoints()) {
        const kit::View view = lightView(light_, point, params_.referenceSizePx);
        images_.push_back(renderer_->makeImage(view));
        if (params_.redundancy == kit::Redundancy::Visibility)
            seen_.push_back(renderer_->makeImage(view));
        if (!isHybrid) continue;
        offsetImages_.push_back(renderer_->makeImage(kit::withOffset(view, glm::vec2(-0.5F))));
    }
}

void SoftShadows::render(technique::FrameContext& context) {
    gl::Profiler& profiler = context.profiler;
    if (params_.method == Method::RayTraced) {
        const gl::CpuScope scope(profiler, "soft_shadow");
        tracedMask_ = traceVisibility(*tracer_, hostReceivers_, light_, params_.lightGrid);
        return;
    }
    if (params_.reconstructs()) {
        caster_.reset();  // the last iteration's meshes, before there are new ones
        {
            const gl::GpuScope scope(profiler, "reference_images");
            renderReferenceImages();
        }
        std::vector<ReconstructedMesh> meshes;
        {
            const gl::GpuScope scope(profiler, "reconstruction");
            if (!offsetImages_.empty()) {
                const gl::GpuScope offsetScope(profiler, "offset_images");
                renderOffsetImages();
            }
            meshes = reconstructMeshes();
        }
        caster_ = makeCaster(std::move(meshes), profiler);
    }
    const ShadowCaster* casters[] = {caster_ ? caster_.get() : &*geometry_};
    if (params_.measured == Timed::DepthAndPass) {
        const gl::GpuScope scope(profiler, "depth_and_pass");
        visibility_->drawMapsAndPlainPasses(mask_, light_, params_.lightGrid, casters);
        return;
    }
    const gl::GpuScope scope(profiler, "soft_shadow");
    if (params_.isFiltered()) {
        filtered_->render(receivers_, light_, casters, litShares_);
    } else {
        visibility_->accumulate(mask_, receivers_, light_, params_.lightGrid, casters);
    }
}

// [xie2017] Algorithm 5, step 1
void SoftShadows::renderReferenceImages() {
    for (kit::DepthImage& image : seen_) renderer_->render(*drawable_, image);
    for (std::size_t i = 0; i < images_.size(); ++i) {
        renderer_->render(*drawable_, images_[i], earlierOf(i), params_.redundancy);
    }
}

std::vector<const kit::DepthImage*> SoftShadows::earlierOf(std::size_t i) const {
    if (params_.method == Method::Conventional) return {};
    return kit::firstOf(params_.redundancy == kit::Redundancy::Visibility ? seen_ : images_, i);
}

// H of Algorithm 4. H drops what Iⱼ have, j < i. A peeled layer of H drops what the layers of H
// before it have: in Iⱼ its samples would land on corners of pixels, and rounding would decide. Of
// H depths and ids are read alone.
void SoftShadows::renderOffsetImages() {
    for (std::size_t i = 0; i < offsetImages_.size(); ++i) {
        const bool isPeeling = params_.method == Method::DepthPeeling;
        renderer_->render(*drawable_, offsetImages_[i],
                          isPeeling ? kit::firstOf(offsetImages_, i) : earlierOf(i),
                          params_.redundancy, kit::DepthImageRenderer::Content::Samples);
    }
}

// [xie2017] Algorithm 5, step 2
std::vector<ReconstructedMesh> SoftShadows::reconstructMeshes() {
    std::vector<ReconstructedMesh> meshes;
    meshCounts_ = {};
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const kit::DepthImage* offsetImage = offsetImages_.empty() ? nullptr : &offsetImages_[i];
        meshes.push_back(reconstructor_->reconstruct(images_[i], offsetImage, triangleNormals_));
        const ReconstructedMesh& mesh = meshes.back();
        meshCounts_.samples += mesh.sampleCount;
        meshCounts_.triangles += mesh.triangleCount;
        meshCounts_.bytes += mesh.sizeBytes();
    }
    return meshes;
}

std::unique_ptr<ShadowCaster> SoftShadows::makeCaster(std::vector<ReconstructedMesh> meshes,
                                                      gl::Profiler& profiler) {
    if (params_.simplifyTo == 1.0F) {
        return std::make_unique<ReconstructedCaster>(*shaders_, std::move(meshes));
    }
    const gl::CpuScope scope(profiler, "simplification");
    const float diagonal = glm::length(light_.casters.size());
    scene::Scene simplifiedScene;
    simplificationErrorM_ = 0.0F;
    for (const ReconstructedMesh& mesh : meshes) {
        SimplifiedMesh result = simplified(
            toWorldMesh(mesh), {params_.simplifyTo, params_.simplificationError * diagonal});
        simplificationErrorM_ = std::max(simplificationErrorM_, result.errorM);
        simplifiedScene.instances.push_back(
            {.mesh = static_cast<int>(simplifiedScene.meshes.size())});
        simplifiedScene.meshes.push_back(std::move(result.mesh));
    }
    return std::make_unique<MeshCaster>(*shaders_, scene::flattened(simplifiedScene));
}

HostVisibilityMask SoftShadows::measuredMask() const {
    return params_.method == Method::RayTraced ? *tracedMask_ : readMask(mask_);
}

std::shared_ptr<const HostVisibilityMask> SoftShadows::sharedTruth(
    const char* name, const std::function<HostVisibilityMask()>& make) const {
    return technique::sharedResult<HostVisibilityMask>(
        shared_, name,
        {"method", "redundancy", "reference_images", "reference_size", "reconstruction",
         "discontinuity", "grazing_limit", "merge_rows", "simplify_to", "simplification_error"},
        make);
}

const HostVisibilityMask& SoftShadows::geometryTruth() {
    if (!geometryTruth_) {
        geometryTruth_ = sharedTruth("geometry", [&] {
            const glm::ivec2 sizePx = receivers_.view.sizePx;
            VisibilityMask mask = LightVisibility::makeMask(sizePx, params_.lightGrid);
            const ShadowCaster* casters[] = {&*geometry_};
            visibility_->accumulate(mask, receivers_, light_, params_.lightGrid, casters);
            return readMask(mask);
        });
    }
    return *geometryTruth_;
}

const HostVisibilityMask& SoftShadows::tracedTruth() {
    if (!tracedTruth_) {
        tracedTruth_ = sharedTruth("ray_traced", [&] {
            return traceVisibility(*tracer_, hostReceivers_, light_, params_.lightGrid);
        });
    }
    return *tracedTruth_;
}

void SoftShadows::record(technique::Recorder& recorder) {
    recorder.metric("coverage_pct",
                    kit::percent(hostReceivers_.covered(), hostReceivers_.positions.size()));
    if (params_.method == Method::RayTraced) return;
    const ShadowCaster& caster = caster_ ? *caster_ : *geometry_;
    recorder.metric("caster_triangles", static_cast<double>(caster.triangleCount()));
}

void SoftShadows::recordOnce(technique::Recorder& recorder) {
    if (params_.measuresErrors) recordErrors(recorder, "geometry", geometryTruth());
    if (params_.tracesTruth) recordErrors(recorder, "ray_traced", tracedTruth());
    if (params_.reconstructs()) recordMeshes(recorder);
    if (params_.showsPictures) recordPicture(recorder);
    if (!params_.seesFromLight) return;
    recordLightView(recorder, "inside", light_.centre);
    // As far beyond the edge as the edge is from the centre, seen from there.
    recordLightView(recorder, "outside", light_.at({2.0F, 0.0F}));
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
    const VisibilityErrors errors =
        params_.isFiltered() ? compareShares(litShares_.read<float>(GL_RED, GL_FLOAT, 1), truth)
                             : compareMasks(measuredMask(), truth);
    recorder.metric("intensity_error_mean", errors.intensityMean, truthName);
    recorder.metric("intensity_error_max", errors.intensityMax, truthName);
    if (!params_.isFiltered()) {
        recorder.metric("visibility_error_mean", errors.visibilityMean, truthName);
        recorder.metric("visibility_error_max", errors.visibilityMax, truthName);
        recorder.metric("wrongly_lit_mean", errors.wronglyLitMean, truthName);
        recorder.metric("wrongly_dark_mean", errors.wronglyDarkMean, truthName);
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
    const MeshCounts& total = meshCounts_;
    const double perSample =
        total.samples == 0 ? 0.0
                           : static_cast<double>(total.bytes) / static_cast<double>(total.samples);
    recorder.metric("mesh_triangles", static_cast<double>(total.triangles));
    recorder.metric("bytes_per_sample", perSample);
    if (params_.simplifyTo < 1.0F) {
        recorder.metric("simplification_error", simplificationErrorM_);
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
    const LightViewAgreement agreement =
        compareDepths(view, light_.casters, truth, measured, params_.referenceSizePx);
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

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"intensity_error_mean", "light sample",
             "how many light samples too many or too few light a pixel, mean of all pixels",
             Better::Lower},
            {"intensity_error_max", "light sample", "intensity error of the worst pixel",
             Better::Lower},
            {"visibility_error_mean", "light sample",
             "light samples that a pixel sees wrongly either way, mean of all pixels",
             Better::Lower},
            {"wrongly_lit_mean", "light sample",
             "of these, samples that light a pixel and should not", Better::Lower, kIsDetail},
            {"wrongly_dark_mean", "light sample",
             "of these, samples that should light a pixel and do not", Better::Lower, kIsDetail},
            {"visibility_error_max", "light sample", "visibility error of the worst pixel",
             Better::Lower},
            {"coverage_pct", "%", "share of the picture's pixels that show a surface",
             Better::Neither, kIsDetail},
            {"caster_triangles", "triangle", "triangles that cast the shadows"},
            {"mesh_triangles", "triangle", "triangles of the meshes made of depth images"},
            {"bytes_per_sample", "byte", "memory of the meshes for each sample of the depth images",
             Better::Lower, kIsDetail},
            {"simplification_error", "m", "largest distance by which simplification moved a mesh",
             Better::Lower},
            {"missing_pct", "%", "share of the casters seen from the light that the meshes lack",
             Better::Lower},
            {"nearer_pct", "%",
             "share of the casters seen from the light that the meshes stand before",
             Better::Lower},
        },
        {
            {"depth_and_pass", "drawing the receivers' points as the eye sees them"},
            {"reference_images", "drawing depth images of the casters"},
            {"reconstruction", "making meshes of the depth images"},
            {"offset_images", "of that: finding which samples neighbouring images have"},
            {"simplification", "reducing the triangles of the meshes"},
            {"soft_shadow", "testing the visibility of all light samples"},
            {"geometry", "errors against shadow maps of the geometry"},
            {"ray_traced", "errors against traced rays"},
            {"inside", "as seen from the light's centre"},
            {"outside", "as seen from beyond the light's edge"},
        },
        false,
        {"shadow", "casters_inside", "casters_outside"},
        {"intensity_error_mean", "intensity_error_max", "visibility_error_mean",
         "visibility_error_max", "wrongly_lit_mean", "wrongly_dark_mean", "missing_pct",
         "nearer_pct"}};
}

}  // namespace

const technique::TechniqueInfo kSoftShadows{
    "soft_shadows", "soft shadows of a rectangular light from reconstructed depth images",
    technique::make<SoftShadows>, outputs};

}  // namespace gfxrepro::soft_shadows
