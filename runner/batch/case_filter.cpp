#include "runner/batch/case_filter.h"

#include <algorithm>
#include <set>

#include "runner/core/text.h"
#include "runner/report/case_records.h"

namespace gfxrepro::batch {

namespace {

constexpr const char* kCaseKey = "case";
/// More values than these do not help in a message.
constexpr std::size_t kShownValues = 12;

/// What the case has under a key; empty where it has nothing of that name.
std::optional<std::string> valueOf(const Case& item, const std::string& key) {
    if (item.axes.isMap()) {
        if (const config::Node* value = item.axes.find(key)) return report::canonicalText(*value);
    }
    if (key == kCaseKey) return item.id;
    if (key == "scene" && !item.scene.isNull()) return report::canonicalText(item.scene);
    if (key == "output.width") return std::to_string(item.outputWidthPx);
    if (key == "output.height") return std::to_string(item.outputHeightPx);
    const config::Node* value = item.params.isMap() ? item.params.find(key) : nullptr;
    return value ? std::optional(report::canonicalText(*value)) : std::nullopt;
}

bool has(const Case& item, const config::Override& wanted) {
    const auto value = valueOf(item, wanted.key);
    if (wanted.key == kCaseKey) return value->starts_with(wanted.value.text());
    return value == report::canonicalText(wanted.value);
}

[[noreturn]] void failWithout(const config::Override& wanted, const std::string& written,
                              const std::vector<Case>& cases) {
    std::set<std::string> values, keys;
    for (const Case& item : cases) {
        if (const auto value = valueOf(item, wanted.key)) values.insert(*value);
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

}  // namespace

void keepOnly(Plan& plan, const std::vector<std::string>& only) {
    for (const std::string& written : only) {
        const config::Override wanted = config::parseOverride(written);
        std::vector<Case> kept;
        std::ranges::copy_if(plan.cases, std::back_inserter(kept),
                             [&](const Case& item) { return has(item, wanted); });
        if (kept.empty()) failWithout(wanted, written, plan.cases);
        plan.cases = std::move(kept);
    }
}

std::vector<std::string> onlyOf(const Case& item, const Plan& plan) {
    std::vector<std::string> only;
    std::vector<config::Override> axes;
    if (item.axes.isMap()) {
        for (const auto& [key, value] : item.axes.entries()) {
            only.push_back(key + '=' + (value.isScalar() ? value.text() : value.toFlowText()));
            axes.push_back({key, value});
        }
    }
    const auto alike = std::ranges::count_if(plan.cases, [&](const Case& other) {
        return other.experiment == item.experiment &&
               std::ranges::all_of(axes, [&](const auto& axis) { return has(other, axis); });
    });
    if (alike > 1) return {std::string(kCaseKey) + '=' + item.id};
    return only;
}

}  // namespace gfxrepro::batch
