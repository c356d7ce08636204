#include "runner/run/case_filter.h"

#include <fnmatch.h>

#include <algorithm>
#include <set>

#include "engine/core/text.h"
#include "runner/tables/case_records.h"

namespace gfxrepro::run {

namespace {

constexpr const char* kCaseKey = "case";
/// More values than these do not help in a message.
constexpr std::size_t kShownValues = 12;

/// What the case has under a key; empty where it has nothing of that name.
std::optional<std::string> valueOfKey(const Case& item, const std::string& key) {
    if (item.axes.isMap()) {
        if (const Node* value = item.axes.find(key)) return tables::canonicalText(*value);
    }
    if (key == kCaseKey) return item.id;
    if (key == "scene" && !item.scene.isNull()) return tables::canonicalText(item.scene);
    if (key == "output.width") return std::to_string(item.outputWidthPx);
    if (key == "output.height") return std::to_string(item.outputHeightPx);
    const Node* value = item.params.isMap() ? item.params.find(key) : nullptr;
    return value ? std::optional(tables::canonicalText(*value)) : std::nullopt;
}

/// What is allowed: one value, or those between signs `|`, or of a list.
Node::Sequence wantedAlternatives(const Node& wanted) {
    if (wanted.isSequence()) return wanted.items();
    if (!wanted.isScalar() || wanted.text().find('|') == std::string::npos) return {wanted};
    Node::Sequence values;
    for (const std::string& text : split(wanted.text(), '|')) {
        values.push_back(Node::scalar(text, wanted.location()));
    }
    return values;
}

bool has(const Case& item, const config::Override& wanted) {
    const auto value = valueOfKey(item, wanted.key);
    if (!value) return false;
    // A vector is a list itself.
    if (value == tables::canonicalText(wanted.value)) return true;
    return std::ranges::any_of(wantedAlternatives(wanted.value), [&](const Node& allowed) {
        const std::string text = tables::canonicalText(allowed);
        if (wanted.key == kCaseKey) return value->starts_with(text);
        return value == text || ::fnmatch(text.c_str(), value->c_str(), 0) == 0;
    });
}

/// What the case has under all of the keys; empty where it lacks one.
std::optional<std::vector<std::string>> keyValues(const Case& item,
                                                  const std::vector<std::string>& keys) {
    std::vector<std::string> values;
    for (const std::string& key : keys) {
        std::optional<std::string> value = valueOfKey(item, key);
        if (!value) return std::nullopt;
        values.push_back(std::move(*value));
    }
    return values;
}

[[noreturn]] void failWithout(const config::Override& wanted, const std::string& written,
                              const std::vector<Case>& cases) {
    std::set<std::string> values, keys;
    for (const Case& item : cases) {
        if (const auto value = valueOfKey(item, wanted.key)) values.insert(*value);
        if (!item.axes.isMap()) continue;
        for (const auto& [key, value] : item.axes.entries()) keys.insert(key);
    }
    const std::string start = "--only " + written + ": ";
    if (wanted.key == kCaseKey) {
        throw UsageError(start +
                         "no case has an id that begins so; ids change with the program, "
                         "'gfxrepro plan' shows them");
    }
    if (values.empty()) {
        const std::vector<std::string> known(keys.begin(), keys.end());
        throw UsageError(start + "no case has '" + wanted.key + "'" +
                         suggestion(wanted.key, known) + " (axes here: " + joined(known) + ")");
    }
    std::vector<std::string> shown(values.begin(), values.end());
    const bool isCut = shown.size() > kShownValues;
    if (isCut) shown.resize(kShownValues);
    throw UsageError(start + "no case has that value; there are " + joined(shown) +
                     (isCut ? ", …" : ""));
}

/// A pattern is text, whatever YAML makes of `*` at its beginning.
config::Override wantedBy(const std::string& written) {
    const std::size_t value = written.find('=') + 1;
    const std::string text(trimmed(std::string_view(written).substr(value)));
    const bool isPattern = value > 0 && text.find_first_of("*?") != std::string::npos;
    const bool isList = text.starts_with('[') && text.ends_with(']');
    if (!isPattern || isList) return config::parseOverride(written);
    std::string quoted = written.substr(0, value) + '\'';
    for (const char c : text) quoted.append(c == '\'' ? 2 : 1, c);
    return config::parseOverride(quoted + '\'');
}

}  // namespace

void keepOnly(Plan& plan, const std::vector<std::string>& only) {
    std::vector<std::string> keys;
    std::map<std::string, std::vector<config::Override>> byKey;
    for (const std::string& written : only) {
        config::Override wanted = wantedBy(written);
        const bool isThere =
            std::ranges::any_of(plan.cases, [&](const Case& item) { return has(item, wanted); });
        if (!isThere) failWithout(wanted, written, plan.cases);
        if (!byKey.contains(wanted.key)) keys.push_back(wanted.key);
        byKey[wanted.key].push_back(std::move(wanted));
    }
    for (const std::string& key : keys) {
        std::vector<Case> kept;
        std::ranges::copy_if(plan.cases, std::back_inserter(kept), [&](const Case& item) {
            return std::ranges::any_of(byKey[key],
                                       [&](const auto& wanted) { return has(item, wanted); });
        });
        if (kept.empty()) throw UsageError("--only: no case has all of " + joined(only));
        plan.cases = std::move(kept);
    }
}

std::vector<std::string> CaseNames::onlyOf(const Case& item) {
    std::vector<std::string> only;
    Keys keys;
    if (item.axes.isMap()) {
        for (const auto& [key, value] : item.axes.entries()) {
            only.push_back(key + '=' + (value.isScalar() ? value.text() : value.toFlowText()));
            keys.push_back(key);
        }
    }
    const auto [counts, isNew] = counts_.try_emplace({item.experiment, keys});
    if (isNew) {
        for (const Case& other : plan_.cases) {
            if (other.experiment != item.experiment) continue;
            if (const auto values = keyValues(other, keys)) ++counts->second[*values];
        }
    }
    const auto values = keyValues(item, keys);
    const auto alike = counts->second.find(values.value_or(Keys()));
    if (alike != counts->second.end() && alike->second > 1) {
        return {std::string(kCaseKey) + '=' + item.id};
    }
    return only;
}

}  // namespace gfxrepro::run
