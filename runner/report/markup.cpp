#include "runner/report/markup.h"

#include <array>
#include <cstdint>
#include <utility>

namespace gfxrepro::report {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// Bytes of the character of several bytes that the text begins with; 0 where it is no UTF-8, or
/// none that XML has (U+FFFE, U+FFFF).
std::size_t longCharacter(std::string_view text) {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t length = at(0) >= 0xF0 ? 4 : at(0) >= 0xE0 ? 3 : 2;
    if (at(0) < 0xC2 || at(0) > 0xF4 || text.size() < length) return 0;
    std::uint32_t code = at(0) & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((at(i) & 0xC0U) != 0x80U) return 0;
        code = code << 6 | (at(i) & 0x3FU);
    }
    constexpr std::uint32_t kLeast[] = {0x80, 0x800, 0x10000};
    const bool isSurrogate = code >= 0xD800 && code <= 0xDFFF;
    const bool isShort = code < kLeast[length - 2];
    return isShort || isSurrogate || code > 0x10FFFF || code == 0xFFFE || code == 0xFFFF ? 0
                                                                                         : length;
}

}  // namespace

std::string escapeXml(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            case '\n':
                out += "&#10;";
                break;
            case '\t':
                out += "&#9;";
                break;
            default:
                if (static_cast<unsigned char>(c) < 0x20) {
                    out += kReplacement;
                } else if (static_cast<unsigned char>(c) < 0x80) {
                    out += c;
                } else if (const std::size_t length = longCharacter(text.substr(i)); length > 0) {
                    out += text.substr(i, length);
                    i += length - 1;
                } else {
                    out += kReplacement;
                }
        }
    }
    return out;
}

std::string escapeLatex(std::string_view text) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 40> kCommands = {{
        {"\\", "\\textbackslash{}"},
        {"{", "\\{"},
        {"}", "\\}"},
        {"$", "\\$"},
        {"&", "\\&"},
        {"#", "\\#"},
        {"%", "\\%"},
        {"_", "\\_"},
        {"^", "\\textasciicircum{}"},
        {"~", "\\textasciitilde{}"},
        {"<", "\\textless{}"},
        {">", "\\textgreater{}"},
        {"|", "\\textbar{}"},
        {"\"", "''"},
        {"\n", " "},
        {"\r", " "},
        {"\t", " "},
        {"→", "$\\rightarrow$"},
        {"×", "$\\times$"},
        {"²", "$^2$"},
        {"³", "$^3$"},
        {"∞", "$\\infty$"},
        {"≤", "$\\leq$"},
        {"≥", "$\\geq$"},
        {"−", "$-$"},
        {"·", "$\\cdot$"},
        {"°", "$^\\circ$"},
        {"µ", "$\\mu$"},
        {"α", "$\\alpha$"},
        {"β", "$\\beta$"},
        {"δ", "$\\delta$"},
        {"ε", "$\\varepsilon$"},
        {"θ", "$\\theta$"},
        {"λ", "$\\lambda$"},
        {"μ", "$\\mu$"},
        {"π", "$\\pi$"},
        {"σ", "$\\sigma$"},
        {"τ", "$\\tau$"},
        {"φ", "$\\varphi$"},
        {"Δ", "$\\Delta$"},
    }};
    std::string out;
    while (!text.empty()) {
        std::size_t length = 1;
        std::string_view replacement = text.substr(0, 1);
        for (const auto& [symbol, command] : kCommands) {
            if (!text.starts_with(symbol)) continue;
            length = symbol.size();
            replacement = command;
        }
        out += replacement;
        text.remove_prefix(length);
    }
    return out;
}

std::string escapeMarkdown(std::string_view text) {
    constexpr std::string_view kMarkup = "\\`*_{}[]<>#|~";
    std::string out;
    for (const char c : text) {
        if (c == '\n' || c == '\r' || c == '\t') {
            out += ' ';
            continue;
        }
        if (c == '&') {
            out += "&amp;";
            continue;
        }
        if (kMarkup.find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
    return out;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t at = i + j;
            group = group << 8 | (at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0U);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            const bool isPadding = i + j > bytes.size();
            out += isPadding ? '=' : kDigits[group >> (18 - 6 * j) & 63U];
        }
    }
    return out;
}

}  // namespace gfxrepro::report
