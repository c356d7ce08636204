#include "runner/run/kernel_files.h"

#include <algorithm>
#include <fstream>
#include <string>

#include "engine/core/text.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

std::vector<std::string> linesOf(const fs::path& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
}

std::optional<double> numberIn(const fs::path& path) {
    const std::vector<std::string> lines = linesOf(path);
    return lines.empty() ? std::nullopt : parseDouble(trimmed(lines.front()));
}

std::vector<fs::path> entriesOf(const fs::path& folder, std::string_view begin) {
    std::error_code isAbsent;
    std::vector<fs::path> entries;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, isAbsent)) {
        if (entry.path().filename().string().starts_with(begin)) entries.push_back(entry.path());
    }
    std::ranges::sort(entries);
    return entries;
}

}  // namespace gfxrepro::run
