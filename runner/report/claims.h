// Claims: what the paper says must follow from its table, judged on the measured one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/report/table.h"

namespace gfxrepro::report {

enum class Verdict { Holds, Fails, Ambiguous, NotApplicable, Unmeasured };
/// "holds", "fails", "ambiguous", "not-applicable", "unmeasured".
std::string_view verdictName(Verdict verdict);

/// Where the run took place, as far as claims ask.
struct ReportContext {
    std::string device;       // renderer, for people: "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string deviceClass;  // "software" | "gpu"
    std::string profile;      // "quick" | "full" | "paper"
    std::string commit;       // of the program
    std::string command;      // of the whole run, for people
};

struct ClaimResult {
    std::string id;     // "V1"
    std::string table;  // "zju2005/2.1"
    std::string text;   // what the paper says
    Verdict verdict = Verdict::Unmeasured;
    std::string measured;  // "0.41 [0.38, 0.44]"
    std::string required;  // "exponent in [0.3, 1.2]"
    std::string margin;    // distance from the point to the nearest bound, in the quantity's unit;
                           // negative outside
    std::string reason;
};

/// Judges every claim of the experiment on its table. Each type is one quantity with a required
/// range, computed from the cells' values and again from each of their bootstrap draws: a 95 %
/// interval wholly inside of the range holds, wholly outside fails, else it is ambiguous. Groups of
/// rows are judged apart; the worst verdict counts. Throws Error with the claim's place for an
/// operand that is no expression over the columns, or an axis that the table has not.
std::vector<ClaimResult> evaluateClaims(const config::Experiment& experiment, const Table& table,
                                        const ReportContext& context);

/// "12 hold, 1 fails, 2 unmeasured": only those that occur; "no claims" for none.
std::string claimSummaryLine(const std::vector<ClaimResult>& results);

}  // namespace gfxrepro::report
