// Implicit surfaces f(x, y, z) = 0 sampled into a worksheet. [zju2005] Sec. 2.4.1 (1), figure 2.6.
#pragma once

#include "engine/gl/pass.h"
#include "techniques/voxelization/expression.h"
#include "techniques/voxelization/grid_source.h"

namespace gfxrepro::voxelization {

/// Surface: 6-separating, by the crosshair of each voxel. Solid: the voxels whose centre is inside.
class ImplicitSource final : public GridSource {
  public:
    /// Declares `formula` and `inside`. `box` is cubic, world space; without one, the box of the
    /// thesis's quartic.
    ImplicitSource(Params& params, const GridSettings& settings,
                   const std::optional<scene::Box>& box);

    void setup(technique::SetupContext& context) override;
    void render(gl::Profiler& profiler) override;
    const VoxelGrid* grid() const override { return &grid_; }
    void record(technique::Recorder&) override {}

    const Expression& formula() const { return formula_; }

  private:
    GridSettings settings_;
    Expression formula_;
    bool isNegativeInside_;
    VoxelGrid grid_;
    gl::Pass pass_;
};

}  // namespace gfxrepro::voxelization
