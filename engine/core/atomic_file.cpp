#include "engine/core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/core/error.h"

namespace gfxrepro {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostUnwrittenBytes = std::size_t{1} << 20;

[[noreturn]] void failToWrite(const char* what, const fs::path& path) {
    throw Error(std::string("cannot ") + what + ' ' + path.string() + ": " + std::strerror(errno));
}

/// A name that is a device, a pipe or a link would be one no more: a rename takes its place.
void requireReplaceable(const fs::path& path) {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) return;
    if (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) return;  // a folder refuses by itself
    throw Error("cannot write " + path.string() + ": a link, a pipe or a device, not a file");
}

}  // namespace

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
    if (path_.has_parent_path()) {
        std::error_code failure;
        fs::create_directories(path_.parent_path(), failure);
        if (failure) {
            throw Error("cannot create " + path_.parent_path().string() + ": " + failure.message());
        }
    }
    requireReplaceable(path_);
    temporary_ = path_;
    temporary_ += ".tmp" + std::to_string(::getpid());
    constexpr int kSafe = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;  // no link, no pipe's reader
    file_ = Descriptor(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | kSafe, 0644));
    if (file_.get() < 0) failToWrite("write", temporary_);
}

AtomicFile::~AtomicFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view text) {
    if (unwritten_.size() + text.size() <= kMostUnwrittenBytes) {
        unwritten_ += text;
        return;
    }
    put(unwritten_);
    unwritten_.clear();
    put(text);
}

void AtomicFile::put(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file_.get(), text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) failToWrite("write", path_);
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit() {
    put(unwritten_);
    unwritten_.clear();
    if (::fsync(file_.get()) != 0) failToWrite("flush", temporary_);
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) failToWrite("rename to", path_);
    temporary_.clear();
}

}  // namespace gfxrepro
