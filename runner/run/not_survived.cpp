#include "runner/run/not_survived.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <set>
#include <utility>

#include "runner/run/twins.h"

namespace gfxrepro::run {

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
    for (const Case& item : plan.cases) {
        const std::string key = workKey(item);
        if (!key.empty()) works[item.id] = key;
    }
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
