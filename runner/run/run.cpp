#include "runner/run/run.h"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>
#include <utility>

#include "engine/core/near_file.h"
#include "engine/core/text.h"
#include "runner/records/images.h"
#include "runner/run/manifest.h"
#include "runner/run/plan_json.h"
#include "runner/run/run_directory.h"
#include "runner/run/twins.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

bool hasValues(records::Status status) {
    return status == records::Status::Ok || status == records::Status::Flaky;
}

/// The first row of each unit that has no value; else the first that is not `ok`; else its first.
using WorstRows = std::map<UnitKey, const records::Record*>;
WorstRows worstRows(const std::vector<records::Record>& records) {
    const auto weight = [](const records::Record& row) {
        return hasValues(row.status) ? (row.status == records::Status::Ok ? 0 : 1) : 2;
    };
    WorstRows worst;
    for (const records::Record& row : records) {
        const auto [unit, isNew] = worst.try_emplace({row.caseId, row.process}, &row);
        if (!isNew && weight(row) > weight(*unit->second)) unit->second = &row;
    }
    return worst;
}

/// Leaves in records.csv the units whose worst row has a status that stays.
void keepUnits(const RunDirectory& directory, const std::vector<records::Record>& records,
               const WorstRows& worst, bool (*stays)(records::Status)) {
    const auto isKept = [&](const records::Record& row) {
        return stays(worst.at({row.caseId, row.process})->status);
    };
    if (std::ranges::all_of(records, isKept)) return;
    std::vector<records::Record> kept;
    std::ranges::copy_if(records, std::back_inserter(kept), isKept);
    records::writeRecords(directory.recordsFile(), kept);
}

}  // namespace

void forgetFlaky(const RunDirectory& directory) {
    if (!fs::exists(directory.recordsFile())) return;
    const std::vector<records::Record> records = records::readRecords(directory.recordsFile());
    keepUnits(directory, records, worstRows(records),
              [](records::Status status) { return status != records::Status::Flaky; });
}

std::vector<Unit> remainingUnits(const Plan& plan, const RunDirectory& directory) {
    if (!fs::exists(directory.recordsFile())) return unitsOf(plan);
    const std::vector<records::Record> records = records::readRecords(directory.recordsFile());
    const WorstRows worst = worstRows(records);
    keepUnits(directory, records, worst, hasValues);
    std::vector<Unit> units = unitsOf(plan, records);
    std::erase_if(units, [&](const Unit& unit) {
        const auto found = worst.find({unit.item->id, unit.process});
        return found != worst.end() && hasValues(found->second->status);
    });
    return units;
}

Rounds roundsOf(const Plan& plan, const RunDirectory& directory, const std::vector<Json>& journal) {
    std::vector<records::Record> records;
    if (fs::exists(directory.recordsFile()))
        records = records::readRecords(directory.recordsFile());
    return {plan, records, journal};
}

std::vector<std::string> replaceForeignTimes(const Plan& plan, const RunDirectory& directory,
                                             const std::vector<Json>& journal, Json& manifest,
                                             const std::string& machine) {
    if (!fs::exists(directory.recordsFile())) records::RecordWriter{directory.recordsFile()};
    std::set<std::string> unfinished;
    for (const Unit& unit : remainingUnits(plan, directory)) {
        if (unit.item->measure.lane != config::Measure::Lane::Timing) continue;
        unfinished.insert(unit.item->experiment);
    }
    // Between two rounds no unit is left of a table that goes on.
    const Rounds rounds = roundsOf(plan, directory, journal);
    for (const std::string& experiment : rounds.undecided()) {
        if (rounds.mayFollow(experiment)) unfinished.insert(experiment);
    }
    // What a table takes from another goes with it.
    for (const auto& [table, lender] : lendersOfTimes(pointersTo(plan.cases))) {
        if (unfinished.contains(lender)) unfinished.insert(table);
    }
    std::erase_if(unfinished, [&](const std::string& experiment) {
        return timingMachine(manifest, experiment) == machine;
    });
    if (unfinished.empty()) return {};
    std::vector<records::Record> kept, replaced;
    std::set<std::string> experiments;
    for (const records::Record& row : records::readRecords(directory.recordsFile())) {
        const bool isReplaced = row.lane == "timing" && unfinished.contains(row.table);
        (isReplaced ? replaced : kept).push_back(row);
        if (isReplaced) experiments.insert(row.table);
    }
    if (!replaced.empty()) {
        records::RecordWriter(directory.path() / "records-replaced.csv").append(replaced);
        records::writeRecords(directory.recordsFile(), kept);
    }
    for (const std::string& experiment : unfinished) {
        manifest["timing_machines"][experiment] = machine;
    }
    return {experiments.begin(), experiments.end()};
}

namespace {

/// Throws Error for a record of a case that the plan does not have, or has in another table.
void requirePlanned(const fs::path& file, const Plan& plan,
                    const std::vector<records::Record>& records) {
    std::unordered_map<std::string_view, std::string_view> tables;
    for (const Case& item : plan.cases) tables[item.id] = item.experiment;
    for (const records::Record& row : records) {
        const auto found = tables.find(row.caseId);
        if (found != tables.end() && found->second == row.table) continue;
        throw Error({file.string(), 0, 0},
                    fmt::format("the case {} of {} is not in the plan", row.caseId, row.table));
    }
}

}  // namespace

bool holdsRun(const fs::path& folder) {
    return fs::exists(folder / "plan.json") &&
           (fs::exists(folder / "manifest.json") || fs::exists(folder / "records.csv"));
}

namespace {

Plan planOfPart(const fs::path& file) {
    Plan plan = planWithUnreadExperiments(file);
    return plan.shard ? plan : Plan::fromJsonFile(file);
}

StoredRun readRunWith(Plan (*readPlan)(const fs::path&), const fs::path& runDir) {
    if (!fs::exists(runDir / "plan.json")) {
        throw Error(runDir.string() + ": is not a run directory (it has no plan.json)" +
                    suggestedFile(runDir));
    }
    if (!holdsRun(runDir)) {
        throw Error(runDir.string() + ": was planned, and not begun (it has no manifest.json)");
    }
    requirePlainFiles(runDir);
    requireModestFiles(runDir);
    StoredRun run;
    run.plan = readPlan(runDir / "plan.json");
    run.manifest = readManifest(runDir / "manifest.json");
    requireOfPlan(run.manifest, run.plan, runDir / "manifest.json");
    noteChanges(run.manifest, runDir);
    noteMachines(run.manifest);
    if (fs::exists(runDir / "records.csv")) {
        run.records = records::readRecords(runDir / "records.csv");
        requirePlanned(runDir / "records.csv", run.plan, run.records);
    }
    return run;
}

}  // namespace

StoredRun readRun(const fs::path& runDir) {
    return readRunWith(&Plan::fromJsonFile, runDir);
}

StoredRun readPart(const fs::path& runDir) {
    return readRunWith(&planOfPart, runDir);
}

void noteChangedImages(Json& manifest, const fs::path& runDir, const std::vector<Unit>& again) {
    constexpr std::size_t kNamed = 3;
    std::set<std::string> others;
    for (const Unit& unit : again) others.insert(unit.item->id);
    std::vector<std::string> changed = records::changedImages(runDir, others);
    if (changed.empty()) return;
    const std::size_t count = changed.size();
    changed.resize(std::min(count, kNamed));
    addNote(manifest,
            fmt::format("pictures are not as they were recorded: {}{}", joined(changed, ", "),
                        count > kNamed ? fmt::format(", and {} others", count - kNamed) : ""));
}

Completeness completeness(const StoredRun& run) {
    const WorstRows worst = worstRows(run.records);
    Completeness counts;
    for (const Unit& unit : unitsOf(run.plan, run.records)) {
        ++counts.units;
        const auto found = worst.find({unit.item->id, unit.process});
        if (found == worst.end()) {
            ++counts.missing;
            continue;
        }
        const records::Status status = found->second->status;
        if (hasValues(status)) continue;
        ++counts.failed;
        ++counts.failures[status];
    }
    return counts;
}

void noteCompleteness(Json& manifest, const Completeness& counts) {
    manifest["units"] = {
        {"planned", counts.units}, {"missing", counts.missing}, {"failed", counts.failed}};
}

Completeness readCompleteness(const fs::path& runDir, const Plan* plan) {
    requirePlainFiles(runDir);
    requireModestFiles(runDir);
    const Json manifest = readManifest(runDir / "manifest.json");
    if (plan) requireOfPlan(manifest, *plan, runDir / "manifest.json");
    if (!manifest.contains("units") || !areRecordsSealed(manifest, runDir)) {
        return completeness(readRun(runDir));
    }
    const Json& units = manifest.at("units");
    return {units.at("planned"), units.at("missing"), units.at("failed")};
}

namespace {

/// What a case took, by its id; nothing of one whose measurement is another's.
std::map<std::string, double> secondsOfCases(const fs::path& runDir) {
    std::map<std::string, double> seconds;
    forEachEvent(runDir / "journal.jsonl", [&](const Json& event) {
        if (event.value("event", "") != "case" || event.contains("as")) return;
        if (!event.contains("cost")) return;
        for (const char* part : {"load_s", "setup_s", "render_s", "record_s"}) {
            seconds[event.value("case", "")] += event["cost"].value(part, 0.0);
        }
    });
    return seconds;
}

/// How one unit of a case ended; nothing more than that where it has values.
records::CaseEnd resultOf(const Case& item, const records::Record* row) {
    using Ended = records::CaseEnd::Outcome;
    records::CaseEnd result{item.experiment, item.title()};
    if (!row) {
        result.outcome = Ended::Failed;
        result.text = "not run";
        return result;
    }
    if (hasValues(row->status)) return result;
    result.text = records::statusName(row->status);
    if (!row->message.empty()) result.text += ": " + row->message;
    const bool isSkipped =
        row->status == records::Status::Missing || row->status == records::Status::Unsupported;
    result.outcome = isSkipped ? Ended::Skipped : Ended::Failed;
    return result;
}

}  // namespace

std::vector<records::CaseEnd> caseResults(const StoredRun& run, const fs::path& runDir) {
    using Ended = records::CaseEnd::Outcome;
    const WorstRows worst = worstRows(run.records);
    // Of the processes of a case what failed weighs most, then what was left out.
    const auto weight = [](const records::CaseEnd& result) {
        return result.outcome == Ended::Failed ? 2 : result.outcome == Ended::Skipped ? 1 : 0;
    };
    std::map<std::string, records::CaseEnd> results;
    std::vector<std::string> order;
    for (const Unit& unit : unitsOf(run.plan, run.records)) {
        const Case& item = *unit.item;
        const auto found = worst.find({item.id, unit.process});
        records::CaseEnd result = resultOf(item, found == worst.end() ? nullptr : found->second);
        const auto [known, isNew] = results.try_emplace(item.id, result);
        if (isNew) order.push_back(item.id);
        if (weight(result) > weight(known->second)) known->second = std::move(result);
    }
    if (!runDir.empty()) {
        for (const auto& [id, seconds] : secondsOfCases(runDir)) {
            const auto found = results.find(id);
            if (found != results.end()) found->second.seconds = seconds;
        }
    }
    std::vector<records::CaseEnd> ordered;
    for (const std::string& id : order) ordered.push_back(std::move(results.at(id)));
    return ordered;
}

namespace {

/// What a case's measurement is, by the case's id; an id that is not there stands for itself.
using Works = std::map<std::string, std::string>;
using WorkUnit = std::pair<std::string, int>;  // work, process

/// The invocations that ended during a unit, with the case under whose name it had begun.
using Lost = std::map<WorkUnit, std::map<int, std::string>>;

Lost lostUnits(const std::vector<Json>& journal, const Works& works) {
    Lost lost;
    std::map<WorkUnit, std::string> underWay;
    int invocation = 0;
    const auto endUnsaid = [&] {
        for (const auto& [unit, id] : underWay) lost[unit][invocation] = id;
        underWay.clear();
        ++invocation;
    };
    for (const Json& event : journal) {
        const std::string name = event.value("event", "");
        if (name == "begin") endUnsaid();
        if (name == "end" || name == "interrupted") underWay.clear();
        if (!event.contains("case") || !event.contains("process")) continue;
        const std::string id = event["case"].get<std::string>();
        const auto work = works.find(id);
        const WorkUnit unit = {work == works.end() ? id : work->second,
                               event["process"].get<int>()};
        if (name == "start") underWay.insert_or_assign(unit, id);
        if (name == "case" || name == "retry") underWay.erase(unit);
        if (name == "case") lost.erase(unit);
    }
    endUnsaid();
    return lost;
}

Works worksOf(const Plan& plan) {
    Works works;
    for (const auto& [item, key] : keysOfTwins(pointersTo(plan.cases))) works[item->id] = key;
    return works;
}

std::string titleOf(const Plan& plan, const std::string& id) {
    for (const Case& item : plan.cases) {
        if (item.id == id) return item.title();
    }
    return id;
}

}  // namespace

std::map<std::string, std::string> casesNotSurvived(const Plan& plan,
                                                    const std::vector<Json>& journal) {
    if (lostUnits(journal, {}).empty()) return {};  // as of nearly every run: without a key a case
    const Works works = worksOf(plan);
    std::map<std::string, std::map<int, std::string>> lostWork;  // all processes together
    for (const auto& [unit, invocations] : lostUnits(journal, works)) {
        lostWork[unit.first].insert(invocations.begin(), invocations.end());
    }
    std::map<std::string, std::string> messages;
    for (const Case& item : plan.cases) {
        const auto work = works.find(item.id);
        const auto lost = lostWork.find(work == works.end() ? item.id : work->second);
        if (lost == lostWork.end() || lost->second.size() < 2) continue;
        std::set<std::string> names;
        for (const auto& [invocation, id] : lost->second) names.insert(id);
        const std::string what =
            names.contains(item.id) ? "it" : "its twin " + titleOf(plan, *names.begin());
        messages[item.id] = fmt::format(
            "the runner did not survive {}, {} times; resume with --retry to try it again", what,
            lost->second.size());
    }
    return messages;
}

}  // namespace gfxrepro::run
