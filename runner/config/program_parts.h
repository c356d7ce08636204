// What the readers of a program's parts share; private to this module.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runner/config/program.h"

namespace gfxrepro::config {

/// The placeholders that every program has.
const std::vector<std::string>& reservedNames();

/// Throws Error for a key that is no name in small letters, digits and _; `what` it names.
void requireSnakeCase(const Node& map, const std::string& name, std::string_view what);

/// "" where the key is not there.
std::string optionalLine(const Node& map, const char* key, const std::string& what);

/// An entry of `program.params`.
ProgramParam readProgramParam(const Node& params, const std::string& name);

}  // namespace gfxrepro::config
