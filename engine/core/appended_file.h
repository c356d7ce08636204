// A file that grows by whole blocks, and that nobody else may touch meanwhile.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string_view>

#include "engine/core/descriptor.h"

namespace gfxrepro {

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

  private:
    std::filesystem::path path_;
    Descriptor file_;
    off_t endBytes_ = 0;
};

}  // namespace gfxrepro
