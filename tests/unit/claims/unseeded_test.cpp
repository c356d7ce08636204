// Verdicts on what a program or an import says of itself, where its numbers differ when they are
// taken again, or its sweep has the seeds.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "engine/core/random.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::claims {
namespace {

enum class Of { Import, Program };

config::Experiment experimentOf(Of of, const std::string& body) {
    config::Experiment experiment = tables::experimentFrom(body);
    experiment.technique = of == Of::Import ? config::kImported : "external";
    if (of == Of::Program) {
        experiment.document.set("program", parseYaml("{command: x}", "t.yaml"));
    }
    return experiment;
}

ClaimResult resultOf(const config::Experiment& experiment, const tables::Recorded& records) {
    return evaluateClaims(experiment, tables::buildTable(experiment, records),
                          {"llvmpipe", "software", "quick", "abc", ""})[0];
}

const std::string kOneBesideMany =
    "one process of numbers that differ when they are taken again; " + tables::kNeedsSix;

/// `one` in the first process alone, `many` in each of six, where it differs unless `isSure`;
/// `one` of that frame.
ClaimResult judgeOneBesideMany(Of of, const std::string& one, const std::string& claim,
                               bool isSure = false, int frame = 0) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})");
    for (int process = 0; process < 6; ++process) {
        maker.process(process).frame(0).add("many", {isSure ? 1.0 : 1.0 + 0.01 * process}, "", "1");
        if (process == 0) maker.frame(frame).add(one, {0.5}, "", "1");
    }
    const std::string body =
        "sweep: {n: [1]}\nlayout: {rows: n, columns: {one: {metric: " + one +
        "}, many: {metric: many}, both: {of: one / many}}}\nclaims: {C: {says: so, " + claim +
        "}}\n";
    return resultOf(experimentOf(of, body), maker.records());
}

TEST(Unseeded, OneProcessOfAnotherMetricBesideManyDecidesNothing) {
    for (const char* claim : {"order: one < many", "ratio: one / many, at_most: 1",
                              "bound: both, at_most: 1", "bound: one, at_most: 1"}) {
        for (const Of of : {Of::Import, Of::Program}) {
            const ClaimResult result = judgeOneBesideMany(of, "value", claim);
            EXPECT_EQ(result.verdict, Verdict::Ambiguous) << claim;
            EXPECT_EQ(result.reason, kOneBesideMany) << claim;
            EXPECT_EQ(judgeOneBesideMany(of, "value", claim, true).verdict, Verdict::Holds)
                << "what does not differ is certain: " << claim;
        }
    }
}

/// What stands under frame −1 is of the set-up, and draws nothing, unless it differs itself.
TEST(Unseeded, WhatSetUpRecordedIsKnownBesideWhatDiffers) {
    for (const char* claim : {"order: one < many", "ratio: one / many, at_most: 1",
                              "bound: both, at_most: 1", "exact: one, equals: 0.5"}) {
        EXPECT_EQ(judgeOneBesideMany(Of::Import, "value", claim, false, records::kSetup).verdict,
                  Verdict::Holds)
            << claim;
    }
}

/// Rows a, b and c: `many` differs in a, of which the layout need not have a column; b and c share
/// other metrics with it.
TEST(Unseeded, WhatDiffersIsOfWhatWasMeasuredWhateverIsShown) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})");
    for (int process = 0; process < 6; ++process) {
        maker.process(process).add("many", {1.0 + 0.01 * process}, "", "1");
        maker.add("seen", {2.0}, "", "1");
    }
    for (const int n : {2, 3}) {
        maker.beginCase("", fmt::format(R"({{"n":{}}})", n)).process(0);
        maker.add(n == 2 ? "seen" : "other", {2.0}, "", "1").add("one", {0.5}, "", "1");
    }
    for (const Of of : {Of::Import, Of::Program}) {
        for (const char* columns : {"one: {metric: one}", "one: {metric: one, scale: 2}",
                                    "one: {metric: one}, many: {metric: many}"}) {
            for (const char* claim :
                 {"bound: one, at_most: 1, at: {n: [2, 3]}", "exact: one, equals: 0.5, at: {n: 3}",
                  "order: [n=2, n=3], of: one"}) {
                const ClaimResult result = resultOf(
                    experimentOf(of,
                                 fmt::format("sweep: {{n: [1, 2, 3]}}\nlayout: {{rows: n, columns: "
                                             "{{{}}}}}\nclaims: {{C: {{says: so, {}}}}}\n",
                                             columns, claim)),
                    maker.records());
                EXPECT_EQ(result.verdict, Verdict::Ambiguous) << columns << claim;
                EXPECT_THAT(result.reason, HasSubstr(kOneBesideMany)) << columns << claim;
            }
        }
    }
}

/// Of a program the first process records the error, and the others that their picture is the same.
TEST(Unseeded, TheErrorOfAPictureThatEachProcessMakesIsKnown) {
    const std::string claim = "bound: one, at_most: 1";
    EXPECT_EQ(judgeOneBesideMany(Of::Program, "rmse", claim).verdict, Verdict::Holds);
    EXPECT_EQ(judgeOneBesideMany(Of::Import, "rmse", claim).verdict, Verdict::Ambiguous);
}

/// As where the budget of times ends with the first round.
TEST(Unseeded, OneProcessOfSeveralThatWereAskedForDecidesNothing) {
    const auto judge = [](Of of, const std::string& metric, int asked, const std::string& claim) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})").add(metric, {0.4}, "", "1");
        maker.beginCase("", R"({"n":2})").add(metric, {0.5}, "", "1");
        tables::Recorded records = maker.records();
        for (config::Case& one : records.cases) one.measure.processes = asked;
        const std::string body =
            "sweep: {n: [1, 2]}\nlayout: {rows: n, columns: {one: {metric: " + metric +
            "}, half: {of: one / 2}}}\nclaims: {C: {says: so, " + claim + "}}\n";
        return resultOf(experimentOf(of, body), records);
    };
    for (const char* claim : {"order: [n=1, n=2], of: one", "bound: half, at_most: 1, at: {n: 1}",
                              "exact: one, equals: 0.4, at: {n: 1}"}) {
        for (const char* metric : {"value", "rmse"}) {
            const ClaimResult result = judge(Of::Program, metric, 6, claim);
            EXPECT_EQ(result.verdict, Verdict::Ambiguous) << claim;
            EXPECT_THAT(
                result.reason,
                HasSubstr("one process of a program without a seed; `measure: {processes: 2}` "
                          "tells whether another comes to the same, `processes: 1` says so"))
                << claim;
            EXPECT_EQ(judge(Of::Program, metric, 1, claim).verdict, Verdict::Holds) << claim;
            EXPECT_EQ(judge(Of::Import, metric, 6, claim).verdict, Verdict::Ambiguous) << claim;
            EXPECT_EQ(judge(Of::Import, metric, 1, claim).verdict, Verdict::Holds) << claim;
        }
    }
}

/// Of an import: one metric has a seed in each of its rows, the other in none.
TEST(Unseeded, WhatHasNoSeedBesideWhatHasOneDrawsNone) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})").seeds(config::Measure::Seeds::Process);
    for (int process = 0; process < 6; ++process) {
        maker.process(process).frame(0).add("many", {1.0 + 0.01 * process}, "", "1");
        if (process == 0) maker.frame(records::kSetup).add("rays", {4.0}, "", "ray");
    }
    const std::string body =
        "sweep: {n: [1]}\nlayout: {rows: n, columns: {rays: {metric: rays}, many: {metric: "
        "many}}}\nclaims: {C: {says: so, exact: rays, equals: 4}}\n";
    EXPECT_EQ(resultOf(experimentOf(Of::Import, body), maker.records()).verdict, Verdict::Holds);
}

/// The logarithm of most integers, and back, is another number.
TEST(Unseeded, EqualNumbersAreAtTheirBound) {
    for (const double count : {3.0, 5.0, 8.0, 64.0, 100.0, 1000.0, 12345.0}) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})");
        for (int process = 0; process < 6; ++process) {
            maker.process(process).add("many", {1.0 + 0.01 * process}, "", "1");
            maker.add("rays", {count}, "", "ray");
        }
        for (const auto& [limit, verdict] : {std::pair("at_most", Verdict::Holds),
                                             {"at_least", Verdict::Holds},
                                             {"more_than", Verdict::Fails},
                                             {"less_than", Verdict::Fails}}) {
            const std::string body = fmt::format(
                "sweep: {{n: [1]}}\nlayout: {{rows: n, columns: {{rays: {{metric: rays}}, many: "
                "{{metric: many}}}}}}\nclaims: {{C: {{says: so, bound: rays, {}: {}}}}}\n",
                limit, count);
            EXPECT_EQ(resultOf(experimentOf(Of::Import, body), maker.records()).verdict, verdict)
                << limit << ' ' << count;
        }
    }
}

/// `heap` differs in three processes; the verdict on the other number.
Verdict besideWhatDiffers(const std::string& name, const std::string& unit,
                          const std::string& other, const std::string& otherUnit) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})");
    for (int process = 0; process < 3; ++process) {
        maker.process(process).add(name, {1e6 + 10.0 * process}, "", unit);
        maker.add(other, {4.0}, "", otherUnit);
    }
    const std::string body = fmt::format(
        "sweep: {{n: [1]}}\nlayout: {{rows: n, columns: {{other: {{metric: {}}}}}}}\n"
        "claims: {{C: {{says: so, bound: other, at_least: 1}}}}\n",
        other);
    return resultOf(experimentOf(Of::Import, body), maker.records()).verdict;
}

/// Memory, energy, power, heat and clocks differ in any program, and say nothing of what it
/// computes.
TEST(Unseeded, MemoryAndEnergyTellOfTheirLikeAlone) {
    for (const char* unit :
         {"byte",      "bytes", "Byte", "B",   "kB",  "kb", "KB",  "KBytes",    "MB",  "mb",
          "megabytes", "GB",    "TB",   "KiB", "MiB", "Mi", "GiB", "gibibytes", "J",   "kJ",
          "Wh",        "kWh",   "W",    "mW",  "°C",  "Hz", "MHz", "GHz",       "watt"}) {
        EXPECT_EQ(besideWhatDiffers("heap", unit, "rays", "ray"), Verdict::Holds) << unit;
        EXPECT_EQ(besideWhatDiffers("heap", unit, "stack", "kB"), Verdict::Ambiguous) << unit;
    }
    EXPECT_EQ(besideWhatDiffers("peak_memory_mb", "1", "rays", "ray"), Verdict::Holds);
    EXPECT_EQ(besideWhatDiffers("peak_memory_mb", "1", "stack", "kB"), Verdict::Ambiguous);
    for (const char* unit : {"1", "%", "ray", "kbit", "m", "Gray"}) {
        EXPECT_EQ(besideWhatDiffers("heap", unit, "rays", "ray"), Verdict::Ambiguous) << unit;
    }
}

/// A sum in another order is the same number.
TEST(Unseeded, NumbersThatDifferByTheirRoundingAreEqual) {
    for (const int processes : {2, 3, 5, 6}) {
        for (const bool isBesideNoise : {false, true}) {
            tables::RecordMaker maker;
            for (const int n : {1, 2}) {
                maker.beginCase("", fmt::format(R"({{"n":{}}})", n));
                for (int process = 0; process < processes; ++process) {
                    const double rounding = 1.0 + 2e-16 * process;
                    maker.process(process).add("e", {(n == 1 ? 0.4 : 0.5) * rounding}, "", "1");
                    if (isBesideNoise) maker.add("noise", {1.0 + 0.1 * process}, "", "1");
                }
            }
            for (const char* claim : {"order: [n=1, n=2], of: e", "bound: e, at_least: 0.3",
                                      "ratio: n=1 / n=2, of: e, at_most: 0.81"}) {
                const ClaimResult result = resultOf(
                    experimentOf(Of::Import, fmt::format("sweep: {{n: [1, 2]}}\nlayout: {{rows: n, "
                                                         "columns: {{e: {{metric: e}}}}}}\n"
                                                         "claims: {{C: {{says: so, {}}}}}\n",
                                                         claim)),
                    maker.records());
                const bool isOpen = isBesideNoise && processes < 6;
                EXPECT_EQ(result.verdict, isOpen ? Verdict::Ambiguous : Verdict::Holds) << claim;
                EXPECT_EQ(result.reason,
                          isOpen
                              ? fmt::format("{}{} equal processes beside numbers that differ; {}",
                                            claim[0] == 'b' ? "worst at n 1; " : "", processes,
                                            tables::kNeedsSix)
                              : std::string(claim[0] == 'b' ? "worst at n 1" : ""))
                    << claim;
                EXPECT_THAT(result.measured, Not(HasSubstr("…"))) << claim;
            }
        }
    }
}

/// What a device counts may differ between processes, which are no scenes.
TEST(Unseeded, CountsOfADeviceThatDifferNeedSixProcesses) {
    const auto judge = [](int processes) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})");
        for (int process = 0; process < processes; ++process) {
            maker.process(process).add("work_fragments", {100.0 + process}, "", "1");
        }
        return resultOf(tables::experimentFrom(
                            "sweep: {n: [1]}\nlayout: {rows: n, columns: {w: {metric: "
                            "work_fragments}}}\nclaims: {C: {says: so, bound: w, at_least: 1}}\n"),
                        maker.records());
    };
    EXPECT_EQ(judge(5).verdict, Verdict::Ambiguous);
    EXPECT_EQ(judge(5).reason, "a range of 5 processes; " + tables::kNeedsSix);
    EXPECT_EQ(judge(6).verdict, Verdict::Holds);
}

/// Numbers of two values, one as likely as the other, beside one that always differs: how often
/// `exact` holds and fails on the first in `processes` processes.
std::map<Verdict, int> exactByChance(int processes, int trials) {
    const config::Experiment experiment = experimentOf(
        Of::Import,
        "sweep: {n: [1]}\nlayout: {rows: n, columns: {a: {metric: a}, b: {metric: b}}}\n"
        "claims: {C: {says: so, exact: a, equals: 5}}\n");
    Random random(1);
    std::map<Verdict, int> verdicts;
    for (int trial = 0; trial < trials; ++trial) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})");
        for (int process = 0; process < processes; ++process) {
            const double isSix = double{random.uniform()} < 0.5 ? 1.0 : 0.0;
            maker.process(process).add("a", {5.0 + isSix}, "", "1");
            maker.add("b", {double{random.uniform()}}, "", "1");
        }
        ++verdicts[resultOf(experiment, maker.records()).verdict];
    }
    return verdicts;
}

TEST(Unseeded, FewEqualProcessesOfARandomProgramAreNoExactNumber) {
    constexpr int kTrials = test::kIsSanitized ? 4 : 1000;
    for (const int processes : {2, 3, 5}) {
        EXPECT_EQ(exactByChance(processes, kTrials)[Verdict::Ambiguous], kTrials) << processes;
    }
    std::map<Verdict, int> six = exactByChance(6, kTrials);
    if (test::kIsSanitized) return;
    EXPECT_LE(six[Verdict::Holds] + six[Verdict::Fails], 0.05 * kTrials);
}

/// Rows m × …: an import whose config sweeps the seed; `b` is as much above `a`.
ClaimResult judgeSwept(const std::string& layout, int seeds, double ratio, Random& random) {
    tables::RecordMaker maker;
    std::string values;
    for (int seed = 0; seed < seeds; ++seed) {
        values += fmt::format("{}{}", seed == 0 ? "" : ", ", seed);
        for (const char* m : {"a", "b"}) {
            maker.beginCase("", fmt::format(R"({{"m":"{}","seed":{}}})", m, seed));
            const double value = 1.0 + 0.05 * (double{random.uniform()} - 0.5);
            maker.add("e", {m[0] == 'a' ? value : ratio * value}, "", "1");
        }
    }
    const std::string body = fmt::format(
        "sweep: {{m: [a, b], seed: [{0}]}}\n"
        "layout: {{{1}}}\nclaims: {{C: {{says: so, order: [a, b], of: e}}}}\n",
        values, fmt::format(fmt::runtime(layout), values));
    return resultOf(experimentOf(Of::Import, body), maker.records());
}

/// A number of two values, one as likely as the other, beside which nothing is known.
Verdict exactOfSeeds(const std::string& layout, const std::string& at, int seeds, Random& random) {
    tables::RecordMaker maker;
    std::string values;
    for (int seed = 0; seed < seeds; ++seed) {
        values += fmt::format("{}{}", seed == 0 ? "" : ", ", seed);
        maker.beginCase("", fmt::format(R"({{"seed":{}}})", seed));
        maker.add("e", {double{random.uniform()} < 0.5 ? 4.0 : 5.0}, "", "1");
    }
    const std::string body = fmt::format(
        "sweep: {{seed: [{}]}}\nlayout: {{{}}}\nclaims: {{C: {{says: so, exact: e, equals: "
        "4{}}}}}\n",
        values, fmt::format(fmt::runtime(layout), values), at);
    return resultOf(experimentOf(Of::Import, body), maker.records()).verdict;
}

TEST(Unseeded, ANumberOfASeedIsExactInSixOrMore) {
    constexpr int kTrials = test::kIsSanitized ? 4 : 400;
    Random random(3);
    const std::string pooled = "columns: {{e: {{metric: e, where: {{seed: [{}]}}}}}}";
    std::map<Verdict, int> six;
    for (int trial = 0; trial < kTrials; ++trial) {
        for (const int seeds : {2, 3, 5}) {
            EXPECT_EQ(exactOfSeeds(pooled, "", seeds, random), Verdict::Ambiguous) << seeds;
        }
        const std::string rows = "rows: seed, columns: {{e: {{metric: e}}}}";
        EXPECT_EQ(exactOfSeeds(rows, ", at: {seed: 1}", 3, random), Verdict::Ambiguous);
        ++six[exactOfSeeds(pooled, "", 6, random)];
    }
    if (test::kIsSanitized) return;
    EXPECT_LE(six[Verdict::Holds] + six[Verdict::Fails], 0.05 * kTrials);
    EXPECT_GT(six[Verdict::Holds], 0) << "all of six";
}

/// A baseline that draws nothing stands beside each of the others' seeds; the plan of a program
/// says that all of its cases have seeds.
TEST(Unseeded, WhatTheSweepLeavesWithoutASeedIsCertain) {
    using Seeds = config::Measure::Seeds;
    const auto recorded = [](Seeds seeds) {
        tables::RecordMaker maker;
        const int processes = seeds == Seeds::Process ? 6 : 1;
        for (int seed = -1; seed < 6; ++seed) {
            const bool isLeft = seed < 0;
            maker.beginCase(
                "", isLeft ? R"({"m":"a"})" : fmt::format(R"({{"m":"b","seed":{}}})", seed));
            maker.seeds(seeds);
            for (int process = 0; process < processes; ++process) {
                const double value = isLeft ? 0.4 : 0.5 + 0.01 * (seed + process);
                maker.process(process).add("e", {value}, "", "1");
            }
        }
        tables::Recorded records = maker.records();
        for (std::size_t i = 1; i < records.cases.size(); ++i) records.cases[i].seed = i - 1;
        return records;
    };
    const std::string body =
        "sweep: {m: [a, b], seed: [0, 1, 2, 3, 4, 5], when: {seed: {m: b}}}\n"
        "layout: {rows: m, columns: {e: {metric: e, where: {seed: [0, 1, 2, 3, 4, 5]}}}}\n"
        "claims: {C: {says: so, order: [a, b], of: e}}\n";
    for (const auto& [of, seeds] : {std::pair(Of::Import, Seeds::None),
                                    {Of::Program, Seeds::Case},
                                    {Of::Program, Seeds::Process}}) {
        const ClaimResult result = resultOf(experimentOf(of, body), recorded(seeds));
        EXPECT_EQ(result.verdict, Verdict::Holds) << result.reason;
    }
}

/// Two methods, each with `processes` values at each of six values of an axis that rows do not
/// name.
ClaimResult judgeTogether(Of of, const std::string& axis, int processes, const std::string& claim,
                          double apart = 0.0) {
    tables::RecordMaker maker;
    for (const char* m : {"b", "c"}) {
        for (int trial = 0; trial < 6; ++trial) {
            const std::string name = axis == "scene" ? "other" : axis;
            maker.beginCase(axis == "scene" ? fmt::format("s{}", trial) : "",
                            fmt::format(R"({{"m":"{}","{}":{}}})", m, name, trial));
            for (int process = 0; process < processes; ++process) {
                maker.process(process).add(
                    "e", {(m[0] == 'b' ? 0.4 : 0.5) + 0.01 * trial + apart * process}, "", "1");
            }
        }
    }
    const bool isScene = axis == "scene";
    const std::string values = isScene ? "[s0, s1, s2, s3, s4, s5]" : "[0, 1, 2, 3, 4, 5]";
    return resultOf(
        experimentOf(of, fmt::format("sweep: {{m: [b, c], {0}: {1}}}\nlayout: {{rows: m, columns: "
                                     "{{e: {{metric: e, where: {{{0}: {1}}}}}, half: {{of: e / "
                                     "2}}}}}}\nclaims: {{C: {{says: so, {2}}}}}\n",
                                     axis, values, claim)),
        maker.records());
}

/// Whatever the axis is called: it may be a number of trials.
TEST(Unseeded, WhatIsTakenTogetherOfCasesMeasuredOnceDecidesNothing) {
    const std::string order = "order: [b, c], of: e";
    for (const Of of : {Of::Import, Of::Program}) {
        for (const std::string claim :
             {order, std::string("order: [b, c], of: half"), std::string("bound: e, at_most: 1"),
              std::string("ratio: m=b / m=c, of: e, at_most: 1"),
              std::string("exact: e, equals: 0.425, at: {m: b}")}) {
            const ClaimResult once = judgeTogether(of, "run", 1, claim);
            EXPECT_EQ(once.verdict, Verdict::Ambiguous) << claim;
            EXPECT_THAT(
                once.reason,
                HasSubstr("takes values of 'run' together that were measured once each, and may "
                          "repeat one case: an axis of rows tells them apart; what repeats a case "
                          "is its processes (of an import the column 'process', or 'seed')"))
                << claim;
        }
        EXPECT_EQ(judgeTogether(of, "run", 2, order).verdict, Verdict::Holds) << "known by now";
        EXPECT_EQ(judgeTogether(of, "run", 2, order, 0.01).verdict, Verdict::Ambiguous);
        EXPECT_EQ(judgeTogether(of, "run", 6, order, 0.01).verdict, Verdict::Holds);
        EXPECT_EQ(judgeTogether(of, "scene", 1, order).verdict, Verdict::Holds);
        EXPECT_EQ(judgeTogether(of, "scene_seed", 1, order).verdict, Verdict::Ambiguous);
    }
}

/// What has no seed was measured once, whatever seeds others of the case have.
TEST(Unseeded, AMetricWithoutSeedsBesideOneWithSomeIsTakenTogetherLikewise) {
    tables::RecordMaker maker;
    for (const char* m : {"b", "c"}) {
        for (int trial = 0; trial < 5; ++trial) {
            maker.beginCase("", fmt::format(R"({{"m":"{}","trial":{}}})", m, trial));
            maker.seeds(config::Measure::Seeds::Process);
            maker.frame(records::kSetup);
            maker.add("once", {(m[0] == 'b' ? 0.4 : 0.5) + 0.01 * trial}, "", "1");
            for (int process = 0; process < 6; ++process) {
                maker.process(process).frame(0).add("drawn", {1.0 + 0.01 * process}, "", "1");
            }
        }
    }
    const ClaimResult result =
        resultOf(experimentOf(Of::Import,
                              "sweep: {m: [b, c], trial: [0, 1, 2, 3, 4]}\nlayout: {rows: m, "
                              "columns: {once: {metric: once, where: {trial: [0, 1, 2, 3, 4]}}}}\n"
                              "claims: {C: {says: so, order: [b, c], of: once}}\n"),
                 maker.records());
    EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    EXPECT_THAT(result.reason, HasSubstr("takes values of 'trial' together"));
}

/// Frames that a file tells apart may be repetitions, too; those of our own are a path.
TEST(Unseeded, FramesOfAnImportThatWereMeasuredOnceDecideNothing) {
    for (const auto& [of, verdict] :
         {std::pair(Of::Import, Verdict::Ambiguous), {Of::Program, Verdict::Holds}}) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})");
        for (int frame = 0; frame < 6; ++frame) {
            maker.frame(frame).add("e", {0.4 + 0.01 * frame}, "", "1");
        }
        const std::string body =
            "sweep: {n: [1]}\nlayout: {rows: n, columns: {e: {metric: e}}}\nclaims: {C: {says: so, "
            "bound: e, at_most: 1}}\n";
        EXPECT_EQ(resultOf(experimentOf(of, body), maker.records()).verdict, verdict);
    }
}

/// A file has the frames that it has; none is left out of rows.
TEST(Unseeded, ARowForEachFrameOfAnImport) {
    tables::RecordMaker maker;
    for (const char* m : {"b", "c"}) {
        maker.beginCase("", fmt::format(R"({{"m":"{}"}})", m));
        for (const int frame : {1, 7}) {
            const bool isSmall = (m[0] == 'b') == (frame == 1);
            maker.frame(frame).add("e", {isSmall ? 1.0 : 2.0}, "", "1");
        }
    }
    const config::Experiment experiment =
        experimentOf(Of::Import,
                     "sweep: {m: [b, c]}\nlayout: {rows: [m, frame], columns: {e: {metric: "
                     "e}}}\nclaims: {C: {says: so, order: [m=b, m=c], of: e}}\n");
    const tables::Table table = tables::buildTable(experiment, maker.records());
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(table.rowName(1), "m=b, frame=7");
    const ClaimResult result = resultOf(experiment, maker.records());
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.reason, "worst at frame 7, e; one sample");
}

/// What differs in one table of a program is in doubt in each; another program, or other imported
/// numbers, are none of it.
TEST(Unseeded, DoubtIsOfAllTablesOfAProgram) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})");
    for (int process = 0; process < 3; ++process) {
        maker.process(process).add("e", {1.0 + 0.01 * process}, "", "1");
    }
    tables::Recorded records = maker.records();
    tables::RecordMaker other;
    other.beginCase("", R"({"n":2})").add("f", {0.5}, "", "1");
    for (records::Record record : other.records()) {
        record.table = "zju2005/9.8";
        records.push_back(record);
    }
    records.cases.push_back(other.records().cases.front());
    records.cases.back().experiment = "zju2005/9.8";
    const auto programOf = [](const char* command) {
        return Node::map({{"command", Node::scalar(command)}});
    };
    for (const auto& [of, command, verdict] : {std::tuple(Of::Import, "a", Verdict::Holds),
                                               {Of::Program, "a", Verdict::Ambiguous},
                                               {Of::Program, "b", Verdict::Holds}}) {
        config::Experiment first =
            experimentOf(of, "sweep: {n: [1]}\nlayout: {rows: n, columns: {e: {metric: e}}}\n");
        config::Experiment second =
            experimentOf(of,
                         "sweep: {n: [2]}\nlayout: {rows: n, columns: {f: {metric: f}}}\nclaims: "
                         "{C: {says: so, bound: f, at_most: 1}}\n");
        second.id = "zju2005/9.8";
        if (of == Of::Program) {
            first.document.set("program", programOf("a"));
            second.document.set("program", programOf(command));
        }
        const auto judge = [&](std::span<const config::Experiment> measured) {
            const std::vector<config::Experiment> shown = {second};
            const auto tables = tables::buildTables(shown, records.cases, records, measured);
            return evaluateClaims(second, tables[0], {"llvmpipe", "software", "quick", "abc", ""})
                .front();
        };
        EXPECT_EQ(judge({}).verdict, Verdict::Holds) << "nothing of it alone";
        const std::vector<config::Experiment> both = {first, second};
        EXPECT_EQ(judge(both).verdict, verdict) << command;
        EXPECT_EQ(judge(both).reason, verdict == Verdict::Holds ? "one sample" : kOneBesideMany);
    }
}

/// As of a sum in another order.
TEST(Unseeded, WhatDiffersByRoundingIsOneNumber) {
    tables::RecordMaker maker;
    for (const char* m : {"b", "c"}) {
        maker.beginCase("", fmt::format(R"({{"m":"{}"}})", m));
        for (int process = 0; process < 3; ++process) {
            const double value = (m[0] == 'b' ? 0.4 : 0.5) * (1.0 + 2e-16 * process);
            maker.process(process).add("e", {value}, "", "1");
        }
    }
    for (const char* claim : {"order: [b, c], of: e", "bound: e, at_most: 0.41, at: {m: b}",
                              "exact: e, equals: 0.4, at: {m: b}"}) {
        const ClaimResult result = resultOf(
            experimentOf(Of::Import,
                         fmt::format("sweep: {{m: [b, c]}}\nlayout: {{rows: m, columns: {{e: "
                                     "{{metric: e}}}}}}\nclaims: {{C: {{says: so, {}}}}}\n",
                                     claim)),
            maker.records());
        EXPECT_EQ(result.verdict, Verdict::Holds) << claim << ": " << result.reason;
    }
}

/// Whatever a claim asks of two values, and of a value and its bound.
TEST(Unseeded, WhatIsApartByRoundingIsEqual) {
    const auto verdictOf = [](double b, double c, const std::string& claim) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})").add("e", {b}, "", "1");
        maker.beginCase("", R"({"n":2})").add("e", {c}, "", "1");
        return resultOf(experimentOf(Of::Import,
                                     "sweep: {n: [1, 2]}\nlayout: {rows: n, columns: {e: {metric: "
                                     "e}}}\nclaims: {C: {says: so, " +
                                         claim + "}}\n"),
                        maker.records())
            .verdict;
    };
    for (const double ulps : {-3.0, 3.0}) {
        const double b = 0.4, c = 0.4 * (1.0 + ulps * 2.3e-16);
        for (const char* claim :
             {"ratio: n=2 / n=1, of: e, at_least: 1", "ratio: n=2 / n=1, of: e, at_most: 1",
              "bound: e, at_most: 0.4", "bound: e, at_least: 0.4", "exact: e, equals: 0.4",
              "independent: e, of: n, at_most: 0%", "trend: e, over: n, direction: increasing",
              "trend: e, over: n, direction: decreasing"}) {
            EXPECT_EQ(verdictOf(b, c, claim), Verdict::Holds) << claim << ulps;
        }
        for (const char* claim :
             {"order: [n=1, n=2], of: e", "order: [n=2, n=1], of: e",
              "ratio: n=2 / n=1, of: e, less_than: 1", "ratio: n=2 / n=1, of: e, more_than: 1",
              "bound: e, less_than: 0.4", "bound: e, more_than: 0.4",
              "trend: e, over: n, direction: increasing, strictly: true",
              "trend: e, over: n, direction: decreasing, strictly: true"}) {
            EXPECT_EQ(verdictOf(b, c, claim), Verdict::Fails) << claim << ulps;
        }
    }
    // Counts are exact.
    EXPECT_EQ(verdictOf(1e13, 1e13 + 1, "exact: e, equals: 10000000000000"), Verdict::Fails);
    EXPECT_EQ(verdictOf(1e13, 1e13 + 1, "order: [n=1, n=2], of: e"), Verdict::Holds);
    EXPECT_EQ(verdictOf(1e13, 1e13 + 1, "bound: e, at_most: 10000000000000"), Verdict::Fails);
}

/// So is what is computed of numbers that are apart by rounding: a difference of them is 0.
TEST(Unseeded, WhatIsComputedOfRoundingIsEqual) {
    const auto verdictOf = [](double b, double c, const std::string& claim) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})").add("e", {b}, "", "1").add("f", {c}, "", "1");
        maker.beginCase("", R"({"n":1.000001})").add("e", {c}, "", "1").add("f", {b}, "", "1");
        return resultOf(experimentOf(Of::Import,
                                     "sweep: {n: [1, 1.000001]}\nlayout: {rows: n, columns: {e: "
                                     "{metric: e}, f: {metric: f}, less: {of: '1 - e / e[n=1]'}, "
                                     "apart: {of: e - f}}}\nclaims: {C: {says: so, " +
                                         claim + "}}\n"),
                        maker.records())
            .verdict;
    };
    for (const double ulps : {-3.0, 3.0}) {
        const double b = 0.4, c = 0.4 * (1.0 + ulps * 2.3e-16);
        for (const char* number :
             {"bound: less", "bound: apart", "bound: log2(e / f)", "trend: e, over: n"}) {
            for (const char* within : {", at_least: 0", ", at_most: 0"}) {
                EXPECT_EQ(verdictOf(b, c, std::string(number) + within), Verdict::Holds)
                    << number << within << ulps;
            }
            for (const char* beyond : {", more_than: 0", ", less_than: 0"}) {
                EXPECT_EQ(verdictOf(b, c, std::string(number) + beyond), Verdict::Fails)
                    << number << beyond << ulps;
            }
        }
    }
    EXPECT_EQ(verdictOf(1e13 + 1, 1e13, "bound: apart, more_than: 0, at: {n: 1}"), Verdict::Holds);
    EXPECT_EQ(verdictOf(0.4, 0.4 + 1e-9, "bound: apart, less_than: 0, at: {n: 1}"), Verdict::Holds);
}

/// Our own counts of work are the device's; those of another program are what it says.
TEST(Unseeded, NoNameKeepsAnImportFromDoubt) {
    for (const char* metric : {"work_fragments", "work_image_digest", "bias_seen", "same_mean_p"}) {
        for (const int processes : {3, 5}) {
            tables::RecordMaker maker;
            maker.beginCase("", R"({"n":1})");
            for (int process = 0; process < processes; ++process) {
                maker.process(process).add(metric, {1.0 + 0.01 * process}, "", "1");
            }
            const std::string body = fmt::format(
                "sweep: {{n: [1]}}\nlayout: {{rows: n, columns: {{w: {{metric: {}}}}}}}\n"
                "claims: {{C: {{says: so, bound: w, at_most: 2}}}}\n",
                metric);
            const ClaimResult result = resultOf(experimentOf(Of::Import, body), maker.records());
            EXPECT_EQ(result.verdict, Verdict::Ambiguous) << metric;
            EXPECT_EQ(result.reason, fmt::format("{} processes came to different numbers; {}",
                                                 processes, tables::kNeedsSix));
        }
    }
}

/// A case that is its own truth has the error 0 whatever the program does.
TEST(Unseeded, AnErrorAgainstItselfIsSaidOfAClaim) {
    tables::RecordMaker maker;
    for (const int n : {1, 4}) {
        maker.beginCase("", fmt::format(R"({{"n":{}}})", n));
        maker.add("rmse", {n == 4 ? 0.0 : 0.1}, "r", "1");
    }
    for (const auto& [at, isSaid] : {std::pair("", true), {", at: {n: 1}", false}}) {
        config::Experiment experiment = experimentOf(
            Of::Program,
            fmt::format(
                "sweep: {{n: [1, 4]}}\nlayout: {{rows: n, columns: {{e: {{metric: rmse, pass: r}}, "
                "d: {{of: 2 * e}}}}}}\nclaims: {{C: {{says: so, bound: d, at_most: 1{}}}}}\n",
                at));
        experiment.document.set("program", parseYaml("{command: \"x {n} {out}\", params: {n: 1}, "
                                                     "images: {r: {file: r.pfm, truth: {n: 4}}}}",
                                                     "t.yaml"));
        const ClaimResult result = resultOf(experiment, maker.records());
        EXPECT_EQ(result.verdict, Verdict::Holds);
        EXPECT_EQ(result.reason.find(
                      "reads an error of a case against itself, 0 whatever the program does") !=
                      std::string::npos,
                  isSaid)
            << result.reason;
    }
}

/// Rows a and b of so many seeds each, those of b from `first` on, with a time in so many
/// processes.
ClaimResult judgeSeedsOf(const std::string& metric, int seeds, int first, int processes) {
    tables::RecordMaker maker;
    Random random(5);
    std::string values;
    for (const char* m : {"a", "b"}) {
        for (int i = 0; i < seeds; ++i) {
            const int seed = i + (m[0] == 'b' ? first : 0);
            if (m[0] == 'a' || seed >= seeds) {
                values += fmt::format("{}{}", values.empty() ? "" : ", ", seed);
            }
            maker.beginCase("", fmt::format(R"({{"m":"{}","seed":{}}})", m, seed));
            for (int process = 0; process < processes; ++process) {
                const double value = (m[0] == 'a' ? 1.0 : 1.2) + 0.05 * double{random.uniform()};
                maker.process(process).add(metric, {value}, "", metric == "e" ? "1" : "ms");
            }
        }
    }
    const config::Experiment experiment = experimentOf(
        Of::Import, fmt::format("sweep: {{m: [a, b], seed: [{0}]}}\nlayout: {{rows: m, columns: "
                                "{{x: {{metric: {1}, where: {{seed: [{0}]}}}}}}}}\n"
                                "claims: {{C: {{says: so, order: [a, b], of: x}}}}\n",
                                values, metric));
    // Of an import there are the cases of the file alone.
    std::vector<config::Case> planned = tables::planOf(experiment, maker.records());
    std::erase_if(planned, [&](const config::Case& item) {
        return std::ranges::find(maker.records().cases, item.id, &config::Case::id) ==
               maker.records().cases.end();
    });
    return evaluateClaims(experiment, tables::buildTable(experiment, planned, maker.records()),
                          {"llvmpipe", "software", "quick", "abc", ""})[0];
}

TEST(Unseeded, ATimeOfEachSweptSeedIsOneProcess) {
    EXPECT_EQ(judgeSeedsOf("t_ms", 8, 0, 1).verdict, Verdict::Holds);
    EXPECT_EQ(judgeSeedsOf("t_ms", 4, 0, 1).verdict, Verdict::Ambiguous);
    EXPECT_EQ(judgeSeedsOf("t_ms", 4, 0, 1).reason, "a range of 4 processes; " + tables::kNeedsSix);
    EXPECT_EQ(judgeSeedsOf("t_ms", 8, 0, 3).reason, "a range of 3 processes; " + tables::kNeedsSix)
        << "rounds are of processes where there are several";
}

/// Rounds of seeds that nobody shares are independent; of shared ones each is one.
TEST(Unseeded, SweptSeedsMayBeOthersForEach) {
    for (const int first : {0, 6, 100}) {
        const ClaimResult result = judgeSeedsOf("e", 6, first, 1);
        EXPECT_EQ(result.verdict, Verdict::Holds) << first << result.reason;
    }
    EXPECT_THAT(judgeSeedsOf("e", 8, 3, 1).reason, HasSubstr("a range of 5 processes"))
        << "five seeds in common";
}

TEST(Unseeded, ValuesOfASweptSeedAreRounds) {
    constexpr int kTrials = test::kIsSanitized ? 4 : 400;
    const std::string pooled = "rows: m, columns: {{e: {{metric: e, where: {{seed: [{}]}}}}}}";
    Random random(2);
    int alarms = 0, found = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        const Verdict alike = judgeSwept(pooled, 8, 1.0, random).verdict;
        alarms += alike == Verdict::Holds || alike == Verdict::Fails ? 1 : 0;
        found += judgeSwept(pooled, 8, 1.1, random).verdict == Verdict::Holds ? 1 : 0;
    }
    if (!test::kIsSanitized) {
        EXPECT_LE(alarms, 0.07 * kTrials);
        EXPECT_GE(found, 0.95 * kTrials);
    }
    const ClaimResult few = judgeSwept(pooled, 4, 1.1, random);
    EXPECT_EQ(few.verdict, Verdict::Ambiguous);
    EXPECT_EQ(few.reason,
              "4 seeds of random numbers; an interval needs 6: `measure: {processes: 6}` where the "
              "seed is not swept, or as many values of 'seed' in a sweep or an import");
    EXPECT_EQ(judgeSwept("rows: [m, seed], columns: {{e: {{metric: e}}}}", 8, 1.1, random).verdict,
              Verdict::Ambiguous)
        << "one seed a row";
}

}  // namespace
}  // namespace gfxrepro::claims
