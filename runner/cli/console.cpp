#include "runner/cli/console.h"

#include <algorithm>

namespace gfxrepro::cli {

namespace {

/// What a terminal takes for a command: U+0000 … U+001F, U+007F, U+0080 … U+009F.
bool isControl(std::string_view text, std::size_t at) {
    const auto byte = static_cast<unsigned char>(text[at]);
    if (byte == 0xC2 && at + 1 < text.size()) {
        const auto next = static_cast<unsigned char>(text[at + 1]);
        return next >= 0x80 && next <= 0x9F;
    }
    return byte < 0x20 || byte == 0x7F;
}

/// Nothing but blanks, those of Unicode too: the runner of GitHub skips them before a command.
bool isBlank(std::string_view text) {
    return std::ranges::none_of(text, [](char c) { return c > ' ' && c < '\x7F'; });
}

}  // namespace

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t at = 0; at < text.size(); ++at) {
        const std::string_view rest = text.substr(at);
        if (text[at] == '\n') {
            result += rest.size() > 1 ? "\n| " : "\n";
        } else if (isControl(text, at)) {
            result += text[at] == '\t' ? '\t' : '?';
            if (text[at] == '\xC2') ++at;
        } else if (rest.starts_with("##[") || (rest.starts_with("::") && isBlank(result))) {
            result += std::string(rest.substr(0, 1)) + ' ';
        } else {
            result += text[at];
        }
    }
    return result;
}

}  // namespace gfxrepro::cli
