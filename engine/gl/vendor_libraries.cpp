#include "engine/gl/vendor_libraries.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "engine/core/text.h"

namespace gfxrepro::gl {

namespace fs = std::filesystem;

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
    std::string library;
    try {
        library = nlohmann::json::parse(readFile(file)).at("ICD").at("library_path");
    } catch (const std::exception& error) {
        return fmt::format("{}: {}", file.string(), error.what());
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
