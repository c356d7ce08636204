#include "techniques/voxelization/drawing.h"

#include "techniques/kit/image_layers.h"
#include "techniques/voxelization/phantom.h"

namespace gfxrepro::voxelization {

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
    azimuthDeg = params.getDouble("azimuth_deg", 30.0,
                                  {"of the eye, from +z towards +x", "degree", -360.0, 360.0});
    elevationDeg = params.getDouble("elevation_deg", 17.0,
                                    {"of the eye, above the horizon", "degree", -90.0, 90.0});
    draw.cut = readCut(params);
}

void Drawing::setup(technique::SetupContext& context, const WorksheetLayout& layout,
                    const scene::Box& box, const scene::Box& shown, bool isCollision) {
    const float aspect =
        static_cast<float>(context.outputSizePx.x) / static_cast<float>(context.outputSizePx.y);
    settings_.draw.hasSecond = isCollision;
    // Something thin, seen along itself, would bring the eye into the grid.
    const glm::vec3 half = glm::max(0.5F * shown.size(), 0.1F * box.size());
    const scene::Box framed = settings_.framing == Framing::Grid
                                  ? box
                                  : scene::Box{shown.centre() - half, shown.centre() + half};
    const scene::Camera camera =
        orbitCamera(framed, settings_.azimuthDeg, settings_.elevationDeg, aspect);
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
    recorder.metric("planes", renderer_->planeCount(), "plane");
    recorder.image("draw", renderer_->readImage(), kit::seenFrom(view_));
}

}  // namespace gfxrepro::voxelization
