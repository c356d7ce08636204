// What `check` refuses of a claim: whose it is, where its number comes from, what it reads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "runner/claims/claim_reader.h"
#include "runner/claims/claims.h"
#include "runner/config/external_program.h"

namespace gfxrepro::claims {

namespace {

/// Labels that only a measurement knows (of a parameter left to its default) are not in a table
/// without records.
bool isReadable(const ClaimSpec& claim, const tables::Table& table) {
    try {
        const ClaimReader reader(claim, table);
        return true;
    } catch (const ExpressionError&) {
        throw;
    } catch (const Error&) {
        return false;
    }
}

bool isLeftOut(const tables::TableRow& row, std::size_t axis) {
    return axis < row.labels.size() && row.labels[axis] == tables::kLeftOut;
}

std::size_t placeOf(const std::string& axis, const tables::Table& table) {
    return static_cast<std::size_t>(std::ranges::find(table.rowAxes, axis) - table.rowAxes.begin());
}

/// Whether `at` names a value of an axis that `when` of the sweep leaves out of what else it names.
bool namesLeftOut(const ClaimSpec& claim, const tables::Table& table) {
    return std::ranges::any_of(claim.at, [&](const auto& left) {
        ClaimSpec others = claim;
        std::erase_if(others.at, [&](const auto& one) { return one.first == left.first; });
        const Rows rows = ClaimReader(others, table).rows();
        return !rows.empty() && std::ranges::all_of(rows, [&](std::size_t row) {
            return isLeftOut(table.rows[row], placeOf(left.first, table));
        });
    });
}

/// What to write in the place of a claim on what never stands in one row.
std::string besideInstead(const ClaimSpec& claim, const tables::Table& table,
                          const std::string& name) {
    if (name == tables::kSeedAxis) {
        return "a layout whose rows do not name it, with its values in the column: 'where: {seed: "
               "[…]}'";
    }
    if (claim.operands.size() == 1) return fmt::format("'at' without '{}'", name);
    const std::size_t axis = placeOf(name, table);
    std::string column = "x", place = "AXIS=VALUE";
    for (const auto& [of, columns] : claim.at) {
        if (claim.across && of == kColumnAxis && columns.size() == 1) column = columns[0].text();
    }
    for (std::size_t i = 0; i < table.columns.size() && claim.across; ++i) {
        const bool isBaseline = std::ranges::all_of(table.rows, [&](const tables::TableRow& row) {
            return isLeftOut(row, axis) || !row.cells[i].isPlanned;
        });
        const std::string& label = table.columns[i].label;
        const bool isCompared = std::ranges::find(claim.operands, label) != claim.operands.end();
        if (isBaseline && isCompared) place = *claim.across + "=" + label;
    }
    return fmt::format(
        "rows of both, with a column 'of: \"{0} / {0}[{1}]\"' in the layout, and a bound of it",
        column, place);
}

/// Why no measurement could judge a claim; `what` is empty where one could.
struct Never {
    std::string what;        // follows the claim's name
    Rows without{}, with{};  // rows that lack what it needs, which it reads, and such as have it
    std::string instead{};   // what to write where no `at` reads the latter alone
};

/// The first axis of which `when` of the sweep leaves out some of what is compared.
std::optional<std::string> axisLeftOut(const ClaimSpec& claim, const tables::Table& table) {
    for (std::size_t axis = 0; axis < table.rowAxes.size(); ++axis) {
        const auto isSuch = [&](const tables::TableRow& row) { return isLeftOut(row, axis); };
        if (std::ranges::any_of(table.rows, isSuch)) return table.rowAxes[axis];
    }
    return table.findColumn(std::string(tables::kLeftOut)) ? claim.across : std::nullopt;
}

/// Where what is compared never stands in one row, as some of it has no value of an axis that
/// `when` of the sweep leaves out.
Never neverBeside(const ClaimSpec& claim, const ClaimReader& reader, const tables::Table& table) {
    if (!reader.readsAny()) {
        return {namesLeftOut(claim, table) ? "is judged nowhere: " + reader.whyNoRow() : ""};
    }
    const std::optional<std::string> axis = axisLeftOut(claim, table);
    if (!axis || !reader.plannedRows().empty()) return {};
    ClaimSpec anywhere = claim;
    std::erase_if(anywhere.at, [](const auto& one) { return one.first != kColumnAxis; });
    return {fmt::format("has no row of all that it compares: 'when' of the sweep leaves some of it "
                        "without '{}'",
                        *axis),
            reader.rows(), ClaimReader(anywhere, table).plannedRows(),
            besideInstead(claim, table, *axis)};
}

/// The rows of each group of which the sweep has what the claim reads. A column's values, along
/// which some claims go, are not known yet.
std::vector<Rows> plannedGroups(const ClaimSpec& claim, ClaimReader& reader,
                                const tables::Table& table) {
    const bool isAlongAxis =
        !claim.over || std::ranges::find(table.rowAxes, *claim.over) != table.rowAxes.end();
    if (!isAlongAxis) return {};
    const Rows planned = reader.plannedRows();
    std::vector<Rows> groups = reader.groups();
    for (Rows& group : groups) {
        std::erase_if(group, [&](std::size_t row) {
            return std::ranges::find(planned, row) == planned.end();
        });
    }
    return groups;
}

std::size_t rowsNeeded(const ClaimSpec& claim) {
    std::size_t most = 1;
    for (const ClaimPart& part : partsOf(claim)) most = std::max(most, part.minRows);
    return most;
}

/// Where `when` of the sweep leaves rows without a number along which the claim goes, or a group of
/// rows with fewer than it needs.
Never neverAlong(const ClaimSpec& claim, ClaimReader& reader, const tables::Table& table) {
    Never never;
    const std::optional<std::string> word = reader.wordAlongOver();
    if (word) {
        never.what = fmt::format("needs numbers along '{}', which holds '{}'", *claim.over, *word);
        if (*word != tables::kLeftOut) return never;
    }
    const std::size_t needed = rowsNeeded(claim);
    for (const Rows& group : plannedGroups(claim, reader, table)) {
        Rows along = group;
        std::erase_if(along, [&](std::size_t row) {
            return isLeftOut(table.rows[row], placeOf(*claim.over, table));
        });
        const bool isEnough = along.size() >= needed;
        std::ranges::copy(group, std::back_inserter(isEnough ? never.with : never.without));
        for (std::size_t axis = 0; axis < table.rowAxes.size(); ++axis) {
            const bool isSuch = !group.empty() && isLeftOut(table.rows[group[0]], axis);
            if (isEnough || !isSuch || !never.what.empty()) continue;
            never.what = fmt::format(
                "needs {} rows along '{}', and has one where 'when' of the sweep leaves it without "
                "'{}'",
                needed, *claim.over, table.rowAxes[axis]);
        }
    }
    return never;
}

Never neverOf(const ClaimSpec& claim, const tables::Table& read) {
    ClaimReader reader(claim, read);
    Never never = neverBeside(claim, reader, read);
    if (never.what.empty() && claim.over) never = neverAlong(claim, reader, read);
    if (never.what.empty() && reader.isOverItself())
        never.what = fmt::format("holds '{}' against itself", *claim.over);
    return never;
}

/// Of the file as it stands, of which nothing took a part: where it reads nothing, or a group lacks
/// what it needs.
Never neverInProfile(const ClaimSpec& claim, const tables::Table& read) {
    Never never = neverOf(claim, read);
    ClaimReader reader(claim, read);
    if (!never.what.empty()) return never;
    if (!reader.readsAny()) return {reader.whyNoRow()};
    if (reader.plannedRows().empty()) return {"no row has all that it compares"};
    for (const ClaimPart& part : partsOf(claim)) {
        for (const Rows& group : reader.groups()) {
            const std::string why = reader.whyUnread(part, group);
            std::ranges::copy(group, std::back_inserter(why.empty() ? never.with : never.without));
            if (never.what.empty()) never.what = why;
        }
    }
    return never;
}

using WhyNever = Never(const ClaimSpec& claim, const tables::Table& read);

/// The `at` of one axis by which the claim reads only rows that have what it needs; empty where
/// there is none.
std::string atInstead(const ClaimSpec& claim, const tables::Table& read, WhyNever& why,
                      const Never& never) {
    for (std::size_t axis = 0; axis < read.rowAxes.size(); ++axis) {
        const std::string& name = read.rowAxes[axis];
        Node::Sequence values;
        const auto has = [&](const Rows& rows, const std::string& label) {
            return std::ranges::any_of(
                rows, [&](std::size_t row) { return read.rows[row].labels[axis] == label; });
        };
        bool isApart = !never.without.empty() && name != kColumnAxis && name != claim.over;
        for (const std::size_t row : never.with) {
            const std::string& label = read.rows[row].labels[axis];
            isApart &= label != tables::kLeftOut && !has(never.without, label);
            const Node value = Node::scalar(label);
            if (std::ranges::none_of(values, [&](const Node& one) { return one.text() == label; }))
                values.push_back(value);
        }
        if (!isApart || values.empty()) continue;
        ClaimSpec other = claim;
        std::erase_if(other.at, [&](const auto& one) { return one.first == name; });
        other.at.emplace_back(name, values);
        if (!why(other, read).what.empty()) continue;
        const bool isOne = values.size() == 1;
        return fmt::format("at: {{{}: {}}}", name,
                           (isOne ? values[0] : Node::sequence(values)).toFlowText());
    }
    return "";
}

/// With what to write instead.
std::string whyNever(const ClaimSpec& claim, const tables::Table& read, WhyNever& why) {
    const Never never = why(claim, read);
    if (never.what.empty()) return "";
    const std::string at = atInstead(claim, read, why, never);
    const std::string& instead = at.empty() ? never.instead : at;
    return never.what + (instead.empty() ? "" : "; allowed: " + instead);
}

/// Why no measurement could judge the claim; empty where one could, and where it does not fit the
/// table, of which an override or a profile may have taken a part. Throws ExpressionError.
std::string whyNeverJudged(const ClaimSpec& claim, const tables::Table& table) {
    for (const auto& [axis, wanted] : claim.at) {
        if (wanted.empty()) return fmt::format("has an empty list of '{}' in 'at'", axis);
    }
    try {
        return whyNever(claim, tableFor(claim, table), neverOf);
    } catch (const ExpressionError&) {
        throw;
    } catch (const Error&) {
        return "";
    }
}

/// Fewer than an interval takes decide no time on any device.
int processesOfPaper(const config::Experiment& experiment) {
    if (experiment.paperDocument.isNull()) return config::kFewestRounds;
    return config::experimentFromDocument(experiment.paperDocument, experiment.file)
        .measure.processes;
}

/// Why a claim's kind of time is not that of what it reads; empty if it is.
std::string whyWrongKind(const ClaimSpec& claim, const config::Experiment& experiment,
                         ClaimReader& reader) {
    if (!reader.readsTime()) return claim.timeKind ? "has a 'kind' and reads no time" : "";
    if (!reader.timeKind()) {
        // A program's times are the clock's, whatever decides them; of one's own sweep counts do.
        const bool isOpen =
            experiment.kind != config::ExperimentKind::Sweep && !config::goesByClock(experiment);
        return !isOpen ? "" : "reads a time and needs 'kind': algorithmic | architectural";
    }
    if (*reader.timeKind() != ClaimSpec::TimeKind::Absolute && reader.asksForATimeAsSuch()) {
        return "holds a time against a number, which neither a count of work nor another machine "
               "decides; its 'kind' is absolute";
    }
    return "";
}

/// Of the technique or program of the experiment.
Sampling samplingOf(const config::Experiment& experiment, const ClaimReader& reader) {
    Sampling sampling{reader.rowCount(), experiment.measure.frames};
    const Node& program = config::programOf(experiment);
    if (program.isNull()) return sampling;
    sampling.truthFrames = 0;
    for (const config::ProgramPicture& picture : config::readProgram(program).pictures) {
        if (picture.truthFrames < 2) continue;
        const bool isFirst = *sampling.truthFrames == 0;
        sampling.truthFrames =
            isFirst ? picture.truthFrames : std::min(*sampling.truthFrames, picture.truthFrames);
    }
    return sampling;
}

/// What its kind refuses of a claim.
std::string whyRefused(const ClaimSpec& claim, const config::Experiment& experiment,
                       const ClaimReader& reader) {
    const Kind& kind = *claim.kind;
    if (!kind.metric.empty() && !reader.readsOnly(kind.metric)) {
        return fmt::format("is '{}': allowed: a column of the metric {}, without 'scale' and alone",
                           kind.name(), kind.metric);
    }
    return kind.refused ? kind.refused(claim, samplingOf(experiment, reader)) : "";
}

/// The table with what was printed where measurements stand, each a number without an interval.
tables::Table asPrinted(tables::Table table) {
    std::ranges::move(table.printedRows, std::back_inserter(table.rows));
    for (tables::TableRow& row : table.rows) {
        for (tables::Cell& cell : row.cells) {
            cell.isTime = false;
            cell.values.clear();
            const bool isPrinted = !cell.printedValues.empty() && cell.printedValues[0];
            cell.isPlanned = isPrinted;
            cell.status = isPrinted ? records::Status::Ok : records::Status::Missing;
            if (!isPrinted) continue;
            tables::Measured& number = cell.values.emplace_back();
            number.value = *cell.printedValues[0];
            number.interval = {number.value, number.value};
        }
    }
    return table;
}

ClaimResult judgedOnPrint(ClaimSpec claim, const tables::Table& table) {
    ReportContext context;
    context.deviceClass = "gpu";
    context.profile = claim.profile.value_or("paper");
    claim.timeKind.reset();
    config::Experiment alone;
    alone.claims = {std::move(claim)};
    return evaluateClaims(alone, asPrinted(table), context)[0];
}

/// Whether what was printed is the bound itself, but for rounding, both of two, or lies evenly
/// between the two, as "within a factor of two" has it, the largest that there may be.
bool isAtBound(const ClaimSpec& claim, const tables::Table& table) {
    static constexpr double kRounding = 0.02, kLeast = 1e-9;  // the latter of a bound of 0
    const auto fails = [&](std::optional<double> low, std::optional<double> high) {
        ClaimSpec tighter = claim;
        tighter.low = low;
        tighter.high = high;
        return judgedOnPrint(std::move(tighter), table).verdict == Verdict::Fails;
    };
    const auto raised = [](double bound) {
        return bound + std::max(kRounding * std::abs(bound), kLeast);
    };
    const auto lowered = [](double bound) {
        return bound - std::max(kRounding * std::abs(bound), kLeast);
    };
    const bool isLow = claim.low && fails(raised(*claim.low), claim.high);
    const bool isHigh = claim.high && fails(claim.low, lowered(*claim.high));
    if (!claim.low || !claim.high) return isLow || isHigh;
    if (isLow && isHigh) return true;
    constexpr double kFactor = 2.0 * (1.0 + kRounding);
    const double ratio = *claim.high / *claim.low;
    if (ratio <= 0.0 || std::max(ratio, 1.0 / ratio) > kFactor * kFactor) return false;
    const double middle = std::copysign(std::sqrt(*claim.low * *claim.high), *claim.low);
    return !fails(lowered(middle), raised(middle));
}

/// A bound that is from print is met by what was printed, and is that number or lies about it, but
/// for an aim of ours to better it: what the claim comes to there if not; empty if it is, and where
/// not all that it reads is there.
std::string whyNotOfPrint(const ClaimSpec& claim, const tables::Table& table) {
    if (claim.origin == ClaimSpec::Origin::Ours) return "";
    const ClaimResult result = judgedOnPrint(claim, table);
    if (result.verdict == Verdict::Fails) {
        return "what is printed does not meet it: " + result.measured;
    }
    const bool isGiven = result.verdict != Verdict::Holds || isAtBound(claim, table);
    return isGiven ? "" : "what is printed is another number: " + result.measured;
}

bool isPrinted(const tables::Cell& cell) {
    return cell.printed.has_value();
}

/// Perhaps scaled, a recorded percentage, which has an interval where it is a share of a count.
bool isShare(const tables::Cell& cell) {
    const bool isScaled = cell.metric.empty() && cell.unit.empty();
    return isScaled || cell.metric.ends_with("_pct");
}

/// Scenes that a verdict in the profile, or in any, is taken over.
int seedsAtMost(const config::Experiment& experiment, const std::optional<std::string>& profile) {
    int seeds = experiment.measure.sceneSeeds;
    if (profile.value_or("paper") != "paper" || experiment.paperDocument.isNull()) return seeds;
    return std::max(seeds, config::experimentFromDocument(experiment.paperDocument, experiment.file)
                               .measure.sceneSeeds);
}

}  // namespace

bool isOfTime(const ClaimSpec& claim, const tables::Table& table) {
    const tables::Table read = tableFor(claim, table);
    return isReadable(claim, read) ? ClaimReader(claim, read).readsTime()
                                   : claim.timeKind.has_value();
}

void requireJudgeable(const config::Experiment& experiment, const tables::Table& table) {
    for (const ClaimSpec& claim : experiment.claims) {
        const std::string why = whyNeverJudged(claim, table);
        if (!why.empty()) {
            throw Error(claim.location, fmt::format("claim '{}' {}", claim.id, why));
        }
    }
}

void requireRows(std::span<const config::Experiment> profiles,
                 std::span<const tables::Table> tables) {
    const auto whyNot = [&](std::size_t i, const std::string& id) -> std::string {
        const auto own = std::ranges::find(profiles[i].claims, id, &ClaimSpec::id);
        if (own == profiles[i].claims.end()) return "";
        try {
            return whyNever(*own, tableFor(*own, tables[i]), neverInProfile);
        } catch (const Error&) {  // said elsewhere
            return "";
        }
    };
    if (profiles.empty()) return;
    for (const ClaimSpec& claim : profiles[0].claims) {
        const std::string why = whyNot(0, claim.id);
        bool isNowhere = !why.empty();
        for (std::size_t i = 1; i < profiles.size(); ++i) {
            isNowhere = isNowhere && !whyNot(i, claim.id).empty();
        }
        if (!isNowhere) continue;
        const bool isOfProfile = whyNeverJudged(claim, tables[0]).empty();
        throw Error(claim.location,
                    fmt::format("claim '{}' {}{}", claim.id,
                                isOfProfile ? "is judged in no profile: " : "", why));
    }
}

void requireInOneRow(const config::Experiment& experiment, const tables::Table& table) {
    const std::string column = tables::unnamedColumn(experiment, table);
    if (experiment.layout.isGiven || column.empty()) return;
    for (const ClaimSpec& claim : experiment.claims) {
        try {
            const tables::Table read = tableFor(claim, table);
            ClaimReader reader(claim, read);
            const std::vector<Rows> groups = plannedGroups(claim, reader, read);
            const auto isEnough = [&](const Rows& group) {
                return group.size() >= rowsNeeded(claim);
            };
            if (groups.empty() || std::ranges::any_of(groups, isEnough)) continue;
        } catch (const Error&) {  // said elsewhere
            continue;
        }
        throw Error(claim.location, fmt::format("claim '{}': what it compares stands in rows that "
                                                "differ by {}",
                                                claim.id, column));
    }
}

void requireProvenance(const config::Experiment& experiment, const tables::Table& table) {
    requireJudgeable(experiment, table);
    const bool isOfDocument = experiment.kind != config::ExperimentKind::Sweep;
    const int paperProcesses = processesOfPaper(experiment);
    tables::Table read;  // outlives its reader
    for (const ClaimSpec& claim : experiment.claims) {
        const auto complain = [&](const std::string& what) {
            throw Error(claim.location, fmt::format("claim '{}' {}", claim.id, what));
        };
        if (claim.boundFrom == ClaimSpec::BoundSource::Print && experiment.printed.rows.empty()) {
            complain("has its bound from print, and the table has no printed values: text | ours");
        }
        if (!isReadable(claim, read = tableFor(claim, table))) continue;
        ClaimReader reader(claim, read);
        if (!reader.readsAny()) continue;  // its rows are not of this profile
        const auto timeKind = reader.timeKind();
        for (const ClaimSpec::Known& known : claim.because) {
            if (isOfGpu(timeKind, table) && known.device == "software") {
                complain("has a reason for software ('because'), and a GPU alone judges it");
            }
            if (claim.profile && known.profile && known.profile != claim.profile) {
                complain(fmt::format("has a reason in the profile {}, and is judged in {} alone",
                                     *known.profile, *claim.profile));
            }
        }
        if (const std::string why = whyRefused(claim, experiment, reader); !why.empty()) {
            complain(why);
        }
        if (claim.boundFrom == ClaimSpec::BoundSource::Print && !reader.readsSome(isPrinted)) {
            complain(
                "has its bound from print, and reads no cell with a printed value: text | ours");
        }
        if (claim.boundFrom == ClaimSpec::BoundSource::Print) {
            const std::string printed = whyNotOfPrint(claim, table);
            if (!printed.empty()) {
                complain("has its bound from print, and " + printed);
            }
        }
        for (const ClaimSpec::Known& known : claim.because) {
            if (known.verdict != verdictName(Verdict::Ambiguous) || reader.readsTime()) continue;
            if (reader.readsSome(isShare) || seedsAtMost(experiment, known.profile) > 1) continue;
            if (experiment.measure.seeds == config::Measure::Seeds::Process) continue;
            complain(
                "is known as ambiguous, and reads neither a time nor a share, of one scene: a "
                "number without an interval holds or fails");
        }
        if (table.isPublished && claim.origin == ClaimSpec::Origin::Calibrated &&
            !reader.readsCalibrated()) {
            complain(
                "is of a calibrated input, and reads cells that 'printed.calibrated' does not "
                "mark");
        }
        if (claim.isReadOffDocument() && reader.readsCalibrated()) {
            complain(
                "reads nothing but cells that an input of ours was fitted to "
                "('printed.calibrated'): its origin is calibrated");
        }
        if (const std::string why = whyWrongKind(claim, experiment, reader); !why.empty())
            complain(why);
        if (isOfDocument && timeKind && paperProcesses < config::kFewestRounds) {
            complain(
                fmt::format("is of a time: the paper profile needs processes: {} or more, has {}",
                            config::kFewestRounds, paperProcesses));
        }
    }
}

}  // namespace gfxrepro::claims
