// Whether the files are there that a program's section names.
#pragma once

#include "runner/config/program.h"

namespace gfxrepro::config {

/// Throws Error with file:line:column for one of `files`, and for a truth, that is no file. `node`
/// is what `program` was read from. A truth below {out}, or one of {frame}, {width} or {height}, is
/// passed over.
void requireFiles(const Node& node, const Program& program, const Placeholders& values);

}  // namespace gfxrepro::config
