// A second model voxelized into the same grid: boolean operations and the collision test.
// [zju2005] Sec. 2.4.1 (3), 2.4.3.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/gl/pass.h"
#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/mesh_voxelizer.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

enum class CsgOperation { Union, Intersection, Difference };

/// Constructive solid geometry on worksheets, [zju2005] Sec. 2.4.1 (3).
/// Combines grids of one layout and box, voxel by voxel. A voxel is full when its value is not 0;
/// where both grids have one, the left grid's value stays.
class CsgPass {
  public:
    CsgPass(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout,
            CsgOperation operation);
    /// Writes all of `result`, which may be `left` or `right`.
    void run(const gl::Texture& left, const gl::Texture& right, const gl::Texture& result) const;

  private:
    WorksheetLayout layout_;
    gl::Pass pass_;
};

/// Counts the full voxels of a grid, on the device: of an intersection, what a collision test
/// answers. [zju2005] Sec. 2.4.3.
class CountPass {
  public:
    CountPass(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout);
    void run(const gl::Texture& sheets);
    /// Of the last run; waits for the device.
    std::uint32_t read() const { return count_.read<std::uint32_t>(1)[0]; }

  private:
    WorksheetLayout layout_;
    gl::Pass pass_;
    gl::Buffer count_;
};

struct CombinationSettings {
    std::optional<CsgOperation> csg;
    bool findsCollision = false;
    std::string sceneB;       // catalogue name or path
    glm::vec3 offsetB{0.0F};  // longest edges of the first model's box

    /// Declares csg, collision, scene_b and offset_b. Throws Error when a second scene is missing
    /// or not used.
    explicit CombinationSettings(Params& params);
    bool needsSecond() const { return csg || findsCollision; }
};

/// Life: loadSecond → setup → render, repeatedly → grid, record.
class Combination {
  public:
    explicit Combination(const CombinationSettings& settings) : settings_(settings) {}

    /// Loads the second model and returns its bounds where it is put.
    scene::Box loadSecond(technique::SetupContext& context, const scene::Box& firstBounds);
    void setup(technique::SetupContext& context, const MeshVoxelizerSettings& voxelizer,
               const scene::Box& box);
    /// Voxelizes the second model like the first, then combines; scopes "csg" and "collision".
    void render(gl::Profiler& profiler, const VoxelGrid& first);
    /// Collision: collision_voxels.
    void record(technique::Recorder& recorder) const;

    /// The combined grid; null without a boolean operation.
    const VoxelGrid* result() const { return settings_.csg ? &result_ : nullptr; }
    const VoxelGrid& second() const { return *secondSource_->grid(); }

  private:
    CombinationSettings settings_;
    glm::vec3 offsetWorld_{0.0F};
    std::optional<MeshInput> secondInput_;
    std::optional<MeshVoxelizer> secondSource_;
    std::optional<CsgPass> csgPass_, intersectionPass_;
    std::optional<CountPass> countPass_;
    VoxelGrid result_, common_;
};

}  // namespace gfxrepro::voxelization
