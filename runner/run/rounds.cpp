#include "runner/run/rounds.h"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <set>

#include "runner/tables/labels.h"

namespace gfxrepro::run {

namespace {

/// Of each case, the processes of which all rows have values; and of each experiment one past the
/// last process that has rows.
struct Recorded {
    std::map<std::string, std::set<int>> complete;
    std::map<std::string, int> rounds;
};

Recorded recordedOf(const std::vector<records::Record>& records) {
    Recorded recorded;
    std::set<std::pair<std::string, int>> failed;
    for (const records::Record& row : records) {
        int& rounds = recorded.rounds[row.table];
        rounds = std::max(rounds, row.process + 1);
        recorded.complete[row.caseId].insert(row.process);
        if (row.status != records::Status::Ok && row.status != records::Status::Flaky) {
            failed.emplace(row.caseId, row.process);
        }
    }
    for (const auto& [id, process] : failed) recorded.complete[id].erase(process);
    return recorded;
}

bool hasAllBefore(const std::set<int>& complete, int process) {
    for (int i = 0; i < process; ++i) {
        if (!complete.contains(i)) return false;
    }
    return true;
}

/// The cases from `first` on that are of one experiment.
std::vector<const Case*> casesFrom(const Plan& plan, std::size_t first) {
    std::vector<const Case*> cases;
    for (std::size_t i = first; i < plan.cases.size(); ++i) {
        if (plan.cases[i].experiment != plan.cases[first].experiment) break;
        cases.push_back(&plan.cases[i]);
    }
    return cases;
}

/// Whether rounds may follow those that are measured whatever they take.
bool mayFollow(const config::Measure& measure) {
    return measure.mayContinue() || measure.certainRounds() < measure.processes;
}

bool isTimed(const Case& item) {
    return item.measure.lane == config::Measure::Lane::Timing;
}

/// Round `process` of `count` of an experiment, and the cases that take part in it.
struct Round {
    int experiment = 0;  // which one of those in its lane
    int process = 0;
    int count = 0;
    std::vector<const Case*> cases;
};

void append(Round round, std::vector<Unit>& units) {
    const bool isBackwards =
        round.process % 2 == 1 && !round.cases.empty() && isTimed(*round.cases.front());
    if (isBackwards) std::ranges::reverse(round.cases);
    for (const Case* item : round.cases) units.push_back({item, round.process, {}});
}

/// Every experiment's rounds evenly over the whole, and those of several in turn.
void spread(std::vector<Round>& rounds, int experiments) {
    std::ranges::stable_sort(rounds, {}, [&](const Round& round) {
        return (round.process + (round.experiment + 0.5) / experiments) / round.count;
    });
}

}  // namespace

std::vector<Unit> unitsOf(const Plan& plan, const std::vector<records::Record>& records) {
    const Recorded recorded = recordedOf(records);
    std::vector<Unit> units;
    std::vector<Round> timed;
    int timedExperiments = 0;
    for (std::size_t first = 0; first < plan.cases.size();) {
        const std::vector<const Case*> all = casesFrom(plan, first);
        first += all.size();
        const auto begun = recorded.rounds.find(all.front()->experiment);
        int count = begun == recorded.rounds.end() ? 0 : begun->second;
        for (const Case* item : all) count = std::max(count, item->measure.certainRounds());
        for (int process = 0; process < count; ++process) {
            Round round{timedExperiments, process, count, {}};
            for (const Case* item : all) {
                const auto complete = recorded.complete.find(item->id);
                const bool isFurther = mayFollow(item->measure) &&
                                       complete != recorded.complete.end() &&
                                       hasAllBefore(complete->second, process);
                const bool isCertain = process < item->measure.certainRounds();
                if (isCertain || isFurther) round.cases.push_back(item);
            }
            if (isTimed(*all.front())) {
                timed.push_back(std::move(round));
            } else {
                append(std::move(round), units);
            }
        }
        timedExperiments += isTimed(*all.front()) ? 1 : 0;
    }
    spread(timed, timedExperiments);
    for (Round& round : timed) append(std::move(round), units);
    return units;
}

Rounds::Rounds(const Plan& plan, const std::vector<records::Record>& records,
               const std::vector<Json>& journal) {
    for (const Case& item : plan.cases) {
        if (!isTimed(item)) continue;
        const auto [table, isNew] = tables_.try_emplace(item.experiment);
        if (isNew) {
            order_.push_back(item.experiment);
            table->second.times = tables::FrameTimes(!item.program.isNull());
        }
        table->second.cases.push_back(&item);
    }
    add(records);
    std::map<std::string_view, const Case*> cases;
    for (const Case& item : plan.cases) cases[item.id] = &item;
    for (const Json& event : journal) {
        const std::string name = event.value("event", "");
        const auto item = cases.find(event.value("case", ""));
        if (name == "case" && item != cases.end()) {
            takenFrom(*item->second, event.value("times_of", ""));
        }
        const auto table = tables_.find(event.value("table", ""));
        if (table == tables_.end()) continue;
        if (name == "machine") {  // measured again from there
            table->second.ending = nullptr;
            table->second.takenFrom.clear();
        }
        if (name == "rounds") table->second.ending = event;
    }
    for (auto& [name, table] : tables_) {
        if (!table.ending.is_object()) continue;
        for (const char* key : {"event", "time"}) table.ending.erase(key);
    }
}

void Rounds::begin(const std::string& experiment, TimePoint now) {
    end(experiment, now);
    const auto table = tables_.find(experiment);
    if (table != tables_.end()) table->second.runsSince = now;
}

void Rounds::end(const std::string& experiment, TimePoint now, double onceS) {
    const auto table = tables_.find(experiment);
    if (table == tables_.end() || !table->second.runsSince) return;
    table->second.spent += now - *table->second.runsSince - std::chrono::duration<double>(onceS);
    table->second.runsSince.reset();
}

void Rounds::add(const std::vector<records::Record>& rows) {
    for (const records::Record& row : rows) {
        const auto table = tables_.find(row.table);
        if (table != tables_.end()) table->second.times.add(row);
    }
}

void Rounds::takenFrom(const Case& item, const std::string& table) {
    const auto own = tables_.find(item.experiment);
    if (own == tables_.end()) return;
    own->second.takenFrom.erase(item.id);
    if (!table.empty()) own->second.takenFrom[item.id] = table;
}

std::vector<Unit> Rounds::next(const std::string& experiment) {
    const auto found = tables_.find(experiment);
    if (found == tables_.end() || !found->second.ending.is_null()) return {};
    TimedTable& table = found->second;
    const config::Measure& measure = table.cases.front()->measure;
    const std::size_t rounds = table.times.roundCount();
    const auto process = static_cast<int>(rounds);
    const std::optional<double> error = table.times.relativeError();
    std::vector<const Case*> cases;
    for (const Case* item : table.cases) {
        if (table.times.hasRounds(item->id, process)) cases.push_back(item);
    }
    // A round takes as long as those before it did.
    const int measured = std::max(table.roundsBegun, measure.certainRounds());
    const bool isAffordable = measure.mayFollow(measured, table.spent.count() / measured);
    const bool isAsked = process < measure.processes;
    const bool isUnknown = measure.mayContinue() && process < config::kMostRounds &&
                           !table.times.isKnownTo(config::kKnownTo, measure.processes);
    const bool isWanted = rounds > 0 && (isAsked || isUnknown);
    if (isWanted && isAffordable && !cases.empty()) {
        table.roundsBegun = measured + 1;
        std::vector<Unit> units;
        append({.process = process, .cases = std::move(cases)}, units);
        return units;
    }
    table.ending = {{"table", experiment},
                    {"rounds", rounds},
                    {"ended_by", tables::endOfRounds(measure, table.times)},
                    {"relative_error", error ? Json(*error) : Json(nullptr)},
                    {"seconds", table.spent.count()}};
    return {};
}

bool Rounds::isUndecided(const std::string& experiment) const {
    const auto table = tables_.find(experiment);
    return table != tables_.end() && table->second.ending.is_null();
}

bool Rounds::mayFollow(const std::string& experiment) const {
    return isUndecided(experiment) && run::mayFollow(tables_.at(experiment).cases.front()->measure);
}

std::vector<std::string> Rounds::undecided() const {
    std::vector<std::string> names;
    std::ranges::copy_if(order_, std::back_inserter(names),
                         [&](const std::string& name) { return isUndecided(name); });
    return names;
}

Json Rounds::endings() const {
    Json all = Json::object();
    for (const std::string& name : order_) {
        const TimedTable& table = tables_.at(name);
        Json ending = table.ending;
        if (ending.is_null()) continue;
        ending.erase("table");
        if (!table.takenFrom.empty()) {
            ending["times_of"] = table.takenFrom.begin()->second;
            ending["taken"] = table.takenFrom.size();
            ending["cases"] = table.cases.size();
        }
        all[name] = ending;
    }
    return all;
}

std::vector<std::string> Rounds::warnings() const {
    std::vector<std::string> lines;
    for (const std::string& name : order_) {
        const TimedTable& table = tables_.at(name);
        tables::LabelsOfCases names;
        for (const Case* item : table.cases) {
            const std::string title = item->title();
            if (title != name) names[item->id] = tables::shownCase(title, name);
        }
        for (const std::string& text : tables::outlierTexts(table.times, names)) {
            lines.push_back(name + ": " + text);
        }
    }
    return lines;
}

Json Rounds::ending(const std::string& experiment) const {
    const auto table = tables_.find(experiment);
    return table == tables_.end() ? Json(nullptr) : table->second.ending;
}

std::string takenTimesNote(const Json& manifest, const std::string& table) {
    const auto rounds = manifest.find("rounds");
    if (rounds == manifest.end() || !rounds->contains(table)) return "";
    const Json& ending = rounds->at(table);
    const std::string other = ending.value("times_of", "");
    const int taken = ending.value("taken", 0), all = ending.value("cases", 0);
    if (other.empty()) return "";
    if (taken == all) return "Times are those of " + other + ", which has these cases, too";
    return fmt::format(
        "Times of {} of {} cases are those of {}, which has these cases, too; the others' were "
        "measured at another moment",
        taken, all, other);
}

}  // namespace gfxrepro::run
