// The technique's pass "draw": what is shown of the grid, and from where.
#pragma once

#include <optional>

#include "techniques/kit/view.h"
#include "techniques/voxelization/volume_renderer.h"

namespace gfxrepro::voxelization {

/// What the picture holds: the model as large as it fits, or the whole grid, so that every model
/// covers as many pixels of every plane.
enum class Framing { Model, Grid };

struct DrawingSettings {
    DrawSettings draw;
    Framing framing = Framing::Model;
    double azimuthDeg = 0.0;
    double elevationDeg = 0.0;
    bool isBeside = false;  // no pass: drawn once, when everything is measured

    /// Declares draw, pictures, opacity, frame, azimuth_deg, elevation_deg, cut_min and cut_max.
    DrawingSettings(Params& params, VoxelValue value);
    bool isOn() const { return draw.mode != DrawMode::None; }
    bool isPass() const { return isOn() && !isBeside; }
};

/// Life: setup → render, repeatedly → record.
class Drawing {
  public:
    explicit Drawing(const DrawingSettings& settings) : settings_(settings) {}

    /// `shown` is what Framing::Model frames; `isCollision`: two grids are drawn, common voxels
    /// red.
    void setup(technique::SetupContext& context, const WorksheetLayout& layout,
               const scene::Box& box, const scene::Box& shown, bool isCollision);
    void render(gl::Profiler& profiler, const VoxelGrid& grid, const VoxelGrid* second);
    /// planes, and the image "draw".
    void record(technique::Recorder& recorder) const;

  private:
    DrawingSettings settings_;
    std::optional<VolumeRenderer> renderer_;
    kit::View view_;
    gl::Texture head_;
};

}  // namespace gfxrepro::voxelization
