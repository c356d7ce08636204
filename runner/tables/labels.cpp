#include "runner/tables/labels.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <functional>
#include <optional>
#include <vector>

#include "engine/core/text.h"
#include "runner/config/experiment.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

namespace {

struct Suffix {
    std::string_view name;
    std::string_view unit;
    std::string_view quantity;  // that is measured in it; empty where it may be anything
};
constexpr std::string_view kMemory = "memory";
/// The units that names of configs end with. No "_s": delta_s is no number of seconds.
constexpr Suffix kSuffixes[] = {{"_ms", "ms", "time"},
                                {"_us", "µs", "time"},
                                {"_pct", "%", ""},
                                {"_px", "px", ""},
                                {"_db", "dB", ""},
                                {"_mb", "MB", kMemory},
                                {"_mib", "MiB", kMemory},
                                {"_bytes", "bytes", kMemory},
                                {"_fps", "fps", "frame rate"},
                                {"_deg", "°", "angle"},
                                {"_m", "m", ""}};
/// What the runner itself gives a case.
constexpr Suffix kOwn[] = {{"output.width", "px", "width of the image"},
                           {"output.height", "px", "height of the image"},
                           {"output.frames", "", "frames"}};

bool isWordCharacter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-';
}

/// "outdoor/bird_nest", "draw_ms": words joined by _, perhaps in a folder. With capitals it is a
/// word of others, which stays as they write it.
bool isName(std::string_view name) {
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) return false;
    if (std::ranges::count(name, '/') > 1 || name.back() == '/') return false;
    return std::ranges::all_of(name, [](char c) {
        const bool isCapital = std::isupper(static_cast<unsigned char>(c)) != 0;
        return !isCapital && (isWordCharacter(c) || c == '/');
    });
}

/// "model.glb" of "/home/me/model.glb"; empty of what is no path from the root.
std::string_view fileName(std::string_view name) {
    return name.starts_with('/') ? name.substr(name.rfind('/') + 1) : std::string_view();
}

std::string withBlanks(std::string_view name) {
    std::string text(name);
    std::ranges::replace(text, '_', ' ');
    return text;
}

/// 1 and enum are no units to read, and "clusters [cluster]", "vertices [vertex]" or "patches
/// [patch]" would say nothing more.
bool isWorthReading(std::string_view unit, std::string_view words) {
    if (unit.empty() || unit == "1" || unit == "enum") return false;
    const std::string said = fmt::format(" {} ", words);
    std::vector<std::string> forms = {std::string(unit), fmt::format("{}s", unit),
                                      fmt::format("{}es", unit)};
    if (unit.ends_with("ex")) {
        forms.push_back(fmt::format("{}ices", unit.substr(0, unit.size() - 2)));
    }
    return std::ranges::none_of(forms, [&](const std::string& form) {
        return said.find(fmt::format(" {} ", form)) != said.npos;
    });
}

Quantity withUnit(std::string words, std::string_view unit) {
    const bool isRead = isWorthReading(unit, words);
    return {std::move(words), isRead ? std::string(unit) : ""};
}

/// "redundant, image 0" in "%" of "redundant_pct_image_0", a metric and its pass, where percent
/// was recorded.
std::optional<Quantity> passOf(std::string_view own, std::string_view unit) {
    for (const Suffix& one : kSuffixes) {
        const std::size_t at = own.find(std::string(one.name) + '_');
        if (one.unit != unit || at == own.npos || at == 0) continue;
        return Quantity{
            withBlanks(own.substr(0, at)) + ", " + withBlanks(own.substr(at + one.name.size() + 1)),
            std::string(unit)};
    }
    return std::nullopt;
}

/// The unit that a name ends with, as "_level" of "rmse_level" where levels were recorded.
bool endsWithUnit(std::string_view name, std::string_view unit) {
    const std::string ending = "_" + lowerCase(unit);
    return !unit.empty() && name.size() > ending.size() && name.ends_with(ending);
}

}  // namespace

std::string Quantity::text() const {
    return unit.empty() ? words : fmt::format("{} [{}]", words, unit);
}

std::string Quantity::with(std::string_view value) const {
    // "image 0: 12 %": two numbers would run together.
    const bool endsWithNumber = !words.empty() && parseDouble(words.substr(words.size() - 1));
    return fmt::format("{}{} {}{}{}", words, endsWithNumber ? ":" : "", value,
                       unit.empty() || unit == "°" ? "" : " ", unit);
}

Quantity quantityOf(std::string_view name, const Words& words, std::string_view unit) {
    std::string_view own = name.substr(name.find('/') == name.npos ? 0 : name.find('/') + 1);
    if (own.starts_with(config::kSceneAxisPrefix))
        own.remove_prefix(config::kSceneAxisPrefix.size());
    const auto suffix = std::ranges::find_if(kSuffixes, [&](const Suffix& one) {
        return own == one.name.substr(1) ||
               (own.size() > one.name.size() && own.ends_with(one.name));
    });
    const bool hasSuffix = isName(name) && suffix != std::end(kSuffixes);
    if (const auto known = words.find(std::string(name)); known != words.end()) {
        return withUnit(known->second, hasSuffix ? suffix->unit : unit);
    }
    for (const Suffix& one : kOwn) {
        if (name == one.name) return {std::string(one.quantity), std::string(one.unit)};
    }
    if (const std::string_view file = fileName(name); !file.empty()) {
        const auto known = words.find(std::string(file));
        return withUnit(known == words.end() ? std::string(file) : known->second, unit);
    }
    if (!isName(name)) return withUnit(std::string(name), unit);
    if (hasSuffix && own.size() > suffix->name.size()) {
        std::string before = withBlanks(own.substr(0, own.size() - suffix->name.size()));
        // "point [MiB]" would not say what of it.
        const bool saysMemory = before.find(kMemory) != before.npos;
        if (suffix->quantity == kMemory && !saysMemory) before.append(" ").append(kMemory);
        return {std::move(before), std::string(suffix->unit)};
    }
    if (const auto of = passOf(own, unit)) return *of;
    if (hasSuffix && !suffix->quantity.empty()) {
        return {std::string(suffix->quantity), std::string(suffix->unit)};
    }
    if (endsWithUnit(own, unit)) {
        return {withBlanks(own.substr(0, own.size() - unit.size() - 1)), std::string(unit)};
    }
    return withUnit(withBlanks(own), unit);
}

Quantity quantityOf(const TableColumn& column, const Words& words) {
    if (column.parts.size() < 2 || words.contains(column.label)) {
        return quantityOf(column.label, words, column.unit);
    }
    std::vector<std::string> before;
    std::string_view unit = column.unit;
    for (std::size_t i = 0; i + 1 < column.parts.size(); ++i) {
        const Quantity part = quantityOf(column.parts[i], words);
        if (!part.unit.empty()) unit = {};  // it is said
        before.push_back(part.text());
    }
    const Quantity last = quantityOf(column.parts.back(), words, unit);
    return withUnit(joined(before) + ", " + last.words, last.unit);
}

std::string unitLabel(const std::string& unit) {
    const auto suffix = std::ranges::find(kSuffixes, unit, &Suffix::unit);
    const bool isNamed = suffix != std::end(kSuffixes) && !suffix->quantity.empty();
    return isNamed ? fmt::format("{} [{}]", suffix->quantity, unit) : unit;
}

std::string shownName(std::string_view name, const Words& words) {
    return quantityOf(name, words).text();
}

std::map<std::string, std::string> shownNames(const std::set<std::string>& names,
                                              const Words& words) {
    std::map<std::string, std::string> shown;
    for (const std::string& name : names) shown[name] = shownName(name, words);
    const auto keepApart = [&](auto&& longerOf) {
        std::map<std::string, int> uses;
        for (const auto& [name, text] : shown) ++uses[text];
        for (auto& [name, text] : shown) {
            if (uses[text] > 1) text = longerOf(name);
        }
    };
    keepApart([](const std::string& name) { return isName(name) ? withBlanks(name) : name; });
    keepApart([](const std::string& name) { return name; });
    return shown;
}

std::vector<std::map<std::string, std::string>> shownLabels(
    const std::vector<std::vector<std::string>>& rows, const Words& words) {
    std::vector<std::set<std::string>> names;
    for (const std::vector<std::string>& labels : rows) {
        names.resize(std::max(names.size(), labels.size()));
        for (std::size_t i = 0; i < labels.size(); ++i) names[i].insert(labels[i]);
    }
    std::vector<std::map<std::string, std::string>> shown;
    for (const auto& axis : names) shown.push_back(shownNames(axis, words));
    return shown;
}

std::string valueInWords(const std::string& value, const Words& words) {
    if (words.contains(value)) return words.at(value);
    const bool isWords = isName(value) && value.find_first_of("/.") == value.npos;
    return isWords ? withBlanks(value) : value;
}

std::string inWords(std::string_view required, const Table& table) {
    std::map<std::string, Quantity, std::less<>> known;
    for (const TableRow& row : table.rows) {
        for (const std::string& label : row.labels) {
            if (label.find('_') != label.npos) known[label] = quantityOf(label, table.words);
        }
    }
    for (const std::string& axis : table.rowAxes) known[axis] = quantityOf(axis, table.words);
    for (const TableColumn& column : table.columns) {
        known[column.label] = quantityOf(column, table.words);
    }
    struct Piece {
        std::string_view text;
        const Quantity* quantity;  // that it names; null of other text
    };
    std::vector<Piece> pieces;
    const auto isOfName = [](char c) { return isWordCharacter(c) && c != '-'; };
    for (std::size_t at = 0; at < required.size();) {
        const std::size_t begin = at;
        const char first = required[at];
        const std::size_t quote = first == '\'' ? required.find('\'', at + 1) : required.npos;
        std::string_view name;
        if (quote != required.npos) {
            name = required.substr(at + 1, quote - at - 1);
            at = quote + 1;
        } else {
            const bool isName = isOfName(first);
            while (at < required.size() && isOfName(required[at]) == isName &&
                   (at == begin || required[at] != '\'')) {
                ++at;
            }
            name = required.substr(begin, at - begin);
        }
        const auto found = known.find(name);
        pieces.push_back(
            {required.substr(begin, at - begin), found == known.end() ? nullptr : &found->second});
    }
    const bool isAlone = std::ranges::count_if(pieces, [](const Piece& piece) {
                             return piece.quantity != nullptr;
                         }) == 1;
    std::string text;
    for (const Piece& piece : pieces) {
        text += !piece.quantity ? std::string(piece.text)
                : isAlone       ? piece.quantity->text()
                                : piece.quantity->words;
    }
    return text;
}

std::string shownValue(const std::string& axis, const std::string& value, const Words& words) {
    if (words.contains(value)) return words.at(value);
    if (parseDouble(value) || value == "true" || value == "false") {
        return quantityOf(axis, words).with(value);
    }
    return shownName(value, words);
}

std::string shownCase(const std::string& title, const std::string& table, const Words& words) {
    if (!title.starts_with(table + ' ')) return title;
    std::string_view settings = std::string_view(title).substr(table.size() + 1);
    std::string_view other;  // " (outdoor/grass@2)": another scene than its axis says
    if (const std::size_t at = settings.rfind(" (");
        settings.ends_with(')') && at != settings.npos) {
        other = settings.substr(at);
        settings = settings.substr(0, at);
    }
    /// The next " name=" from there on; values may have blanks.
    const auto nextAxis = [&](std::size_t from) {
        for (std::size_t blank = from; (blank = settings.find(' ', blank)) != settings.npos;) {
            std::size_t end = ++blank;
            while (end < settings.size() && isWordCharacter(settings[end])) ++end;
            if (end > blank && end < settings.size() && settings[end] == '=') return blank - 1;
        }
        return settings.size();
    };
    std::vector<std::string> said;
    for (std::size_t begin = 0; begin < settings.size();) {
        const std::size_t end = nextAxis(begin);
        const std::string_view setting = settings.substr(begin, end - begin);
        const std::size_t equals = setting.find('=');
        said.push_back(equals == setting.npos
                           ? std::string(setting)
                           : shownValue(std::string(setting.substr(0, equals)),
                                        std::string(setting.substr(equals + 1)), words));
        begin = end + 1;
    }
    return joined(said).append(other);
}

std::string shortened(std::vector<std::string> values, std::string_view separator) {
    constexpr std::size_t kMostListed = 12;
    if (values.size() > kMostListed) {
        values.resize(kMostListed);
        values.emplace_back("…");
    }
    return joined(values, separator);
}

}  // namespace gfxrepro::tables
