#include "runner/claims/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "engine/core/text.h"
#include "runner/claims/claim_reader.h"
#include "runner/claims/kinds/operands.h"
#include "runner/config/schema.h"
#include "runner/tables/frame_times.h"
#include "runner/tables/labels.h"

namespace gfxrepro::claims {

namespace {

/// In the order of Verdict: the name, and what it counts.
struct VerdictInfo {
    std::string_view name;
    int severity;
};
constexpr std::array<VerdictInfo, 5> kVerdicts = {
    {{"holds", 0}, {"fails", 4}, {"ambiguous", 2}, {"not-applicable", 1}, {"unmeasured", 3}}};

/// What one part came to in one group.
struct Outcome {
    Judgement judgement;
    std::string reason;
};

bool isWorse(const Outcome& a, const Outcome& b) {
    const int left = severity(a.judgement.verdict);
    const int right = severity(b.judgement.verdict);
    return left != right ? left > right : a.judgement.margin < b.judgement.margin;
}

/// A group of rows, as a part of the claim reads it, and what its comparisons came to.
struct GroupRead {
    Rows all, unfit, rows;  // `unfit` of `all`; `rows` are those that count
    ClaimReader::Reading reading;
    bool varies = false;
    std::vector<Judgement> judgements = {};  // none where it cannot be read

    /// Whether the claim is judged in it.
    bool counts() const { return unfit.empty() || unfit.size() < all.size(); }
};

/// `noise` is of the times that are read; absent for a claim that reads none.
GroupRead readGroup(const ClaimPart& part, ClaimReader& reader, const Rows& all, bool isOfTimes,
                    const std::optional<double>& noise) {
    GroupRead group{all, reader.unfitOf(all), all, {}};
    if (group.counts()) {
        std::erase_if(group.rows, [&](std::size_t row) {
            return std::ranges::find(group.unfit, row) != group.unfit.end();
        });
    }
    group.reading = reader.read(part, group.rows);
    if (group.reading.rows.empty() || !group.reading.problem.empty()) return group;
    // A count is what it is, and a p-value is of several pictures.
    const Group& values = group.reading.group;
    const bool isSampled = !part.requirement.isOfCounts && !part.isOfSeeds;
    group.varies = isOfTimes || isOverProcesses(values) || (isSampled && isRandom(values));
    group.judgements = group.varies ? judgeVarying(values, part.onTimes, noise)
                                    : std::vector{judge(values, part.quantity, part.requirement)};
    return group;
}

Outcome outcomeOf(const ClaimPart& part, const GroupRead& group, const std::string& groupName,
                  bool isNamed) {
    if (!group.reading.problem.empty()) return {{}, group.reading.problem};
    Outcome outcome{worstOf(group.judgements), ""};
    std::vector<std::string> reasons;
    if (outcome.judgement.isAbsent) reasons.push_back(part.requirement.absence);
    if (isNamed) reasons.push_back("worst at " + groupName);
    switch (outcome.judgement.verdict) {
        case Verdict::Ambiguous:
            reasons.push_back(
                outcome.judgement.why.empty()
                    ? "the interval reaches over the bound, so neither verdict is sure"
                    : outcome.judgement.why);
            break;
        case Verdict::Unmeasured:
            reasons.emplace_back(
                "not a number: zero, negative or equal values where the quantity "
                "needs positive, different ones");
            break;
        default:
            break;
    }
    if (outcome.judgement.isSingleSample) reasons.emplace_back("one sample");
    outcome.reason = joined(reasons, "; ");
    if (!group.varies && !part.measuredName.empty() && !outcome.judgement.measured.empty()) {
        outcome.judgement.measured = part.measuredName + " " + outcome.judgement.measured;
    }
    return outcome;
}

/// The worst verdict on the rows of each scene, by its name in the table, in the table's order.
using SceneVerdicts = std::vector<std::pair<std::string, Verdict>>;

void addToScene(SceneVerdicts& scenes, const std::string& scene, Verdict verdict) {
    if (scene.empty()) return;
    const auto found = std::ranges::find(scenes, scene, &SceneVerdicts::value_type::first);
    if (found == scenes.end()) {
        scenes.emplace_back(scene, verdict);
    } else if (severity(verdict) > severity(found->second)) {
        found->second = verdict;
    }
}

/// "3 of 4 scenes, not on tree"; empty where it holds on all of them or on none.
std::string holdsOn(const SceneVerdicts& scenes) {
    std::vector<std::string> others;
    for (const auto& [scene, verdict] : scenes) {
        if (verdict != Verdict::Holds) others.push_back(scene);
    }
    if (others.empty() || others.size() == scenes.size()) return "";
    return fmt::format("{} of {} scenes, not on {}", scenes.size() - others.size(), scenes.size(),
                       joined(others));
}

/// "not judged on city (fails there), which could not be fitted"; empty without such.
std::string unfitNote(const SceneVerdicts& unfit) {
    std::vector<std::string> names;
    for (const auto& [scene, verdict] : unfit) {
        const bool isVerb = verdict == Verdict::Holds || verdict == Verdict::Fails;
        names.push_back(
            verdict == Verdict::NotApplicable
                ? scene
                : fmt::format("{} ({}{} there)", scene, isVerb ? "" : "is ", verdictName(verdict)));
    }
    return names.empty() ? ""
                         : fmt::format(
                               "not judged on {}, which could not be fitted to what is "
                               "printed",
                               joined(names));
}

/// What scenes came to: those that the claim is judged on, and those that could not be fitted.
struct ByScene {
    SceneVerdicts judged, unfit;
};

Outcome judgePart(const ClaimPart& part, const ClaimReader& reader,
                  const std::vector<GroupRead>& groups, ByScene& scenes) {
    std::optional<Outcome> worst;
    Judgement aside;  // what was measured of those that are not judged
    for (const GroupRead& group : groups) {
        if (group.reading.rows.empty() && group.reading.problem.empty()) continue;
        const std::string name = reader.groupName(group.rows);
        const bool isNamed = groups.size() > 1 && !name.empty();
        Outcome outcome = outcomeOf(part, group, name, isNamed);
        if (!group.unfit.empty()) {
            const std::string scene = reader.sceneOf(group.unfit);
            addToScene(scenes.unfit, scene.empty() ? "its scenes" : scene,
                       group.counts() ? Verdict::NotApplicable : outcome.judgement.verdict);
            if (!group.counts()) {
                aside.measured = outcome.judgement.measured;
                continue;
            }
        }
        addToScene(scenes.judged, reader.sceneOf(group.rows), outcome.judgement.verdict);
        if (!worst || isWorse(outcome, *worst)) worst = std::move(outcome);
    }
    if (worst) return *worst;
    return {aside, part.needsExpected && !groups.empty()
                       ? "no printed number to compare with"
                       : "this run has no row that the claim reads"};
}

/// Where the claim is not to be judged here, says so; true then.
bool isNotApplicable(const ClaimSpec& claim, const tables::Table& table,
                     const ReportContext& context, ClaimResult& result) {
    if (isOfGpu(result.timeKind, table) && context.deviceClass != "gpu") {
        result.reason = "claims about a GPU are not judged on a " + context.deviceClass + " device";
    } else if (claim.profile && *claim.profile != context.profile) {
        result.reason = "judged in the profile '" + *claim.profile + "' only";
    } else {
        return false;
    }
    result.verdict = Verdict::NotApplicable;
    return true;
}

/// What counts of work decide is judged by the work of all cores where they are the device: the
/// process's CPU time, which waits for no neighbour. Says which clock it is; empty for none.
std::string chooseClock(const tables::Table& table, const ReportContext& context,
                        ClaimReader& reader, ClaimResult& claim) {
    using Kind = ClaimSpec::TimeKind;
    const bool isAlgorithmic = claim.timeKind.value_or(Kind::Algorithmic) == Kind::Algorithmic;
    if (!isAlgorithmic || context.deviceClass != "software" || table.goesByClock) return "";
    if (!reader.hasTimes()) return "";
    if (!reader.readByProcess()) return "by the clock: no CPU time was recorded of these";
    claim.columnsByProcess = reader.timeColumns();
    return "by the CPU time of the process";
}

/// What the config knows of the claim on this device, in this profile and of such scenes.
void takeKnown(const ClaimSpec& claim, const ReportContext& context, ClaimResult& result) {
    const auto loaded = context.sceneClasses.find(result.table);
    const std::string scenes = loaded == context.sceneClasses.end() ? "" : loaded->second;
    for (const ClaimSpec::Known& known : claim.because) {
        if (known.device.value_or(context.deviceClass) != context.deviceClass) continue;
        if (known.profile.value_or(context.profile) != context.profile) continue;
        if (known.scenes && *known.scenes != scenes) continue;
        result.known = verdictFromName(known.verdict);
        result.because = known.reason;
        result.shownBy = known.shownBy;
        return;
    }
}

/// The claim with what its config says of it, not judged yet.
ClaimResult unjudged(const ClaimSpec& claim, const tables::Table& table,
                     const ReportContext& context) {
    ClaimResult result;
    result.sameAs = claim.sameAs;
    result.id = claim.id;
    result.table = table.id;
    result.text = claim.text;
    result.origin = claim.origin;
    result.boundFrom = claim.boundFrom;
    result.timeKind = claim.timeKind;
    takeKnown(claim, context, result);
    if (context.isAltered) result.known.reset();
    std::vector<std::string> required;
    for (const ClaimPart& part : partsOf(claim)) required.push_back(part.requirement.text);
    result.required = joined(required, "; ");
    isNotApplicable(claim, table, context, result);
    return result;
}

/// That an input was fitted to what a claim reads that is not of that input; else empty.
std::string calibratedNote(const ClaimSpec& claim, const ClaimReader& reader) {
    if (claim.origin == ClaimSpec::Origin::Calibrated || !reader.readsSome(isCalibrated)) return "";
    return reader.readsCalibrated() ? "what it reads is calibrated"
                                    : "some of what it reads is calibrated";
}

/// That nothing could have made what it reads worse; else empty.
std::string ownTruthNote(const ClaimReader& reader) {
    return reader.readsSome(&tables::Cell::isOwnTruth)
               ? "reads an error of a case against itself, 0 whatever the program does"
               : "";
}

/// What the run and the profile `paper` lay out of their cases, without a measurement.
struct Laid {
    config::Experiment paper;
    tables::Table here, there;  // each with the row axes of both
};

/// An axis that is not swept has its one value in all rows.
void addRowAxes(const std::vector<config::LayoutAxis>& from, config::Layout& layout) {
    for (const config::LayoutAxis& axis : from) {
        const auto isIn = [&](const std::vector<config::LayoutAxis>& axes) {
            return std::ranges::find(axes, axis.name, &config::LayoutAxis::name) != axes.end();
        };
        const bool isKnown = isIn(layout.rows) || isIn(layout.columns);
        if (axis.isSweepAxis() && !isKnown) layout.rows.push_back(axis);
    }
}

/// None where the cases of one of them are not known.
std::optional<Laid> layOut(config::Experiment own, std::span<const config::Case> planned) {
    if (own.claims.empty() || own.paperCases.empty() || planned.empty()) return std::nullopt;
    config::Experiment paper = config::experimentFromDocument(own.paperDocument, own.file);
    const std::vector<config::LayoutAxis> rows = own.layout.rows;
    addRowAxes(paper.layout.rows, own.layout);
    addRowAxes(rows, paper.layout);
    tables::Table here = tables::buildTable(own, planned, {});
    tables::Table there = tables::buildTable(paper, own.paperCases, {});
    return Laid{std::move(paper), std::move(here), std::move(there)};
}

/// The rows that the claim reads of its table, each by its labels on the axes of these names.
std::vector<std::vector<std::string>> readOf(const ClaimSpec& claim, const tables::Table& table,
                                             const std::vector<std::string>& axes) {
    std::vector<std::vector<std::string>> read;
    for (const std::size_t row : ClaimReader(claim, table).plannedRows()) {
        std::vector<std::string>& labels = read.emplace_back();
        for (const std::string& axis : axes) {
            const auto place = std::ranges::find(table.rowAxes, axis) - table.rowAxes.begin();
            labels.push_back(table.rows[row].labels[static_cast<std::size_t>(place)]);
        }
    }
    return read;
}

/// "1 of 4 values of scene, 2 of 3 values of resolution": what of the rows that it reads in the
/// profile `paper`, as it stands there, it reads here, too; empty of all of them.
std::string partOfRows(const ClaimSpec& claim, const Laid& laid) {
    const auto inPaper = std::ranges::find(laid.paper.claims, claim.id, &ClaimSpec::id);
    const ClaimSpec& asked = inPaper == laid.paper.claims.end() ? claim : *inPaper;
    const tables::Table own = tableFor(claim, laid.here), all = tableFor(asked, laid.there);
    std::vector<std::string> axes = all.rowAxes;
    std::erase_if(axes, [&](const std::string& axis) {
        return std::ranges::find(own.rowAxes, axis) == own.rowAxes.end();
    });
    const auto read = readOf(claim, own, axes), there = readOf(asked, all, axes);
    if (read.empty()) return "";
    const std::set<std::vector<std::string>> here(read.begin(), read.end());
    std::vector<std::set<std::string>> few(axes.size()), many(axes.size());
    std::size_t shared = 0;
    for (const std::vector<std::string>& labels : there) {
        const bool isShared = here.contains(labels);
        shared += isShared ? 1 : 0;
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            many[axis].insert(labels[axis]);
            if (isShared) few[axis].insert(labels[axis]);
        }
    }
    if (shared == there.size()) return "";
    std::vector<std::string> parts;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        if (few[axis].size() == many[axis].size()) continue;
        const std::string name = tables::shownName(axes[axis], all.words);
        parts.push_back(
            fmt::format("{} of {} values of {}", few[axis].size(), many[axis].size(), name));
    }
    const bool isNone = shared == 0 || parts.empty();
    return isNone ? fmt::format("{} of {} rows", shared, there.size()) : joined(parts);
}

/// What each part reads of each group, judged together.
std::vector<std::vector<GroupRead>> readParts(const std::vector<ClaimPart>& parts,
                                              ClaimReader& reader,
                                              const std::optional<double>& noise) {
    const std::vector<Rows> groups = reader.groups();
    const bool isOfTimes = reader.readsTime();
    std::vector<std::vector<GroupRead>> read(parts.size());
    std::vector<Judgement*> all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (const Rows& rows : groups) {
            read[i].push_back(readGroup(parts[i], reader, rows, isOfTimes, noise));
        }
        for (GroupRead& group : read[i]) {
            if (!group.counts()) continue;
            for (Judgement& judgement : group.judgements) all.push_back(&judgement);
        }
    }
    forgiveChance(all);
    return read;
}

/// `given` is the table of which `table` may be the turned one (tableFor).
void judgeClaim(const ClaimSpec& claim, const tables::Table& given, const ReportContext& context,
                ClaimReader& reader, ClaimResult& result) {
    const std::string clock = chooseClock(given, context, reader, result);
    const std::vector<ClaimPart> parts = partsOf(claim);
    const auto read =
        readParts(parts, reader, tables::columnNoise(given, reader.timeColumns(), reader.clock()));
    std::vector<std::string> measured;
    std::optional<Outcome> worst;
    ByScene scenes;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Outcome outcome = judgePart(parts[i], reader, read[i], scenes);
        if (!outcome.judgement.measured.empty()) measured.push_back(outcome.judgement.measured);
        if (worst && !isWorse(outcome, *worst)) continue;
        result.margin = outcome.judgement.marginText;
        result.distance =
            result.margin.empty() ? std::nullopt : std::optional(outcome.judgement.margin);
        worst = std::move(outcome);
    }
    result.measured = joined(measured, "; ");
    result.verdict = worst->judgement.verdict;
    result.reason = worst->reason;
    result.holdsOn = holdsOn(scenes.judged);
    if (!result.holdsOn.empty()) result.reason += "; holds on " + result.holdsOn;
    const std::string unfit = unfitNote(scenes.unfit);
    if (!unfit.empty() && scenes.judged.empty()) {
        result.verdict = Verdict::NotApplicable;
        result.reason = unfit;
        return;
    }
    const std::string part = result.rows.empty() ? "" : fmt::format("on {}", result.rows);
    for (const std::string& note :
         {unfit, clock, calibratedNote(claim, reader), ownTruthNote(reader), part}) {
        if (!note.empty()) result.reason += (result.reason.empty() ? "" : "; ") + note;
    }
}

/// What was measured stands also beside a claim that is not judged here, where it can be read.
void measureAlone(const ClaimSpec& claim, const tables::Table& given, const ReportContext& context,
                  ClaimReader& reader, ClaimResult& result) {
    ClaimResult judged = result;
    try {
        judgeClaim(claim, given, context, reader, judged);
    } catch (const Error&) {
        return;
    }
    result.measured = judged.measured;
}

ClaimResult evaluateClaim(const ClaimSpec& claim, const tables::Table& given,
                          const tables::Table& table, const std::string& rows,
                          const ReportContext& context) {
    ClaimResult result = unjudged(claim, table, context);
    result.rows = rows;
    ClaimReader reader(claim, table);
    const bool isElsewhere = result.verdict == Verdict::NotApplicable;
    if (!isElsewhere) result.timeKind = reader.timeKind();
    if (isElsewhere || isNotApplicable(claim, table, context, result)) {
        measureAlone(claim, given, context, reader, result);
        return result;
    }
    const std::string_view metric = claim.kind->metric;
    if (!metric.empty() && !reader.readsOnly(metric)) {
        result.reason = fmt::format("reads another metric than {}", metric);
        return result;
    }
    const bool isAbsolute = result.timeKind == ClaimSpec::TimeKind::Absolute;
    if (isAbsolute && table.isPublished && !reader.isAtPrintedParameters()) {
        measureAlone(claim, given, context, reader, result);
        result.verdict = Verdict::NotApplicable;
        result.reason = "a time as such is judged at the printed parameters only";
        return result;
    }
    judgeClaim(claim, given, context, reader, result);
    return result;
}

/// The same of a table that may lack what the claim reads.
ClaimResult evaluateWhatIsThere(const ClaimSpec& claim, const tables::Table& table,
                                const std::optional<Laid>& laid, const ReportContext& context) {
    std::string why = "nothing was measured";  // nor laid out
    try {
        if (!table.columns.empty()) {
            return evaluateClaim(claim, table, tableFor(claim, table),
                                 laid ? partOfRows(claim, *laid) : "", context);
        }
    } catch (const AbsentColumnError& error) {
        why = "not among what was measured: " + error.text();
    } catch (const ExpressionError& error) {  // where no table was known before
        why = error.text();
    }
    ClaimResult result = unjudged(claim, table, context);
    if (result.verdict != Verdict::NotApplicable) result.reason = why;
    return result;
}

/// Kept results tell nothing of a verdict that they do not start from.
std::string restsOn(const ClaimResult& result, const ReportContext& context) {
    if (result.verdict == Verdict::NotApplicable || result.verdict == Verdict::Unmeasured) {
        return "";
    }
    if (!context.knowsTried) return kRestsOnUnknown;
    const auto found = context.tried.find({result.table, result.id});
    if (found == context.tried.end()) return "not tried";
    if (found->second.verdict == result.verdict) return found->second.restsOn;
    return fmt::format("not tried: {} then", verdictName(found->second.verdict));
}

}  // namespace

Verdict verdictFromName(std::string_view name) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kVerdicts.size(); ++i) {
        if (kVerdicts[i].name == name) return static_cast<Verdict>(i);
        names.emplace_back(kVerdicts[i].name);
    }
    throw Error(fmt::format("'{}' is no verdict ({})", name, joined(names)));
}

std::string_view verdictName(Verdict verdict) {
    return kVerdicts[static_cast<std::size_t>(verdict)].name;
}

int severity(Verdict verdict) {
    return kVerdicts[static_cast<std::size_t>(verdict)].severity;
}

std::string sceneClass(const std::set<std::string>& scenes, const SceneFiles& files) {
    std::size_t ofFiles = 0;
    for (const std::string& scene : scenes) {
        const auto found = files.find(scene);
        if (found == files.end()) return "";
        ofFiles += found->second ? 1 : 0;
    }
    if (scenes.empty() || (ofFiles > 0 && ofFiles < scenes.size())) return "";
    return std::string(config::kSceneClasses[ofFiles > 0 ? 0 : 1]);
}

std::string whyText(const ClaimResult& claim) {
    if (claim.because.empty()) return claim.reason;
    if (claim.verdict == claim.known) {
        return claim.because + (claim.reason.empty() ? "" : fmt::format(" ({})", claim.reason));
    }
    const std::string where =
        !claim.known ? "In the table as configured"
                     : fmt::format("Where it {}{}", *claim.known == Verdict::Fails ? "" : "is ",
                                   verdictName(*claim.known));
    return fmt::format("{}{}{}: {}", claim.reason, claim.reason.empty() ? "" : ". ", where,
                       claim.because);
}

std::vector<ClaimResult> evaluateClaims(const config::Experiment& experiment,
                                        const tables::Table& table, const ReportContext& context,
                                        std::span<const config::Case> planned) {
    std::vector<ClaimResult> results;
    const std::optional<Laid> laid = layOut(experiment, planned);
    for (const ClaimSpec& claim : experiment.claims) {
        results.push_back(evaluateWhatIsThere(claim, table, laid, context));
        results.back().restsOn = restsOn(results.back(), context);
    }
    return results;
}

bool isOfGpu(const std::optional<ClaimSpec::TimeKind>& kind, const tables::Table& table) {
    using Of = ClaimSpec::TimeKind;
    return kind == Of::Architectural || (kind == Of::Absolute && !table.goesByClock);
}

std::string whatIsAbsent(const ClaimSpec& claim, const tables::Table& table) {
    if (table.columns.empty()) return "";
    const tables::Table own = tableFor(claim, table);
    for (const auto& [axis, wanted] : claim.at) {
        if (!claim.across || axis != kColumnAxis) continue;
        std::vector<std::string> labels;
        for (const tables::TableColumn& column : table.columns) labels.push_back(column.label);
        for (const Node& column : wanted) {
            if (std::ranges::find(labels, column.text()) != labels.end()) continue;
            return noColumn(column.text(), labels);
        }
    }
    try {
        return ClaimReader(claim, own).whyNoRow();
    } catch (const AbsentColumnError& error) {
        for (std::size_t axis = 0; axis < own.rowAxes.size() && !claim.across; ++axis) {
            for (const tables::TableRow& row : own.rows) {
                const std::string& label = row.labels[axis];
                if (!error.text().starts_with(fmt::format("'{}' is no column", label))) continue;
                return error.text() + acrossHint(label, own.rowAxes[axis]);
            }
        }
        return error.text();
    } catch (const ExpressionError& error) {
        return error.text();
    }
}

void markRepeats(std::vector<ClaimResult>& results) {
    std::map<std::string, Verdict> verdicts;
    for (const ClaimResult& result : results) {
        verdicts.emplace(fmt::format("{} {}", result.table, result.id), result.verdict);
    }
    for (ClaimResult& result : results) {
        const auto found = verdicts.find(result.sameAs);
        result.isRepeat = found != verdicts.end() &&
                          (result.verdict == Verdict::Holds || result.verdict == found->second);
    }
}

std::vector<ClaimResult> evaluateClaims(const std::vector<config::Experiment>& experiments,
                                        const std::vector<tables::Table>& tables,
                                        const ReportContext& context,
                                        std::span<const config::Case> planned) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    std::vector<ClaimResult> results;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        for (ClaimResult& result : evaluateClaims(experiments[i], tables[i], context, planned)) {
            results.push_back(std::move(result));
        }
    }
    markRepeats(results);
    return results;
}

}  // namespace gfxrepro::claims
