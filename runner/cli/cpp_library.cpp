#include "runner/cli/cpp_library.h"

#include <dlfcn.h>
#include <gnu/libc-version.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "engine/core/text.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSelf = "/proc/self/exe";
constexpr const char* kName = "libstdc++.so.6";

/// Empty where it is not known.
fs::path folderOfCLibrary() {
    Dl_info found{};
    if (::dladdr(reinterpret_cast<const void*>(&::gnu_get_libc_version), &found) == 0) return {};
    return fs::path(found.dli_fname).parent_path();
}

}  // namespace

int releaseOfCppLibrary(const fs::path& library) {
    const std::string prefix = std::string(kName) + ".0.";
    const auto releaseIn = [&](const std::string& name) {
        if (!name.starts_with(prefix)) return 0;
        return static_cast<int>(parseInteger(name.substr(prefix.size())).value_or(0));
    };
    std::error_code notThere;
    const fs::path file = fs::canonical(library, notThere);
    if (file.filename() != kName) return releaseIn(file.filename());
    // A copy of the link, beside one of what it led to: a submission's has no links.
    const auto size = fs::file_size(file, notThere);
    for (const auto& other : fs::directory_iterator(file.parent_path(), notThere)) {
        const int release = releaseIn(other.path().filename());
        if (release > 0 && other.file_size(notThere) == size) return release;
    }
    return 0;
}

void takeNewerCppLibrary(char** arguments) {
    std::error_code unknown;
    const fs::path own = fs::read_symlink(kSelf, unknown).parent_path() / "lib" / kName;
    const int ownRelease = releaseOfCppLibrary(own);
    if (ownRelease == 0) return;
    const fs::path folder = folderOfCLibrary();
    if (releaseOfCppLibrary(folder / kName) <= ownRelease) return;
    // What is loaded first is taken by all that ask for a library of its name.
    std::string libraries = (folder / kName).string();
    if (const fs::path support = folder / "libgcc_s.so.1"; fs::exists(support)) {
        libraries += ':' + support.string();
    }
    if (const char* others = std::getenv("LD_PRELOAD"); others && *others != '\0') {
        if (std::string_view(others).starts_with(libraries)) return;  // it was started again
        libraries += std::string(":") + others;
    }
    ::setenv("LD_PRELOAD", libraries.c_str(), 1);
    ::execv(kSelf, arguments);  // returns only where that fails: then with its own
}

}  // namespace gfxrepro::cli
