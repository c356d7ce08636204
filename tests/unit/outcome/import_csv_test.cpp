#include "runner/outcome/import_csv.h"

#include <cmath>

#include "tests/support/support.h"

namespace gfxrepro::outcome {
namespace {

struct ImportCsv : FolderTest {
    ImportedNumbers read(const std::string& text) const {
        return readImport({folder.write("a.csv", text)});
    }
    std::string refusal(const std::string& text) const {
        return errorText([&] { read(text); }, folder.path());
    }
    /// With columns of numbers.
    std::string wideRefusal(const std::string& text) const {
        const ImportFiles files{folder.write("a.csv", text), {{"ms", "ms"}, {"mse", "1"}}};
        return errorText([&] { readImport(files); }, folder.path());
    }
};

/// In one order in all cases, so that one seed is one round; a metric without any draws none.
TEST_F(ImportCsv, ASeedNumbersProcesses) {
    const ImportedNumbers numbers = read(
        "method,seed,metric,value\na,7,rmse,1\na,3,rmse,2\nb,3,rmse,3\nb,7,rmse,4\nc,,rays,5\n"
        "d,9,rmse,6\nd,8,rmse,7\n");
    ASSERT_EQ(numbers.cases.size(), 4U);
    std::vector<int> processes;
    for (const ImportedRow& row : numbers.rows) processes.push_back(row.record.process);
    EXPECT_EQ(processes, (std::vector<int>{0, 1, 1, 0, 0, 0, 1}));
    EXPECT_TRUE(numbers.cases[0].hasSeeds);
    EXPECT_TRUE(numbers.cases[1].hasSeeds);
    EXPECT_FALSE(numbers.cases[2].hasSeeds);
    const ImportedNumbers parts = read(
        "method,seed,metric,value\na,1,rmse,1\na,2,rmse,2\na,3,rmse,3\nb,2,rmse,4\nb,3,rmse,5\n");
    EXPECT_EQ(parts.rows[3].record.process, 1) << "as of the same seed elsewhere";
    EXPECT_EQ(parts.rows[4].record.process, 2);
    const ImportedNumbers apart =
        read("method,process,metric,value\na,2,rmse,1\na,4,rmse,2\nb,5,rmse,3\nb,7,rmse,4\n");
    EXPECT_EQ(apart.rows[2].record.process, 0) << "processes that nobody shares";
    EXPECT_EQ(apart.rows[3].record.process, 1);
    const ImportedNumbers framed = read(
        "method,seed,frame,metric,value\na,7,0,rmse,1\na,,,rays,5\na,,0,nodes,5\na,,,t_ms,5\n");
    std::vector<int> frames;
    for (const ImportedRow& row : framed.rows) frames.push_back(row.record.frame);
    EXPECT_EQ(frames, (std::vector<int>{0, records::kSetup, 0, 0})) << "of no seed and no frame";
    EXPECT_EQ(refusal("method,seed,metric,value\na,7,rmse,1\nb,,rmse,2\n"),
              "DIR/a.csv:3: 'rmse' has no seed; in line 2 it has the seed '7'; allowed: one in all "
              "of its rows, or in none; what draws no random numbers has the same value with each");
    EXPECT_EQ(refusal("method,seed,metric,value\na,,rmse,1\na,8,rmse,2\n"),
              "DIR/a.csv:3: 'rmse' has the seed '8'; in line 2 it has no seed; allowed: one in all "
              "of its rows, or in none; what draws no random numbers has the same value with each");
    EXPECT_EQ(refusal("seed,process,metric,value\n1,0,rmse,1\n"),
              "DIR/a.csv:1: columns 'seed' and 'process': a seed is of a process of its own; "
              "allowed: one of the two, or the column 'params.seed' for a parameter");
}

TEST_F(ImportCsv, ANumberARow) {
    const ImportedNumbers numbers = read(
        "samples,metric,value,unit,pass,frame,repeat,process,lane,status,message,scene\n"
        "4,mse,0.5,1,,,,,,,,kitchen\n"
        "4,ms,1e2,ms,trace,2,1,3,,,,kitchen\n"
        "16,mse,inf,1,,,,,quality,,,kitchen\n"
        "64,,,,,-1,-1,,,crash,\"two\nlines\",\n");
    ASSERT_EQ(numbers.cases.size(), 3U);
    EXPECT_EQ(numbers.columns, (std::vector<std::string>{"samples", "scene"}));
    EXPECT_EQ(numbers.cases[0].cell("samples"), "4");
    EXPECT_EQ(numbers.cases[0].cell("scene"), "kitchen");
    EXPECT_EQ(numbers.cases[2].cells.size(), 1U);
    ASSERT_EQ(numbers.rows.size(), 4U);
    EXPECT_EQ(numbers.rows[1].caseIndex, 0U);
    const records::Record& timed = numbers.rows[1].record;
    EXPECT_EQ(timed.value, 100.0);
    EXPECT_EQ(timed.pass, "trace");
    EXPECT_EQ(timed.frame, 2);
    EXPECT_EQ(timed.repeat, 1);
    EXPECT_EQ(timed.process, 3);
    EXPECT_EQ(timed.lane, "timing");
    EXPECT_EQ(numbers.rows[2].record.lane, "quality");
    EXPECT_TRUE(std::isinf(numbers.rows[2].record.value));
    EXPECT_EQ(numbers.rows[3].record.status, records::Status::Crash);
    EXPECT_EQ(numbers.rows[3].record.message, "two\nlines");
    EXPECT_TRUE(std::isnan(numbers.rows[3].record.value));
}

TEST_F(ImportCsv, AsOtherProgramsWriteIt) {
    const ImportedNumbers numbers = read(
        "\xEF\xBB\xBF"
        "samples ,\"metric\",value\r\n 4,\"mse\", 0.5 \r\n\r\n8,mse,0.25");
    ASSERT_EQ(numbers.rows.size(), 2U);
    EXPECT_EQ(numbers.cases[1].cell("samples"), "8");
    EXPECT_EQ(numbers.rows[1].record.value, 0.25);
}

TEST_F(ImportCsv, AColumnForEachMetric) {
    const ImportFiles files{
        folder.write("a.csv", "samples,process,ms,mse\n4,0,10,0.5\n4,1,11,\n16,0,40,0.1\n"),
        {{"ms", "ms"}, {"mse", "1"}}};
    const ImportedNumbers numbers = readImport(files);
    EXPECT_EQ(numbers.columns, std::vector<std::string>{"samples"});
    EXPECT_EQ(numbers.cases.size(), 2U);
    ASSERT_EQ(numbers.rows.size(), 5U);
    EXPECT_EQ(numbers.rows[0].record.metric, "ms");
    EXPECT_EQ(numbers.rows[0].record.unit, "ms");
    EXPECT_EQ(numbers.rows[4].record.value, 0.1);
    EXPECT_EQ(wideRefusal("samples,ms\n4,1\n"),
              "DIR/a.csv:1: no column 'mse' (columns: samples, ms); needed: what --metric names");
    EXPECT_EQ(wideRefusal("ms,mse,value\n1,2,3\n"),
              "DIR/a.csv:1: column 'value' beside --metric; allowed: one of the two forms");
    EXPECT_EQ(wideRefusal("ms,mse\n1,2\n,\n"),
              "DIR/a.csv:3: no number; allowed: none only in a row whose status is not ok");
}

TEST_F(ImportCsv, WhatIsWrongIsNamedWithItsLine) {
    const std::string head = "n,metric,value,unit,frame,process,lane,status\n";
    EXPECT_EQ(refusal(""), "DIR/a.csv:1: is empty; expected a header");
    EXPECT_EQ(refusal(head), "DIR/a.csv: has a header and no row");
    EXPECT_EQ(refusal("n,value\n1,2\n"),
              "DIR/a.csv:1: no column 'metric' (columns: n, value); needed: metric, value; or "
              "--metric COLUMN=UNIT for each column of numbers");
    EXPECT_EQ(refusal("n;metric;value\n"),
              "DIR/a.csv:1: no column 'metric' (columns: n;metric;value); needed: metric, value; "
              "or --metric COLUMN=UNIT for each column of numbers");
    EXPECT_EQ(refusal("n,metric,value,n\n"), "DIR/a.csv:1: two columns 'n'");
    EXPECT_EQ(refusal("n,,metric,value\n"), "DIR/a.csv:1: column 2 has no name");
    EXPECT_EQ(refusal("a,a.b,metric,value\n"),
              "DIR/a.csv:1: columns 'a' and 'a.b': the second is a part of the first");
    EXPECT_EQ(refusal(head + "1,a,2\n"), "DIR/a.csv:2: 3 columns; the header has 8");
    EXPECT_EQ(refusal(head + "1,a,fast,ms,,,,\n"),
              "DIR/a.csv:2: column 'value': 'fast'; allowed: a number, inf, or nothing in a row "
              "whose status is not ok");
    EXPECT_EQ(refusal(head + "1,a,nan,ms,,,,\n").substr(0, 41),
              "DIR/a.csv:2: column 'value': 'nan'; allow");
    EXPECT_EQ(refusal(head + "1,a,\"1,5\",ms,,,,\n").substr(0, 41),
              "DIR/a.csv:2: column 'value': '1,5'; allow");
    EXPECT_EQ(refusal(head + "1,,2,ms,,,,\n"),
              "DIR/a.csv:2: column 'metric' is empty; allowed: nothing only in a row whose status "
              "is not ok");
    EXPECT_EQ(refusal(head + "1,a,2,ms,-2,,,\n").substr(0, 60),
              "DIR/a.csv:2: column 'frame': '-2'; allowed: a whole number f");
    EXPECT_EQ(refusal(head + "1,a,2,ms,,1000000,,\n"),
              "DIR/a.csv:2: column 'process': '1000000'; allowed: a whole number from 0 to 999999");
    EXPECT_EQ(refusal(head + "1,a,2,ms,,,slow,\n"),
              "DIR/a.csv:2: column 'lane': 'slow'; allowed: timing (the default), quality");
    EXPECT_EQ(refusal(head + "1,a,2,ms,,,,fine\n"),
              "DIR/a.csv:2: column 'status': unknown status 'fine'; allowed: ok, ambiguous, flaky, "
              "unsupported, timeout, oom, crash, device-lost, missing, error");
    EXPECT_EQ(refusal(head + "1,a,2,ms,,,,\n2,a,2,s,,,,\n"),
              "DIR/a.csv:3: 'a' has the unit 's'; in line 2 it has 'ms'");
    EXPECT_EQ(refusal(head + "1,a,2,ms,,,timing,\n1,b,2,ms,,,quality,\n"),
              "DIR/a.csv:3: column 'lane': 'quality'; the same case has 'timing' in line 2");
    EXPECT_EQ(refusal(head + "1,a,2,ms,,,,\n1,a,3,ms,,,,\n"),
              "DIR/a.csv:3: 'a' of this case stands in line 2 already; columns process, seed, "
              "frame and repeat tell measurements apart");
    EXPECT_EQ(refusal(head + "1,\"a,2,ms,,,,\n"), "DIR/a.csv:2: a quote that is not closed");
    EXPECT_EQ(refusal(head + "\x01,a,2,ms,,,,\n"),
              "DIR/a.csv:2: column 'n': a control character; allowed: text of one line");
    EXPECT_EQ(refusal(head + "\xff,a,2,ms,,,,\n"), "DIR/a.csv:2: column 'n': is not UTF-8");
    EXPECT_EQ(refusal(head + std::string(1025, 'x') + ",a,2,ms,,,,\n"),
              "DIR/a.csv:2: column 'n': 1025 bytes; at most 1024 are allowed");
    EXPECT_EQ(errorText([&] { readImport({folder.path() / "none.csv"}); }, folder.path()),
              "cannot read DIR/none.csv: No such file or directory");
}

TEST_F(ImportCsv, AMessageMayHaveAnything) {
    const auto file = folder.write(
        "records.csv", "n,metric,value,status,message\nx,,,error,\"\x1b[31mred\x1b[0m\n\x07\"\n");
    EXPECT_EQ(readImport({file}).rows.at(0).record.message, "\x1b[31mred\x1b[0m\n\x07");
    EXPECT_EQ(refusal("case_id,metric,value\na,mse,1\n"),
              "DIR/a.csv:1: column 'case_id' says nothing of a case here; allowed: columns of its "
              "parameters");
}

}  // namespace
}  // namespace gfxrepro::outcome
