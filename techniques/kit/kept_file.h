// Files that keep between runs what a preprocess made, found again by a key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace gfxrepro::kit {

/// Begins a kept file: a file of other stamps is another version's or another key's.
struct FileStamp {
    char magic[8];
    std::uint32_t version;  // goes up when the file's layout or the making of its content changes
    char key[64];           // a sha256 of what the content is made of

    FileStamp() = default;
    FileStamp(std::string_view magic, std::uint32_t version, std::string_view key);
    bool operator==(const FileStamp&) const = default;
};

/// Writes a file whole under a temporary name and renames it, so that several processes may do so
/// at once. False where the folder cannot be written: that costs the next run its time, no more.
bool keepFile(const std::filesystem::path& path, const std::string& bytes);

}  // namespace gfxrepro::kit
