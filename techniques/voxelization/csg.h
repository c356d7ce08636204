// Constructive solid geometry on worksheets. [zju2005] Sec. 2.4.1 (3).
#pragma once

#include "engine/gl/pass.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

enum class CsgOperation { Union, Intersection, Difference };

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

}  // namespace gfxrepro::voxelization
