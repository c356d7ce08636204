#include "engine/core/checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/text.h"

namespace gfxrepro {

namespace {

/// "; of 'light' there are light_ratio, …" for `light_size`: names that begin with the same word.
std::string kinHint(const std::string& name, std::span<const std::string> names) {
    const std::string word = name.substr(0, name.find('_'));
    std::vector<std::string> kin;
    for (const std::string& other : names) {
        if (other.starts_with(word + '_')) kin.push_back(other);
    }
    if (kin.empty() || word.size() == name.size()) return "";
    return fmt::format("; of '{}' there are {}", word, joined(kin));
}

}  // namespace

void requireKeys(const Node& map, std::string_view what, std::span<const std::string> allowed,
                 std::string_view noun) {
    if (!map.isMap()) throwNotAllowed(map, what, "a map of " + joined(allowed));
    for (const auto& [key, value] : map.entries()) {
        if (std::find(allowed.begin(), allowed.end(), key) != allowed.end()) continue;
        const std::string near = suggestion(key, allowed), kin = kinHint(key, allowed);
        const std::string hint = !near.empty()     ? near
                                 : !kin.empty()    ? kin
                                 : allowed.empty() ? "; it has none"
                                                   : "; allowed: " + joined(allowed);
        throw Error(map.keyLocation(key),
                    fmt::format("{}: unknown {} '{}'{}", what, noun, key, hint));
    }
}

void throwNotAllowed(const Node& value, std::string_view what, std::string_view allowed) {
    throw Error(value.location(), std::string(what) + " is " +
                                      (value.isNull() ? "empty" : value.toFlowText()) +
                                      "; allowed: " + std::string(allowed));
}

const std::string& lineOf(const Node& node, std::string_view what) {
    if (!node.isScalar() || trimmed(node.text()).empty() ||
        node.text().find('\n') != std::string::npos) {
        throwNotAllowed(node, what, "one line of text");
    }
    return node.text();
}

std::string NumberRange::text(std::string_view unit) const {
    const std::string end = unit.empty() || unit == "1" ? "" : " " + std::string(unit);
    const auto shown = [](double value) { return Node::number(value).text(); };
    const std::string low = (isLeastExcluded ? "above " : "at least ") + shown(least);
    const std::string high = (isMostExcluded ? "below " : "at most ") + shown(most);
    if (std::isinf(most)) return std::isinf(least) ? "" : low + end;
    if (std::isinf(least)) return high + end;
    const bool isClosed = !isLeastExcluded && !isMostExcluded;
    return (isClosed ? shown(least) + " … " + shown(most) : low + ", " + high) + end;
}

double numberIn(const Node& node, const NumberRange& range, std::string_view what,
                std::string_view unit) {
    const std::optional<double> value = node.tryDouble();
    const bool isOfType = value && (!range.isWhole || node.tryInteger());
    if (isOfType && range.has(*value)) return *value;
    const std::string kind = range.isWhole ? "a whole number" : "a number";
    const std::string allowed = range.text(unit);
    throwNotAllowed(node, what,
                    isOfType ? allowed : kind + (allowed.empty() ? "" : ", " + allowed));
}

bool flagOf(const Node& node, std::string_view what) {
    if (const std::optional<bool> flag = node.tryBool()) return *flag;
    throwNotAllowed(node, what, "true | false");
}

std::size_t choiceOf(const Node& node, std::span<const std::string> names, std::string_view what) {
    const auto found = std::ranges::find(names, node.isScalar() ? node.text() : "");
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    throwNotAllowed(node, what, joined(names, " | "));
}

std::optional<double> fractionOf(const Node& node) {
    const std::string text = node.isScalar() ? node.text() : "";
    std::optional<double> fraction = node.tryDouble();
    if (text.ends_with('%')) {
        fraction = parseDouble(trimmed(std::string_view(text).substr(0, text.size() - 1)));
        if (fraction) *fraction /= 100.0;
    } else if (fraction && *fraction > 1.0) {
        fraction.reset();
    }
    return fraction;
}

std::string contentKey(const Node& node) {
    if (const auto number = node.tryDouble()) return Node::number(*number).text();
    std::string key;
    if (node.isSequence()) {
        for (const Node& item : node.items()) key += contentKey(item) + ",";
        return fmt::format("[{}]", key);
    }
    if (node.isMap()) {
        std::vector<std::string> parts;
        for (const auto& [name, value] : node.entries()) {
            parts.push_back(nlohmann::json(name).dump() + ":" + contentKey(value));
        }
        std::sort(parts.begin(), parts.end());
        return fmt::format("{{{}}}", joined(parts));
    }
    return node.toJson().dump();
}

bool matchesAny(const Node& value, const Node& pattern) {
    if (value.sameContent(pattern)) return true;
    return pattern.isSequence() &&
           std::any_of(pattern.items().begin(), pattern.items().end(),
                       [&](const Node& item) { return value.sameContent(item); });
}

}  // namespace gfxrepro
