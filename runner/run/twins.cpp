#include "runner/run/twins.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/hash.h"
#include "engine/core/output_files.h"
#include "runner/run/recorder.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// 64 and 64.0 are one number.
void spellNumbersAlike(Json& value) {
    if (value.is_number()) value = value.get<double>();
    if (!value.is_structured()) return;
    for (Json& item : value) spellNumbersAlike(item);
}

bool hasTimes(const Case& item) {
    return item.measure.lane == config::Measure::Lane::Timing;
}

}  // namespace

std::string workKey(const Case& item) {
    const config::Measure& measure = item.measure;
    Json content = {{"technique", item.technique},
                    {"scene", item.scene.toJson()},
                    {"params", item.params.toJson()},
                    {"output", {item.outputWidthPx, item.outputHeightPx}},
                    {"measure",
                     {measure.warmup(), measure.repeats, measure.processes, measure.frames,
                      measure.timeLimitS}}};
    if (!item.program.isNull()) content["program"] = {item.program.toJson(), item.programKey};
    if (!hasTimes(item)) content["params"].erase("pictures");
    spellNumbersAlike(content);
    if (measure.seeds == config::Measure::Seeds::Process) content["seeds"] = "process";
    content["seed"] = std::to_string(item.seed);
    return sha256(content.dump());
}

namespace {

/// The works of the cases of each table whose times may be another's: measured once, and none of
/// them twice.
std::map<std::string, std::set<std::string>> worksOfTables(const Cases& cases) {
    std::map<std::string, std::set<std::string>> works;
    std::set<std::string> others;
    for (const Case* item : cases) {
        if (!hasTimes(*item)) continue;
        const bool isOnce = item->measure.processes == 1 && !item->measure.mayContinue();
        if (!isOnce || !works[item->experiment].insert(workKey(*item)).second) {
            others.insert(item->experiment);
        }
    }
    std::erase_if(works, [&](const auto& table) { return others.contains(table.first); });
    return works;
}

}  // namespace

std::map<std::string, std::string> lendersOfTimes(const Cases& cases) {
    const std::map<std::string, std::set<std::string>> works = worksOfTables(cases);
    std::map<std::string, std::vector<std::string>> tablesOf;  // of a work
    for (const auto& [table, keys] : works) {
        for (const std::string& key : keys) tablesOf[key].push_back(table);
    }
    // Whether `table` has all that `other` has; of two with the same, the first by name.
    const auto has = [&](const std::string& table, const std::string& other) {
        const std::set<std::string>&all = works.at(table), &some = works.at(other);
        return table != other && std::ranges::includes(all, some) &&
               (all.size() > some.size() || table < other);
    };
    std::map<std::string, std::string> lenders;
    for (const auto& [table, keys] : works) {
        const std::vector<std::string>& others = tablesOf.at(*keys.begin());
        for (const std::string& other : others) {
            const bool isLent = std::ranges::any_of(
                others, [&](const std::string& more) { return has(more, other); });
            if (has(other, table) && !isLent) lenders.emplace(table, other);  // the first
        }
    }
    return lenders;
}

std::map<const Case*, std::string> keysOfTwins(const Cases& cases) {
    const std::map<std::string, std::string> lenders = lendersOfTimes(cases);
    std::set<std::string> lending;
    for (const auto& [table, lender] : lenders) lending.insert(lender);
    std::map<const Case*, std::string> keys;
    std::map<std::string, int> counts;
    for (const Case* item : cases) {
        std::string key;
        if (const auto lender = lenders.find(item->experiment); lender != lenders.end()) {
            key = lender->second + ' ';
        } else if (hasTimes(*item) && lending.contains(item->experiment)) {
            key = item->experiment + ' ';
        } else if (hasTimes(*item)) {
            continue;
        }
        key += workKey(*item);
        ++counts[key];
        keys.emplace(item, std::move(key));
    }
    std::erase_if(keys, [&](const auto& entry) { return counts[entry.second] == 1; });
    return keys;
}

bool savesPictures(const Case& item) {
    const Node* pictures = item.params.find("pictures");
    return pictures && pictures->toJson() == true;
}

Cases pointersTo(std::span<const Case> cases) {
    Cases pointers;
    for (const Case& item : cases) pointers.insert(&item);
    return pointers;
}

std::vector<std::size_t> firstTwins(std::span<const Case> cases) {
    const Cases pointers = pointersTo(cases);
    const std::map<const Case*, std::string> keys = keysOfTwins(pointers);
    const std::map<std::string, std::string> lenders = lendersOfTimes(pointers);
    std::map<std::string, std::size_t> known;
    for (const bool areBorrowed : {false, true}) {  // a table that lends its times may come later
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const auto key = keys.find(&cases[i]);
            if (key != keys.end() && lenders.contains(cases[i].experiment) == areBorrowed) {
                known.try_emplace(key->second, i);
            }
        }
    }
    std::vector<std::size_t> firsts;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto key = keys.find(&cases[i]);
        firsts.push_back(key == keys.end() ? i : known.at(key->second));
    }
    return firsts;
}

std::vector<double> withoutTwins(std::span<const Case> cases, std::vector<double> timesS) {
    GFXREPRO_ASSERT_EQ(cases.size(), timesS.size());
    const std::vector<std::size_t> firsts = firstTwins(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (firsts[i] != i) timesS[i] = 0.0;
    }
    return timesS;
}

std::vector<records::ImageEntry> shareFiles(const fs::path& runDir, const Case& measured,
                                            const Case& twin,
                                            const std::vector<records::ImageEntry>& images) {
    if (savesPictures(measured) && !savesPictures(twin)) return {};
    const std::string stem = "images/" + fileStem(measured);
    std::vector<records::ImageEntry> shared = images;
    for (records::ImageEntry& image : shared) {
        image.caseId = twin.id;
        image.table = twin.experiment;
        image.title = twin.title();
        for (std::string* file : {&image.png, &image.exr}) {
            if (file->empty()) continue;
            GFXREPRO_ASSERT(file->starts_with(stem));
            const std::string from = *file;
            *file = "images/" + fileStem(twin) + from.substr(stem.size());
            shareFile(runDir / from, runDir / *file);
        }
    }
    return shared;
}

}  // namespace gfxrepro::run
