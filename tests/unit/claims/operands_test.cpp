// Claims that noisy pictures have the expectation of their truth.

#include "runner/claims/kinds/operands.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::claims {
namespace {

const ReportContext kSoftwareDevice{"llvmpipe", "software", "quick", "abc", ""};

std::string bodyOf(const std::string& claim, const std::string& column = "metric: same_mean_p") {
    return "sweep: {n: [1, 2, 4]}\nlayout: {rows: n, columns: {p: {" + column +
           ", pass: result}}}\nclaims:\n  X: {says: as claimed, " + claim + "}\n";
}

tables::Recorded recorded(std::initializer_list<double> p) {
    tables::RecordMaker maker;
    int n = 1;
    for (const double value : p) {
        maker.beginCase("", "{\"n\":" + std::to_string(n) + "}");
        maker.add("same_mean_p", {value}, "result", "1");
        n *= 2;
    }
    return maker.records();
}

ClaimResult judged(const std::string& body, std::initializer_list<double> p) {
    const config::Experiment experiment = tables::experimentFrom(body);
    return evaluateClaims(experiment, tables::buildTable(experiment, recorded(p)), kSoftwareDevice)
        .at(0);
}

TEST(SameMean, HoldsWhereNoRowIsTooUnlikely) {
    const std::string body = bodyOf("same_mean: p, false_alarms: 3%");
    const ClaimResult result = judged(body, {0.5, 0.2, 1.0});
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.required, "the same expectation (p: p of all rows ≥ 0.03)");
    EXPECT_EQ(result.measured, "p of all rows 0.6");
    EXPECT_EQ(judged(body, {0.9, 0.9, 0.9}).measured, "p of all rows 1");
}

/// Three rows give three chances of a false alarm: each counts a third.
TEST(SameMean, SharesItsFalseAlarmsAmongTheRows) {
    const std::string body = bodyOf("same_mean: p, false_alarms: 3%");
    EXPECT_EQ(judged(body, {0.5, 0.011, 1.0}).verdict, Verdict::Holds);
    EXPECT_EQ(judged(body, {0.5, 0.009, 1.0}).verdict, Verdict::Fails);
    const std::string alone = bodyOf("same_mean: p, false_alarms: 3%, at: {n: 2}");
    EXPECT_EQ(judged(alone, {0.5, 0.031, 0.001}).verdict, Verdict::Holds);
    EXPECT_EQ(judged(alone, {0.5, 0.029, 1.0}).verdict, Verdict::Fails);
}

std::string checkError(const std::string& body) {
    const config::Experiment experiment = tables::experimentFrom(body);
    return errorText([&] { requireProvenance(experiment, tables::buildTable(experiment, {})); });
}

TEST(SameMean, IsAskedOfItsMetricAlone) {
    const std::string origin = ", origin: ours";
    const std::string claim = "same_mean: p, false_alarms: 1%" + origin;
    EXPECT_EQ(checkError(bodyOf(claim)), "no error");
    const std::string refused =
        " is 'same_mean': allowed: a column of the metric same_mean_p, without 'scale' and alone";
    for (const std::string& body :
         {bodyOf(claim, "metric: rmse"), bodyOf(claim, "metric: same_mean_p, scale: 2"),
          bodyOf("same_mean: p + 1, false_alarms: 1%" + origin)}) {
        const std::string error = checkError(body);
        EXPECT_TRUE(error.ends_with("claim 'X'" + refused)) << error;
        EXPECT_THAT(error, HasSubstr(".yaml:"));
    }
    const config::Experiment wrong = tables::experimentFrom(bodyOf(claim, "metric: rmse"));
    EXPECT_EQ(evaluateClaims(wrong, tables::buildTable(wrong, recorded({0.5})), kSoftwareDevice)
                  .at(0)
                  .verdict,
              Verdict::Unmeasured);
}

TEST(SameMean, IsRefusedWhereItCouldNotFail) {
    const auto errorWith = [](const std::string& truth, const std::string& output,
                              const std::string& rate) {
        const std::string error = checkError(
            "program: {command: \"t {n} {frame}\", params: {n: 4}, images: {result: {file: r.exr, "
            "truth: " +
            truth + "}}}\noutput: " + output + "\n" +
            bodyOf("same_mean: p, origin: ours, false_alarms: " + rate));
        return error.substr(error.find("claim 'X'") == std::string::npos ? 0
                                                                         : error.find("claim 'X'"));
    };
    EXPECT_EQ(errorWith("{frame: 99, frames: 6}", "{frames: 6}", "1%"), "no error");
    EXPECT_EQ(errorWith("{frame: 99}", "{frames: 6}", "1%"),
              "claim 'X' is 'same_mean' and needs an image whose truth has several 'frames': "
              "{frame: 1000, frames: 6}");
    EXPECT_EQ(errorWith("{frame: 99, frames: 6}", "{frames: 1}", "1%"),
              "claim 'X' is 'same_mean' and needs 'output.frames', a seed each: 2 or more");
    // 2 of 924 deals a row.
    EXPECT_EQ(
        errorWith("{frame: 99, frames: 6}", "{frames: 6}", "0.6%"),
        "claim 'X' asks for 0.6 % of false alarms over 3 rows, and could not fail: 6 frames and 6 "
        "of the truth come to no p below 0.65 %; take more ('output.frames', 'truth: {frames}')");
}

const std::vector<std::string> kLabels{"a", "a_0.5", "a / b", "8 bits", "8"};

/// Columns as [label], problems as !text!, what stands between as it is.
std::string read(const std::string& expression, const std::vector<std::string>& labels = kLabels) {
    std::string text;
    for (const OperandPiece& piece : operandPieces(expression, labels)) {
        text += piece.column            ? "[" + labels[*piece.column] + "]"
                : piece.problem.empty() ? std::string(piece.text)
                                        : "!" + std::string(piece.text) + "!";
    }
    return text;
}

std::string problemOf(const std::string& expression) {
    for (const OperandPiece& piece : operandPieces(expression, kLabels)) {
        if (!piece.problem.empty()) return piece.problem;
    }
    return "none";
}

TEST(ClaimOperands, NameColumnsByTheirLabels) {
    EXPECT_EQ(read("a"), "[a]");
    EXPECT_EQ(read("a_0.5 * 2 + max(a, 1e-3)"), "[a_0.5] * 2 + max([a], 1e-3)");
    EXPECT_EQ(read("a / b"), "[a / b]") << "the longest";
    EXPECT_EQ(read("(a / b) / a"), "([a / b]) / [a]");
    EXPECT_EQ(read("'a' / \"a / b\""), "[a] / [a / b]");
    EXPECT_EQ(read("8 bits - 1"), "[8 bits] - 1");
    EXPECT_EQ(read(""), "");
}

TEST(ClaimOperands, ANumberIsOneWhereItCannotBeAColumn) {
    EXPECT_EQ(read("8"), "[8]");
    EXPECT_EQ(read("4"), "!4!") << "a column that is not there";
    EXPECT_EQ(read("4", {"a"}), "4");
    EXPECT_EQ(read("'8' + 8.0"), "[8] + 8.0");
    EXPECT_EQ(problemOf("a + 8"),
              "'8' may be the column or the number (quoted it is the column; written otherwise, as "
              "8.0, the number)");
}

TEST(ClaimOperands, OtherNamesAreNoColumns) {
    const std::string columns = " (columns: " + joined(kLabels) + ")";
    EXPECT_EQ(problemOf("a + time"), "'time' is no column" + columns);
    EXPECT_EQ(problemOf("a + 'a_0.6'"), "'a_0.6' is no column; did you mean 'a_0.5'?" + columns);
    EXPECT_EQ(problemOf("a + 'a"), "quotes without an end: 'a");
    EXPECT_EQ(read("sum (a)"), "sum ([a])") << "called";
    EXPECT_EQ(problemOf("mean(a)"),
              "'mean' is no function; allowed: abs, avg, exp, ln, log10, log2, max, min, rint, "
              "sign, sqrt, sum");
    EXPECT_EQ(problemOf("squrt(a)"), "'squrt' is no function; did you mean 'sqrt'?");
}

TEST(ClaimOperands, AFunctionIsCalledBesideAColumnOfItsName) {
    EXPECT_EQ(read("sqrt(log2)", {"log2"}), "sqrt([log2])");
    EXPECT_EQ(read("log2 (log2) / log2", {"log2"}), "log2 ([log2]) / [log2]");
    EXPECT_EQ(read("a (b)", {"a", "b"}), "[a] ([b])") << "no function";
}

TEST(ClaimOperands, SidesAreApartOutsideOfParenthesesAndColumns) {
    EXPECT_THAT(sidesOf("a_0.5 / a", " / ", kLabels), ElementsAre("a_0.5", "a"));
    EXPECT_THAT(sidesOf("(a / 2) / 'a / b'", " / ", kLabels), ElementsAre("(a / 2)", "'a / b'"));
    EXPECT_THAT(sidesOf("a / b / a", " / ", kLabels), ElementsAre("a / b", "a"));
    EXPECT_THAT(sidesOf("a/2 / a", " / ", kLabels), ElementsAre("a/2", "a"));
    EXPECT_THAT(sidesOf("a < 8 bits<b", "<", kLabels), ElementsAre("a", "8 bits", "b"));
    EXPECT_THAT(sidesOf("a <", "<", kLabels), ElementsAre("a", ""));
    EXPECT_THAT(sidesOf("a / b", " / ", kLabels), ElementsAre("a / b"));
}

// Verdicts on generated scenes that were taken at several seeds.

constexpr const char* kBody = R"(
sweep: {scene: [grass, scan]}
layout:
  rows: scene
  columns: {share: {metric: share}}
  cell: "{median:.1f}"
claims:
  bound: {says: the meadow has many, bound: share, at_least: 5, at: {scene: grass}}
  order: {says: and more than the scan, order: [scene=scan, scene=grass]}
)";

/// The meadow's share at each seed; the scan, which has none, has 6.
tables::Recorded records(const std::vector<double>& shares) {
    tables::RecordMaker maker;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const std::string sample = "\"scene_sample\":" + std::to_string(i);
        if (i == 0) {
            maker.beginCase("grass", "{" + sample + "}");
        } else {
            maker.beginCase("grass@" + std::to_string(i + 1),
                            "{" + sample + ",\"stands_for\":\"grass\"}");
        }
        maker.lane("quality").add("share", {shares[i]}, "", "%");
    }
    maker.beginCase("scan").lane("quality").add("share", {6.0}, "", "%");
    return maker.records();
}

Verdict verdictOnShares(const std::string& claim, const std::vector<double>& shares) {
    const config::Experiment experiment = tables::experimentFrom(kBody);
    for (const ClaimResult& result :
         evaluateClaims(experiment, tables::buildTable(experiment, records(shares)),
                        {"llvmpipe", "software", "paper", "abc", ""})) {
        if (result.id == claim) return result.verdict;
    }
    return Verdict::Unmeasured;
}

TEST(SceneSeeds, AreOneCellWithTheRange) {
    const config::Experiment experiment = tables::experimentFrom(kBody);
    const tables::Table table = tables::buildTable(experiment, records({9, 8, 7, 10, 11}));
    ASSERT_EQ(table.rows.size(), 2U);
    const tables::Cell& grass = table.rows[0].cells[0];
    EXPECT_TRUE(grass.isOk()) << grass.message;
    EXPECT_EQ(grass.measured, "9.0");
    EXPECT_EQ(grass.low, "7.0");
    EXPECT_EQ(grass.high, "11.0");
    EXPECT_EQ(table.rows[1].cells[0].measured, "6.0");
}

/// Other scenes have other numbers: these are no random ones.
TEST(SceneSeeds, AreNoScatter) {
    const config::Experiment experiment = tables::experimentFrom(kBody);
    const tables::Table table = tables::buildTable(experiment, records({9, 8, 7, 10, 11}));
    EXPECT_FALSE(table.rows[0].cells[0].scatters);
}

TEST(SceneSeeds, FewDecideNothing) {
    EXPECT_EQ(verdictOnShares("bound", {9, 8}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("bound", {9, 8, 7, 10}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("bound", {9, 9}), Verdict::Holds) << "they do not differ";
}

/// However many processes each scene has, these are no more scenes.
TEST(SceneSeeds, AreAsManyRoundsAsScenes) {
    tables::RecordMaker maker;
    for (int seed = 0; seed < 3; ++seed) {
        const std::string sample = "\"scene_sample\":" + std::to_string(seed);
        const std::string other = seed == 0 ? "" : ",\"stands_for\":\"grass\"";
        maker.beginCase(seed == 0 ? "grass" : "grass@" + std::to_string(seed + 1),
                        "{" + sample + other + "}");
        maker.lane("quality");
        for (const int process : {0, 1}) {
            maker.process(process).add("share", {9.0 + seed + 0.2 * process}, "", "%");
        }
    }
    const tables::Table table = tables::buildTable(tables::experimentFrom(kBody), maker.records());
    const tables::Cell& grass = table.rows[0].cells[0];
    EXPECT_EQ(grass.values[0].rounds.size(), 3U);
    EXPECT_DOUBLE_EQ(grass.values[0].value, 10.1);
}

/// Two processes of a scan are two however many seeds the meadow has.
TEST(SceneSeeds, ProcessesOfOtherScenesAreNoSeeds) {
    tables::RecordMaker maker;
    for (int seed = 0; seed < 5; ++seed) {
        const std::string sample = "\"scene_sample\":" + std::to_string(seed);
        maker.beginCase(
            seed == 0 ? "grass" : "grass@" + std::to_string(seed + 1),
            seed == 0 ? "{" + sample + "}" : "{" + sample + ",\"stands_for\":\"grass\"}");
        maker.lane("quality").add("share", {9.0}, "", "%");
    }
    maker.beginCase("scan").lane("quality");
    for (const int process : {0, 1}) {
        maker.process(process).add("share", {process == 0 ? 6.0 : 7.0}, "", "%");
    }
    const config::Experiment experiment = tables::experimentFrom(kBody);
    const tables::Table table = tables::buildTable(experiment, maker.records());
    const tables::Cell& scan = table.rows[1].cells[0];
    EXPECT_EQ(scan.values[0].rounds.size(), 2U);
    EXPECT_EQ(scan.bounds(), tables::Bounds::Range);
    for (const ClaimResult& result :
         evaluateClaims(experiment, table, {"llvmpipe", "software", "paper", "abc", ""})) {
        if (result.id == "order") EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    }
}

TEST(SceneSeeds, AVerdictTakesAllOfThem) {
    EXPECT_EQ(verdictOnShares("bound", {9, 8, 7, 10, 11}), Verdict::Holds);
    EXPECT_EQ(verdictOnShares("bound", {9, 8, 3, 10, 11}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("bound", {1, 2, 3, 4, 4.5}), Verdict::Fails);
    EXPECT_EQ(verdictOnShares("order", {9, 8, 7, 10, 11}), Verdict::Holds);
    EXPECT_EQ(verdictOnShares("order", {9, 8, 5.5, 10, 11}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("order", {1, 2, 3, 4, 5.5}), Verdict::Fails);
}

}  // namespace
}  // namespace gfxrepro::claims
