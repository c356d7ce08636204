// Files that keep between runs what a preprocess made, found again by a key.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace gfxrepro::kit {

/// Begins a kept file: a file of other stamps is another version's or another key's.
struct FileStamp {
    char magic[8];
    std::uint32_t version;  // goes up when the file's layout or the making of its content changes
    char key[64];           // a sha256 of what the content is made of

    FileStamp() = default;
    FileStamp(std::string_view fileMagic, std::uint32_t fileVersion, std::string_view fileKey)
        : version(fileVersion) {
        GFXREPRO_ASSERT_EQ(fileMagic.size(), sizeof magic);
        GFXREPRO_ASSERT_EQ(fileKey.size(), sizeof key);
        std::memcpy(magic, fileMagic.data(), sizeof magic);
        std::memcpy(key, fileKey.data(), sizeof key);
    }
    bool operator==(const FileStamp&) const = default;
};

/// Writes a file whole under a temporary name and renames it, so that several processes may do so
/// at once. False where the folder cannot be written: that costs the next run its time, no more.
inline bool keepFile(const std::filesystem::path& path, const std::string& bytes) {
    try {
        writeFileAtomic(path, bytes);
        return true;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace gfxrepro::kit
