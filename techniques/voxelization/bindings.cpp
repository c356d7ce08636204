#include "techniques/voxelization/bindings.h"

namespace gfxrepro::voxelization {

gl::Defines passDefines(const WorksheetLayout& layout) {
    gl::Defines defines = layout.defines();
    const auto add = [&](const char* name, auto number) {
        defines[name] = static_cast<int>(number);
    };
    add("RECORD_BINDING", kRecordBinding);
    add("COUNTER_BINDING", kCounterBinding);
    add("POSITION_BINDING", kPositionBinding);
    add("TRIANGLE_BINDING", kTriangleBinding);
    add("ATTRIBUTE_BINDING", kAttributeBinding);
    add("BEHIND_BINDING", kBehindBinding);
    add("STATISTICS_BINDING", kStatisticsBinding);
    add("TILE_BINDING", kTileBinding);
    add("SHEET_UNIT", kSheetUnit);
    add("SHEET_X_UNIT", kSheetXUnit);
    add("SHEET_Y_UNIT", kSheetYUnit);
    add("BIT_OF_BYTE_UNIT", kBitOfByteUnit);
    add("POWER_OF_TWO_UNIT", kPowerOfTwoUnit);
    add("X_FROM_Z_UNIT", kXFromZUnit);
    add("Y_FROM_Z_UNIT", kYFromZUnit);
    add("POSITION_LOCATION", kPositionLocation);
    add("ATTRIBUTE_LOCATION", kAttributeLocation);
    return defines;
}

}  // namespace gfxrepro::voxelization
