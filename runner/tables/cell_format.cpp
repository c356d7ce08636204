#include "runner/tables/cell_format.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "engine/core/text.h"

namespace gfxrepro::tables {

namespace {

std::string formatted(const std::string& spec, double value) {
    return fmt::format(fmt::runtime("{:" + spec + "}"), value);
}

/// "1,254" reads as 1254.
std::optional<double> parsePrinted(std::string_view text) {
    std::string digits(trimmed(text));
    std::erase(digits, ',');
    return parseDouble(digits);
}

}  // namespace

CellFormat::CellFormat(std::string_view text, const SourceLocation& where) {
    const auto fail = [&](const std::string& reason) {
        throw Error(where, "format '" + std::string(text) + "': " + reason);
    };
    literals_.emplace_back();
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isDoubled = i + 1 < text.size() && text[i + 1] == text[i];
        if (text[i] == '}' && !isDoubled) fail("'}' without '{'; write '}}' for a brace");
        if (text[i] != '{' || isDoubled) {
            literals_.back() += text[i];
            if (text[i] == '{' || text[i] == '}') ++i;
            continue;
        }
        const std::size_t end = text.find('}', i);
        if (end == std::string_view::npos) fail("'{' without '}'");
        const std::string_view inside = text.substr(i + 1, end - i - 1);
        const std::size_t colon = std::min(inside.find(':'), inside.size());
        Placeholder placeholder{std::string(inside.substr(0, colon)), {}, ""};
        if (colon < inside.size()) placeholder.spec = inside.substr(colon + 1);
        try {
            placeholder.statistic = metrics::statisticFromName(placeholder.name);
            formatted(placeholder.spec, 1.0);
        } catch (const Error& error) {
            fail(error.what());
        } catch (const fmt::format_error& error) {
            fail("bad number format '" + placeholder.spec + "': " + error.what());
        }
        placeholders_.push_back(std::move(placeholder));
        literals_.emplace_back();
        i = end;
    }
    if (placeholders_.empty()) fail("expected a statistic in braces, as in '{median:.2f}'");
}

std::string CellFormat::format(std::span<const double> values) const {
    GFXREPRO_ASSERT_EQ(values.size(), placeholders_.size());
    std::string text = literals_[0];
    for (std::size_t i = 0; i < values.size(); ++i) {
        text += formatOne(i, values[i]) + literals_[i + 1];
    }
    return text;
}

std::string CellFormat::formatOne(std::size_t placeholder, double value) const {
    if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
    return formatted(placeholders_[placeholder].spec, value);
}

std::vector<std::optional<double>> CellFormat::parse(std::string_view text) const {
    std::vector<std::optional<double>> values(placeholders_.size());
    if (!text.starts_with(literals_[0])) return values;
    text.remove_prefix(literals_[0].size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string& after = literals_[i + 1];
        const std::size_t end = after.empty() ? text.size() : text.find(after);
        if (end == std::string_view::npos) {
            // The last literal (a unit) may be left away.
            if (i + 1 == values.size()) values[i] = parsePrinted(text);
            return values;
        }
        values[i] = parsePrinted(text.substr(0, end));
        text.remove_prefix(end + after.size());
    }
    return values;
}

}  // namespace gfxrepro::tables
