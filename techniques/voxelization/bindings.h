// Binding points shared by the shaders of this folder; the same numbers reach GLSL as defines.
#pragma once

#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

enum StorageBinding : unsigned {
    kRecordBinding = 0,
    kCounterBinding = 1,
    kPositionBinding = 2,
    kTriangleBinding = 3,
    kAttributeBinding = 4,
    kBehindBinding = 5,
    kStatisticsBinding = 6,
    kTileBinding = 7,
};

enum ImageUnit : unsigned { kSheetUnit = 0, kSheetXUnit = 1, kSheetYUnit = 2 };

enum TextureUnit : unsigned {
    kBitOfByteUnit = 0,
    kPowerOfTwoUnit = 1,
    kXFromZUnit = 2,
    kYFromZUnit = 3,
};

enum VertexLocation : unsigned { kPositionLocation = 0, kAttributeLocation = 1 };

/// The layout's defines and those of the enumerations above.
gl::Defines passDefines(const WorksheetLayout& layout);

}  // namespace gfxrepro::voxelization
