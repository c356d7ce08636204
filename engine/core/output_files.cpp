#include "engine/core/output_files.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"

namespace gfxrepro {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostUnwrittenBytes = std::size_t{1} << 20;

[[noreturn]] void failToWrite(const char* what, const fs::path& path) {
    throw WriteError(std::string("cannot ") + what + ' ' + path.string() + ": " +
                     std::strerror(errno));
}

[[noreturn]] void failWriting(const fs::path& path, int reason) {
    throw WriteError("cannot write " + path.string() + ": " + std::strerror(reason));
}

/// No link, no pipe's reader.
constexpr int kSafe = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;

/// A name that is a device, a pipe or a link would be one no more: a rename takes its place.
void requireReplaceable(const fs::path& path) {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) return;
    if (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) return;  // a folder refuses by itself
    throw WriteError("cannot write " + path.string() + ": a link, a pipe or a device, not a file");
}

/// What a process that was killed left as it wrote this folder.
void removeAbandoned(const fs::path& folder) {
    const std::string begin = folder.filename().string() + ".tmp";
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder.parent_path(), ignored)) {
        const std::string name = entry.path().filename();
        const auto writer =
            name.starts_with(begin) ? parseInteger(name.substr(begin.size())) : std::nullopt;
        const bool isGone = writer && *writer > 0 && *writer <= std::numeric_limits<pid_t>::max() &&
                            ::kill(static_cast<pid_t>(*writer), 0) != 0 && errno == ESRCH;
        if (isGone) fs::remove_all(entry.path(), ignored);
    }
}

}  // namespace

void makeFolder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw WriteError("cannot create " + folder.string() + ": " + failure.message());
}

FileLock::FileLock(const fs::path& path) {
    makeFolder(path.parent_path());
    file_ = Descriptor(::open(path.c_str(), O_RDWR | O_CREAT | kSafe, 0644));
    if (file_.get() < 0) failToWrite("write", path);
    while (::flock(file_.get(), LOCK_EX) != 0) {
        if (errno != EINTR) failToWrite("lock", path);
    }
}

void writeFolder(const fs::path& target, const std::function<void(const fs::path&)>& write) {
    const fs::path plain = fs::absolute(target / "").lexically_normal().parent_path();
    if (fs::exists(plain)) throw Error(target.string() + ": is there already; give another folder");
    removeAbandoned(plain);
    fs::path temporary = plain;
    temporary += ".tmp" + std::to_string(::getpid());
    std::error_code failure;
    try {
        const fs::path part = temporary / plain.filename();
        makeFolder(part);
        write(part);
        fs::rename(part, plain, failure);
    } catch (...) {
        fs::remove_all(temporary, failure);
        throw;
    }
    std::error_code ignored;
    fs::remove_all(temporary, ignored);
    if (failure) throw WriteError("cannot write " + target.string() + ": " + failure.message());
}

void removeOldest(const fs::path& folder, std::string_view extension, const fs::path& kept,
                  std::uintmax_t mostBytes) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : entriesIn(folder)) {
        if (entry.path().extension() != extension && !isTemporary(entry.path())) continue;
        bytes += entry.file_size();
        if (entry.path() != kept) files.emplace_back(entry.last_write_time(), entry.path());
    }
    std::ranges::sort(files);
    for (const auto& [time, path] : files) {
        if (bytes <= mostBytes) return;
        bytes -= fs::file_size(path);
        fs::remove(path);  // whoever has mapped it keeps it
    }
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
    if (path_.has_parent_path()) makeFolder(path_.parent_path());
    requireReplaceable(path_);
    temporary_ = path_;
    temporary_ += ".tmp" + std::to_string(::getpid());
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
    commitUnflushed();
}

void AtomicFile::commitUnflushed() {
    put(unwritten_);
    unwritten_.clear();
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) failToWrite("rename to", path_);
    temporary_.clear();
}

void shareFile(const fs::path& from, const fs::path& to) {
    std::error_code failure;
    fs::create_directories(to.parent_path());
    fs::remove(to, failure);  // of a try that was not recorded
    fs::create_hard_link(from, to, failure);
    if (failure) fs::copy_file(from, to, fs::copy_options::overwrite_existing, failure);
    if (failure) {
        throw Error("cannot write " + to.string() + ": " + failure.message());
    }
}

AppendedFile::AppendedFile(const fs::path& path) : path_(path) {
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
    for (std::string_view rest = block; !rest.empty();) {
        const ssize_t written = ::write(file_.get(), rest.data(), rest.size());
        if (written >= 0) {  // a full disk takes a part of the block, and tells of the rest
            rest.remove_prefix(static_cast<std::size_t>(written));
            continue;
        }
        if (errno == EINTR) continue;
        const int reason = errno;  // give that part back, so that no half case stays
        if (::ftruncate(file_.get(), endBytes_) != 0) failWriting(path_, errno);
        failWriting(path_, reason);
    }
    endBytes_ += static_cast<off_t>(block.size());
    if (::fdatasync(file_.get()) != 0) failWriting(path_, errno);
}

}  // namespace gfxrepro
