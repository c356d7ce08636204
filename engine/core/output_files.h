// Files that are written in pieces: one that appears as a whole, and one that grows by whole
// blocks.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "engine/core/descriptor.h"

namespace gfxrepro {

/// Goes to a temporary name beside its path until commit() puts it in its place: a reader sees the
/// old file or the new one, never a part.
class AtomicFile {
  public:
    /// Creates missing folders. Throws WriteError, also where `path` is a link, a pipe or a device.
    explicit AtomicFile(std::filesystem::path path);
    /// Without commit(), what was there stays.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Throws WriteError when the disk is full.
    void write(std::string_view text);
    /// Flushes it to the disk and renames it. Throws WriteError. Once.
    void commit();
    /// Without flushing it, which may take seconds: after a power cut the file may be any bytes.
    void commitUnflushed();

  private:
    void put(std::string_view text);

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // empty once it is in its place
    std::string unwritten_;
    Descriptor file_;
};

/// With those above it. Throws WriteError.
void makeFolder(const std::filesystem::path& folder);

/// Held by one process at a time, until it goes: of all that need a file one makes it, and the
/// others wait for it.
class FileLock {
  public:
    /// Waits. Makes an empty file and its folder. Throws WriteError.
    explicit FileLock(const std::filesystem::path& path);

  private:
    Descriptor file_;
};

/// Lets `write` make and fill the folder that it is given, which has the name of `target` and lies
/// in a temporary one beside it, and moves it there: `target` is there as a whole, or not at all.
/// Throws Error where it is there already, WriteError, and what `write` throws.
void writeFolder(const std::filesystem::path& target,
                 const std::function<void(const std::filesystem::path&)>& write);

/// `to` becomes the same file as `from`, which takes no room, or a copy where the disk is another.
/// Throws Error.
void shareFile(const std::filesystem::path& from, const std::filesystem::path& to);

/// Whether it is the name of a file that is being written: "a.exr.tmp123", "records.csv.tmp".
inline bool isTemporary(const std::filesystem::path& file) {
    const std::string name = file.filename();
    const std::size_t at = name.rfind(".tmp");
    return at != name.npos && name.find_first_not_of("0123456789", at + 4) == name.npos;
}

/// Removes files of a folder that end in `extension`, or are temporary, until all of them together
/// take at most `mostBytes`: those written longest ago first, but never `kept`. Throws
/// std::filesystem::filesystem_error, also where another process removes one meanwhile.
void removeOldest(const std::filesystem::path& folder, std::string_view extension,
                  const std::filesystem::path& kept, std::uintmax_t mostBytes);

/// A file that nobody else may touch meanwhile.
class AppendedFile {
  public:
    /// Opens it, or makes an empty one. Throws Error, also for a link.
    explicit AppendedFile(const std::filesystem::path& path);

    /// Leaves the first `sizeBytes`: what follows them was torn.
    void cut(std::size_t sizeBytes);
    /// One write, then flushed to the disk. Throws Error, leaving the file as it was; also as
    /// requireOurs().
    void append(std::string_view block);
    /// Throws Error where the file is not what was written: somebody removed, replaced or changed
    /// it.
    void requireOurs() const;
    std::uintmax_t sizeBytes() const { return static_cast<std::uintmax_t>(endBytes_); }

  private:
    std::filesystem::path path_;
    Descriptor file_;
    off_t endBytes_ = 0;
};

}  // namespace gfxrepro
