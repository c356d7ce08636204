// The command line: argv → command → exit code.
#pragma once

#include <span>

#include "engine/scene/generators.h"
#include "runner/technique/technique.h"

namespace gfxrepro::cli {

/// 0 all well · 1 a claim failed · 2 usage or config error · 3 no usable device · 4 some case did
/// not finish · 130 interrupted (resumable). Errors are printed to standard error.
int run(int argc, const char* const* argv, std::span<const technique::TechniqueInfo> techniques,
        std::span<const scene::GeneratorInfo> generators);

}  // namespace gfxrepro::cli
