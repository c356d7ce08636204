// Voxelizes a mesh: the worksheet method of the thesis and the methods it is measured against.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "techniques/voxelization/mesh_input.h"

namespace gfxrepro::voxelization {

/// One way of making (or, as a yardstick, not making) the grid; passes are timed inside.
class MeshMethod {
  public:
    virtual ~MeshMethod() = default;
    virtual void run(const DeviceMesh& mesh, gl::Profiler& profiler) = 0;
    virtual const VoxelGrid* grid() const { return nullptr; }
    virtual void record(technique::Recorder& /*recorder*/) {}
    virtual std::uint32_t openScanLines() const { return 0; }
    virtual std::size_t sizeBytes() const = 0;
};

class MeshVoxelizer : public GridSource {
  public:
    /// `mesh` must outlive the voxelizer. `box` is of the layout's
    /// shape, in world space.
    MeshVoxelizer(const MeshVoxelizerSettings& settings, const scene::Mesh& mesh,
                  const scene::Box& box);

    void setup(technique::SetupContext& context) override;
    void render(gl::Profiler& profiler) override;
    const VoxelGrid* grid() const override { return method_->grid(); }
    /// memory_bytes; of worksheets fragments; solid: ambiguous_scan_lines, by crossings
    /// disagreeing_voxels.
    void record(technique::Recorder& recorder) override;
    std::uint32_t openScanLines() const override { return method_->openScanLines(); }

  private:
    MeshRequest request_;
    AxisSplit split_;
    std::optional<DeviceMesh> deviceMesh_;
    std::unique_ptr<MeshMethod> method_;
};

/// Method::Worksheet.
std::unique_ptr<MeshMethod> makeWorksheetMethod(technique::SetupContext& context,
                                                const MeshRequest& request, const DeviceMesh& mesh);
/// Method::Direct of what MeshRequest::isExact().
std::unique_ptr<MeshMethod> makeExactMethod(technique::SetupContext& context,
                                            const MeshRequest& request, const DeviceMesh& mesh);

}  // namespace gfxrepro::voxelization
