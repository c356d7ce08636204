// The look-up textures of [zju2005] Sec. 2.3.2, beside the integer instructions of worksheet.glsl.
#pragma once

#include "engine/gl/pass.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// Integer textures, read without filtering.
class LookupTables {
  public:
    /// Asserts that the layout is one sheet, as the thesis's.
    explicit LookupTables(const WorksheetLayout& layout);

    /// Of lookup_tables.glsl.
    gl::Resources resources() const;
    std::size_t sizeBytes() const;

  private:
    gl::Texture bitOfByte_;   // (1) 256 × 8: texel (s, t) is bit t of the byte s
    gl::Texture powerOfTwo_;  // (2) 8 × 1: texel s is 2^s
    // (3) The size of the sheet: for the first voxel of a texel of the z sheet where the sheet of x
    // (of y) has it: column, row, byte of the texel (0 … 3) and bit of the byte.
    gl::Texture xFromZ_;
    gl::Texture yFromZ_;
};

}  // namespace gfxrepro::voxelization
