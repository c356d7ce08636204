// The pictures that show at a glance what of a document reproduced and what did not.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "runner/report/model.h"

namespace gfxrepro::report {

struct Highlight {
    const Page* page = nullptr;
    std::size_t run = 0;  // whose shot it is
    const Shot* shot = nullptr;
    const claims::ClaimResult* claim = nullptr;  // what it stands for
};

/// How much two pictures of a run differ, from 0 to 1.
using ShotDifference = std::function<double(std::size_t run, const Shot& a, const Shot& b)>;

/// The mean difference of their PNGs' values below the run's folder; 1 where the sizes differ.
double shotDifference(const std::filesystem::path& runFolder, const Shot& a, const Shot& b);

/// How many stand for a document.
inline constexpr std::size_t kHighlights = 6;

/// Up to kHighlights pictures of the first run that has pictures of these pages, in their order:
/// half of them of tables of which a claim fails, where there are so many, the others of tables
/// whose claims hold. Of a page where all holds the picture nearest to its truth, else the one
/// farthest from it; without a truth the one with most to see, by its size as a file. Where fewer
/// pages have pictures, their next pictures follow, each for another claim of its page: those first
/// that are least like what is shown of the page.
std::vector<Highlight> highlightsOf(const std::vector<const Page*>& pages,
                                    const ShotDifference& difference);

}  // namespace gfxrepro::report
