// A second model voxelized into the same grid: boolean operations and the collision test.
// [zju2005] Sec. 2.4.1 (3), 2.4.3.
#pragma once

#include <optional>
#include <string>

#include "techniques/voxelization/collision.h"
#include "techniques/voxelization/csg.h"
#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/mesh_voxelizer.h"

namespace gfxrepro::voxelization {

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
    scene::Box loadSecond(technique::SetupContext& context, VoxelValue value,
                          const scene::Box& firstBounds);
    void setup(technique::SetupContext& context, const MeshVoxelizerSettings& voxelizer,
               const scene::Box& box);
    /// Voxelizes the second model like the first, then combines; scopes "csg" and "collision".
    void render(gl::Profiler& profiler, const VoxelGrid& first);
    /// Collision: collision_voxels, and where there are any collision_{min,max}_{x,y,z}, the box
    /// that holds them in world units.
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
    std::optional<ExtentPass> extentPass_;
    VoxelGrid result_, common_;
};

}  // namespace gfxrepro::voxelization
