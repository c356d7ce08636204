// Claims: what the paper says must follow from its table, judged on the measured one.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/table.h"

namespace gfxrepro::claims {

/// "holds", "fails", "ambiguous", "not-applicable", "unmeasured".
std::string_view verdictName(Verdict verdict);
/// Throws Error for a name that is none.
Verdict verdictFromName(std::string_view name);

/// What counts more when a verdict is made of several: fails, unmeasured, ambiguous, holds.
int severity(Verdict verdict);

/// What kept results of `gfxrepro sensitivity` say of a claim.
struct TriedClaim {
    Verdict verdict = Verdict::Unmeasured;  // as configured, when it was tried
    std::string restsOn;                    // "bias, scene_seed (of 5 tried)"
};
/// What a verdict rests on where no folder of such results was found.
inline constexpr const char* kRestsOnUnknown = "not known";
/// By table and claim.
using KeptSensitivity = std::map<std::pair<std::string, std::string>, TriedClaim>;

/// Of each scene of a run, whether a file was read for it; none was for a generated one.
using SceneFiles = std::map<std::string, bool>;
/// "files" where every one of the scenes was made of a file, "generated" where none was; empty
/// where some were, where there is no scene, and where one is not known.
std::string sceneClass(const std::set<std::string>& scenes, const SceneFiles& files);

/// Where the run took place, as far as claims ask, and what is known of them.
struct ReportContext {
    std::string device;       // renderer, for people: "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string deviceClass;  // "software" | "gpu"
    std::string profile;      // "quick" | "full" | "paper"
    std::string commit;       // of the program
    std::string command;      // of the whole run, for people
    KeptSensitivity tried = {};
    bool knowsTried = true;  // false: there was nowhere to look
    tables::TableNotes tableNotes = {};
    std::map<std::string, std::string> sceneClasses = {};  // by table, of what its cases loaded
    /// The command line left rows out or gave values of its own: verdicts are not known of that.
    bool isAltered = false;
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
    std::optional<double> distance;  // the same as a number; of percent as a share
    std::string reason;              // of a verdict that is not plain: "worst at …", "one sample"

    ClaimSpec::Origin origin = ClaimSpec::Origin::Ours;
    std::optional<ClaimSpec::BoundSource> boundFrom;
    std::optional<ClaimSpec::TimeKind> timeKind;
    /// What it comes to as far as the config knows; none where the run is altered.
    std::optional<Verdict> known = Verdict::Holds;
    std::string because;       // why, where it does not hold
    std::string shownBy = {};  // and the place in results/findings that proves it

    /// Of the table's columns those that it was judged on by the CPU time of the process.
    std::vector<std::string> columnsByProcess = {};

    /// Of which part of the rows of the profile `paper` it is: "1 of 4 values of scene"; empty of
    /// all of them, and where these are not known.
    std::string rows;
    /// Of a claim about several scenes that does not hold on all: "3 of 4 scenes, not on tree".
    std::string holdsOn = {};
    std::string sameAs;     // "TABLE CLAIM": ClaimSpec
    bool isRepeat = false;  // not counted beside that one: markRepeats()

    /// A statement of the document itself.
    bool isOfDocument() const { return origin == ClaimSpec::Origin::Document; }
    /// What counts: of these what holds on all of its rows, and each truth once. What fails counts
    /// on a part of them, too.
    bool isCounted() const {
        return isOfDocument() && !isRepeat && (verdict != Verdict::Holds || rows.empty());
    }
    /// Another verdict than the known one. Ambiguous is none, and tells nothing against one; where
    /// it is the known one, failing is news.
    bool isNews() const {
        const auto isVerdict = [](Verdict one) {
            return one != Verdict::Ambiguous && one != Verdict::NotApplicable;
        };
        if (!known) return false;
        if (*known == Verdict::Ambiguous) return verdict == Verdict::Fails;
        return isVerdict(verdict) && isVerdict(*known) && verdict != *known;
    }

    /// Which assumptions the verdict rests on: "bias (of 5 tried)", "none of the 5 tried", "not
    /// tried"; kRestsOnUnknown; empty where there is no verdict.
    std::string restsOn = {};
    /// Whether another value of one of them turns it.
    bool restsOnAssumption() const {
        return !restsOn.empty() && !restsOn.starts_with("none ") && !restsOn.starts_with("not ");
    }
};

/// Why it does not hold, for people: the known cause, then what the judging noted; where the cause
/// is of another verdict, behind that and with its name. Empty where neither is known.
std::string whyText(const ClaimResult& claim);

/// Judges every claim of the experiment on its table. Each type is one quantity with a required
/// range. Of values that are no times it is computed and judged as it is (judge(),
/// judge.h); of times, and of random numbers, in each round, and a 95 % interval over rounds wholly
/// inside of the range holds, wholly outside fails, else it is ambiguous (judgeVarying(), judge.h).
/// On a software device the times of an algorithmic claim are the CPU times of the process, but for
/// what goes by the clock (config::goesByClock). Groups of
/// rows are judged apart; the worst verdict counts, and one that fails alone fails no surer than
/// among all of them (forgiveChance(), judge.h). What reads a column that
/// the table does not have is unmeasured. Throws Error with the claim's place for an operand that
/// is no expression, or an axis that the table has not. On which part of its rows a claim is judged
/// is known of the cases that were `planned` for the table.
std::vector<ClaimResult> evaluateClaims(const config::Experiment& experiment,
                                        const tables::Table& table, const ReportContext& context,
                                        std::span<const config::Case> planned = {});

/// The claims of all experiments, in order; `tables` lies beside `experiments`. Throws Error as the
/// single-experiment form.
std::vector<ClaimResult> evaluateClaims(const std::vector<config::Experiment>& experiments,
                                        const std::vector<tables::Table>& tables,
                                        const ReportContext& context,
                                        std::span<const config::Case> planned = {});

/// Whether a GPU alone judges times of that kind: those of a program's own, as such, any machine.
bool isOfGpu(const std::optional<ClaimSpec::TimeKind>& kind, const tables::Table& table);

/// Whether the claim reads a time of the table.
bool isOfTime(const ClaimSpec& claim, const tables::Table& table);

/// What the claim reads and the table does not have, as one whose profile or override took a column
/// or rows away: "'y' is no column (columns: x)"; empty where it has all of it. The table may have
/// been built from no records.
std::string whatIsAbsent(const ClaimSpec& claim, const tables::Table& table);

/// Throws Error for a claim that no measurement could judge: a trend or a crossing along words, a
/// column over itself, `at` with an empty list, rows that `when` of the sweep never gives. `table`
/// may have been built from no records.
void requireJudgeable(const config::Experiment& experiment, const tables::Table& table);

/// Throws Error for a claim of which no profile's table has a row; `tables` lies beside `profiles`,
/// the whole first.
void requireRows(std::span<const config::Experiment> profiles,
                 std::span<const tables::Table> tables);

/// Throws Error for a claim on an import that nobody laid out, where no row has all that it
/// compares because they differ by a column of the file that the config does not name.
void requireInOneRow(const config::Experiment& experiment, const tables::Table& table);

/// Throws Error for what `gfxrepro check` refuses of the experiment's claims: a time whose kind is
/// open, or that of what is no time; a bound from print that is not what was printed (an aim of
/// ours may better that); cells to which an input was fitted, in a claim that is not of that input;
/// a reason where the claim is not judged, or for what has no interval and is known as ambiguous;
/// and what its kind refuses. `table` may have been built from no records.
void requireProvenance(const config::Experiment& experiment, const tables::Table& table);

/// Marks the claims whose `sameAs` is among them, and that hold or have its verdict: a truth holds
/// once, and only where the claim that the others name does.
void markRepeats(std::vector<ClaimResult>& results);

/// "12 hold, 3 fail (2 hold on some scenes), 2 unmeasured": only those that occur; "no
/// claims" for none.
std::string claimSummaryLine(const std::vector<ClaimResult>& results);

/// "of the documents' own claims 40 hold, 12 fail; on part of their rows, or said twice 3 hold;
/// derived from their numbers 5 hold; …": those that are counted, then the others by origin, only
/// those that occur. A definition and a calibrated input are tests of ours.
std::string originSummaryLine(const std::vector<ClaimResult>& results);

}  // namespace gfxrepro::claims
