// Names of files that are being written.
#pragma once

#include <filesystem>
#include <string>

namespace gfxrepro {

/// Whether it is the name of a file that is being written: "a.exr.tmp123", "records.csv.tmp".
inline bool isTemporary(const std::filesystem::path& file) {
    const std::string name = file.filename();
    const std::size_t at = name.rfind(".tmp");
    return at != name.npos && name.find_first_not_of("0123456789", at + 4) == name.npos;
}

}  // namespace gfxrepro
