// What the technique voxelizes: a mesh, or any other source of a grid.
#pragma once

#include "runner/technique/technique.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// What a voxel's value says.
enum class VoxelValue { Occupancy, Normal, Color };
enum class Fill { Surface, Solid };

/// What every source has to know of the grid that is asked for.
struct GridSettings {
    WorksheetLayout layout;
    VoxelValue value = VoxelValue::Occupancy;
    Fill fill = Fill::Surface;
};

/// Life: setup → render, repeatedly → grid, record.
class GridSource {
  public:
    virtual ~GridSource() = default;
    virtual void setup(technique::SetupContext& context) = 0;
    /// Makes the grid anew, each stage in a scope of the profiler.
    virtual void render(gl::Profiler& profiler) = 0;
    /// The grid of the last render; null when the method under measurement makes none.
    virtual const VoxelGrid* grid() const = 0;
    /// Metrics of the source's own (the grid's are the technique's). Throws Error when the last
    /// render failed.
    virtual void record(technique::Recorder& recorder) = 0;
};

}  // namespace gfxrepro::voxelization
