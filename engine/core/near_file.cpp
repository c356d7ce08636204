#include "engine/core/near_file.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "engine/core/text.h"

namespace gfxrepro {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLeastLetters = 3;   // of a shorter name every other short one is near
constexpr std::size_t kMostBeside = 2000;  // more would take longer than the command itself

std::string withoutDigits(std::string name) {
    std::erase_if(name, [](unsigned char c) { return std::isdigit(c) != 0; });
    return name;
}

/// Without an error for a folder that cannot be read.
std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code failure;
    fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, failure);
    for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
        if (names.size() == kMostBeside) return {};
        names.push_back(entry->path().filename().string());
    }
    std::ranges::sort(names);  // what a folder has first is nobody's choice
    return names;
}

}  // namespace

std::string suggestedFile(const fs::path& absent) {
    fs::path there;
    std::error_code failure;
    auto part = absent.begin();
    while (part != absent.end() && fs::exists(there / *part, failure)) there /= *part++;
    if (failure || part == absent.end()) return "";
    const std::string name = part->string();
    if (part->stem().string().size() < kLeastLetters) return "";
    // One of another ending is near by that alone: a short name and its ending are soon near.
    std::vector<std::string> stems, sameStems;
    for (const fs::path other : namesIn(there)) {
        if (other.string().starts_with('.')) continue;
        if (other.extension() != part->extension()) {
            if (other.stem() == part->stem()) sameStems.push_back(other.string());
        } else if (withoutDigits(other.string()) != withoutDigits(name)) {
            stems.push_back(other.stem().string());
        }
    }
    auto near = nearestName(part->stem().string(), stems);
    if (near) {
        *near += part->extension().string();
    } else {
        near = nearestName(name, sameStems);
    }
    if (!near) return "";
    fs::path meant = there / *near;
    for (++part; part != absent.end(); ++part) meant /= *part;
    return fs::exists(meant, failure)
               ? "; did you mean '" + meant.lexically_normal().string() + "'?"
               : "";
}

}  // namespace gfxrepro
