// The lists of expectations beside configs, held against the tables of those configs.
#pragma once

#include <string>
#include <vector>

#include "engine/core/error.h"
#include "runner/cli/commands.h"

namespace gfxrepro::cli {

/// What `expect-<class>.yaml` beside `configs` names that is not there, of each class of
/// `deviceClasses`: tables that no config of the folder has, axes and values that no case of the
/// table has in any profile. Throws Error for a list that cannot be read.
std::vector<Error> unknownExpectations(const Context& context,
                                       const std::vector<std::string>& configs,
                                       const std::vector<std::string>& deviceClasses,
                                       const std::string& assets);

}  // namespace gfxrepro::cli
