#include "runner/config/when.h"

#include <algorithm>

#include "engine/core/checks.h"

namespace gfxrepro::config {

const Node* valueAt(const AxisPoint& point, std::string_view axis) {
    for (const auto& [name, value] : point) {
        if (name == axis) return &value;
    }
    return nullptr;
}

bool matchesAll(const AxisPoint& point, const Node& conditions) {
    return std::all_of(conditions.entries().begin(), conditions.entries().end(),
                       [&](const auto& condition) {
                           const Node* value = valueAt(point, condition.key());
                           return value && matchesAny(*value, condition.value);
                       });
}

void applyWhen(const Node& when, AxisPoint& point) {
    for (std::size_t before = point.size() + 1; before != point.size();) {
        before = point.size();
        std::erase_if(point, [&, whole = point](const auto& axis) {
            const Node* conditions = when.find(axis.key());
            return conditions && !matchesAll(whole, *conditions);
        });
    }
}

}  // namespace gfxrepro::config
