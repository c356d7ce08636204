// What an EXR file of a run says of its making, so that a picture that lies somewhere can be
// traced.
#pragma once

#include <string>

#include "engine/image/exr_io.h"
#include "runner/run/plan.h"
#include "runner/technique/technique.h"

namespace gfxrepro::run {

/// Text attributes: case (its hash), table, title, technique, method where there is one, params
/// (JSON with scene and output size), frame, command (the one that measured) and commit. Of a
/// camera: camera (JSON: eye, forward, up, vertical_fov_deg, near_m, far_m) and the matrices that
/// OpenEXR names, worldToCamera and worldToNDC, as it defines them: left-handed, and from (0, 0) in
/// the upper left to (1, 1) in the lower right corner. Files of twins are those of the measured
/// case.
void describeImage(image::ExrImage& exr, const Case& item, int frame, const std::string& command,
                   const technique::ImageOptions& options);

}  // namespace gfxrepro::run
