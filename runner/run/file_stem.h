// How the files of a case are called.
#pragma once

#include <string>

#include "runner/run/plan.h"

namespace gfxrepro::run {

/// The beginning of the names of a case's files below images/ and artifacts/: what varies, by which
/// people find them, then the id, which tells them apart:
/// "sweep-mine/scene=torus,light_ratio=0.25-0123456789ab-". A value's folder is left out, a long
/// text cut, and what a shell or an address would take for something else is "_".
std::string fileStem(const Case& item);

}  // namespace gfxrepro::run
