// From the records of a finished run to the files that people read.
#pragma once

#include <filesystem>

namespace gfxrepro::cli {

/// Makes tables, claims and report; says what the claims came to. kExitClaimFailed when one fails,
/// else kExitOk.
int conclude(const std::filesystem::path& runDir);

}  // namespace gfxrepro::cli
