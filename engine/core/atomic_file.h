// A file that is written in pieces and appears as a whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/descriptor.h"

namespace gfxrepro {

/// Goes to a temporary name beside its path until commit() puts it in its place: a reader sees the
/// old file or the new one, never a part.
class AtomicFile {
  public:
    /// Creates missing folders. Throws Error, also where `path` is a link, a pipe or a device.
    explicit AtomicFile(std::filesystem::path path);
    /// Without commit(), what was there stays.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Throws Error when the disk is full.
    void write(std::string_view text);
    /// Flushes it to the disk and renames it. Throws Error. Once.
    void commit();

  private:
    void put(std::string_view text);

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // empty once it is in its place
    std::string unwritten_;
    Descriptor file_;
};

}  // namespace gfxrepro
