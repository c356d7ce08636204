// What the 8 bytes of a point lose (zju2005 Table 3.1).
#pragma once

#include "techniques/point_splatting/model_file.h"

namespace gfxrepro::point_splatting {

struct ErrorStatistics {
    double mean = 0.0, max = 0.0;
    double ofBound = 0.0;  // the largest error : the largest that the grid allows
};
struct CompressionErrors {
    ErrorStatistics positionPct;  // distance, of the diagonal of the patch's box
    ErrorStatistics normalDeg;
    /// Angle between the decoded tangent and the plane across the true normal: at most the normal's
    /// error.
    ErrorStatistics tangentDeg;
    ErrorStatistics radiusPct;  // ofBound: 0, a table has none
};

/// Over all points: decoded against original.
CompressionErrors compressionErrors(const ModelFile& model);

}  // namespace gfxrepro::point_splatting
