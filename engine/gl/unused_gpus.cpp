#include "engine/gl/unused_gpus.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "engine/core/text.h"

namespace gfxrepro::gl {

namespace fs = std::filesystem;

namespace {

/// Files of `folder` that are called `prefix` and a number, in the order of their names.
std::vector<fs::path> numbered(const fs::path& folder, std::string_view prefix) {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        const std::string name = entry.path().filename();
        if (name.starts_with(prefix) && name.size() > prefix.size() &&
            name.find_first_not_of("0123456789", prefix.size()) == std::string::npos) {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

/// The kernel's driver of a file of /dev/dri: "amdgpu"; empty when it is not known.
std::string driverOf(const fs::path& file, const fs::path& drivers) {
    std::error_code none;
    return fs::read_symlink(drivers / file.filename() / "device/driver", none).filename();
}

bool isVirtualDisplay(const std::string& driver) {
    return std::ranges::any_of(
        std::array{"vgem", "vkms", "virtio_gpu", "virtio-pci", "qxl", "bochs-drm", "vmwgfx"},
        [&](const char* name) { return driver == name; });
}

}  // namespace

std::vector<std::string> unusedGpus(const fs::path& devices, const fs::path& drivers) {
    std::vector<std::string> sentences;
    const auto add = [&](const fs::path& file, const std::string& driver) {
        const bool opens = ::access(file.c_str(), R_OK | W_OK) == 0;
        sentences.push_back(
            file.string() + (driver.empty() ? "" : " (" + driver + ")") + ": " +
            (opens ? "no driver gives an OpenGL device for it" : std::strerror(errno)));
    };
    for (const fs::path& file : numbered(devices, "nvidia")) add(file, "");
    for (const fs::path& file : numbered(devices / "dri", "renderD")) {
        const std::string driver = driverOf(file, drivers);
        // Those of NVIDIA were named above.
        if (driver != "nvidia" && !isVirtualDisplay(driver)) add(file, driver);
    }
    // The Windows host's, of a Linux that runs in it.
    if (std::error_code none; fs::exists(devices / "dxg", none)) add(devices / "dxg", "");
    return sentences;
}

namespace {

std::vector<std::string> listed(const char* variable, const std::string& otherwise) {
    const char* value = std::getenv(variable);
    return split(value && *value != '\0' ? value : otherwise, ':');
}

/// In GLVND's order.
std::vector<fs::path> vendorFiles() {
    std::vector<fs::path> files;
    for (const std::string& file : listed("__EGL_VENDOR_LIBRARY_FILENAMES", "")) {
        if (!file.empty()) files.emplace_back(file);
    }
    if (!files.empty()) return files;
    for (const std::string& folder :
         listed("__EGL_VENDOR_LIBRARY_DIRS",
                "/etc/glvnd/egl_vendor.d:/usr/share/glvnd/egl_vendor.d")) {
        std::vector<fs::path> there;
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder, none)) {
            if (entry.path().extension() == ".json") there.push_back(entry.path());
        }
        std::sort(there.begin(), there.end());
        files.insert(files.end(), there.begin(), there.end());
    }
    return files;
}

/// Empty: it can be loaded.
std::string problemOf(const fs::path& file) {
    static constexpr JsonMember kMembers[] = {{"/ICD/library_path", JsonKind::Text}};
    std::string library;
    try {
        const SourceLocation where{file.string(), 0, 0};
        const Json json = parseJsonObject(readFile(file), where);
        requireMembers(json, kMembers, where);
        library = json["ICD"]["library_path"];
    } catch (const Error& error) {
        return error.what();
    }
    if (void* driver = ::dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
        ::dlclose(driver);
        return "";
    }
    return fmt::format("{} names the driver {}: {}", file.string(), library, ::dlerror());
}

}  // namespace

std::vector<std::string> vendorLibraryProblems() {
    std::vector<std::string> problems;
    for (const fs::path& file : vendorFiles()) {
        if (std::string problem = problemOf(file); !problem.empty()) problems.push_back(problem);
    }
    return problems;
}

}  // namespace gfxrepro::gl
