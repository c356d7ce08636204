#include "tests/support/support.h"

#include <cstdlib>
#include <fstream>

namespace gfxrepro::test {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "gfxrepro-test-XXXXXX").string();
    GFXREPRO_ASSERT(::mkdtemp(name.data()) != nullptr);
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path TemporaryFolder::write(const std::string& name, std::string_view content) const {
    const fs::path path = path_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

std::optional<fs::path> asset(const std::string& name) {
    const char* folder = std::getenv("GFXREPRO_ASSETS");
    if (!folder) return std::nullopt;
    const fs::path path = fs::absolute(fs::path(folder) / name);
    return fs::exists(path) ? std::optional(path) : std::nullopt;
}

}  // namespace gfxrepro::test
