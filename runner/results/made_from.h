// Which run the results in a folder are of: results of another do not go over them.
#pragma once

#include <filesystem>
#include <string>

#include "runner/run/manifest.h"

namespace gfxrepro::results {

/// The line that made-from.txt has of a run: its name, when it started, the hash of its plan.
std::string madeFromLine(const std::filesystem::path& runDir, const run::Json& manifest);

/// Throws Error where `folder` was made from other runs than `lines`, is a run itself, or has
/// results and does not say of what.
void requireMadeFrom(const std::filesystem::path& folder, const std::string& lines);
/// Writes made-from.txt.
void noteMadeFrom(const std::filesystem::path& folder, const std::string& lines);
/// Both, for what is made of one run; the run's own folder needs neither.
void takeFolder(const std::filesystem::path& folder, const std::filesystem::path& runDir,
                const run::Json& manifest);

}  // namespace gfxrepro::results
