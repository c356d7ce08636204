// Which tables to measure when there is not time for all.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gfxrepro::studies {

/// "90s", "20m", "1.5h" in seconds. Throws UsageError for anything else, and for 0.
double parseBudgetS(const std::string& text);

/// A table with what it takes and what it decides.
struct BudgetItem {
    double timeS = 0.0;
    std::size_t claimCount = 0;
};

/// The items to measure, in their order: those with the most claims a second first, as long as they
/// fit; or the one item that decides more than all of these. Items without a claim are not taken.
std::vector<std::size_t> withinBudget(const std::vector<BudgetItem>& items, double budgetS);

}  // namespace gfxrepro::studies
