#include "engine/core/appended_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace gfxrepro {

namespace {

[[noreturn]] void failWriting(const std::filesystem::path& path, int reason) {
    throw Error("cannot write " + path.string() + ": " + std::strerror(reason));
}

}  // namespace

AppendedFile::AppendedFile(const std::filesystem::path& path) : path_(path) {
    constexpr int kSafe = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;  // no link, no pipe's reader
    file_ = Descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | kSafe, 0644));
    if (file_.get() < 0) failWriting(path, errno);
    endBytes_ = ::lseek(file_.get(), 0, SEEK_END);
}

void AppendedFile::cut(std::size_t sizeBytes) {
    endBytes_ = static_cast<off_t>(sizeBytes);
    if (::ftruncate(file_.get(), endBytes_) != 0) failWriting(path_, errno);
}

void AppendedFile::requireOurs() const {
    if (isStillAt(path_, file_.get()) && ::lseek(file_.get(), 0, SEEK_END) == endBytes_) return;
    throw Error(path_.string() +
                ": was removed, replaced or changed while a run wrote to it: rows are lost; "
                "nothing more is measured into it");
}

void AppendedFile::append(std::string_view block) {
    requireOurs();
    ssize_t written = 0;
    do {
        written = ::write(file_.get(), block.data(), block.size());
    } while (written < 0 && errno == EINTR);
    if (written != static_cast<ssize_t>(block.size())) {
        // A full disk takes a part of the block: give it back, so that no half case stays.
        const int reason = written < 0 ? errno : ENOSPC;
        if (::ftruncate(file_.get(), endBytes_) != 0) failWriting(path_, errno);
        failWriting(path_, reason);
    }
    endBytes_ += written;
    if (::fdatasync(file_.get()) != 0) failWriting(path_, errno);
}

}  // namespace gfxrepro
