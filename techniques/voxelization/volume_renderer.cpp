#include "techniques/voxelization/volume_renderer.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "engine/core/error.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/path_view.h"
#include "techniques/kit/view.h"
#include "techniques/voxelization/phantom.h"

namespace gfxrepro::voxelization {
namespace {

/// Right, up and backwards, unit, world space.
glm::mat3 frameOf(const scene::Camera& camera) {
    const glm::vec3 backwards = glm::normalize(camera.position - camera.target);
    const glm::vec3 right = glm::normalize(glm::cross(camera.up, backwards));
    return {right, glm::cross(backwards, right), backwards};
}

/// From the upper left behind the eye.
glm::vec3 headlight(const scene::Camera& camera) {
    return frameOf(camera) * glm::normalize(glm::vec3(-0.5F, 0.7F, 1.0F));
}

/// What is flat would be a strip of the picture, seen from as low as others are.
double usualElevationDeg(const scene::Box& framed) {
    const glm::vec3 size = framed.size();
    return size.y < 0.125F * std::min(size.x, size.z) ? 45.0 : 17.0;
}

/// Moves the eye of a camera whose target lies in the grid back until it is outside: of something
/// thin, seen along itself, the nearest eye that holds it may not be.
void moveOutOf(const scene::Box& grid, scene::Camera& camera) {
    const float distance = glm::distance(camera.position, camera.target);
    const glm::vec3 back = (camera.position - camera.target) / distance;
    float leaves = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const float side = back[axis] < 0.0F ? grid.min[axis] : grid.max[axis];
        if (back[axis] != 0.0F) {
            leaves = std::min(leaves, (side - camera.target[axis]) / back[axis]);
        }
    }
    const float move = std::max(1.01F * leaves - distance, 0.0F);
    camera.position += move * back;
    camera.nearM += move;
    camera.farM += move;
}

}  // namespace

scene::Camera orbitCamera(const scene::Box& box, double azimuthDeg, double elevationDeg,
                          float aspect) {
    constexpr float kFovRad = 0.5F;
    constexpr float kMargin = 1.03F;
    const auto azimuth = static_cast<float>(glm::radians(azimuthDeg));
    const auto elevation = static_cast<float>(glm::radians(elevationDeg));
    scene::Camera camera;
    camera.target = box.centre();
    camera.position =
        camera.target + glm::vec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                  std::cos(azimuth) * std::cos(elevation));
    // Straight from above or below, the picture's upper side is where the azimuth would look to.
    if (std::abs(std::cos(elevation)) < 1e-3F) {
        camera.up = {-std::sin(azimuth), 0.0F, -std::cos(azimuth)};
    }
    camera.verticalFovRad = kFovRad;

    const glm::mat3 frame = frameOf(camera);
    const float tangentY = std::tan(0.5F * kFovRad) / kMargin;
    const glm::vec2 tangent(tangentY * aspect, tangentY);
    float distance = 0.0F;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::vec3 local =
            glm::transpose(frame) * (glm::mix(box.min, box.max, side) - camera.target);
        distance = std::max({distance, local.z + std::abs(local.x) / tangent.x,
                             local.z + std::abs(local.y) / tangent.y});
    }
    const float radius = 0.5F * glm::length(box.size());
    camera.position = camera.target + distance * frame[2];
    camera.nearM = std::max(distance - 4.0F * radius, 0.01F * distance);
    camera.farM = distance + 4.0F * radius;
    return camera;
}

scene::Camera cameraOf(const std::string& view, const scene::Scene& scene, const scene::Box& framed,
                       const scene::Box& grid, float aspect) {
    const auto towards = kit::towardsEyeOf(view);
    if (towards || view.empty()) {
        double azimuthDeg = 30.0, elevationDeg = usualElevationDeg(framed);  // ours
        if (towards) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(*towards));
            azimuthDeg = glm::degrees(std::atan2(d.x, d.z));
            elevationDeg = glm::degrees(std::asin(d.y));
        }
        scene::Camera camera = orbitCamera(framed, azimuthDeg, elevationDeg, aspect);
        moveOutOf(grid, camera);
        return camera;
    }
    scene::Camera camera = kit::stillCamera(scene, view, aspect);
    float nearest = 0.0F, farthest = 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
        const float eye = camera.position[axis];
        nearest = std::max({nearest, grid.min[axis] - eye, eye - grid.max[axis]});
    }
    if (nearest <= 0.0F) {
        throw Error(fmt::format(
            "view '{}': the eye lies within the grid, from {:g} {:g} {:g} to "
            "{:g} {:g} {:g}; allowed: one outside of it",
            view, grid.min.x, grid.min.y, grid.min.z, grid.max.x, grid.max.y, grid.max.z));
    }
    for (int corner = 0; corner < 8; ++corner) {
        farthest = std::max(farthest, glm::distance(camera.position, grid.corner(corner)));
    }
    // Planes are wider than the scene, and none is cut by its camera's.
    camera.farM = 1.01F * farthest;
    camera.nearM = 1e-3F * camera.farM;
    return camera;
}

PlaneView planeViewOf(const scene::Camera& camera, const scene::Box& box, const GridShape& shape,
                      glm::ivec2 sizePx) {
    const float voxelSize = voxelSizeOf(box, shape);
    const float aspect = static_cast<float>(sizePx.x) / static_cast<float>(sizePx.y);
    const glm::vec3 eye = (camera.position - box.min) / voxelSize;
    const glm::vec3 half = 0.5F * glm::vec3(shape.size);
    const glm::vec3 outside = glm::abs(half - eye) - half;

    PlaneView view;
    view.axis = Axis::X;
    if (outside.y > outside.x) view.axis = Axis::Y;
    if (outside.z > std::max(outside.x, outside.y)) view.axis = Axis::Z;
    view.eye = localFromVolume(view.axis, eye);
    const auto end = static_cast<float>(localFromVolume(view.axis, shape.size).z);
    GFXREPRO_ASSERT(view.eye.z < 0.0F || view.eye.z > end);
    view.clipFromVoxel = kit::viewOf(camera, sizePx).clipFromWorld() *
                         glm::translate(glm::mat4(1.0F), box.min) *
                         glm::scale(glm::mat4(1.0F), glm::vec3(voxelSize));

    const glm::mat3 frame = frameOf(camera);
    const float halfHeight = std::tan(0.5F * camera.verticalFovRad);
    const glm::vec3 right = frame[0] * halfHeight * aspect;
    const glm::vec3 up = frame[1] * halfHeight;
    view.rayOrigin = localFromVolume(view.axis, -frame[2] - right - up);
    view.rayRight = localFromVolume(view.axis, right) * (2.0F / static_cast<float>(sizePx.x));
    view.rayUp = localFromVolume(view.axis, up) * (2.0F / static_cast<float>(sizePx.y));
    return view;
}

VolumeRenderer::VolumeRenderer(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout,
                               const scene::Box& box, const scene::Camera& camera,
                               glm::ivec2 sizePx, const DrawSettings& settings)
    : layout_(layout),
      settings_(settings),
      view_(planeViewOf(camera, box, layout.shape(), sizePx)),
      eyeVolume_(volumeFromLocal(view_.axis, view_.eye)),
      light_(headlight(camera)) {
    GFXREPRO_ASSERT(settings.mode != DrawMode::None);
    const bool isOpaque = settings.mode == DrawMode::Opaque;
    gl::Defines defines = layout.defines();
    defines["AXIS"] = static_cast<int>(view_.axis);
    defines["CUT"] = settings.cut ? 1 : 0;
    defines["FRONT_TO_BACK"] = isOpaque ? 1 : 0;
    defines["HEAD"] = settings.mode == DrawMode::Mixed ? 1 : 0;
    defines["NORMALS"] = settings.value == VoxelValue::Normal ? 1 : 0;
    defines["SECOND"] = settings.hasSecond ? 1 : 0;
    if (settings.looksUpBits) {
        defines["TABLES"] = 1;
        bitOfByte_ = makeBitTable();
    }
    planes_ = gl::Pass(shaders,
                       {"voxelization/proxy_plane.vert.glsl",
                        isOpaque ? "voxelization/volume_opaque.frag.glsl"
                                 : "voxelization/volume_transparent.frag.glsl"},
                       defines);
    color_ = gl::Texture::make2D(GL_RGBA16F, sizePx);
    const std::array<const gl::Texture*, 1> color{&color_};
    colorTarget_ = gl::Framebuffer(color);
    if (!isOpaque) return;
    shade_ = gl::Pass(shaders, {"kit/whole_image.vert.glsl", "voxelization/volume_shade.frag.glsl"},
                      defines);
    hits_ = gl::Texture::make2D(GL_R32UI, sizePx);
    depth_ = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx);
    const std::array<const gl::Texture*, 1> hits{&hits_};
    hitTarget_ = gl::Framebuffer(hits, &depth_);
}

void VolumeRenderer::draw(const gl::Texture& sheets, const gl::Texture* second,
                          const gl::Texture* head) {
    gl::Resources volumes{{"sheets", sheets}};
    if (second) volumes = volumes.with({{"secondSheets", *second}});
    if (head) volumes = volumes.with({{"head", *head}});
    if (settings_.looksUpBits) volumes = volumes.with({{"bitOfByte", bitOfByte_}});
    vertexArray_.bind();
    glDisable(GL_CULL_FACE);
    if (settings_.mode == DrawMode::Opaque) {
        drawOpaque(volumes);
    } else {
        drawTransparent(volumes);
    }
}

void VolumeRenderer::drawOpaque(const gl::Resources& volumes) {
    hits_.clearToZero();
    hitTarget_.clearDepth(1.0F);
    hitTarget_.bind();
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    drawPlanes(volumes);

    colorTarget_.bind();
    setView(shade_);
    shade_.use(gl::Resources{{"hits", hits_}}.with(volumes));
    wholeImage_.draw();
}

// [zju2005] Sec. 2.4.2: alpha blending, back to front; premultiplied, since a slice may blend
// several voxels.
void VolumeRenderer::drawTransparent(const gl::Resources& volumes) {
    colorTarget_.clearColour(0, glm::vec4(1.0F));
    colorTarget_.bind();
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    drawPlanes(volumes);
    glDisable(GL_BLEND);
}

void VolumeRenderer::drawPlanes(const gl::Resources& volumes) const {
    setView(planes_);
    planes_.set("clipFromVoxel", view_.clipFromVoxel);
    planes_.set("eye", view_.eye);
    planes_.set("rayOrigin", view_.rayOrigin);
    planes_.set("rayRight", view_.rayRight);
    planes_.set("rayUp", view_.rayUp);
    planes_.use(volumes);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, planeCount());
}

/// What the shaders use, each its part.
void VolumeRenderer::setView(const gl::Program& program) const {
    program.setIfActive("light", light_);
    program.setIfActive("eyeVolume", eyeVolume_);
    program.setIfActive("opacity", settings_.opacity);
    if (!settings_.cut) return;
    const glm::vec3 size(layout_.shape().size);
    program.setIfActive("cutLow", glm::ivec3(glm::round(settings_.cut->min * size)));
    program.setIfActive("cutHigh", glm::ivec3(glm::round(settings_.cut->max * size)));
}

namespace {

constexpr int kHeadResolution = 128;  // [zju2005] Sec. 2.4.2

constexpr Choice<DrawMode> kModes[] = {
    {DrawMode::None, "none", "no picture"},
    {DrawMode::Opaque, "opaque", "the first voxel of each ray, shaded"},
    {DrawMode::Transparent, "transparent", "all voxels blended (section 2.4.2)"},
    {DrawMode::Mixed, "mixed", "blended together with a CT/MR head around the model (figure 2.7)"},
};

constexpr Choice<Framing> kFramings[] = {
    {Framing::Model, "model", "the model, as large as it fits"},
    {Framing::Grid, "grid", "the whole grid: the same pixels per plane for every model"},
};

std::optional<scene::Box> readCut(Params& params) {
    const ParamSpec lowSpec{
        "lowest corner of a box that is not drawn, as a fraction of the "
        "grid's; with cut_max",
        "1", 0.0, 1.0};
    const ParamSpec highSpec{"highest corner of that box", "1", 0.0, 1.0};
    const auto low = params.getOptionalVector("cut_min", 3, lowSpec);
    const auto high = params.getOptionalVector("cut_max", 3, highSpec);
    if (!low && !high) return std::nullopt;
    if (!low || !high) {
        throw Error(params.locationOf(low ? "cut_min" : "cut_max"),
                    "cut_min and cut_max must be given together");
    }
    const auto vector = [](const std::vector<double>& v) {
        return glm::vec3(static_cast<float>(v[0]), static_cast<float>(v[1]),
                         static_cast<float>(v[2]));
    };
    return scene::Box{vector(*low), vector(*high)};
}

}  // namespace

DrawingSettings::DrawingSettings(Params& params, VoxelValue value) {
    draw.value = value;
    draw.mode = params.getEnum("draw", DrawMode::None, kModes, {"what is drawn of the grid"});
    if (params.getBool("pictures", false,
                       {"an opaque picture beside what is measured, where nothing is drawn"}) &&
        !isOn()) {
        draw.mode = DrawMode::Opaque;
        isBeside = true;
    }
    draw.opacity = static_cast<float>(params.getDouble(
        "opacity", 0.1, {"of a voxel, where voxels are blended", "1", 0.001, 0.999}));
    framing = params.getEnum("frame", Framing::Model, kFramings, {"what the picture holds"});
    view =
        params.getText("view", "",
                       {"where from to frame it, \"AZIMUTH ELEVATION\" in degrees, a camera of the "
                        "scene, a path, seen from its middle, or \"X Y Z > X Y Z\" from and to; "
                        "none: \"30 17\", of what is flat \"30 45\""});
    if (params.isGiven("frame") && !view.empty() && !kit::towardsEyeOf(view)) {
        throw Error(params.locationOf("frame"),
                    "'frame' needs a 'view' that frames, \"AZIMUTH ELEVATION\" in degrees");
    }
    draw.cut = readCut(params);
}

void Drawing::setup(technique::SetupContext& context, const scene::Scene& scene,
                    const WorksheetLayout& layout, const scene::Box& box, const scene::Box& shown,
                    bool isCollision) {
    const float aspect =
        static_cast<float>(context.outputSizePx.x) / static_cast<float>(context.outputSizePx.y);
    settings_.draw.hasSecond = isCollision;
    const scene::Box& framed = settings_.framing == Framing::Grid ? box : shown;
    const scene::Camera camera = cameraOf(settings_.view, scene, framed, box, aspect);
    view_ = kit::viewOf(camera, context.outputSizePx);
    renderer_.emplace(context.shaders, layout, box, camera, context.outputSizePx, settings_.draw);
    if (settings_.draw.mode == DrawMode::Mixed) {
        head_ = makeHeadTexture(kHeadResolution, context.seed);
    }
}

void Drawing::render(gl::Profiler& profiler, const VoxelGrid& grid, const VoxelGrid* second) {
    const gl::GpuScope scope(profiler, "draw");
    renderer_->draw(grid.sheets, second ? &second->sheets : nullptr,
                    settings_.draw.mode == DrawMode::Mixed ? &head_ : nullptr);
}

void Drawing::record(technique::Recorder& recorder) const {
    recorder.metric("planes", renderer_->planeCount());
    recorder.image("draw", renderer_->readImage(), kit::seenFrom(view_));
}

}  // namespace gfxrepro::voxelization
