#include "runner/cluster/shards.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/output_files.h"
#include "engine/core/text.h"
#include "runner/records/images.h"
#include "runner/run/manifest.h"
#include "runner/run/plan_json.h"
#include "runner/run/twins.h"

namespace gfxrepro::cluster {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxShards = 10000;

}  // namespace

run::Shard parseShard(std::string_view text) {
    const std::vector<std::string> parts = split(text, '/');
    const auto index = parts.size() == 2 ? parseInteger(parts[0]) : std::nullopt;
    const auto count = parts.size() == 2 ? parseInteger(parts[1]) : std::nullopt;
    if (!index || !count || *count < 1 || *count > kMaxShards || *index < 1 || *index > *count) {
        throw UsageError("--shard: expected k/n with 1 ≤ k ≤ n ≤ " + std::to_string(kMaxShards) +
                         ", found '" + std::string(text) + "'");
    }
    return {static_cast<int>(*index), static_cast<int>(*count)};
}

std::vector<std::vector<std::size_t>> indivisibleGroups(std::span<const config::Case> cases) {
    const std::map<std::string, std::string> lenders = run::lendersOfTimes(run::pointersTo(cases));
    std::vector<std::vector<std::size_t>> groups;
    std::map<std::string, std::size_t> groupOf;  // of an experiment, or of work
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const bool isTiming = cases[i].measure.lane == config::Measure::Lane::Timing;
        const auto lender = lenders.find(cases[i].experiment);
        const std::string key = lender != lenders.end() ? lender->second
                                : isTiming              ? cases[i].experiment
                                                        : run::workKey(cases[i]);
        const auto [group, isNew] = groupOf.try_emplace(key, groups.size());
        if (isNew) groups.emplace_back();
        groups[group->second].push_back(i);
    }
    return groups;
}

std::vector<int> cutShards(std::span<const config::Case> cases, std::span<const double> timesS,
                           int count) {
    GFXREPRO_ASSERT_EQ(cases.size(), timesS.size());
    const std::vector<std::vector<std::size_t>> groups = indivisibleGroups(cases);
    std::vector<double> groupS;
    for (const std::vector<std::size_t>& group : groups) {
        groupS.push_back(std::accumulate(group.begin(), group.end(), 0.0,
                                         [&](double sum, auto i) { return sum + timesS[i]; }));
    }
    std::vector<std::size_t> order(groups.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](auto a, auto b) { return groupS[a] > groupS[b]; });

    // Of shards with equal times the one with fewer cases: cases that take no time spread too.
    std::vector<std::pair<double, std::size_t>> load(static_cast<std::size_t>(count));
    std::vector<int> shardOf(cases.size());
    for (const std::size_t g : order) {
        const auto least = std::ranges::min_element(load);
        least->first += groupS[g];
        least->second += groups[g].size();
        for (const std::size_t i : groups[g]) shardOf[i] = static_cast<int>(least - load.begin());
    }
    return shardOf;
}

run::Plan shardPlan(const run::Plan& whole, const run::Shard& shard, std::span<const int> shardOf) {
    GFXREPRO_ASSERT_EQ(whole.cases.size(), shardOf.size());
    run::Plan plan;
    plan.request = whole.request;
    plan.profile = whole.profile;
    plan.deviceClass = whole.deviceClass;
    plan.seed = whole.seed;
    plan.hash = whole.hash;
    plan.buildId = whole.buildId;
    plan.shard = shard;
    std::set<std::string_view> experiments;
    for (std::size_t i = 0; i < shardOf.size(); ++i) {
        if (shardOf[i] != shard.index - 1) continue;
        const config::Case& item = whole.cases[i];
        plan.cases.push_back(item);
        experiments.insert(item.experiment);
        for (const auto& [name, reference] : run::scenesOf(item)) {
            const auto scene = whole.sceneKeys.find(reference.text());
            if (scene != whole.sceneKeys.end()) plan.sceneKeys.insert(*scene);
        }
    }
    std::ranges::copy_if(whole.experiments, std::back_inserter(plan.experiments),
                         [&](const auto& one) { return experiments.contains(one.id); });
    return plan;
}

namespace {

using UnitRows = std::map<std::pair<std::string, int>, std::vector<records::Record>>;

void requireOnePlan(const std::vector<ShardRun>& shards) {
    const ShardRun& first = shards.front();
    for (const ShardRun& shard : shards) {
        const std::string difference = run::planDifference(first.run.plan, shard.run.plan);
        if (difference.empty()) continue;
        throw Error(first.path.string() + " and " + shard.path.string() +
                    " are shards of different plans (" + first.run.plan.hash.substr(0, 12) + ", " +
                    shard.run.plan.hash.substr(0, 12) + "): " + difference);
    }
}

/// Each case of the shards is one of the plan, and of one of them alone.
void requireParts(const run::Plan& whole, const std::vector<ShardRun>& shards) {
    std::map<std::string_view, std::pair<const config::Case*, const ShardRun*>> owners;
    for (const config::Case& item : whole.cases) owners[item.id] = {&item, nullptr};
    for (const ShardRun& shard : shards) {
        for (const config::Case& own : shard.run.plan.cases) {
            const auto found = owners.find(own.id);
            if (found == owners.end()) {
                throw Error(fmt::format("{}: its case {} of {} is not in the plan of the shards",
                                        shard.path.string(), own.id, own.experiment));
            }
            auto& [item, owner] = found->second;
            if (owner) {
                throw Error("the case '" + item->title() + "' is in both " + owner->path.string() +
                            " and " + shard.path.string() + ": these are no shards of one cut");
            }
            owner = &shard;
        }
    }
}

/// The machine that each experiment's times are from. Throws when there are two.
run::Json timingMachines(const std::vector<ShardRun>& shards) {
    std::map<std::string, std::pair<std::string, const ShardRun*>> machines;
    for (const ShardRun& shard : shards) {
        std::set<std::string> timed;
        for (const records::Record& row : shard.run.records) {
            if (row.lane == "timing") timed.insert(row.table);
        }
        for (const std::string& experiment : timed) {
            const std::string machine = run::timingMachine(shard.run.manifest, experiment);
            const auto [known, isNew] = machines.try_emplace(experiment, machine, &shard);
            if (isNew || known->second.first == machine) continue;
            throw Error("the times of " + experiment + " would mix devices: " +
                        known->second.second->path.string() + " was measured on " +
                        known->second.first + "; " + shard.path.string() + " on " + machine);
        }
    }
    run::Json json = run::Json::object();
    for (const auto& [experiment, machine] : machines) json[experiment] = machine.first;
    return json;
}

/// The distinct values of a text in the manifests: "A; B".
std::string together(const std::vector<ShardRun>& shards, const run::Json::json_pointer& place) {
    std::vector<std::string> values;
    for (const ShardRun& shard : shards) {
        const std::string value = shard.run.manifest.at(place).get<std::string>();
        if (std::ranges::find(values, value) == values.end()) values.push_back(value);
    }
    return joined(values, "; ");
}

run::Json mergedManifest(const std::vector<ShardRun>& shards, const std::string& commandLine) {
    run::Json manifest = shards.front().run.manifest;
    for (const char* place : {"/cpu", "/gl/vendor", "/gl/renderer", "/gl/version"}) {
        const run::Json::json_pointer pointer(place);
        manifest[pointer] = together(shards, pointer);
    }
    manifest["timing_machines"] = timingMachines(shards);
    run::breakSeal(manifest);
    for (const char* own : {"shard", "notes"}) manifest.erase(own);
    manifest["invocations"] = run::Json::array();
    manifest["merged"] = run::Json::array();
    run::beginInvocation(manifest, commandLine);
    run::Json rounds = run::Json::object();  // each table's are of one shard
    run::Json states = run::Json::object();  // likewise
    for (const ShardRun& shard : shards) {
        const run::Json& from = shard.run.manifest;
        for (const std::string& note : run::notesOf(from)) {
            manifest["notes"].push_back(shard.path.string() + ": " + note);
        }
        manifest["scenes"].update(from.at("scenes"));
        run::addPrograms(manifest, run::programsOf(from));
        run::addWarnings(manifest, from.value("warnings", std::set<std::string>{}));
        if (from.contains("rounds")) rounds.update(from.at("rounds"));
        if (from.contains("machine_states")) states.update(from.at("machine_states"));
        manifest["merged"].push_back(
            {{"folder", shard.path.string()},
             {"shard", shard.run.plan.shard ? shard.run.plan.shard->name() : "1/1"},
             {"machine", run::machineName(from)},
             {"invocations", from.at("invocations")}});
    }
    manifest["rounds"] = rounds;
    manifest["machine_states"] = states;
    return manifest;
}

std::vector<records::Record> allRecords(const std::vector<ShardRun>& shards) {
    std::vector<records::Record> records;
    for (const ShardRun& shard : shards) {
        std::ranges::copy(shard.run.records, std::back_inserter(records));
    }
    return records;
}

UnitRows rowsByUnit(const std::vector<ShardRun>& shards) {
    UnitRows rows;
    for (const ShardRun& shard : shards) {
        for (const records::Record& row : shard.run.records) {
            rows[{row.caseId, row.process}].push_back(row);
        }
    }
    return rows;
}

void copyImages(const run::RunDirectory& directory, const std::vector<ShardRun>& shards,
                const run::Plan& plan) {
    std::map<std::string, std::vector<records::ImageEntry>> imagesOf;
    for (const ShardRun& shard : shards) {
        for (records::ImageEntry& image : records::readImages(shard.path)) {
            imagesOf[image.caseId].push_back(std::move(image));
        }
        copyTree(shard.path / "images", directory.path() / "images");
    }
    // The copy of a shard's list goes: the new one has the images of all, in the plan's order.
    fs::remove(directory.path() / "images" / "index.csv");
    std::vector<records::ImageEntry> images;
    for (const config::Case& item : plan.cases) {
        std::ranges::move(imagesOf[item.id], std::back_inserter(images));
    }
    records::ImageWriter(directory.path()).append(images);
}

/// The journals of the shards one after another; a torn last line ends.
void writeJournal(const fs::path& path, const std::vector<ShardRun>& shards) {
    AtomicFile file(path);
    for (const ShardRun& shard : shards) {
        if (!fs::exists(shard.path / "journal.jsonl")) continue;
        const MappedFile journal(shard.path / "journal.jsonl");
        file.write(journal.text());
        file.write("\n");
    }
    file.commit();
}

/// Throws Error where what the shards have together would be written and not be read again.
void requireReadable(const std::vector<ShardRun>& shards) {
    const auto require = [](const char* file, std::uintmax_t count, std::uintmax_t most,
                            const char* what) {
        if (count <= most) return;
        throw Error(
            fmt::format("the {} of the shards have {} {} together; at most {} are read of "
                        "a run. Merge them in parts, or read each by itself",
                        file, count, what, most));
    };
    const auto requireBytes = [&](const char* file, std::uintmax_t most) {
        std::uintmax_t bytes = 0;
        for (const ShardRun& shard : shards) {
            std::error_code isAbsent;
            const std::uintmax_t size = fs::file_size(shard.path / file, isAbsent);
            if (!isAbsent) bytes += size + 1;
        }
        require(file, bytes, most, "bytes");
    };
    requireBytes("journal.jsonl", run::kMostJournalBytes);
    requireBytes("records.csv", records::kMostRecordBytes);
    requireBytes("images/index.csv", records::kMostIndexBytes);
    std::size_t rows = 1, images = 1;  // the headers
    for (const ShardRun& shard : shards) {
        rows += shard.run.records.size();
        images += records::readImages(shard.path).size();
    }
    require("records.csv", rows, records::kMostRecords, "rows");
    require("images/index.csv", images, records::CsvReader::kMostRows, "rows");
}

}  // namespace

run::Plan wholePlan(const std::vector<ShardRun>& shards) {
    for (const ShardRun& shard : shards) {
        if (!shard.run.plan.shard) return shard.run.plan;
        const fs::path folder = fs::canonical(shard.path);
        for (const fs::path& file :
             {folder / kWholePlan, folder.parent_path().parent_path() / kSubmittedPlan}) {
            if (!fs::exists(file)) continue;
            if (sha256OfFile(file) != shard.run.plan.shard->whole) {
                throw Error(fmt::format("{}: is not the plan that {} is a shard of: it was changed",
                                        file.string(), shard.path.string()));
            }
            run::Plan whole = run::Plan::fromJsonFile(file);
            const std::string& deviceClass = shard.run.plan.deviceClass;
            if (whole.deviceClass != deviceClass) run::rebind(whole, deviceClass);
            return whole;
        }
    }
    throw Error(fmt::format(
        "{}: the plan that it is a shard of is neither in it ({}) nor two folders above it ({}): "
        "a shard of a submission is merged with the submission's folder",
        shards.front().path.string(), kWholePlan, kSubmittedPlan));
}

run::StoredRun mergeRuns(run::Plan whole, const std::vector<ShardRun>& shards,
                         const std::string& commandLine) {
    GFXREPRO_ASSERT(!shards.empty());
    requireOnePlan(shards);
    requireParts(whole, shards);
    requireReadable(shards);
    run::StoredRun merged;
    merged.plan = std::move(whole);
    merged.manifest = mergedManifest(shards, commandLine);
    UnitRows rows = rowsByUnit(shards);
    for (const run::Unit& unit : run::unitsOf(merged.plan, allRecords(shards))) {
        std::ranges::move(rows[{unit.item->id, unit.process}], std::back_inserter(merged.records));
    }
    return merged;
}

std::vector<std::string> missingUnits(const run::StoredRun& run) {
    std::set<std::pair<std::string, int>> recorded;
    for (const records::Record& row : run.records) recorded.emplace(row.caseId, row.process);
    std::vector<std::string> missing;
    for (const run::Unit& unit : run::unitsOf(run.plan, run.records)) {
        if (recorded.contains({unit.item->id, unit.process})) continue;
        missing.push_back(unit.item->title());
        if (unit.item->measure.processes > 1) {
            missing.back() += " process " + std::to_string(unit.process + 1);
        }
    }
    return missing;
}

std::vector<std::string> missingShards(const std::vector<ShardRun>& shards) {
    std::set<int> present;
    int count = 0;
    for (const ShardRun& shard : shards) {
        if (!shard.run.plan.shard) continue;
        present.insert(shard.run.plan.shard->index);
        count = shard.run.plan.shard->count;
    }
    std::vector<std::string> missing;
    for (int index = 1; index <= count; ++index) {
        if (!present.contains(index)) missing.push_back(run::Shard{index, count}.name());
    }
    return missing;
}

void writeMerged(const run::RunDirectory& directory, const std::vector<ShardRun>& shards,
                 const run::StoredRun& merged) {
    // A merge that is made again begins anew; without a plan the folder is no run meanwhile.
    for (const fs::path& old : {directory.planFile(), directory.recordsFile()}) fs::remove(old);
    records::writeRecords(directory.recordsFile(), merged.records);
    copyImages(directory, shards, merged.plan);
    writeJournal(directory.path() / "journal.jsonl", shards);
    run::Json manifest = merged.manifest;
    run::sealRecords(manifest, directory.path());
    run::noteCompleteness(manifest, run::completeness(merged));
    writeFileAtomic(directory.manifestFile(), manifest.dump(2) + '\n');
    merged.plan.writeFile(directory.planFile());
}

}  // namespace gfxrepro::cluster
