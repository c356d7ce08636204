#include "runner/report/markup.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "engine/core/text.h"

namespace gfxrepro::report {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

struct Reference {
    char letter;
    std::string_view text;
};
constexpr Reference kReferences[] = {{'&', "&amp;"},  {'<', "&lt;"},   {'>', "&gt;"},
                                     {'"', "&quot;"}, {'\'', "&#39;"}, {'\n', "&#10;"},
                                     {'\t', "&#9;"}};

/// XML has no place for U+FFFE and U+FFFF.
bool isOfXml(std::string_view character) {
    return character != "\xEF\xBF\xBE" && character != "\xEF\xBF\xBF";
}

}  // namespace

std::string escapeXml(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        text.remove_prefix(character.size());
        const auto reference = std::ranges::find(kReferences, character[0], &Reference::letter);
        if (reference != std::end(kReferences)) {
            out += reference->text;
        } else {
            const bool isControl = static_cast<unsigned char>(character[0]) < 0x20;
            out += length == 0 || isControl || !isOfXml(character) ? kReplacement : character;
        }
    }
    return out;
}

std::string escapeLatex(std::string_view text) {
    static constexpr std::pair<std::string_view, std::string_view> kCommands[] = {
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
        {"⁰", "$^0$"},
        {"⁴", "$^4$"},
        {"⁵", "$^5$"},
        {"⁶", "$^6$"},
        {"⁷", "$^7$"},
        {"⁸", "$^8$"},
        {"⁹", "$^9$"},
        {"⁻", "$^-$"},
        {"ᵀ", "$^T$"},
        {"₀", "$_0$"},
        {"₁", "$_1$"},
        {"₂", "$_2$"},
        {"₋", "$_-$"},
        {"ᵢ", "$_i$"},
        {"ⱼ", "$_j$"},
        {"≈", "$\\approx$"},
        {"≠", "$\\neq$"},
        {"√", "$\\surd$"},
        {"γ", "$\\gamma$"},
        {"η", "$\\eta$"},
        {"ρ", "$\\rho$"},
        {"ω", "$\\omega$"},
        {"Σ", "$\\Sigma$"},
    };
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
