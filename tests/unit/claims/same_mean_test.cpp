// Claims that noisy pictures have the expectation of their truth.

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

}  // namespace
}  // namespace gfxrepro::claims
