#include "runner/run/file_stem.h"

#include <cctype>
#include <filesystem>
#include <string_view>

namespace gfxrepro::run {

namespace {

constexpr std::size_t kLongestSettings = 96;  // a file's name has at most 255 bytes

std::string plain(std::string text) {
    for (char& c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool isPlain =
            std::isalnum(byte) != 0 || std::string_view("._-").find(c) != std::string_view::npos;
        if (!isPlain) c = '_';
    }
    return text;
}

}  // namespace

std::string fileStem(const Case& item) {
    std::string settings;
    if (item.axes.isMap()) {
        for (const auto& [axis, value] : item.axes.entries()) {
            const std::string text = value.isScalar() ? value.text() : value.toFlowText();
            const std::string own = std::filesystem::path(text).filename().string();
            if (!settings.empty()) settings += ',';
            settings += plain(axis);
            settings += '=';
            settings += plain(own);
        }
    }
    if (settings.size() > kLongestSettings) settings.resize(kLongestSettings);
    if (!settings.empty()) settings += '-';
    return item.slug() + '/' + settings + item.id + '-';
}

}  // namespace gfxrepro::run
