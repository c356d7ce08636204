// Cuts: complete, disjoint, repeatable, balanced, and never through a table of times.
#include "runner/cluster/shards.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "engine/core/hash.h"
#include "runner/run/manifest.h"
#include "runner/run/plan_json.h"
#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {

namespace {

using config::Case;
using Lane = config::Measure::Lane;

std::vector<Case> qualityCases(int count) {
    std::vector<Case> cases;
    for (int i = 0; i < count; ++i) cases.push_back(makeCase("q/1", "a", i));
    return cases;
}

std::vector<double> loads(const std::vector<int>& shardOf, const std::vector<double>& timesS,
                          int count) {
    std::vector<double> sums(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < shardOf.size(); ++i) {
        sums[static_cast<std::size_t>(shardOf[i])] += timesS[i];
    }
    return sums;
}

TEST(Shards, ReadsKOfN) {
    const run::Shard shard = cluster::parseShard("2/4");
    EXPECT_EQ(shard.index, 2);
    EXPECT_EQ(shard.count, 4);
    EXPECT_EQ(shard.name(), "2/4");
    for (const char* text : {"", "2", "0/4", "5/4", "-1/4", "1/0", "1/4/2", "a/b", "1/10001"}) {
        EXPECT_EQ(
            errorText([&] { cluster::parseShard(text); }),
            "--shard: expected k/n with 1 ≤ k ≤ n ≤ 10000, found '" + std::string(text) + "'");
    }
}

TEST(Shards, LongestFirstToTheLeastLoaded) {
    // By hand: 7 → 0, 5 → 1, 4 → 2, 3 → 2 (4 is least), 3 → 1 (5), 2 → 0 or 2 (both 7): the first.
    EXPECT_THAT(cluster::cutShards(qualityCases(6), std::vector<double>{3, 7, 2, 5, 3, 4}, 3),
                ElementsAre(2, 0, 0, 1, 1, 2));
}

TEST(Shards, MoreShardsThanCasesLeaveSomeEmpty) {
    EXPECT_THAT(cluster::cutShards(qualityCases(2), std::vector<double>{1, 1}, 5),
                ElementsAre(0, 1));
    EXPECT_TRUE(cluster::cutShards({}, {}, 3).empty());
}

TEST(Shards, CasesWithoutATimeSpread) {
    const std::vector<int> shardOf =
        cluster::cutShards(qualityCases(9), std::vector<double>(9, 0.0), 3);
    for (int shard = 0; shard < 3; ++shard) EXPECT_EQ(std::ranges::count(shardOf, shard), 3);
}

/// The best that any cut can do, by trying all.
double bestLongest(const std::vector<double>& timesS, int count) {
    std::vector<int> shardOf(timesS.size(), 0);
    double best = std::accumulate(timesS.begin(), timesS.end(), 0.0);
    while (true) {
        best = std::min(best, std::ranges::max(loads(shardOf, timesS, count)));
        std::size_t i = 0;
        while (i < shardOf.size() && ++shardOf[i] == count) shardOf[i++] = 0;
        if (i == shardOf.size()) return best;
    }
}

TEST(Shards, RandomCutsAreBalancedAndRepeatable) {
    std::mt19937 random(7);
    for (int round = 0; round < 100; ++round) {
        const int count = 1 + static_cast<int>(random() % 4);
        const std::vector<Case> cases = qualityCases(1 + static_cast<int>(random() % 7));
        std::vector<double> timesS;
        for (std::size_t i = 0; i < cases.size(); ++i) timesS.push_back(1.0 + random() % 1000);
        const std::vector<int> shardOf = cluster::cutShards(cases, timesS, count);
        EXPECT_EQ(shardOf, cluster::cutShards(cases, timesS, count));
        EXPECT_TRUE(std::ranges::all_of(shardOf, [&](int s) { return s >= 0 && s < count; }));
        // Graham 1969: at most 4/3 − 1/3m of the optimum.
        EXPECT_LE(std::ranges::max(loads(shardOf, timesS, count)),
                  (4.0 / 3.0 - 1.0 / (3.0 * count)) * bestLongest(timesS, count) + 1e-9);
    }
}

TEST(Shards, TimesOfATableStayTogether) {
    std::vector<Case> cases;
    for (const char* experiment : {"t/1", "t/2"}) {
        for (const char* method : {"a", "b"}) {
            for (int size = 1; size <= 3; ++size) {
                cases.push_back(makeCase(experiment, method, size, Lane::Timing));
                cases.back().measure.processes = 6;  // of one process they would be shared
            }
        }
    }
    for (Case& item : qualityCases(4)) cases.push_back(item);
    EXPECT_EQ(cluster::indivisibleGroups(cases).size(), 2U + 4U);
    for (int count = 1; count <= 8; ++count) {
        const std::vector<int> shardOf =
            cluster::cutShards(cases, std::vector<double>(cases.size(), 1.0), count);
        for (const std::size_t first : {0U, 6U}) {
            for (std::size_t i = first; i < first + 6; ++i) EXPECT_EQ(shardOf[i], shardOf[first]);
        }
        if (count > 1) EXPECT_NE(shardOf[0], shardOf[6]);
    }
}

TEST(Shards, AllShardsTogetherHaveEachUnitOnce) {
    run::Plan plan{.cases = qualityCases(10)};
    plan.cases[3].measure.processes = 2;
    const std::vector<double> timesS = {5, 1, 1, 8, 1, 1, 1, 2, 2, 3};
    std::multiset<std::string> units;
    const std::vector<int> shardOf = cluster::cutShards(plan.cases, timesS, 3);
    for (int k = 1; k <= 3; ++k) {
        const run::Plan part = cluster::shardPlan(plan, {k, 3, "hash"}, shardOf);
        EXPECT_EQ(part.shard->whole, "hash");
        for (const run::Unit& unit : run::unitsOf(part)) {
            units.insert(unit.item->id + '#' + std::to_string(unit.process));
        }
    }
    std::multiset<std::string> whole;
    for (const run::Unit& unit : run::unitsOf(plan)) {
        whole.insert(unit.item->id + '#' + std::to_string(unit.process));
    }
    EXPECT_EQ(whole.size(), 11U);
    EXPECT_EQ(units, whole);
}

/// Two shards of tables with scenes of their own: neither has what only the other measures.
TEST(Shards, APlanOfAShardHasItsOwnAlone) {
    run::Plan plan;
    for (const char* name : {"q/1", "q/2"}) {
        plan.experiments.emplace_back().id = name;
        Case item = makeCase(name, "a", 1);
        item.scene = Node::scalar(std::string("models/of-") + name);
        item.params.set("scene_b", Node::scalar(std::string("models/b-of-") + name));
        plan.sceneKeys[item.scene.text()] = "key";
        plan.sceneKeys["models/b-of-" + std::string(name)] = "key";
        plan.cases.push_back(item);
    }
    plan.hash = "of the whole";
    const run::Plan part = cluster::shardPlan(plan, {2, 2}, std::vector<int>{0, 1});
    ASSERT_EQ(part.cases.size(), 1U);
    EXPECT_EQ(part.cases[0].id, plan.cases[1].id);
    ASSERT_EQ(part.experiments.size(), 1U);
    EXPECT_EQ(part.experiments[0].id, "q/2");
    EXPECT_EQ(part.sceneKeys.size(), 2U);
    EXPECT_TRUE(part.sceneKeys.contains("models/of-q/2"));
    EXPECT_TRUE(part.sceneKeys.contains("models/b-of-q/2"));
    EXPECT_EQ(part.hash, plan.hash);
    EXPECT_EQ(part.shard->name(), "2/2");
}

/// A case is another one where any of its scenes is; parameters that name none say nothing.
TEST(Plans, EveryModelOfACaseIsInItsId) {
    run::Plan plan;
    Case item = makeCase("q/1", "a", 1);
    item.scene = Node::scalar("a.obj");
    plan.sceneKeys = {{"a.obj", "a"}, {"b.obj", "b"}};
    const auto id = [&] { return run::caseId(item, run::toJson(item), plan); };
    item.params.set("scene_b", Node::scalar(""));
    const std::string ofOne = id();
    plan.sceneKeys["b.obj"] = "another";
    EXPECT_EQ(id(), ofOne);
    item.params.set("scene_b", Node::scalar("b.obj"));
    const std::string ofTwo = id();
    plan.sceneKeys["b.obj"] = "b";
    EXPECT_NE(id(), ofTwo);
    plan.sceneKeys["a.obj"] = "another";
    EXPECT_NE(id(), ofTwo);
}

using cluster::mergeRuns;

/// Four quality cases q/1, then two timing cases t/1.
run::Plan makePlan() {
    run::Plan plan{.hash = "0123456789abcdef"};
    for (int size = 1; size <= 4; ++size) plan.cases.push_back(makeCase("q/1", "a", size));
    for (int size = 1; size <= 2; ++size) {
        plan.cases.push_back(makeCase("t/1", "a", size, Lane::Timing));
    }
    return plan;
}

TEST(Merge, RecordsAreInTheOrderOfThePlan) {
    const run::Plan plan = makePlan();
    const run::StoredRun merged = mergeRuns(
        plan, {makeShard(plan, 2, 2, {5, 4, 1}), makeShard(plan, 1, 2, {3, 0, 2})}, "merge");
    std::vector<double> values;
    for (const records::Record& row : merged.records) values.push_back(row.value);
    EXPECT_THAT(values, ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_FALSE(merged.plan.shard);
    EXPECT_THAT(cluster::missingUnits(merged), IsEmpty());
    EXPECT_EQ(run::completeness(merged).missing, 0);
    EXPECT_EQ(merged.manifest["merged"].size(), 2U);
    EXPECT_EQ(merged.manifest["merged"][0]["shard"], "2/2");
    EXPECT_TRUE(run::isOnlyMerged(merged.manifest));
    run::Json continued = merged.manifest;
    run::beginInvocation(continued, "run --resume");
    EXPECT_FALSE(run::isOnlyMerged(continued));
}

/// Rounds beyond those asked for are in no list of units but the records'.
TEST(Merge, KeepsFurtherRounds) {
    run::Plan plan = makePlan();
    for (const std::size_t i : {4, 5}) {
        plan.cases[i].measure.processes = 6;
        plan.cases[i].measure.timeBudgetS = 60.0;
    }
    std::vector<cluster::ShardRun> shards = {makeShard(plan, 1, 2, {0, 1}),
                                             makeShard(plan, 2, 2, {2, 3, 4, 5})};
    for (int process = 1; process < 8; ++process) {
        for (const std::size_t i : {5, 4}) {
            shards[1].run.records.push_back(makeRow(plan.cases[i], 0.0, process));
        }
    }
    shards[1].run.manifest["rounds"] = {{"t/1", {{"rounds", 8}}}};
    shards[0].run.manifest["machine_states"] = {{"t/2", {{"hottest_c", 40.0}}}};
    shards[1].run.manifest["machine_states"] = {{"t/1", {{"hottest_c", 50.0}}}};
    const run::StoredRun merged = mergeRuns(plan, shards, "merge");
    EXPECT_EQ(merged.records.size(), 4U + 16U);
    EXPECT_EQ(merged.records.back().process, 7);
    EXPECT_EQ(merged.records.back().caseId, plan.cases[4].id) << "odd rounds go backwards";
    EXPECT_EQ(merged.manifest["rounds"]["t/1"]["rounds"], 8);
    EXPECT_EQ(merged.manifest["machine_states"]["t/1"]["hottest_c"], 50.0);
    EXPECT_EQ(merged.manifest["machine_states"]["t/2"]["hottest_c"], 40.0);
    EXPECT_EQ(run::completeness(merged).units, 20);
    EXPECT_EQ(run::completeness(merged).missing, 0);
    shards[1].run.records.pop_back();  // round 7 was interrupted
    EXPECT_THAT(cluster::missingUnits(mergeRuns(plan, shards, "merge")),
                ElementsAre("t/1 method=a size=1 process 8"));
}

/// What would be written and not be read again is refused before anything is.
TEST(Merge, RefusesMoreThanIsReadOfARun) {
    const TemporaryFolder folder;
    const run::Plan plan = makePlan();
    std::vector<cluster::ShardRun> shards = {makeShard(plan, 1, 2, {0, 1}),
                                             makeShard(plan, 2, 2, {2, 3})};
    for (cluster::ShardRun& shard : shards) shard.path = folder.path() / shard.path;
    const auto merged = [&](const std::string& file, std::uintmax_t bytes) {
        for (const cluster::ShardRun& shard : shards) {
            fs::create_directories((shard.path / file).parent_path());
            std::ofstream{shard.path / file};
            fs::resize_file(shard.path / file, bytes);  // of holes
        }
        const std::string problem = errorText([&] { mergeRuns(plan, shards, "merge"); });
        for (const cluster::ShardRun& shard : shards) fs::remove(shard.path / file);
        return problem;
    };
    const auto refused = [](const std::string& file, std::uintmax_t bytes, std::uintmax_t most) {
        return "the " + file + " of the shards have " + std::to_string(bytes) +
               " bytes together; at most " + std::to_string(most) +
               " are read of a run. Merge them in parts, or read each by itself";
    };
    const std::uintmax_t gib = std::uintmax_t{1} << 30;
    EXPECT_EQ(merged("journal.jsonl", 2 * gib), refused("journal.jsonl", 4 * gib + 2, 4 * gib));
    EXPECT_EQ(merged("records.csv", 8 * gib), refused("records.csv", 16 * gib + 2, 16 * gib));
    EXPECT_EQ(merged("images/index.csv", 2 * gib),
              refused("images/index.csv", 4 * gib + 2, 4 * gib));
    EXPECT_EQ(merged("journal.jsonl", 2 * gib - 1), "no error");
}

TEST(Merge, NamesWhatIsMissing) {
    const run::Plan plan = makePlan();
    std::vector<cluster::ShardRun> shards = {makeShard(plan, 1, 3, {0, 2}),
                                             makeShard(plan, 3, 3, {4, 5})};
    shards[0].run.records.pop_back();  // planned there, not measured
    EXPECT_THAT(cluster::missingUnits(mergeRuns(plan, shards, "merge")),
                ElementsAre("q/1 method=a size=2", "q/1 method=a size=3", "q/1 method=a size=4"));
    EXPECT_THAT(cluster::missingShards(shards), ElementsAre("2/3"));
}

TEST(Merge, AMissingProcessIsMissing) {
    run::Plan plan = makePlan();
    plan.cases.resize(1);
    plan.cases[0].measure.processes = 2;
    EXPECT_THAT(cluster::missingUnits(mergeRuns(plan, {makeShard(plan, 1, 1, {0})}, "merge")),
                ElementsAre("q/1 method=a size=1 process 2"));
}

TEST(Merge, RefusesDifferentPlans) {
    const run::Plan plan = makePlan();
    run::Plan other = plan;
    other.hash = "fedcba9876543210";
    other.buildId = "another build";
    EXPECT_EQ(
        errorText([&] {
            mergeRuns(plan, {makeShard(plan, 1, 2, {0}), makeShard(other, 2, 2, {1})}, "merge");
        }),
        "s1 and s2 are shards of different plans (0123456789ab, fedcba987654): the program or a "
        "shader changed (build  then, another buil now)");
}

TEST(Merge, RefusesACaseThatTwoHave) {
    const run::Plan plan = makePlan();
    EXPECT_EQ(
        errorText([&] {
            mergeRuns(plan, {makeShard(plan, 1, 2, {0, 1}), makeShard(plan, 2, 3, {1, 2})}, "");
        }),
        "the case 'q/1 method=a size=2' is in both s1 and s2: these are no shards of one cut");
    // Planned in one and measured in the other is no better.
    std::vector<cluster::ShardRun> shards = {makeShard(plan, 1, 2, {0, 1}),
                                             makeShard(plan, 2, 2, {1})};
    shards[0].run.records.pop_back();
    EXPECT_EQ(
        errorText([&] { mergeRuns(plan, shards, ""); }),
        "the case 'q/1 method=a size=2' is in both s1 and s2: these are no shards of one cut");
}

TEST(Merge, RefusesACaseThatThePlanHasNot) {
    run::Plan plan = makePlan();
    const std::vector<cluster::ShardRun> shards = {makeShard(plan, 1, 2, {0, 3})};
    plan.cases.erase(plan.cases.begin() + 3);
    EXPECT_EQ(errorText([&] { mergeRuns(plan, shards, ""); }),
              "s1: its case q/1 a 4 of q/1 is not in the plan of the shards");
}

/// Submitted where no GPU is, measured where one is: the shards say so, and no file is written
/// anew.
TEST(Merge, TheWholePlanIsOfTheDevicesThatMeasured) {
    const TemporaryFolder folder;
    run::Plan whole = makePlan();
    whole.deviceClass = "software";
    for (config::Case& item : whole.cases) {
        item.given = Node::map({});
        item.id = run::caseId(item, run::toJson(item), whole);
    }
    const auto file = folder.path() / cluster::kSubmittedPlan;
    whole.writeFile(file);
    cluster::ShardRun shard{folder.path() / "shards/2", {}};
    fs::create_directories(shard.path);
    shard.run.plan =
        cluster::shardPlan(whole, {2, 2, sha256OfFile(file)}, std::vector<int>{0, 0, 1, 1, 0, 0});
    run::rebind(shard.run.plan, "gpu");
    const run::Plan found = cluster::wholePlan({shard});
    EXPECT_EQ(found.deviceClass, "gpu");
    EXPECT_EQ(found.hash, whole.hash);
    EXPECT_EQ(found.cases[2].id, shard.run.plan.cases[0].id);
    EXPECT_NE(found.cases[2].id, whole.cases[2].id);
    EXPECT_EQ(run::planDifference(whole, shard.run.plan),
              "the run began on a software device, this one is a gpu device");
    shard.run.plan.shard->whole = "another";
    EXPECT_EQ(errorText([&] { cluster::wholePlan({shard}); }),
              file.string() + ": is not the plan that " + shard.path.string() +
                  " is a shard of: it was changed");
}

TEST(Merge, RefusesToMixDevicesInOneTable) {
    const run::Plan plan = makePlan();
    EXPECT_EQ(errorText([&] {
                  mergeRuns(plan,
                            {makeShard(plan, 1, 2, {0, 4}, "GPU A"),
                             makeShard(plan, 2, 2, {1, 5}, "GPU B")},
                            "merge");
              }),
              "the times of t/1 would mix devices: s1 was measured on CPU, 2 cores, GPU A, 4.5; s2 "
              "on CPU, 2 cores, GPU B, 4.5");
}

TEST(Merge, DevicesMayDifferElsewhere) {
    const run::Plan plan = makePlan();
    const run::StoredRun merged = mergeRuns(
        plan,
        {makeShard(plan, 1, 2, {0, 2, 4, 5}, "GPU A"), makeShard(plan, 2, 2, {1, 3}, "GPU B")},
        "merge");
    EXPECT_EQ(merged.manifest["gl"]["renderer"], "GPU A; GPU B");
    EXPECT_EQ(merged.manifest["timing_machines"], (run::Json{{"t/1", "CPU, 2 cores, GPU A, 4.5"}}));
}

TEST(Merge, AShardThatMovedTellsTheMachineOfItsTimes) {
    const run::Plan plan = makePlan();
    std::vector<cluster::ShardRun> shards = {makeShard(plan, 1, 2, {0, 4}, "GPU A"),
                                             makeShard(plan, 2, 2, {1, 5}, "GPU A")};
    shards[1].run.manifest["timing_machines"]["t/1"] = "another node";
    EXPECT_EQ(errorText([&] { mergeRuns(plan, shards, "merge"); }),
              "the times of t/1 would mix devices: s1 was measured on CPU, 2 cores, GPU A, 4.5; s2 "
              "on another node");
}

/// A run directory with these rows.
run::RunDirectory directoryWith(const TemporaryFolder& folder, const cluster::ShardRun& shard) {
    run::RunDirectory directory = run::RunDirectory::create(folder.path());
    records::RecordWriter(directory.recordsFile()).append(shard.run.records);
    return directory;
}

using ForeignTimes = FolderTest;

TEST_F(ForeignTimes, UnfinishedTablesAreMeasuredAgain) {
    const run::Plan plan = makePlan();
    cluster::ShardRun shard = makeShard(plan, 1, 1, {0, 1, 4}, "GPU A");  // 5, of times, is missing
    shard.run.plan.shard.reset();
    const run::RunDirectory directory = directoryWith(folder, shard);
    EXPECT_THAT(run::replaceForeignTimes(plan, directory, {}, shard.run.manifest,
                                         run::machineName(shard.run.manifest)),
                IsEmpty());
    EXPECT_EQ(records::readRecords(directory.recordsFile()).size(), 3U);

    EXPECT_THAT(run::replaceForeignTimes(plan, directory, {}, shard.run.manifest, "another node"),
                ElementsAre("t/1"));
    EXPECT_EQ(run::timingMachine(shard.run.manifest, "t/1"), "another node");
    const std::vector<records::Record> kept = records::readRecords(directory.recordsFile());
    ASSERT_EQ(kept.size(), 2U);
    EXPECT_EQ(kept[1].caseId, plan.cases[1].id);
    // Nothing measured is lost.
    const auto replaced = records::readRecords(folder.path() / "records-replaced.csv");
    ASSERT_EQ(replaced.size(), 1U);
    EXPECT_EQ(replaced[0].caseId, plan.cases[4].id);
    // Two quality cases and both timing cases.
    EXPECT_EQ(run::remainingUnits(plan, directory).size(), 4U);
}

TEST_F(ForeignTimes, TablesBetweenTwoRoundsAreMeasuredAgain) {
    run::Plan plan = makePlan();
    for (config::Case& item : plan.cases) {
        if (item.measure.lane == config::Measure::Lane::Quality) continue;
        item.measure.timeBudgetS = 60.0;
        item.measure.processes = 2;
        item.measure.isWithinBudget = true;
    }
    cluster::ShardRun shard = makeShard(plan, 1, 1, {0, 4, 5}, "GPU A");
    const run::RunDirectory directory = directoryWith(folder, shard);
    const run::Json ended = {{"event", "rounds"}, {"table", "t/1"}, {"rounds", 1}};
    EXPECT_THAT(run::replaceForeignTimes(plan, directory, {ended}, shard.run.manifest, "another"),
                IsEmpty());
    EXPECT_THAT(run::replaceForeignTimes(plan, directory, {}, shard.run.manifest, "another"),
                ElementsAre("t/1"));
}

TEST_F(ForeignTimes, FinishedTablesStay) {
    const run::Plan plan = makePlan();
    cluster::ShardRun shard = makeShard(plan, 1, 1, {0, 4, 5}, "GPU A");
    const run::RunDirectory directory = directoryWith(folder, shard);
    EXPECT_THAT(run::replaceForeignTimes(plan, directory, {}, shard.run.manifest, "another node"),
                IsEmpty());
    EXPECT_EQ(run::timingMachine(shard.run.manifest, "t/1"), "CPU, 2 cores, GPU A, 4.5");
    EXPECT_EQ(records::readRecords(directory.recordsFile()).size(), 3U);
}

}  // namespace

}  // namespace gfxrepro::test
