// How claims depend on what a paper left open: its `assumptions`, varied one at a time.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runner/batch/plan.h"
#include "runner/report/claims.h"

namespace gfxrepro::batch {

/// One assumption at another value than the config's; the empty name: the config as it is.
struct Variation {
    std::string assumption;
    std::string value;
    std::optional<double> number;   // the value where it is one
    std::vector<std::string> sets;  // as `--set` takes them

    std::string title() const;  // "bias = 0.03", "as configured"
};

struct Variations {
    std::vector<Variation> runs;  // the config as it is, then each assumption
    /// Assumptions that no run can vary, and why not.
    std::vector<std::pair<std::string, std::string>> fixed;
};

/// An assumption is varied where it names a parameter of the technique (or `output`, a square
/// picture) that the table does not sweep and its range is a list: two numbers are an interval, of
/// which `points` values are taken, evenly by ratio where it spans more than a factor of ten; else
/// the listed values are. `cases` are the experiment's.
Variations variationsOf(const config::Experiment& experiment, const std::vector<Case>& cases,
                        int points);

struct Outcome {
    Variation variation;
    std::vector<report::ClaimResult> claims;
};

/// "holds under all 7", "holds under none of 7", or "holds unless …" (where it holds as configured)
/// or "holds only if …" with the values of each assumption that decides, and between which the
/// verdict flips (by the margins, linearly).
/// `claim` counts in the order of the config.
std::string dependence(const std::vector<Outcome>& outcomes, std::size_t claim);

/// A table of claims with their dependence, one of all runs, and what was not varied.
std::string sensitivityMarkdown(const config::Experiment& experiment,
                                const std::vector<Outcome>& outcomes, const Variations& variations);
/// assumption,value,claim,verdict,measured,required,margin
std::string sensitivityCsv(const std::vector<Outcome>& outcomes);

}  // namespace gfxrepro::batch
