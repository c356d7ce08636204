// Small files in which Linux tells numbers (/proc, /sys).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gfxrepro::run {

/// Empty for a file that cannot be read.
std::vector<std::string> linesOf(const std::filesystem::path& path);

/// The number that is the file's first line.
std::optional<double> numberIn(const std::filesystem::path& path);

/// Entries of a folder whose names begin so, in the order of their names; none where there is no
/// such folder.
std::vector<std::filesystem::path> entriesOf(const std::filesystem::path& folder,
                                             std::string_view begin);

}  // namespace gfxrepro::run
