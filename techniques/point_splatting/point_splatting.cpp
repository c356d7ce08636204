#include "techniques/point_splatting/point_splatting.h"

#include <algorithm>
#include <chrono>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/files.h"
#include "techniques/kit/requirements.h"
#include "techniques/point_splatting/outputs.h"

namespace gfxrepro::point_splatting {
namespace {

/// The points' box; grown by a splat where all of it is not larger than one.
scene::Box framedBox(const ModelFile& model) {
    scene::Box box = model.bounds();
    const float radius = *std::max_element(model.radii().begin(), model.radii().end());
    if (glm::length(box.size()) < radius) {
        box.min -= radius;
        box.max += radius;
    }
    return box;
}

}  // namespace

scene::Camera turntableCamera(const scene::Box& box, float aspect, const ViewSettings& settings) {
    scene::Camera camera = scene::framingCamera(box, aspect);
    const glm::vec3 target = box.min + settings.lookAt * box.size();
    const glm::vec3 back = camera.position - camera.target;
    const glm::mat4 turn =
        glm::rotate(glm::mat4(1.0F), settings.rotationRad, glm::vec3(0.0F, 1.0F, 0.0F));
    camera.position = target + settings.distance * glm::vec3(turn * glm::vec4(back, 0.0F));
    camera.target = target;
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
    if (hasPoints && pointsAt_) {
        throw Error(*pointsAt_, "'points' needs a scene without points of its own");
    }
}

scene::PointCloud PointSplatting::takePoints(const scene::Scene& scene) {
    scene::PointCloud points =
        scene.points.positions.empty()
            ? scene::sampledPoints(scene, static_cast<std::size_t>(params_.points))
            : scene.points;
    repairs_ = scene::completePoints(points);
    return points;
}

void PointSplatting::setup(technique::SetupContext& context) {
    shaders_ = &context.shaders;
    sizePx_ = context.outputSizePx;
    const scene::PointCloud points = takePoints(*context.scene);
    const auto begin = std::chrono::steady_clock::now();
    model_ = params_.keepsModel
                 ? ModelFile::openOrBuild(cacheFolder() / "points", points, params_.tree)
                 : ModelFile::build(points, params_.tree);
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - begin;
    preprocessMs_ = elapsed.count();
    framedBox_ = framedBox(*model_);
    if (params_.method == Method::Compute) {
        ComputeSplatSettings settings;
        settings.storage = params_.splats.storage;
        splatter_.emplace(context.shaders, *model_, settings, sizePx_);
    } else if (params_.method == Method::GlPoints) {
        plain_.emplace(context.shaders, *model_, sizePx_);
    } else {
        renderer_.emplace(context.shaders, *model_, params_.splats, sizePx_);
    }
}

scene::Camera PointSplatting::cameraAt(int frame, int frameCount) const {
    ViewSettings view = params_.view;
    view.rotationRad +=
        glm::two_pi<float>() * static_cast<float>(frame) / static_cast<float>(frameCount);
    const glm::vec2 size(sizePx_);
    return turntableCamera(framedBox_, size.x / size.y, view);
}

void PointSplatting::render(technique::FrameContext& context) {
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
    if (splatter_) {
        splatter_->render(drawn_, view_, profiler);
    } else if (plain_) {
        plain_->render(drawn_, view_, profiler);
    } else {
        renderer_->render(drawn_, view_, profiler);
    }
}

const gl::Texture& PointSplatting::output() const {
    if (plain_) return plain_->output();
    return splatter_ ? splatter_->output() : renderer_->output();
}
std::size_t PointSplatting::pointBytes() const {
    if (plain_) return plain_->pointBytes();
    return splatter_ ? splatter_->pointBytes() : renderer_->pointBytes();
}
std::size_t PointSplatting::targetBytes() const {
    if (plain_) return plain_->targetBytes();
    return splatter_ ? splatter_->targetBytes() : renderer_->targetBytes();
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
std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<PointSplatting>(params);
}
}  // namespace

const technique::TechniqueInfo kPointSplatting{
    "point_splatting", "adaptive EWA splatting of large point models (zju2005, chapter 3)", create,
    outputs};

}  // namespace gfxrepro::point_splatting
