#include "runner/report/labels.h"

#include <algorithm>
#include <cctype>

namespace gfxrepro::report {

namespace {

bool isWordCharacter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-';
}

/// "outdoor/bird_nest", "draw_ms": words joined by _, perhaps in a folder.
bool isName(std::string_view name) {
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) return false;
    if (std::ranges::count(name, '/') > 1 || name.back() == '/') return false;
    return std::ranges::all_of(name, [](char c) { return isWordCharacter(c) || c == '/'; });
}

std::string withBlanks(std::string text) {
    std::ranges::replace(text, '_', ' ');
    return text;
}

}  // namespace

std::string shownName(std::string_view name, const Words& words) {
    if (const auto known = words.find(std::string(name)); known != words.end()) {
        return known->second;
    }
    if (!isName(name)) return std::string(name);
    return withBlanks(std::string(name.substr(name.find('/') + 1)));
}

std::map<std::string, std::string> shownNames(const std::set<std::string>& names,
                                              const Words& words) {
    std::map<std::string, int> uses;
    for (const std::string& name : names) ++uses[shownName(name, words)];
    std::map<std::string, std::string> shown;
    for (const std::string& name : names) {
        const std::string text = shownName(name, words);
        shown[name] = uses[text] == 1 ? text : isName(name) ? withBlanks(name) : name;
    }
    return shown;
}

}  // namespace gfxrepro::report
