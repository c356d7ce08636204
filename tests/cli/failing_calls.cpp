// To be preloaded into the program (LD_PRELOAD): call number FAILING_CALL of those that change
// files under the folder FAILING_UNDER, or with FAILING_FOLDERS of those that read folders there,
// fails with FAILING_ERRNO; -1: the process is killed there, with half of a write done. With
// FAILING_COUNT the number of such calls is written to that file at the end. The processes that it
// starts are left alone.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

const char* under = nullptr;  // set once by the constructor
long failing = 0;
int failure = 0;
bool isOfFolders = false;
std::atomic<long> calls = 0;

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

__attribute__((constructor)) void begin() {
    const auto number = [](const char* name) {
        const char* text = std::getenv(name);
        return text ? std::atol(text) : 0;
    };
    under = std::getenv("FAILING_UNDER");
    failing = number("FAILING_CALL");
    failure = static_cast<int>(number("FAILING_ERRNO"));
    isOfFolders = std::getenv("FAILING_FOLDERS") != nullptr;
    ::unsetenv("LD_PRELOAD");
}

__attribute__((destructor)) void end() {
    if (const char* file = std::getenv("FAILING_COUNT")) {
        under = nullptr;
        if (std::FILE* out = std::fopen(file, "w")) {
            std::fprintf(out, "%ld", calls.load());
            std::fclose(out);
        }
    }
}

bool isCounted(const char* path) {
    return under && path && std::strncmp(path, under, std::strlen(under)) == 0;
}

bool isCounted(int file) {
    if (!under) return false;
    char link[64], path[PATH_MAX];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t length = ::readlink(link, path, sizeof path - 1);
    if (length < 0) return false;
    path[length] = 0;
    return isCounted(path);
}

/// Counts a call; whether it is to fail, with errno set. `half` is done before a kill.
template <class Target, class Half>
bool fails(Target target, Half half, bool readsFolder = false) {
    if (readsFolder != isOfFolders || !isCounted(target) || ++calls != failing) return false;
    if (failure < 0) {
        half();
        ::kill(::getpid(), SIGKILL);
    }
    errno = failure;
    return true;
}

template <class Target>
bool fails(Target target) {
    return fails(target, [] {});
}

int openFile(const char* name, const char* path, int flags, mode_t mode) {
    if ((flags & O_ACCMODE) != O_RDONLY && fails(path)) return -1;
    return next<int (*)(const char*, int, ...)>(name)(path, flags, mode);
}

mode_t modeOf(int flags, va_list arguments) {
    return flags & (O_CREAT | O_TMPFILE) ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = modeOf(flags, arguments);
    va_end(arguments);
    return openFile("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = modeOf(flags, arguments);
    va_end(arguments);
    return openFile("open64", path, flags, mode);
}

ssize_t write(int file, const void* data, std::size_t size) {
    const auto real = next<ssize_t (*)(int, const void*, std::size_t)>("write");
    const auto half = [&] { [[maybe_unused]] const ssize_t done = real(file, data, size / 2); };
    return fails(file, half) ? -1 : real(file, data, size);
}

int fsync(int file) {
    return fails(file) ? -1 : next<int (*)(int)>("fsync")(file);
}

int fdatasync(int file) {
    return fails(file) ? -1 : next<int (*)(int)>("fdatasync")(file);
}

int ftruncate(int file, off_t size) noexcept {
    return fails(file) ? -1 : next<int (*)(int, off_t)>("ftruncate")(file, size);
}

int rename(const char* from, const char* to) noexcept {
    return fails(to) ? -1 : next<int (*)(const char*, const char*)>("rename")(from, to);
}

dirent* readdir(DIR* folder) {
    const auto nothing = [] {};
    if (fails(::dirfd(folder), nothing, true)) return nullptr;
    return next<dirent* (*)(DIR*)>("readdir")(folder);
}

int mkdir(const char* path, mode_t mode) noexcept {
    return fails(path) ? -1 : next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

}  // extern "C"
