// Files: whole reads, atomic writes, read-only maps, and where the program's own data lies.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gfxrepro {

/// The whole file. Throws Error("cannot read PATH: reason").
std::string readFile(const std::filesystem::path& path);

/// Writes to a temporary name beside `path`, flushes it to the disk and renames it: a reader sees
/// the old file or the new one, never a part. Creates missing folders. Throws Error.
void writeFileAtomic(const std::filesystem::path& path, std::string_view content);

/// A file mapped read-only. An empty file gives an empty span.
class MappedFile {
  public:
    /// Throws Error("cannot read PATH: reason").
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::span<const std::byte> bytes() const { return bytes_; }
    std::string_view text() const {
        return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
    }

  private:
    std::span<const std::byte> bytes_;
};

/// Whether what lies at `path` is what was opened: it was neither removed nor replaced. Also true
/// where nobody can tell, as of a file system that is away.
bool isStillAt(const std::filesystem::path& path, int fd);

/// What is in the folder; or also in those below it. Throws Error("cannot read PATH: reason").
std::vector<std::filesystem::directory_entry> entriesIn(const std::filesystem::path& folder);
std::vector<std::filesystem::directory_entry> entriesBelow(const std::filesystem::path& folder);

/// Copies a file, or a folder with all that is in it, over what is there. Leaves out what is
/// temporary (isTemporary()) and what goes away meanwhile. Throws Error for a link,
/// a pipe or a device, and for a file of more than 16 GiB: one of holes would fill the disk.
void copyTree(const std::filesystem::path& from, const std::filesystem::path& to);

/// Where shaders/ and configs/ lie: beside the running program in a build tree, share/gfxrepro in
/// an installation, or GFXREPRO_DATA. Throws Error when `name` is in none of them, naming all that
/// were tried.
std::filesystem::path dataFolder(std::string_view name);

/// What may be made again at any time: ${XDG_CACHE_HOME:-~/.cache}/gfxrepro. It need not exist.
std::filesystem::path cacheFolder();

/// The folder of real models: `given` (from --assets), else GFXREPRO_ASSETS, else
/// cacheFolder()/assets. It need not exist.
std::filesystem::path assetsFolder(const std::string& given = "");

}  // namespace gfxrepro
