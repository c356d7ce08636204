// How claims depend on what a paper left open: its `assumptions`, varied one at a time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runner/claims/claims.h"
#include "runner/run/plan.h"

namespace gfxrepro::studies {

/// One assumption at another value than the config's; the empty name: the config as it is.
struct Variation {
    std::string assumption;
    std::string value;
    std::optional<double> number;   // the value where it is one
    std::vector<std::string> sets;  // as `--set` takes them

    std::string title() const;  // "bias = 0.03", "as configured"
};

struct Variations {
    /// The config as it is; then the first other value of each assumption, the second of each, …:
    /// whatever is left out at the end, all assumptions are tried alike. Scenes come first: they
    /// are the least known and decide most.
    std::vector<Variation> runs;
    /// Assumptions that no run can vary, and why not.
    std::vector<std::pair<std::string, std::string>> fixed;
};

/// An assumption is varied where it is bound to the cases, the table does not sweep it, and it has
/// a range: two numbers are an interval, of which `points` values are taken, evenly by ratio where
/// it spans more than a factor of ten; else the listed values are. `cases` are the experiment's.
Variations variationsOf(const config::Experiment& experiment,
                        const std::vector<config::Case>& cases, const scene::Catalog& catalog,
                        int points);

/// What a run with a variation gave: the claims in the order of the config, or why there are none.
struct VariationResult {
    Variation variation;
    std::vector<claims::ClaimResult> claims;
    std::string error = {};
};

/// The outcomes, and behind them the last `left` variations, as what was not made.
std::vector<VariationResult> withLeft(std::vector<VariationResult> outcomes,
                                      const Variations& variations, std::size_t left);

/// "holds under all 7", "holds under none of 7", or "holds unless …" (where it holds as configured)
/// or "holds only if …" with the values of each assumption that decides, and between which the
/// verdict flips (by the margins, linearly). Runs without a verdict are not counted.
/// `claim` counts in the order of the config.
std::string dependence(const std::vector<VariationResult>& outcomes, std::size_t claim);

/// Of the assumptions tried those with which the verdict becomes another: "bias, scene_seed (of 5
/// tried)", "none of the 5 tried"; where some were not, "bias (2 of 5 tried)", "none (1 of 5
/// tried)"; "not tried" without any.
std::string restsOn(const std::vector<VariationResult>& outcomes, std::size_t claim);

/// A table of claims with their dependence, one of all runs, and what was not varied; `left` are
/// runs that are still to be made.
std::string sensitivityMarkdown(const config::Experiment& experiment,
                                const std::vector<VariationResult>& outcomes,
                                const Variations& variations, std::size_t left = 0);
/// table,basis,assumption,value,claim,verdict,measured,required,margin,error: a row a claim and
/// run.
std::string sensitivityCsv(const std::string& table, const std::vector<VariationResult>& outcomes,
                           const std::string& basis);
/// What sensitivityCsv() wrote of a table; nothing when it is of another basis (an empty one is
/// any). Throws Error with file and line.
std::vector<VariationResult> readSensitivity(const std::filesystem::path& file,
                                             const std::string& table,
                                             const std::string& basis = "");
/// Puts what sensitivityCsv() says of a table in the place of what the file has of it.
void keepSensitivity(const std::filesystem::path& file, const std::string& table,
                     const std::string& csv);

/// Identity of what an experiment's verdicts follow from, but for the program: its cases with their
/// scenes and parameters, layout, printed values, what its claims ask, the class of the device.
/// Results of another basis are stale.
std::string basisOf(const run::Plan& plan, const config::Experiment& experiment);

/// Where results of a plan's experiments are kept in `folder`: <device class>-<profile>.csv.
std::filesystem::path keptFile(const std::filesystem::path& folder, const run::Plan& plan);

/// The README of a folder of kept results: what each verdict rests on, a line a table;
/// `command` made the last of them.
std::string sensitivityIndex(const std::filesystem::path& folder, const std::string& command);

/// What kept results say of the claims of a plan's experiments, as the plan or another config has
/// them, beside the verdict under which they were tried. Stale ones are left out.
claims::KeptSensitivity keptSensitivity(const run::Plan& plan,
                                        const std::vector<config::Experiment>& experiments,
                                        const std::filesystem::path& folder);
/// Of the results that are kept beside the configs, in results/sensitivity; nothing where there is
/// no such folder, as beside a program that was installed.
std::optional<claims::KeptSensitivity> keptSensitivity(
    const run::Plan& plan, const std::vector<config::Experiment>& experiments);

}  // namespace gfxrepro::studies
