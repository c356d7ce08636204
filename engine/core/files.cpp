#include "engine/core/files.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "engine/core/descriptor.h"
#include "engine/core/error.h"
#include "engine/core/near_file.h"
#include "engine/core/output_files.h"

namespace gfxrepro {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const char* what, const fs::path& path) {
    const int reason = errno;
    throw Error(std::string("cannot ") + what + ' ' + path.string() + ": " + std::strerror(reason) +
                (reason == ENOENT ? suggestedFile(path) : ""));
}

/// By one of the library's iterators, which name no folder when they fail.
template <class Iterator>
std::vector<fs::directory_entry> entriesBy(const fs::path& folder) {
    std::vector<fs::directory_entry> entries;
    std::error_code failure;
    Iterator entry(folder, failure);
    for (; !failure && entry != Iterator(); entry.increment(failure)) entries.push_back(*entry);
    if (failure) throw Error("cannot read " + folder.string() + ": " + failure.message());
    return entries;
}

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

}  // namespace

std::string readFile(const fs::path& path) {
    constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // twice the largest that is written
    const MappedFile file(path);
    if (file.bytes().size() > kMostBytes) {
        throw Error("cannot read " + path.string() + ": " + std::to_string(file.bytes().size()) +
                    " bytes; at most 1 GiB are read at once");
    }
    return std::string(file.text());
}

void writeFileAtomic(const fs::path& path, std::string_view content) {
    AtomicFile file(path);
    file.write(content);
    file.commit();
}

MappedFile::MappedFile(const fs::path& path) {
    // Not blocking: a pipe without a writer is refused, not waited for.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0) fail("read", path);
    struct stat status {};
    if (::fstat(file.get(), &status) != 0) fail("read", path);
    if (S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        fail("read", path);
    }
    if (!S_ISREG(status.st_mode)) {
        throw Error("cannot read " + path.string() + ": a pipe or a device, not a file");
    }
    const auto sizeBytes = static_cast<std::size_t>(status.st_size);
    if (sizeBytes == 0) return;
    void* data = ::mmap(nullptr, sizeBytes, PROT_READ, MAP_PRIVATE, file.get(), 0);
    if (data == MAP_FAILED) fail("map", path);
    bytes_ = {static_cast<const std::byte*>(data), sizeBytes};
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

bool isStillAt(const fs::path& path, int fd) {
    struct stat opened {
    }, there{};
    if (::stat(path.c_str(), &there) != 0) return errno != ENOENT && errno != ENOTDIR;
    return ::fstat(fd, &opened) == 0 && opened.st_ino == there.st_ino &&
           opened.st_dev == there.st_dev;
}

std::vector<fs::directory_entry> entriesIn(const fs::path& folder) {
    return entriesBy<fs::directory_iterator>(folder);
}

std::vector<fs::directory_entry> entriesBelow(const fs::path& folder) {
    return entriesBy<fs::recursive_directory_iterator>(folder);
}

void copyTree(const fs::path& from, const fs::path& to) {
    const fs::file_status status = fs::symlink_status(from);
    if (fs::is_regular_file(status)) {
        constexpr std::uintmax_t kMostBytes = std::uintmax_t{16} << 30;
        std::error_code failure;
        if (const auto size = fs::file_size(from, failure); !failure && size > kMostBytes) {
            throw Error("cannot copy " + from.string() + ": " + std::to_string(size) +
                        " bytes; more than 16 GiB are not copied");
        }
        fs::create_directories(to.parent_path());
        fs::copy_file(from, to, fs::copy_options::overwrite_existing, failure);
        const bool isGone = failure && !fs::exists(from);
        if (failure && !isGone) {
            throw Error("cannot copy " + from.string() + " to " + to.string() + ": " +
                        failure.message());
        }
    } else if (fs::is_directory(status)) {
        fs::create_directories(to);
        for (const fs::directory_entry& entry : entriesIn(from)) {
            if (!isTemporary(entry.path())) copyTree(entry.path(), to / entry.path().filename());
        }
    } else if (fs::exists(status)) {
        throw Error(from.string() + ": a link, a pipe or a device, which a run has none of");
    }
}

fs::path dataFolder(std::string_view name) {
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
    std::vector<fs::path> candidates;
    if (const std::string data = environment("GFXREPRO_DATA"); !data.empty()) {
        candidates.push_back(fs::path(data) / name);
    }
    // An installed prefix, wherever it is; <build>/shaders; <source>/configs with
    // <source>/build/<preset>/gfxrepro.
    for (const char* up : {"../share/gfxrepro", ".", "..", "../..", "../../..", "../../../.."}) {
        candidates.push_back((program / up / name).lexically_normal());
    }
    std::string tried;
    for (const fs::path& candidate : candidates) {
        if (fs::is_directory(candidate)) return candidate;
        tried += "\n  " + candidate.string();
    }
    throw Error("the folder '" + std::string(name) + "' was not found; searched:" + tried);
}

fs::path assetsFolder(const std::string& given) {
    if (!given.empty()) return given;
    if (const std::string folder = environment("GFXREPRO_ASSETS"); !folder.empty()) return folder;
    return cacheFolder() / "assets";
}

fs::path cacheFolder() {
    if (const fs::path cache = environment("XDG_CACHE_HOME"); !cache.empty()) {
        return cache / "gfxrepro";
    }
    fs::path home = environment("HOME");
    if (home.empty()) {
        const passwd* user = ::getpwuid(::getuid());
        home = user ? fs::path(user->pw_dir) : fs::current_path();
    }
    return home / ".cache/gfxrepro";
}

}  // namespace gfxrepro
