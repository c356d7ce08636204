// The table and the curves of who laid out none.
#include "runner/tables/table.h"

#include <fmt/format.h>

#include <functional>

#include "engine/core/random.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

using config::Better;

/// A sweep of one's own whose technique declares a digest, voxels and an error.
config::Experiment sweepOf(const std::string& sweep) {
    const TemporaryFolder folder;
    const auto file =
        folder.write("s.yaml", "sweep_of: s\ntitle: Mine\ntechnique: x\nsweep: " + sweep + "\n");
    config::Experiment experiment = config::loadExperiment(file, {}, folder.path());
    experiment.outputs = {{{"wall_time_ms", "ms", "a frame", Better::Lower},
                           {"gpu_time_ms", "ms", "a pass", Better::Lower},
                           {"error_pct", "%", "wrong", Better::Lower},
                           {"voxels", "voxel", "full ones"},
                           {"triangles", "triangle", "of the mesh"},
                           {"memory_bytes", "byte", "held", Better::Lower},
                           {"digest", "1", "of all", Better::Neither, true}},
                          {{"draw", "the picture"}}};
    return experiment;
}

/// Cases at these resolutions, each recorded as techniques do.
Recorded recordedAt(std::initializer_list<int> resolutions) {
    RecordMaker maker("sweep/s");
    for (const int n : resolutions) {
        maker.beginCase("", "{\"resolution\": " + std::to_string(n) + "}").lane("timing");
        maker.add("digest", {double(n)}, "", "1").add("memory_bytes", {n * 1048576.0}, "", "byte");
        maker.add("triangles", {69451}, "", "triangle").add("voxels", {n * 10.0}, "", "voxel");
        maker.add("gpu_time_ms", {0.25 * n}, "draw").add("wall_time_ms", {0.5 * n});
        maker.add("error_pct", {100.0 / n}, "", "%").add("baseline_memory_bytes", {5}, "", "byte");
    }
    return maker.records();
}

std::vector<std::string> labelsOf(const Table& table) {
    std::vector<std::string> labels;
    for (const TableColumn& column : table.columns) labels.push_back(column.label);
    return labels;
}

TEST(DefaultLayout, ShowsAFrameMetricsThenStepsAndTellsWhatIsAlikeOnce) {
    const Table table = buildTable(sweepOf("{resolution: [32, 64]}"), recordedAt({32, 64}));
    EXPECT_THAT(table.rowAxes, ElementsAre("resolution"));
    EXPECT_THAT(labelsOf(table),
                ElementsAre("frame_ms", "memory_mib", "error_pct", "voxels", "draw_ms"));
    EXPECT_THAT(table.constants, ElementsAre("triangles 69451"));
    EXPECT_EQ(table.rows[1].cells[0].measured, "32");
    EXPECT_EQ(table.rows[1].cells[3].measured, "640");
    EXPECT_EQ(table.rows[1].cells[1].measured, "64");
    EXPECT_EQ(table.columns[2].better, Better::Lower);
    EXPECT_EQ(table.columns[2].doc, "wrong");
}

/// The records of such a case have the parameter's default, which it does not use.
TEST(DefaultLayout, AnAxisThatDoesNotApplyHasNoValue) {
    RecordMaker maker("sweep/s");
    double voxels = 0.0;
    for (const char* params :
         {R"({"method": "bins", "gain": 2})", R"({"method": "bins", "gain": 4})",
          R"({"method": "none", "gain": 1})"}) {
        maker.beginCase("", params).add("voxels", {++voxels}, "", "voxel");
    }
    const Recorded records = maker.records();
    const Table table = buildTable(
        sweepOf("{method: [bins, none], gain: [2, 4], when: {gain: {method: bins}}}"), records);
    std::vector<std::string> gains;
    for (const TableRow& row : table.rows) gains.push_back(row.labels.at(1));
    EXPECT_THAT(gains, ElementsAre("2", "4", "–"));
}

TEST(DefaultLayout, WhatACaseDoesNotRecordIsBlank) {
    Recorded records = recordedAt({32, 64});
    std::erase_if(records, [](const records::Record& record) {
        return record.metric == "error_pct" && record.caseId.find("32") != std::string::npos;
    });
    const Table table = buildTable(sweepOf("{resolution: [32, 64]}"), records);
    ASSERT_EQ(table.columns[2].label, "error_pct");
    EXPECT_FALSE(table.rows[0].cells[2].isPlanned);
    EXPECT_EQ(table.rows[0].cells[2].measured, "");
    EXPECT_EQ(table.rows[1].cells[2].measured, "1.562");
}

TEST(DefaultLayout, SaysWhatOneFrameAloneCannotHave) {
    config::Experiment experiment = sweepOf("{resolution: [32, 64]}");
    const auto notes = [&] { return buildTable(experiment, recordedAt({32, 64})).notes; };
    experiment.outputs.metrics.push_back({"key_frame_interval", "frame", "since the last"});
    EXPECT_THAT(notes(),
                Contains("One frame of each case is measured: the key frame interval, and whatever "
                         "follows from frames before, needs several (`output: {frames: 20}`)."));
    const auto saysSo = Contains(StartsWith("One frame"));
    experiment.outputs.metrics.back().name = "digest";  // which is recorded
    EXPECT_THAT(notes(), Not(saysSo));
    experiment.outputs.metrics.back().name = "key_frame_interval";
    experiment.measure.frames = 2;
    EXPECT_THAT(notes(), Not(saysSo));
}

/// Frames of three methods over six processes: 10, 9 and 10 ms, of which the first wavers.
Recorded ofMethods(const std::string& suffix = "") {
    RecordMaker maker("sweep/s");
    for (const auto& [method, ms] :
         {std::pair("plain", 10.0), std::pair("fast", 9.0), std::pair("alike", 10.0)}) {
        maker.beginCase("", std::string(R"({"method": ")") + method + suffix + "\"}")
            .lane("timing");
        for (int process = 0; process < 6; ++process) {
            const double wavering = method[0] == 'p' ? 0.01 * (process - 2.5) : 0.0;
            maker.process(process).add("wall_time_ms", {ms + wavering});
        }
    }
    return maker.records();
}

TEST(DefaultLayout, TellsMethodsByTheNamesOfTheirRows) {
    EXPECT_EQ(buildTable(sweepOf("{method: [plain_way, fast_way]}"), ofMethods("_way")).notes[0],
              "frame: fast way is faster than plain way in the one row (0.9 times its time).");
}

TEST(DefaultLayout, HoldsMethodsAgainstTheFirst) {
    const Table table = buildTable(sweepOf("{method: [plain, fast, alike]}"), ofMethods());
    EXPECT_THAT(labelsOf(table), ElementsAre("frame_ms", "frame ÷ plain"));
    EXPECT_EQ(table.rows[0].cells[1].measured, "1");
    EXPECT_EQ(table.rows[1].cells[1].measured, "0.9");
    // What is told stands first, and in ink.
    ASSERT_GE(table.notes.size(), 2U);
    EXPECT_EQ(table.notes[0],
              "frame: fast is faster than plain in the one row (0.9 times its time).");
    EXPECT_EQ(table.notes[1], "frame: alike and plain cannot be told apart in the one row.");
    EXPECT_EQ(table.toldNotes, 1U);
    EXPECT_FALSE(table.rows[1].cells[1].isWithinNoise);
    EXPECT_TRUE(table.rows[2].cells[1].isWithinNoise);
    // Numbers, scenes and what has no name are no rivals.
    EXPECT_THAT(labelsOf(buildTable(sweepOf("{method: ['', fast]}"), ofMethods())),
                Not(Contains(HasSubstr("÷"))));
    EXPECT_THAT(labelsOf(buildTable(sweepOf("{resolution: [32, 64]}"), recordedAt({32, 64}))),
                Not(Contains(HasSubstr("÷"))));
}

/// Methods with parameters of their own, each with an error that no measurement changes.
TEST(DefaultLayout, WhatIsKnownOfMethodsIsToldAsItIs) {
    RecordMaker maker("sweep/s");
    for (const auto& [method, samples, error] :
         {std::tuple("plain", 16, 4.0), {"fine", 64, 1.0}, {"alike", 32, 4.0}}) {
        maker.beginCase("", fmt::format(R"({{"method": "{}", "samples": {}}})", method, samples));
        maker.add("error_pct", {error}, "", "%");
    }
    const Recorded records = maker.records();
    for (const char* sweep : {"{zip: [{method: [plain, fine, alike], samples: [16, 64, 32]}]}",
                              "{list: [[{method: plain, samples: 16}, {method: fine, samples: 64}, "
                              "{method: alike, samples: 32}]]}"}) {
        const Table table = buildTable(sweepOf(sweep), records);
        EXPECT_THAT(labelsOf(table), ElementsAre("error_pct", "error ÷ plain"));
        EXPECT_EQ(table.rows[1].cells[1].measured, "0.25");
        EXPECT_EQ(table.notes[0],
                  "error: fine is lower than plain in the one row (0.25 times its value).");
        EXPECT_EQ(table.notes[1], "error: alike and plain cannot be told apart in the one row.");
        EXPECT_EQ(table.toldNotes, 1U);
        EXPECT_FALSE(table.rows[1].cells[1].isWithinNoise);
        EXPECT_TRUE(table.rows[2].cells[1].isWithinNoise);
    }
    // What else is swept may have other values with each method.
    EXPECT_EQ(buildTable(sweepOf("{method: [plain, fine, alike], samples: [16, 64, 32]}"), records)
                  .rows[1]
                  .cells[1]
                  .measured,
              "missing");
}

/// What is on in some cases is held against those where it is off, unless there are methods.
TEST(DefaultLayout, HoldsOnAgainstOff) {
    const auto timed = [](const char* axes) {
        RecordMaker maker("sweep/s");
        for (const char* value : {"false", "true"}) {
            for (const char* method : {"plain", "fast"}) {
                maker.beginCase("", fmt::format(fmt::runtime(axes), value, method)).lane("timing");
                for (int process = 0; process < 6; ++process) {
                    const double time = (value[0] == 't' ? 5.0 : 10.0) + 0.01 * process;
                    maker.process(process).add("wall_time_ms", {time});
                }
                if (std::string_view(axes).find("method") == std::string_view::npos) break;
            }
        }
        return maker.records();
    };
    const Table table =
        buildTable(sweepOf("{is_culled: [false, true]}"), timed(R"({{"is_culled": {}}})"));
    EXPECT_THAT(labelsOf(table), ElementsAre("frame_ms", "frame ÷ is culled false"));
    EXPECT_THAT(table.notes[0],
                "frame: is culled true is faster than is culled false in the one row (0.501 times "
                "its time).");
    EXPECT_THAT(labelsOf(buildTable(sweepOf("{is_culled: [false, true], method: [plain, fast]}"),
                                    timed(R"({{"is_culled": {}, "method": "{}"}})"))),
                ElementsAre("frame_ms", "frame ÷ plain"));
}

/// The CPU time of what waits says nothing of it.
TEST(DefaultLayout, OfAnImportTheClockComesBeforeCpuTime) {
    RecordMaker maker("sweep/s");
    for (const char* method : {"plain", "fast"}) {
        maker.beginCase("", fmt::format(R"({{"method": "{}"}})", method)).lane("timing");
        for (int process = 0; process < 6; ++process) {
            const double time = (method[0] == 'p' ? 200.0 : 100.0) + 0.1 * process;
            maker.process(process).add("process_time_ms", {10.0 + 0.01 * process});
            maker.add("setup_time_ms", {3.0}).add("wall_time_ms", {time});
        }
    }
    const Recorded records = maker.records();
    config::Experiment experiment = sweepOf("{method: [plain, fast]}");
    experiment.technique = config::kImported;
    experiment.outputs = {};
    const Table table = buildTable(experiment, records);
    EXPECT_THAT(labelsOf(table),
                ElementsAre("frame_ms", "frame ÷ plain", "process_time_ms", "setup_time_ms"));
    EXPECT_THAT(table.notes[0], HasSubstr("frame: fast is faster than plain in the one row (0.5"));
}

/// Of what was measured elsewhere no technique declares it.
TEST(DefaultLayout, ImportedErrorsAreKnownByTheirNames) {
    RecordMaker maker("sweep/s");
    for (const char* method : {"sobol", "jittered"}) {
        maker.beginCase("", fmt::format(R"({{"method": "{}"}})", method));
        const double less = method[0] == 's' ? 1.0 : 0.5;
        maker.add("mse", {0.4 * less}, "", "1").add("shots", {3.0 * less}, "", "1");
    }
    const Recorded records = maker.records();
    config::Experiment experiment = sweepOf("{method: [sobol, jittered]}");
    experiment.outputs = {};
    const Table table = buildTable(experiment, records);
    EXPECT_THAT(labelsOf(table), ElementsAre("mse", "mse ÷ sobol", "shots"));
    EXPECT_EQ(table.rows[1].cells[1].measured, "0.5");
    EXPECT_EQ(table.columns[0].better, Better::Lower);
}

/// Two methods at so many sizes over six processes; `time` is of a method, a size and a process.
using TimeAt = std::function<double(int method, int size, int process)>;
Recorded atSizes(int sizes, const TimeAt& wall, const TimeAt& cpu = {},
                 const char* metric = "wall_time_ms") {
    RecordMaker maker("sweep/s");
    for (int method = 0; method < 2; ++method) {
        for (int size = 1; size <= sizes; ++size) {
            maker.beginCase("", fmt::format(R"({{"method": "{}", "size": {}}})",
                                            method == 0 ? "plain" : "fast", size));
            maker.lane("timing");
            for (int process = 0; process < 6; ++process) {
                maker.process(process).add(metric, {wall(method, size, process)}, "",
                                           metric[0] == 'w' ? "ms" : "1");
                if (cpu) maker.add("process_time_ms", {cpu(method, size, process)});
            }
        }
    }
    return maker.records();
}

/// Of twenty rows of two equal methods nearly every other table has one whose six rounds are all of
/// one sign.
TEST(DefaultLayout, ManyRowsOfEqualMethodsAreNotToldApart) {
    constexpr int kSeeds = test::kIsSanitized ? 8 : 40;
    for (const char* metric : {"wall_time_ms", "rmse"}) {
        int told = 0, apart = 0;
        for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
            Random random(seed);
            const auto noise = [&] {
                double sum = 0.0;
                for (int i = 0; i < 12; ++i) sum += double{random.uniform()} / 12.0;
                return 1.0 + 0.6 * (sum - 0.5);  // 5 %
            };
            config::Experiment experiment =
                sweepOf("{method: [plain, fast], size: {range: [1, 20]}}");
            experiment.outputs.metrics.push_back({"rmse", "1", "wrong", Better::Lower});
            experiment.outputs.metrics.push_back({"wall_time_ms", "ms", "a frame", Better::Lower});
            const auto equal = [&](int, int size, int) { return size * noise(); };
            told += buildTable(experiment, atSizes(20, equal, {}, metric)).toldNotes > 0 ? 1 : 0;
            const auto faster = [&](int method, int size, int) {
                return size * noise() * (method == 1 && size == 7 ? 0.7 : 1.0);
            };
            apart += buildTable(experiment, atSizes(20, faster, {}, metric)).toldNotes > 0 ? 1 : 0;
        }
        EXPECT_LE(told, kSeeds / 8) << metric << ": 5 % of 40, and two standard errors";
        EXPECT_GE(apart, kSeeds * 17 / 20) << metric << ": one row is 30 % less";
    }
}

TEST(DefaultLayout, WhatIsApartByRoundingIsNotToldApart) {
    config::Experiment experiment = sweepOf("{method: [plain, fast], size: [1, 2]}");
    experiment.outputs.metrics.push_back({"rmse", "1", "wrong", Better::Lower});
    const auto alike = [](int method, int size, int) {
        return 0.4 * size * (method == 0 ? 1.0 : 1.0 + 7e-16);
    };
    EXPECT_THAT(buildTable(experiment, atSizes(2, alike, {}, "rmse")).notes[0],
                HasSubstr("cannot be told apart in any of 2 rows"));
}

/// What the clock says of neighbours hides what the work shows.
TEST(DefaultLayout, BuiltInMethodsAreHeldByCpuTimeWhereItWasRecorded) {
    const auto wall = [](int method, int, int process) {
        return 10.0 + 9.0 * ((process * 7 + method * 3) % 5);
    };
    const auto cpu = [](int method, int, int process) {
        return (method == 0 ? 10.0 : 8.0) + 0.01 * process;
    };
    config::Experiment experiment = sweepOf("{method: [plain, fast], size: [1, 2]}");
    Table table = buildTable(experiment, atSizes(2, wall, cpu));
    EXPECT_THAT(
        table.notes[0],
        HasSubstr("frame: fast is faster than plain in both rows (0.8 times its CPU time)"));
    EXPECT_THAT(table.judgedByProcess, ElementsAre("frame_ms", "frame ÷ plain"));
    showProcessTimes(table.judgedByProcess, table);
    EXPECT_THAT(labelsOf(table),
                ElementsAre("frame_ms", "cpu_frame_ms", "frame ÷ plain", "cpu_frame ÷ plain"));
    EXPECT_EQ(table.rows.back().cells[3].measured, "0.8");
    table = buildTable(experiment, atSizes(2, wall));
    EXPECT_THAT(table.notes[0], HasSubstr("cannot be told apart"));
    EXPECT_THAT(table.judgedByProcess, IsEmpty());
}

/// A program that says a time of its own, and whose pictures have errors.
config::Experiment programWith(const std::string& images) {
    const TemporaryFolder folder;
    const auto file = folder.write(
        "s.yaml",
        "sweep_of: s\ntitle: Mine\nprogram:\n  command: t {samples}\n  params: {samples: 4}\n"
        "  metrics: {render_ms: ms, rays: ray}\n  images: {" +
            images + "}\nsweep: {samples: [4, 16]}\n");
    config::Experiment experiment = config::loadExperiment(file, {}, folder.path());
    experiment.outputs = {{{"wall_time_ms", "ms", "a frame", Better::Lower},
                           {"rays", "ray", "traced"},
                           {"render_ms", "ms", "without its start", Better::Lower}}};
    for (const config::MetricInfo& error : config::pictureErrors()) {
        experiment.outputs.metrics.push_back(error);
    }
    return experiment;
}

Recorded recordedOfPictures(std::initializer_list<const char*> pictures) {
    RecordMaker maker("sweep/s");
    for (const int samples : {4, 16}) {
        maker.beginCase("", "{\"samples\": " + std::to_string(samples) + "}").lane("timing");
        maker.add("wall_time_ms", {100.0 + samples}).add("render_ms", {2.0 * samples});
        maker.add("rays", {3.0 * samples}, "", "ray");
        for (const char* picture : pictures) {
            for (const char* error : {"mse", "rmse"}) {
                maker.add(error, {1.0 / samples}, picture, "1");
            }
        }
    }
    return maker.records();
}

TEST(DefaultLayout, ErrorsOfTheOnlyPictureNeedNotSayOfWhich) {
    EXPECT_THAT(labelsOf(buildTable(programWith("a: a.png"), recordedOfPictures({"a"}))),
                ElementsAre("render_ms", "frame_ms", "mse", "rmse", "rays"));
    EXPECT_THAT(
        labelsOf(buildTable(programWith("a: a.png, b: b.png"), recordedOfPictures({"a", "b"}))),
        ElementsAre("render_ms", "frame_ms", "mse_a", "mse_b", "rmse_a", "rmse_b", "rays"));
}

TEST(DefaultPlots, OfAPicturesErrorAreAlsoOverTheTimeThatLeads) {
    const auto plots = defaultPlots(buildTable(programWith("a: a.png"), recordedOfPictures({"a"})));
    ASSERT_EQ(plots.size(), 3U);
    EXPECT_THAT(plots[0].y, ElementsAre("mse"));
    EXPECT_EQ(plots[0].x, "samples");
    EXPECT_EQ(plots[1].x, "render_ms");
    EXPECT_THAT(plots[1].y, ElementsAre("mse"));
    EXPECT_EQ(plots[1].title, "mse over render (lower is better)");
    EXPECT_THAT(plots[2].y, ElementsAre("render_ms", "frame_ms"));
}

TEST(DefaultLayout, OfOneCaseNothingIsFolded) {
    const Table table = buildTable(sweepOf("{resolution: [32]}"), recordedAt({32}));
    EXPECT_THAT(table.constants, IsEmpty());
    EXPECT_EQ(table.columns.size(), 6U);
}

TEST(DefaultLayout, WhatWasNotDeclaredInOlderPlansIsShownAsRecorded) {
    config::Experiment experiment = sweepOf("{resolution: [32, 64]}");
    experiment.outputs = {};
    EXPECT_EQ(labelsOf(buildTable(experiment, recordedAt({32, 64}))).size(), 6U);
}

TEST(DefaultPlots, AreOverTheSweptNumber) {
    const config::Experiment experiment = sweepOf("{resolution: [32, 64, 128]}");
    const auto plots = defaultPlots(buildTable(experiment, recordedAt({32, 64, 128})));
    ASSERT_EQ(plots.size(), 2U);
    EXPECT_EQ(plots[0].x, "resolution");
    EXPECT_THAT(plots[0].y, ElementsAre("frame_ms", "draw_ms"));
    EXPECT_EQ(plots[0].title, "Times over resolution (lower is better)");
    EXPECT_TRUE(plots[0].isLogX);
    EXPECT_FALSE(plots[0].isLogY);
    EXPECT_THAT(plots[1].y, ElementsAre("error_pct"));
}

/// Four decades for a step that takes no time would leave no room for the others.
TEST(DefaultPlots, StepsThatOneCannotSeeAreLeftOut) {
    Table table = buildTable(sweepOf("{resolution: [32, 64]}"), recordedAt({32, 64}));
    const std::size_t draw = *table.findColumn("draw_ms");
    for (TableRow& row : table.rows) row.cells[draw].values[0].value = 1e-4;
    EXPECT_THAT(defaultPlots(table)[0].y, ElementsAre("frame_ms"));
}

TEST(DefaultPlots, NeedAnAxisOfNumbers) {
    Table table = buildTable(sweepOf("{resolution: [32, 64]}"), recordedAt({32, 64}));
    table.rows[0].labels[0] = "coarse";
    EXPECT_THAT(defaultPlots(table), IsEmpty());
}

}  // namespace
}  // namespace gfxrepro::tables
