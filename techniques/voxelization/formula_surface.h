// Surfaces given by formulas, voxelized without triangles. [zju2005] Sec. 2.4.1.
#pragma once

#include "engine/gl/pass.h"
#include "techniques/voxelization/formula.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// Implicit surfaces f(x, y, z) = 0 sampled into a worksheet. [zju2005] Sec. 2.4.1 (1), figure 2.6.
/// Surface: 6-separating, by the crosshair of each voxel. Solid: the voxels whose centre is inside.
class ImplicitSource final : public GridSource {
  public:
    /// Declares `formula`. `box` is of the layout's shape, world space; without one, the box of the
    /// thesis's quartic.
    ImplicitSource(Params& params, const GridSettings& settings,
                   const std::optional<scene::Box>& box);

    void setup(technique::SetupContext& context) override;
    void render(gl::Profiler& profiler) override;
    const VoxelGrid* grid() const override { return &grid_; }

    const Formula& formula() const { return formula_; }

  private:
    GridSettings settings_;
    Formula formula_;
    VoxelGrid grid_;
    gl::Pass pass_;
};

/// Of those points that are some: formulas may give none.
scene::Box finiteBounds(std::span<const glm::vec3> points);

/// Parametric surfaces (x, y, z)(u, v), sampled by points in the vertex stage. [zju2005] Sec. 2.4.1
/// (2). Every voxel that holds a sample; without holes where the sample gap is at most one voxel.
class ParametricSource final : public GridSource {
  public:
    /// Declares `x`, `y`, `z`, `u_range`, `v_range` and `samples`. `box` is of the layout's
    /// shape, world space; without one, the surface fits with a voxel to spare.
    ParametricSource(Params& params, const GridSettings& settings,
                     const std::optional<scene::Box>& box);

    void setup(technique::SetupContext& context) override;
    void render(gl::Profiler& profiler) override;
    const VoxelGrid* grid() const override { return &grid_; }
    void record(technique::Recorder& recorder) override;

  private:
    gl::Defines defines() const;
    std::map<std::string, std::string> snippets() const;
    std::vector<glm::vec3> samplePoints(const gl::ShaderLibrary& shaders) const;

    GridSettings settings_;
    std::vector<Formula> formulas_;  // x, y, z
    glm::vec4 domain_{0.0F};         // u0, v0, u1, v1
    glm::ivec2 sampleCounts_{0};
    std::optional<scene::Box> box_;
    VoxelGrid grid_;
    gl::Pass pass_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray vertexArray_ = gl::VertexArray::none();
};

}  // namespace gfxrepro::voxelization
