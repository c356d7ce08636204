// Voxelizes a mesh: the worksheet method of the thesis and the methods it is measured against.
#pragma once

#include <memory>
#include <optional>

#include "techniques/voxelization/grid_source.h"
#include "techniques/voxelization/lookup_tables.h"
#include "techniques/voxelization/mesh_draw.h"
#include "techniques/voxelization/synthesis.h"

namespace gfxrepro::voxelization {

enum class Method {
    Worksheet,  // rasterization, texelization, synthesis
    Direct,     // one pass: fragments write their voxel with an image atomic
    Slices,     // the mesh is drawn once a slice. [zju2005] Sec. 2.5.3
    DepthOnly,  // no grid: a depth-only draw, the yardstick
};

enum class Split { Once, EveryFrame };
enum class OpenMesh { Refuse, Report };

struct MeshVoxelizerSettings {
    GridSettings grid;
    Method method = Method::Worksheet;
    Rule rule = Rule::Rasterized;
    Split split = Split::Once;
    OpenMesh openMesh = OpenMesh::Report;
    Merging merging = Merging::Transposed;
    Addressing addressing = Addressing::Instructions;
    FillRule fillRule = FillRule::Crossings;
};

/// One way of making (or, as a yardstick, not making) the grid; passes are timed inside.
class MeshMethod {
  public:
    virtual ~MeshMethod() = default;
    virtual void run(const DeviceMesh& mesh, gl::Profiler& profiler) = 0;
    virtual const VoxelGrid* grid() const = 0;
    virtual void record(technique::Recorder& recorder) = 0;
    virtual std::size_t sizeBytes() const = 0;
};

class MeshVoxelizer : public GridSource {
  public:
    /// `mesh` must outlive the voxelizer. `box` is cubic, in world space.
    MeshVoxelizer(const MeshVoxelizerSettings& settings, const scene::Mesh& mesh,
                  const scene::Box& box);

    void setup(technique::SetupContext& context) override;
    void render(gl::Profiler& profiler) override;
    const VoxelGrid* grid() const override { return method_->grid(); }
    /// fragments, memory_bytes; solid: ambiguous_scan_lines, by crossings disagreeing_voxels.
    /// Throws Error for a solid of an open mesh when those are to be refused.
    void record(technique::Recorder& recorder) override;

    const MeshRequest& request() const { return request_; }

  private:
    MeshVoxelizerSettings settings_;
    MeshRequest request_;
    AxisSplit split_;
    std::optional<DeviceMesh> deviceMesh_;
    std::unique_ptr<MeshMethod> method_;
};

/// The baselines Direct, Slices and DepthOnly.
std::unique_ptr<MeshMethod> makeBaseline(technique::SetupContext& context,
                                         const MeshRequest& request, Method method);

}  // namespace gfxrepro::voxelization
