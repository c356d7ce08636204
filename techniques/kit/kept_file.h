// Files that keep between runs what a preprocess made, found again by a key.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/output_files.h"

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

/// False where the folder cannot be written: that costs the next run its time, no more.
inline bool keepFile(const std::filesystem::path& path, const std::string& bytes) {
    try {
        writeFileAtomic(path, bytes);
        return true;
    } catch (const Error&) {
        return false;
    }
}

/// What `find` finds, else what `make` makes, and keeps at `path`. Of several processes that miss
/// it one makes it, on all processors; the others wait, and find it.
template <class Content>
Content foundOrMade(const std::filesystem::path& path,
                    const std::function<std::optional<Content>()>& find,
                    const std::function<Content()>& make) {
    if (auto found = find()) return *std::move(found);
    std::filesystem::path lockPath = path;
    lockPath += ".lock";
    std::optional<FileLock> lock;
    try {
        lock.emplace(lockPath);
    } catch (const WriteError&) {  // then nothing can be kept, either
        return make();
    }
    auto content = find();
    if (!content) content = make();
    std::error_code ignored;
    std::filesystem::remove(lockPath, ignored);  // who waits for it finds the file
    return *std::move(content);
}

}  // namespace gfxrepro::kit
