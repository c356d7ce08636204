#include "runner/studies/budget.h"

#include <algorithm>
#include <numeric>

#include "engine/core/error.h"
#include "engine/core/text.h"

namespace gfxrepro::studies {

double parseBudgetS(const std::string& text) {
    const char unit = text.empty() ? ' ' : text.back();
    const double seconds = unit == 's' ? 1.0 : unit == 'm' ? 60.0 : unit == 'h' ? 3600.0 : 0.0;
    const std::optional<double> value =
        parseDouble(std::string_view(text).substr(0, text.empty() ? 0 : text.size() - 1));
    if (!value || *value <= 0.0 || seconds == 0.0) {
        throw UsageError("--budget is '" + text + "'; allowed: a time such as 90s, 20m or 1.5h");
    }
    return *value * seconds;
}

std::vector<std::size_t> withinBudget(const std::vector<BudgetItem>& items, double budgetS) {
    std::vector<std::size_t> order(items.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(
        order, [&](std::size_t i) { return items[i].claimCount == 0 || items[i].timeS > budgetS; });
    if (order.empty()) return {};
    const auto claims = [&](std::size_t i) { return static_cast<double>(items[i].claimCount); };
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return claims(a) * items[b].timeS > claims(b) * items[a].timeS;
    });
    std::vector<std::size_t> chosen;
    double leftS = budgetS, decided = 0.0;
    for (const std::size_t i : order) {
        if (items[i].timeS > leftS) continue;
        leftS -= items[i].timeS;
        decided += claims(i);
        chosen.push_back(i);
    }
    const std::size_t largest = *std::ranges::max_element(order, {}, claims);
    if (claims(largest) > decided) chosen = {largest};
    std::ranges::sort(chosen);
    return chosen;
}

}  // namespace gfxrepro::studies
