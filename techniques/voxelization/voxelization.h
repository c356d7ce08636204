// The technique `voxelization`: chapter 2 of zju2005. See README.md.
#pragma once

#include <memory>
#include <optional>

#include "techniques/voxelization/combination.h"
#include "techniques/voxelization/drawing.h"
#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/mesh_voxelizer.h"

namespace gfxrepro::voxelization {

/// What is voxelized.
enum class InputKind { Mesh, Implicit, Parametric };

/// Everything that a config may say of the grid and of the way to it.
struct VoxelizationParams {
    InputKind input = InputKind::Mesh;
    MeshVoxelizerSettings voxelizer;
    CombinationSettings combination;
    DrawingSettings drawing;
    int paddingVoxels = 1;
    std::optional<scene::Box> box;  // cubic; empty: around the mesh
    bool readsBack = false;
    bool comparesWithReference = false;
    bool exportsBinvox = false;
    bool showsSlices = false;

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit VoxelizationParams(Params& params);
};

class Voxelization final : public technique::Technique {
  public:
    explicit Voxelization(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override {
        return params_.input == InputKind::Mesh ? technique::SceneNeed::Model
                                                : technique::SceneNeed::Nothing;
    }
    void requireScene(const scene::Scene& scene) const override;
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;

  private:
    void setupMesh(technique::SetupContext& context);
    const VoxelGrid* grid() const;
    void draw(gl::Profiler& profiler);
    void recordGrid(technique::Recorder& recorder, const DenseGrid& grid) const;
    /// `stray_voxels` (fill_rule: surface_voxels) neither lie inside nor touch the surface.
    void recordMisses(technique::Recorder& recorder, const DenseGrid& grid) const;

    VoxelizationParams params_;
    std::optional<MeshInput> input_;
    scene::Box box_;
    std::unique_ptr<GridSource> source_;
    Combination combination_;
    Drawing drawing_;
};

/// Throws UnsupportedError, with the numbers, when the sheets do not fit the device.
void checkFitsDevice(const WorksheetLayout& layout, const gl::DeviceLimits& limits);

/// A number that differs (but for chance, 1 in 2⁴⁸) when any word differs.
double digestOf(std::span<const std::uint32_t> words);

/// The middle slices across z, y and x side by side, voxels that are full white.
image::ImageF middleSlices(const DenseGrid& grid);

extern const technique::TechniqueInfo kVoxelization;

}  // namespace gfxrepro::voxelization
