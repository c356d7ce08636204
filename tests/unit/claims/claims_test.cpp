#include "runner/claims/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "engine/core/random.h"
#include "runner/claims/judge.h"
#include "runner/claims/kinds/operands.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::claims {
namespace {

const ReportContext kSoftware{"llvmpipe", "software", "quick", "abc", ""};
const ReportContext kGpu{"GeForce", "gpu", "paper", "abc", ""};

/// Rows n = 1, 2, 4, 8 with columns a, b, c; one claim.
std::string powersBody(const std::string& claim, const std::string& printed = "") {
    return R"(
sweep: {n: [1, 2, 4, 8]}
layout:
  rows: n
  columns:
    a: {metric: a}
    b: {metric: b}
    c-c: {metric: c}
  cell: "{median:.1f}"
)" + printed +
           "claims:\n  X: {says: as claimed, " + claim + "}\n";
}

using Function = double (*)(double);
constexpr Function kZero = [](double) { return 1.0; };

tables::Recorded powers(Function a, Function b = kZero, Function c = kZero) {
    tables::RecordMaker maker;
    for (const int n : {1, 2, 4, 8}) {
        maker.beginCase("", "{\"n\":" + std::to_string(n) + "}");
        maker.add("a", {a(n)}).add("b", {b(n)}).add("c", {c(n)});
    }
    return maker.records();
}

ClaimResult judgeOne(const std::string& body, const tables::Recorded& records,
                     const ReportContext& context = kSoftware) {
    const config::Experiment experiment = tables::experimentFrom(body);
    const auto results =
        evaluateClaims(experiment, tables::buildTable(experiment, records), context);
    GFXREPRO_ASSERT_EQ(results.size(), 1u);
    return results[0];
}

ClaimResult judgePowers(const std::string& claim, const tables::Recorded& records) {
    return judgeOne(powersBody(claim), records);
}

double infinite(double) {
    return std::numeric_limits<double>::infinity();
}

TEST(Claims, APerfectPictureIsBetterThanAnyOther) {
    const auto forty = [](double) { return 40.0; };
    const ClaimResult bound = judgePowers("bound: a, at_least: 30", powers(infinite));
    EXPECT_EQ(bound.verdict, Verdict::Holds);
    EXPECT_THAT(bound.measured, HasSubstr("∞"));
    EXPECT_THAT(bound.reason, Not(HasSubstr("crossing")));
    EXPECT_EQ(judgePowers("bound: a, at_most: 30", powers(infinite)).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers("order: a < b", powers(forty, infinite)).verdict, Verdict::Holds);
    EXPECT_EQ(judgePowers("order: a < b", powers(infinite, forty)).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers("exact: a, equals: 40", powers(infinite)).verdict, Verdict::Fails);
}

TEST(Claims, InfinityByInfinityIsNoNumber) {
    for (const char* claim : {"ratio: a / b, at_least: 1", "bound: a / b, at_least: 1",
                              "order: c-c < a / b", "trend: a, over: n, at_least: 0, at_most: 1"}) {
        const ClaimResult result = judgePowers(claim, powers(infinite, infinite));
        EXPECT_EQ(result.verdict, Verdict::Unmeasured) << claim << ": " << result.measured;
    }
}

TEST(Claims, Order) {
    const auto records = powers([](double n) { return n; }, [](double n) { return 2.0 * n; },
                                [](double n) { return n == 4.0 ? 8.0 : 4.0 * n; });
    ClaimResult result = judgePowers("order: a < b", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.required, "a < b");
    EXPECT_EQ(result.measured, "smallest gap 50 %");
    EXPECT_EQ(result.margin, "50 %");
    result = judgePowers("order: a < b < c-c", records);  // b = c at n = 4
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "smallest gap 0 %");
    EXPECT_EQ(result.reason, "worst at n 4; one sample");
    EXPECT_EQ(judgePowers("order: b < a", records).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers("order: a < b < c-c, at: {n: [1, 2]}", records).verdict, Verdict::Holds);
}

TEST(Claims, Ratio) {
    const auto records = powers([](double n) { return 3.0 * n; }, [](double n) { return n; });
    ClaimResult result = judgePowers("ratio: a / b, at_least: 2.5, at_most: 4", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "3");
    EXPECT_EQ(result.required, "a / b in [2.5, 4]");
    EXPECT_EQ(result.margin, "0.5");
    EXPECT_EQ(judgePowers("ratio: a / b, at_least: 3", records).verdict, Verdict::Holds);
    result = judgePowers("ratio: a / b, at_least: 3.01", records);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.required, "a / b ≥ 3.01");
    EXPECT_EQ(result.margin, "-0.01");
    EXPECT_EQ(judgePowers("ratio: (a + b) / b, at_least: 4, at_most: 4", records).verdict,
              Verdict::Holds);
}

TEST(Claims, TrendExponentOverAxisAndColumn) {
    const auto records =
        powers([](double n) { return 5.0 * std::pow(n, 1.5); }, [](double n) { return n * n; });
    ClaimResult result = judgePowers("trend: a, over: n, at_least: 1.4, at_most: 1.6", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "exponent 1.5");
    result = judgePowers("trend: a, over: b, at_least: 0.7, at_most: 0.8", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "exponent 0.75");
    EXPECT_EQ(judgePowers("trend: a, over: n, at_least: 1.6, at_most: 2", records).verdict,
              Verdict::Fails);
    result = judgePowers("trend: a, over: n * b, at_least: 0.4, at_most: 0.6", records);
    EXPECT_EQ(result.measured, "exponent 0.5");
    for (const Function square : {Function([](double n) { return 3.0 * n * n; }),
                                  Function([](double n) { return 7.0 * n * n; }),
                                  Function([](double n) { return 10.0 * n * n; })}) {
        EXPECT_EQ(judgePowers("trend: a, over: n, at_least: 2, at_most: 2", powers(square)).verdict,
                  Verdict::Holds);
    }
    const auto exponential = powers([](double n) { return std::exp2(-n); });
    EXPECT_EQ(judgePowers("trend: a, over: 2^n, at_least: -1, at_most: -1", exponential).measured,
              "exponent -1");
}

TEST(Claims, TrendDirection) {
    const auto rising = powers([](double n) { return n; });
    const auto stepped = powers([](double n) { return n == 4.0 ? 2.0 : n; });
    EXPECT_EQ(
        judgePowers("trend: a, over: n, direction: increasing, strictly: true", rising).verdict,
        Verdict::Holds);
    EXPECT_EQ(judgePowers("trend: a, over: n, direction: increasing", stepped).verdict,
              Verdict::Holds);
    const ClaimResult result =
        judgePowers("trend: a, over: n, direction: increasing, strictly: true", stepped);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.required, "strictly increasing with n");
    EXPECT_EQ(judgePowers("trend: a, over: n, direction: decreasing", rising).verdict,
              Verdict::Fails);
    // Both: rising as asked, but not with that exponent.
    const ClaimResult both =
        judgePowers("trend: a, over: n, direction: increasing, at_least: 2, at_most: 3", rising);
    EXPECT_EQ(both.verdict, Verdict::Fails);
    EXPECT_EQ(both.measured, "smallest step 50 %; exponent 1");
    EXPECT_EQ(both.required, "increasing with n; exponent in [2, 3]");
}

TEST(Claims, Independent) {
    const auto records =
        powers([](double n) { return n == 8.0 ? 11.0 : 10.0; }, [](double n) { return n; });
    ClaimResult result = judgePowers("independent: a, of: n, at_most: 10%", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "spread 10 %");
    EXPECT_EQ(result.required, "spread of a ≤ 10 %");
    result = judgePowers("independent: [a, b], of: n, at_most: 10%", records);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "spread 10 %; spread 233.3 %");  // 7 / median 3
}

TEST(Claims, Bound) {
    const auto records = powers([](double n) { return n; }, [](double) { return 0.5; });
    EXPECT_EQ(judgePowers("bound: a + b, at_least: 1.5, at_most: 8.5", records).verdict,
              Verdict::Holds);
    const ClaimResult result = judgePowers("bound: a + b, at_most: 8", records);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "8.5");
    EXPECT_EQ(result.required, "a + b ≤ 8");
    EXPECT_EQ(result.reason, "worst at n 8; one sample");
}

TEST(Claims, StrictBoundsExcludeTheBound) {
    const auto records = powers([](double) { return 0.0; });
    EXPECT_EQ(judgePowers("bound: a, at_least: 0", records).verdict, Verdict::Holds);
    const ClaimResult result = judgePowers("bound: a, more_than: 0, less_than: 1", records);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.required, "a in (0, 1)");
    EXPECT_EQ(judgePowers("bound: a, less_than: 0", records).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers("bound: a, less_than: 0.1", records).required, "a < 0.1");
}

TEST(Claims, KnownVerdictsAndNews) {
    const auto records = powers([](double n) { return n; });
    const std::string fails =
        "because: {verdict: fails, profile: quick, reason: the scene, shown_by: two others}";
    ClaimResult result = judgePowers("bound: a, at_most: 1, " + fails, records);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.known, Verdict::Fails);
    EXPECT_EQ(result.because, "the scene");
    EXPECT_EQ(result.shownBy, "two others");
    EXPECT_FALSE(result.isNews());
    EXPECT_EQ(whyText(result), "the scene (worst at n 8; one sample)") << "the cause comes first";
    result = judgePowers("bound: a, at_most: 8, " + fails, records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_TRUE(result.isNews());
    EXPECT_EQ(whyText(result), "worst at n 8; one sample. Where it fails: the scene");
    result = judgePowers("bound: a, at_most: 1, because: {verdict: fails, device: gpu, reason: r}",
                         records);
    EXPECT_EQ(result.known, Verdict::Holds);
    EXPECT_TRUE(result.isNews());
    const std::string ambiguous = "because: {verdict: ambiguous, reason: at the bound}";
    EXPECT_FALSE(judgePowers("bound: a, at_most: 8, " + ambiguous, records).isNews());
    EXPECT_TRUE(judgePowers("bound: a, at_most: 1, " + ambiguous, records).isNews());
}

TEST(Claims, NothingIsKnownOfAnAlteredRun) {
    ReportContext context = kSoftware;
    context.isAltered = true;
    const ClaimResult result =
        judgeOne(powersBody("bound: a, at_most: 8, because: {verdict: fails, reason: the scene}"),
                 powers([](double n) { return n; }), context);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.known, std::nullopt);
    EXPECT_FALSE(result.isNews());
    EXPECT_EQ(whyText(result), "worst at n 8; one sample. In the table as configured: the scene");
}

/// What is known of real models alone is no news where generated ones stand for them, and hold.
TEST(Claims, AReasonMayBeOfScenesOfFilesOrOfGeneratedOnesAlone) {
    const auto records = powers([](double n) { return n; });
    const auto judged = [&](const std::map<std::string, std::string>& sceneClasses) {
        ReportContext context = kSoftware;
        context.sceneClasses = sceneClasses;
        return judgeOne(
            powersBody("bound: a, at_most: 8, because: {verdict: fails, scenes: files, reason: r}"),
            records, context);
    };
    EXPECT_EQ(judged({{"zju2005/9.9", "files"}}).known, Verdict::Fails);
    EXPECT_TRUE(judged({{"zju2005/9.9", "files"}}).isNews());
    EXPECT_EQ(judged({{"zju2005/9.9", "generated"}}).known, Verdict::Holds);
    EXPECT_EQ(judged({{"zju2005/9.8", "files"}}).known, Verdict::Holds) << "of another table";
}

TEST(Claims, ScenesAreOfFilesOrGeneratedOrSome) {
    const auto classOf = [](const SceneFiles& files) { return sceneClass({"a", "b"}, files); };
    EXPECT_EQ(classOf({{"a", true}, {"b", true}, {"c", false}}), "files");
    EXPECT_EQ(classOf({{"a", false}, {"b", false}}), "generated");
    EXPECT_EQ(classOf({{"a", false}, {"b", true}}), "");
    EXPECT_EQ(classOf({{"a", true}}), "");
    EXPECT_EQ(sceneClass({}, {{"a", true}}), "") << "no scene";
}

/// What is refused of its claims, from the word claim on.
std::string refusalOf(const config::Experiment& experiment) {
    try {
        requireProvenance(experiment, tables::buildTable(experiment, {}));
        return "no error";
    } catch (const Error& error) {
        const std::string text = error.what();
        return text.substr(text.find("claim"));
    }
}

std::string provenanceError(const std::string& claim, bool isSweep = false, int processes = 6) {
    config::Experiment experiment = tables::experimentFrom(
        "measure: {lane: timing, processes: " + std::to_string(processes) +
        "}\nsweep: {scene: [s, t]}\nlayout: {axes: {e: {slow: {metric: gpu_time_ms}, much: "
        "{metric: bytes}, often: {metric: frame_rate}}}, rows: [scene, e], columns: {a: {pass: p}, "
        "n: {metric: bytes}}}\nclaims:\n  C: {says: s, " +
        claim + "}\n");
    if (isSweep) experiment.kind = config::ExperimentKind::Sweep;
    return refusalOf(experiment);
}

TEST(Claims, WhatReadsATimeHasAKind) {
    EXPECT_EQ(provenanceError("bound: a, at_most: 1, at: {e: much}"), "no error");
    EXPECT_EQ(
        provenanceError("bound: a, at_most: 1, at: {e: much}, origin: document, bound_from: print"),
        "claim 'C' has its bound from print, and the table has no printed values: text | ours");
    EXPECT_EQ(provenanceError("order: [scene=s, scene=t], at: {e: slow}, origin: document"),
              "claim 'C' reads a time and needs 'kind': algorithmic | architectural");
    EXPECT_EQ(provenanceError(
                  "order: [scene=s, scene=t], at: {e: slow}, origin: document, kind: algorithmic"),
              "no error");
    EXPECT_EQ(provenanceError(
                  "order: [scene=s, scene=t], at: {e: much}, origin: document, kind: algorithmic"),
              "claim 'C' has a 'kind' and reads no time");
    const std::string isAbsolute =
        "claim 'C' holds a time against a number, which neither a count of work nor another "
        "machine decides; its 'kind' is absolute";
    const std::string ofTime = ", at: {e: slow}, origin: document, kind: algorithmic";
    EXPECT_EQ(provenanceError("bound: a, at_most: 100, bound_from: text" + ofTime), isAbsolute);
    EXPECT_EQ(provenanceError("order: a < 16.6" + ofTime), isAbsolute);
    EXPECT_EQ(
        provenanceError("order: a < 16.6, at: {e: slow}, origin: document, kind: architectural"),
        isAbsolute);
    EXPECT_EQ(provenanceError("order: a < 16.6, at: {e: slow}, origin: document, kind: absolute"),
              "no error");
    EXPECT_EQ(provenanceError("order: a < 16.6, at: {e: slow}"), "no error") << "absolute, too";
    EXPECT_EQ(provenanceError("bound: a / a, at_most: 100, bound_from: text" + ofTime), "no error");
    EXPECT_EQ(provenanceError("bound: a / a, at_most: 100, bound_from: text" + ofTime, false, 5),
              "claim 'C' is of a time: the paper profile needs processes: 6 or more, has 5");
    // What would come out otherwise if all times were twice as long.
    EXPECT_EQ(provenanceError("bound: a / n, at_most: 100, bound_from: text" + ofTime), isAbsolute);
    EXPECT_EQ(provenanceError("order: a < n" + ofTime), isAbsolute);
    EXPECT_EQ(provenanceError("order: a < a + 5" + ofTime), isAbsolute);
    EXPECT_EQ(provenanceError("order: a / n < 2 * a / n" + ofTime), "no error");
    EXPECT_EQ(provenanceError("order: 0 < a - a / 2" + ofTime), "no error");
    EXPECT_EQ(provenanceError("trend: a - 5, over: n, direction: increasing" + ofTime), isAbsolute);
    EXPECT_EQ(provenanceError("bound: a > 20, at_most: 1, bound_from: text" + ofTime), isAbsolute);
    EXPECT_EQ(provenanceError(
                  "trend: n, over: a, direction: increasing, at: {e: slow}, origin: document"),
              "claim 'C' reads a time and needs 'kind': algorithmic | architectural");
    EXPECT_EQ(provenanceError("order: [e=slow, e=often], origin: document, kind: algorithmic"),
              isAbsolute);
    // A reason for where it is not judged is of an earlier claim.
    const std::string ofGpu =
        "order: a < 2 * a, at: {e: slow}, origin: document, kind: architectural, because: "
        "{verdict: fails, reason: r";
    EXPECT_EQ(provenanceError(ofGpu + ", device: software}"),
              "claim 'C' has a reason for software ('because'), and a GPU alone judges it");
    EXPECT_EQ(provenanceError(ofGpu + ", device: gpu}"), "no error");
    EXPECT_EQ(provenanceError(ofGpu + "}"), "no error");
    EXPECT_EQ(provenanceError("profile: paper, " + ofGpu + ", profile: quick}"),
              "claim 'C' has a reason in the profile quick, and is judged in paper alone");
    EXPECT_EQ(provenanceError("profile: paper, " + ofGpu + ", profile: paper}"), "no error");
    EXPECT_EQ(provenanceError("order: n < 2 * n, origin: calibrated"),
              "claim 'C' is of a calibrated input, and reads cells that 'printed.calibrated' does "
              "not mark");
    // A sweep's are ours, and its times no others; counts decide them.
    EXPECT_EQ(provenanceError("bound: a, at_most: 1, at: {e: much}", true), "no error");
    EXPECT_EQ(provenanceError("bound: a / a, at_most: 100, at: {e: slow}", true), "no error");
    EXPECT_EQ(provenanceError("bound: a, at_most: 100, at: {e: slow}", true), "no error");
    EXPECT_EQ(provenanceError("bound: a, at_most: 100, at: {e: slow}, kind: algorithmic", true),
              isAbsolute);
    EXPECT_EQ(provenanceError("order: [scene=s, scene=t], at: {e: slow}, kind: algorithmic", true),
              "no error");
}

TEST(Claims, ABoundFromPrintReadsWhatIsPrinted) {
    const auto errorOf = [](const std::string& claim) {
        const config::Experiment experiment = tables::experimentFrom(
            "sweep: {scene: [s, t]}\nlayout: {rows: scene, columns: {a: {metric: bytes}, b: "
            "{metric: count}}}\nprinted: {values: \"scene,a\\ns,4\\nt,\"}\nclaims:\n  C: {says: s, "
            "origin: document, bound_from: print, " +
            claim + "}\n");
        return refusalOf(experiment);
    };
    const std::string readsNone =
        "claim 'C' has its bound from print, and reads no cell with a printed value: text | ours";
    EXPECT_EQ(errorOf("bound: a, at_most: 4"), "no error");
    EXPECT_EQ(errorOf("ratio: b / a, at_most: 4"), "no error") << "one that is printed will do";
    EXPECT_EQ(errorOf("bound: b, at_most: 4"), readsNone);
    EXPECT_EQ(errorOf("bound: a, at_most: 4, at: {scene: t}"), readsNone) << "what is lost";
    EXPECT_EQ(errorOf("across: scene, ratio: s / t, at_most: 4, of: a"), "no error");
}

TEST(Claims, WhatIsPrintedMeetsABoundFromPrint) {
    const auto errorOf = [](const std::string& claim, const std::string& origin = "document") {
        const config::Experiment experiment = tables::experimentFrom(
            "sweep: {number: [1, 2]}\nlayout: {rows: number, columns: {a: {metric: bytes}, t: "
            "{metric: gpu_time_ms}}}\nprinted: {values: "
            "\"number,a,t\\n1,4,10\\n2,8,20\\n4,16,80\"}\n"
            "profiles: {paper: {measure: {processes: 6}}}\nclaims:\n  C: {says: s, origin: " +
            origin + ", bound_from: print, " + claim + "}\n");
        return refusalOf(experiment);
    };
    const std::string isNotMet =
        "claim 'C' has its bound from print, and what is printed does not meet it: ";
    EXPECT_EQ(errorOf("bound: a, at_most: 16"), "no error");
    EXPECT_EQ(errorOf("bound: a, at_most: 8"), isNotMet + "16") << "of a row that is not measured";
    EXPECT_EQ(errorOf("bound: a, at_most: 8", "ours"), "no error") << "ours may better it";
    EXPECT_EQ(errorOf("across: number, ratio: 2 / 1, at_most: 1.5, of: a"), isNotMet + "2");
    EXPECT_EQ(errorOf("trend: t, over: number, at_least: 0.75, at_most: 3, kind: algorithmic"),
              "no error")
        << "a printed time is a number, and lies evenly between these";
    EXPECT_EQ(errorOf("trend: t, over: number, at_least: 2, at_most: 3, kind: algorithmic"),
              isNotMet + "exponent 1.5");
    const std::string isAnother =
        "claim 'C' has its bound from print, and what is printed is another number: ";
    EXPECT_EQ(errorOf("trend: t, over: number, at_least: 1, at_most: 2, kind: algorithmic"),
              isAnother + "exponent 1.5");
    EXPECT_EQ(errorOf("bound: a, at_least: -5, at_most: 1000"), isAnother + "4");
    EXPECT_EQ(errorOf("bound: a, at_least: 4, at_most: 1000"), isAnother + "4") << "both are asked";
    EXPECT_EQ(errorOf("bound: a, at_least: 4, at_most: 16"), "no error");
    EXPECT_EQ(errorOf("bound: a - a, at_most: 0"), "no error");
    EXPECT_EQ(errorOf("trend: t, over: number, at_least: 0.01, at_most: 225, kind: algorithmic"),
              isAnother + "exponent 1.5")
        << "evenly, but by any factor";
    EXPECT_EQ(errorOf("tolerance: a, at_most: 50%"),
              "claim 'C' is 'tolerance', whose width is never printed; write 'bound_from: ours', "
              "or 'text'");
}

TEST(Claims, WhatCannotBeJudgedIsRefused) {
    const auto errorOf = [](const std::string& claim) {
        return refusalOf(tables::experimentFrom(
            "sweep: {scene: [s, t], number: [1, 2]}\nlayout: {rows: [scene, number], columns: {a: "
            "{metric: bytes}, b: {metric: count}}}\nprinted: {calibrated: [{column: a}], values: "
            "\"scene,number,a\\ns,1,5\"}\nclaims:\n  C: {says: s, origin: document, " +
            claim + "}\n"));
    };
    EXPECT_EQ(errorOf("trend: b, over: scene, direction: increasing"),
              "claim 'C' needs numbers along 'scene', which holds 's'");
    EXPECT_EQ(errorOf("crossover: [a, b], over: scene, at_least: 1, at_most: 2"),
              "claim 'C' needs numbers along 'scene', which holds 's'");
    EXPECT_EQ(errorOf("trend: b, over: number, direction: increasing"), "no error");
    EXPECT_EQ(errorOf("independent: b, of: scene, at_most: 5%"), "no error");
    EXPECT_EQ(errorOf("trend: b, over: b, direction: increasing"),
              "claim 'C' holds 'b' against itself");
    EXPECT_EQ(errorOf("trend: b, over: a, direction: increasing"), "no error");
    EXPECT_EQ(errorOf("order: b < 2 * b, at: {scene: []}"),
              "claim 'C' has an empty list of 'scene' in 'at'");
    EXPECT_EQ(errorOf("order: a < 2 * a"),
              "claim 'C' reads nothing but cells that an input of ours was fitted to "
              "('printed.calibrated'): its origin is calibrated");
    EXPECT_EQ(errorOf("order: a < b"), "no error");
}

TEST(Claims, WhatReadsCalibratedCellsSaysSo) {
    tables::RecordMaker maker;
    maker.beginCase("s", R"({"number":1})").add("bytes", {4.0}).add("count", {5.0});
    const auto reasonOf = [&](const std::string& origin, const std::string& order) {
        const config::Experiment experiment = tables::experimentFrom(
            "sweep: {number: [1]}\nlayout: {rows: number, columns: {a: {metric: bytes}, b: "
            "{metric: count}}}\nprinted: {calibrated: [{column: a}], values: "
            "\"number,a,b\\n1,4,5\"}\nclaims:\n  C: {says: s, origin: " +
            origin + ", order: " + order + "}\n");
        const tables::Table table = tables::buildTable(experiment, maker.records());
        return evaluateClaims(experiment, table, kSoftware)[0].reason;
    };
    EXPECT_EQ(reasonOf("document", "a < b"), "one sample; some of what it reads is calibrated");
    EXPECT_EQ(reasonOf("document", "a < 2 * a"), "one sample; what it reads is calibrated");
    EXPECT_EQ(reasonOf("document", "b < 2 * b"), "one sample");
    EXPECT_EQ(reasonOf("calibrated", "a < 2 * a"), "one sample");
}

/// What has no interval is never told from its bound.
TEST(Claims, OnlyWhatHasAnIntervalIsKnownAsAmbiguous) {
    const auto errorOf = [](const std::string& measure, const std::string& claim) {
        const config::Experiment experiment = tables::experimentFrom(
            measure + "sweep: {scene: [s, t]}\nlayout: {rows: scene, columns: {" +
            (measure.find("timing") == measure.npos ? "" : "time: {metric: gpu_time_ms}, ") +
            "much: {metric: bytes}, part: {metric: drawn_pct}}}\nclaims:\n  C: {says: s, origin: "
            "document, " +
            claim + "}\n");
        return refusalOf(experiment);
    };
    const std::string count = "measure: {lane: quality}\n";
    const std::string five = "scene_seeds: 5\nmeasure: {lane: quality}\n";
    const std::string times = "measure: {lane: timing, processes: 6}\n";
    const std::string known = ", because: {verdict: ambiguous, reason: r}";
    const std::string refused =
        "claim 'C' is known as ambiguous, and reads neither a time nor a share, of one scene: a "
        "number without an interval holds or fails";
    EXPECT_EQ(errorOf(count, "order: much < 2 * much" + known), refused);
    EXPECT_EQ(errorOf(count, "order: part < much" + known), "no error");
    EXPECT_EQ(errorOf(five, "order: much < 2 * much" + known), "no error");
    EXPECT_EQ(errorOf(count, "order: much < 2 * much, because: {verdict: fails, reason: r}"),
              "no error");
    EXPECT_EQ(errorOf(times, "order: time < 2 * time, kind: algorithmic" + known), "no error");
}

TEST(Claims, ATimeAsSuchIsJudgedAtThePrintedParametersAlone) {
    tables::RecordMaker maker;
    maker.beginCase("models/duck", R"({"size": 64})");
    for (int process = 0; process < 6; ++process) maker.process(process).add("gpu_time_ms", {8.0});
    const config::Experiment experiment = tables::experimentFrom(R"(
sweep: {scene: [models/duck]}
layout: {rows: scene, columns: {draw_ms: {metric: gpu_time_ms}}}
printed: {values: "scene,draw_ms\nmodels/duck,8"}
claims:
  V: {says: s, bound: draw_ms, at_most: 10, bound_from: print}
)");
    const auto judgeBeside = [&](const char* printedAt, const ReportContext& context = kGpu) {
        const config::Experiment known =
            tables::withPaperCases(experiment, {{"models/duck", printedAt}});
        return evaluateClaims(known, tables::buildTable(known, maker.records()), context).at(0);
    };
    EXPECT_EQ(judgeBeside(R"({"size": 64})").verdict, Verdict::Holds);
    EXPECT_EQ(judgeBeside(R"({"size": 64})").timeKind, config::ClaimSpec::TimeKind::Absolute);
    EXPECT_EQ(judgeBeside(R"({"size": 64})", kSoftware).verdict, Verdict::NotApplicable);
    const ClaimResult result = judgeBeside(R"({"size": 256})");
    EXPECT_EQ(result.verdict, Verdict::NotApplicable);
    EXPECT_EQ(result.reason, "a time as such is judged at the printed parameters only");
}

TEST(Claims, ExactAndTolerance) {
    const std::string printed = R"(
printed:
  values: |
    n,a,b
    1,16,10
    2,4.0,
    4,,20
)";
    const auto records = powers([](double n) { return n == 1.0 ? 16.0 : 4.0; },
                                [](double n) { return n == 1.0 ? 11.0 : 19.0; });
    const auto judgePrinted = [&](const std::string& claim) {
        return judgeOne(powersBody(claim, printed), records);
    };
    EXPECT_EQ(judgePrinted("exact: a, equals: printed").verdict, Verdict::Holds);
    ClaimResult result = judgePrinted("exact: b, equals: printed");
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "largest difference 1");
    EXPECT_EQ(result.required, "b = printed");
    EXPECT_EQ(judgePrinted("exact: a, equals: 4, at: {n: [2, 4]}").verdict, Verdict::Holds);
    EXPECT_EQ(judgePrinted("exact: a, equals: 4").verdict, Verdict::Fails);
    result = judgePrinted("tolerance: b, at_most: 10%");
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "largest deviation 10 %");
    EXPECT_EQ(judgePrinted("tolerance: b, at_most: 9%").verdict, Verdict::Fails);
    result = judgePrinted("tolerance: b, at_most: 9%, at: {n: 8}");
    EXPECT_EQ(result.verdict, Verdict::Unmeasured);
    EXPECT_EQ(result.reason, "no printed number to compare with");
}

TEST(Claims, Crossover) {
    const auto records = powers([](double n) { return n * n; }, [](double n) { return 3.0 * n; },
                                [](double n) { return 100.0 * n; });
    ClaimResult result =
        judgePowers("crossover: [a, b], over: n, at_least: 2.9, at_most: 3.1", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "crossing at 3");
    EXPECT_EQ(judgePowers("crossover: [a, b], over: n, at_least: 4, at_most: 5", records).verdict,
              Verdict::Fails);
    result = judgePowers("crossover: [a, c-c], over: n, at_least: 1, at_most: 1000", records);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.reason, "there is no crossing within the rows; one sample");
}

TEST(Claims, NotApplicable) {
    const auto records = powers([](double n) { return n; });
    ClaimResult result = judgePowers("bound: a, at_most: 1, kind: architectural", records);
    EXPECT_EQ(result.verdict, Verdict::NotApplicable);
    EXPECT_EQ(result.reason, "claims about a GPU are not judged on a software device");
    EXPECT_EQ(result.measured, judgePowers("bound: a, at_most: 1", records).measured);
    EXPECT_NE(result.measured, "") << "beside what was asked for";
    EXPECT_EQ(result.margin, "");
    result = judgePowers("bound: a, at_most: 1, profile: paper", records);
    EXPECT_EQ(result.verdict, Verdict::NotApplicable);
    EXPECT_EQ(result.reason, "judged in the profile 'paper' only");
    EXPECT_EQ(judgeOne(powersBody("bound: a, at_most: 8, kind: architectural, profile: paper"),
                       records, kGpu)
                  .verdict,
              Verdict::Holds);
}

TEST(Claims, UnmeasuredNamesTheCell) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})").add("a", {1.0}).add("b", {1.0});
    maker.beginCase("", R"({"n":2})").fail(records::Status::Oom, "killed at 2 GiB");
    const ClaimResult result =
        judgePowers("trend: a, over: n, at_least: 0, at_most: 9", maker.records());
    EXPECT_EQ(result.verdict, Verdict::Unmeasured);
    EXPECT_EQ(result.reason, "a at n=2: oom (killed at 2 GiB)");
    EXPECT_EQ(judgePowers("bound: a, at_most: 2, at: {n: 1}", maker.records()).verdict,
              Verdict::Holds);
    config::Experiment one =
        tables::experimentFrom(powersBody("trend: a, over: n, at_least: 0, at_most: 9"));
    one.claims[0].at = {{"n", {Node::number(1.0)}}};
    EXPECT_EQ(evaluateClaims(one, tables::buildTable(one, maker.records()), kSoftware)[0].reason,
              "needs at least 2 rows, found 1");
    const ClaimResult zero = judgePowers("trend: a, over: n, at_least: 0, at_most: 9",
                                         powers([](double n) { return n - 1.0; }));
    EXPECT_EQ(zero.verdict, Verdict::Unmeasured);
}

/// The table shows it blank, as other rows have it, and a claim that asks for it is not judged
/// without it.
TEST(Claims, WhatACaseDidNotRecordIsUnmeasuredWhereAClaimReadsIt) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})").add("a", {1.0}).add("b", {1.0});
    maker.beginCase("", R"({"n":2})").add("b", {1.0});
    const ClaimResult result = judgePowers("bound: a, at_most: 2", maker.records());
    EXPECT_EQ(result.verdict, Verdict::Unmeasured);
    EXPECT_THAT(result.reason, HasSubstr("no 'a' was recorded"));
}

/// A failing row counts even where another row could not be measured.
TEST(Claims, FailureOutweighsAMissingRow) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})").add("a", {5.0});
    EXPECT_EQ(judgePowers("bound: a, at_most: 2", maker.records()).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers("bound: a, at_most: 6", maker.records()).verdict, Verdict::Unmeasured);
}

/// Over a column, rows are grouped by the axes that the column does not depend on.
TEST(Claims, GroupsByTheOtherAxes) {
    const std::string body = R"(
sweep: {scene: [s, m, l], method: [slow, fast]}
layout:
  rows: [scene, method]
  columns: {triangles: {metric: triangles}, time: {metric: t}}
  cell: "{median:.1f}"
claims:
  X: {says: time grows linearly, trend: time, over: triangles, at_least: 0.9, at_most: 1.1}
)";
    tables::RecordMaker maker;
    double triangles = 100.0;
    for (const std::string scene : {"s", "m", "l"}) {
        maker.beginCase(scene, R"({"method":"slow"})").add("triangles", {triangles});
        maker.add("t", {triangles * 9.0});
        maker.beginCase(scene, R"({"method":"fast"})").add("triangles", {triangles});
        maker.add("t", {std::pow(triangles, 0.5)});
        triangles *= 10.0;
    }
    const ClaimResult result = judgeOne(body, maker.records());
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "exponent 0.5");
    EXPECT_EQ(result.reason, "worst at fast; one sample");
}

std::string ratioBody(double low, double high) {
    return R"(
sweep: {method: [ours, theirs]}
scene: models/duck
layout:
  rows: scene
  columns: method
  cell: {metric: gpu_time_ms, format: "{median:.1f}"}
claims:
  X: {says: twice as fast, ratio: theirs / ours, at_least: )" +
           std::to_string(low) + ", at_most: " + std::to_string(high) + "}\n";
}

/// Sum of twelve uniform numbers: near enough to a normal distribution of deviation 1.
double normal(Random& random) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += double{random.uniform()};
    return sum;
}

tables::Recorded noisyPair(double ratio, double noise, std::uint64_t seed) {
    Random random(seed);
    tables::RecordMaker maker;
    for (const auto& [method, mean] :
         {std::pair("ours", 10.0), std::pair("theirs", 10.0 * ratio)}) {
        maker.beginCase("models/duck", std::string("{\"method\":\"") + method + "\"}");
        for (int i = 0; i < 7; ++i) {
            maker.process(i).add("gpu_time_ms", {mean * (1.0 + noise * normal(random))});
        }
    }
    return maker.records();
}

TEST(Claims, NoiseDoesNotUpsetAClearVerdict) {
    std::map<Verdict, int> inside, outside, onTheEdge;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        ++inside[judgeOne(ratioBody(1.5, 2.7), noisyPair(2.0, 0.05, seed)).verdict];
        ++outside[judgeOne(ratioBody(1.5, 2.7), noisyPair(1.2, 0.05, seed)).verdict];
        ++onTheEdge[judgeOne(ratioBody(2.0, 2.5), noisyPair(2.0, 0.05, seed)).verdict];
    }
    EXPECT_GE(inside[Verdict::Holds], 95);
    EXPECT_EQ(inside[Verdict::Fails], 0);
    EXPECT_GE(outside[Verdict::Fails], 95);
    EXPECT_EQ(outside[Verdict::Holds], 0);
    EXPECT_GE(onTheEdge[Verdict::Ambiguous], 80);
}

/// What the reason ends with where no CPU time was recorded.
const std::string kByTheClock = "; by the clock: no CPU time was recorded of these";

TEST(Claims, AmbiguousSaysSo) {
    const ClaimResult result = judgeOne(ratioBody(2.0, 2.5), noisyPair(2.0, 0.05, 3));
    EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    EXPECT_EQ(result.reason,
              "the interval reaches over the bound, so neither verdict is sure" + kByTheClock);
    EXPECT_THAT(result.measured, MatchesRegex("[0-9.]+ \\[[0-9.]+, [0-9.]+\\]"));
}

/// Rows n = 1, 2, 4, 8; wall and CPU time in each of `rounds` processes: a function of n and round.
using Timed = std::function<double(double n, int round)>;

tables::Recorded timedRows(int rounds, const Timed& wallMs, const Timed& processMs = {}) {
    tables::RecordMaker maker;
    for (const int n : {1, 2, 4, 8}) {
        maker.beginCase("", "{\"n\":" + std::to_string(n) + "}");
        for (int round = 0; round < rounds; ++round) {
            maker.process(round).add("wall_time_ms", {wallMs(n, round)});
            maker.add("frame_rate", {1000.0 / wallMs(n, round)}, "", "1/s");
            if (processMs) maker.add("process_time_ms", {processMs(n, round)});
        }
    }
    return maker.records();
}

std::string timedBody(const std::string& claim) {
    return R"(
sweep: {n: [1, 2, 4, 8]}
measure: {lane: timing, processes: 6}
layout:
  rows: n
  columns: {ms: {metric: wall_time_ms}, fps: {metric: frame_rate}}
  cell: "{median:.1f}"
claims:
  X: {says: as claimed, )" +
           claim + "}\n";
}

ClaimResult judgeTimed(const std::string& claim, const tables::Recorded& records,
                       const ReportContext& context = kSoftware) {
    return judgeOne(timedBody(claim), records, context);
}

/// What slows a round, slows all of its cases alike; and ± 1 % in turn.
double drift(int round) {
    constexpr double kDrift[] = {1.0, 1.6, 0.8, 2.0, 1.3, 1.1, 1.0, 0.7};
    return kDrift[round] * (round % 2 == 0 ? 1.01 : 0.99);
}

TEST(Claims, OneSampleOfATimeDecidesNothing) {
    const auto records = timedRows(1, [](double n, int) { return 100.0 * n; });
    ClaimResult result = judgeTimed("bound: ms, at_least: 1, kind: algorithmic", records);
    EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    EXPECT_EQ(result.measured, "100");
    EXPECT_EQ(result.reason, "worst at n 1; one sample of a time decides nothing" + kByTheClock);
    result = judgeTimed("bound: fps, at_most: 1000, kind: algorithmic", records);
    EXPECT_EQ(result.verdict, Verdict::Ambiguous) << "a rate is a time";
}

TEST(Claims, ARangeDecidesNothing) {
    const auto records = timedRows(5, [](double n, int round) { return n * (100.0 + round); });
    const ClaimResult result =
        judgeTimed("bound: ms, at_least: 1, at: {n: 1}, kind: algorithmic", records);
    EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    EXPECT_EQ(result.measured, "102 (100 … 104)");
    EXPECT_EQ(result.reason, "a range of 5 processes; " + tables::kNeedsSix + kByTheClock);
    const auto six = timedRows(6, [](double n, int round) { return n * (100.0 + round); });
    EXPECT_EQ(judgeTimed("bound: ms, at_least: 1, at: {n: 1}, kind: algorithmic", six).verdict,
              Verdict::Holds);
    EXPECT_EQ(judgeTimed("bound: ms, at_most: 1, at: {n: 1}, kind: algorithmic", six).verdict,
              Verdict::Fails);
}

/// The clock differs by 2.5 between rounds; what is compared was measured in the same round.
TEST(Claims, TimesAreComparedWithinTheirRound) {
    const auto records = timedRows(6, [](double n, int round) { return n * drift(round); });
    const ClaimResult result =
        judgeTimed("trend: ms, over: n, at_least: 0.99, at_most: 1.01", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "exponent 1 [1, 1]");
    EXPECT_EQ(judgeTimed("trend: ms, over: n, at_least: 1.02, at_most: 2", records).verdict,
              Verdict::Fails);
    // Alone the clock could not tell.
    EXPECT_EQ(judgeTimed("bound: ms, at_most: 1.2, at: {n: 1}, kind: algorithmic", records).verdict,
              Verdict::Ambiguous);
}

/// What a column shows of a quantity and what a claim says of it are one number and one interval.
TEST(Claims, JudgeTheMedianThatTheirColumnShows) {
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})").seeds(config::Measure::Seeds::Process);
    int process = 0;
    for (const double value : {1.0, 1.01, 1.02, 1.03, 1.04, 1.05, 1.06, 3.0, 4.0, 5.0}) {
        maker.process(process++).add("a", {value}, "", "1").add("b", {2.0}, "", "1");
        maker.add("c", {1.0 + 0.01 * process}, "", "1");
    }
    const auto records = maker.records();
    const config::Experiment experiment = tables::experimentFrom(
        "sweep: {n: [1]}\nlayout: {rows: n, columns: {a: {metric: a}, b: {metric: b}, c: {metric: "
        "c}, q: {of: a / c}}, cell: \"{median:.4g}\"}\n"
        "claims: {A: {says: so, bound: a, at_most: 2}, Q: {says: so, bound: q, at_most: 2}, R: "
        "{says: so, ratio: a / c, at_most: 2}, E: {says: so, bound: a / c, at_most: 2}}\n");
    const tables::Table table = tables::buildTable(experiment, records);
    const auto results = evaluateClaims(experiment, table, kSoftware);
    const auto shown = [&](std::size_t column) {
        const tables::Cell& cell = table.rows[0].cells[column];
        return fmt::format("{} [{}, {}]", cell.measured, cell.low, cell.high);
    };
    EXPECT_EQ(results[0].measured, "1.045 [1.01, 4]");
    EXPECT_EQ(results[0].measured, shown(0));
    for (const std::size_t i : {1U, 2U, 3U}) EXPECT_EQ(results[i].measured, shown(3)) << i;
}

/// Noise about the printed number is no deviation from it.
TEST(Claims, ADeviationHasItsSignWhereRoundsDiffer) {
    const auto judge = [](double middle) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})").seeds(config::Measure::Seeds::Process);
        int process = 0;
        for (const double share : {-0.2, 0.2, -0.15, 0.15, -0.1, 0.1, -0.05, 0.05}) {
            maker.process(process++).add("a", {middle * (1.0 + share)}, "", "1");
        }
        return judgeOne(
            "sweep: {n: [1]}\nlayout: {rows: n, columns: {a: {metric: a}}}\nprinted: {values: "
            "\"n,a\\n1,10\"}\nclaims: {T: {says: so, tolerance: a, at_most: 4%}}\n",
            maker.records());
    };
    ClaimResult result = judge(10.0);
    EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    EXPECT_EQ(result.measured, "deviation 0 % [-20 %, 20 %]");
    result = judge(5.0);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "deviation -50 % [-60 %, -40 %]");
}

TEST(Claims, TimesRiseOnTheWhole) {
    const std::string rising = "trend: ms, over: n, direction: increasing";
    ClaimResult result =
        judgeTimed(rising, timedRows(6, [](double n, int round) { return n * drift(round); }));
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "rank correlation 1 [1, 1]");
    // The last two are equal but for noise: a smallest step would fall below 0 in every other run.
    const Timed plateau = [](double n, int round) {
        const double noise = (round + static_cast<int>(n)) % 3 == 0 ? 1.02 : 0.98;
        return std::min(n, 4.0) * drift(round) * noise;
    };
    EXPECT_EQ(judgeTimed(rising, timedRows(6, plateau)).verdict, Verdict::Holds);
    EXPECT_EQ(
        judgeTimed("trend: ms, over: n, direction: decreasing", timedRows(6, plateau)).verdict,
        Verdict::Fails);
    // A step back that is beyond all noise.
    result = judgeTimed(rising, timedRows(6, [](double n, int round) {
                            return (n == 8.0 ? 2.5 : n) * drift(round);
                        }));
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_THAT(result.measured, StartsWith("step -37.5 %"));
    // Nothing but noise.
    result = judgeTimed(rising, timedRows(6, [](double n, int round) {
                            return 10.0 + (static_cast<int>(n) * 7 + round * 5) % 3;
                        }));
    EXPECT_EQ(result.verdict, Verdict::Ambiguous);
}

TEST(Claims, StrictlyIsSoOfWhatVaries) {
    const std::string rising = "trend: ms, over: n, direction: increasing";
    const auto judge = [&](const Timed& timed) {
        return judgeTimed(rising + ", strictly: true", timedRows(6, timed));
    };
    EXPECT_EQ(judge([](double n, int round) { return n * drift(round); }).verdict, Verdict::Holds);
    const Timed equal = [](double n, int round) { return std::min(n, 4.0) * drift(round); };
    const ClaimResult result = judge(equal);
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "step 0 % [0 %, 0 %]");
    EXPECT_EQ(judgeTimed(rising, timedRows(6, equal)).verdict, Verdict::Holds);
    const Timed open = [&](double n, int round) {
        return equal(n, round) * ((round + static_cast<int>(n)) % 3 == 0 ? 1.02 : 0.98);
    };
    EXPECT_EQ(judge(open).verdict, Verdict::Ambiguous);
    EXPECT_EQ(judgeTimed(rising, timedRows(6, open)).verdict, Verdict::Holds);
    // Rounded noise: 4 or 5 in both rows, which are alike in all six by chance.
    const Timed rounded = [](double n, int round) {
        return n < 4.0 ? n * drift(round) : round % 3 == 1 ? 5.0 : 4.0;
    };
    EXPECT_EQ(judge(rounded).verdict, Verdict::Ambiguous);
    EXPECT_THAT(
        judge(rounded).reason,
        StartsWith(
            "rounded values: with half a step on either side the interval reaches over the bound"));
    const Timed known = [](double n, int round) { return n < 4.0 ? n * drift(round) : 4.0; };
    EXPECT_EQ(judge(known).verdict, Verdict::Fails) << "the same in all processes";
    const Timed beside = [](double n, int round) {
        return n < 4.0 ? n + (round % 3 == 1 ? 0.1 : 0.2) : 4.0;
    };
    EXPECT_EQ(judge(beside).verdict, Verdict::Ambiguous) << "and others are rounded";
}

TEST(Claims, TimesThatAreAlike) {
    const Timed alike = [](double n, int round) { return drift(round) * (n == 8.0 ? 1.05 : 1.0); };
    const std::string within = "independent: ms, of: n, at_most: ";
    ClaimResult result = judgeTimed(within + "10%", timedRows(6, alike));
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "ratio of two rows 1.05 [1.05, 1.05]");
    EXPECT_EQ(judgeTimed(within + "3%", timedRows(6, alike)).verdict, Verdict::Fails);
    // Equal on average, but not known well enough to say so.
    const Timed noisy = [](double n, int round) {
        return (round + static_cast<int>(n)) % 2 == 0 ? 10.0 : 11.5;
    };
    EXPECT_EQ(judgeTimed(within + "10%", timedRows(6, noisy)).verdict, Verdict::Ambiguous);
}

/// The intervals of 1 and 2 are narrow by luck; others of the table are not.
TEST(Claims, ADifferenceBelowTheNoiseOfTheTableIsAmbiguous) {
    const auto records = timedRows(6, [](double n, int round) {
        return n <= 2.0 ? 100.0 + n + 0.02 * round : 500.0 + n * 20.0 * ((round * 5) % 3);
    });
    const ClaimResult result =
        judgeTimed("bound: ms, at_least: 100.5, at: {n: 2}, kind: algorithmic", records);
    EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    EXPECT_THAT(result.measured, HasSubstr("[102, 102.1]"));
    EXPECT_THAT(
        result.reason,
        MatchesRegex("nearer to the bound than the noise of these times, [0-9.]+ %" + kByTheClock));
    EXPECT_EQ(judgeTimed("bound: ms, at_least: 50, at: {n: 2}, kind: algorithmic", records).verdict,
              Verdict::Holds);
}

/// What a program says of itself scatters by a thousandth; its start by the factor of hundred.
TEST(Claims, ATimeIsJudgedByTheNoiseOfItsOwnColumn) {
    tables::RecordMaker maker;
    for (const char* build : {"old", "new"}) {
        maker.beginCase("", std::string(R"({"build":")") + build + "\"}").lane("timing");
        for (int round = 0; round < 6; ++round) {
            const double own = (build[0] == 'o' ? 1000.0 : 1500.0) * (1.0 + 0.001 * round);
            maker.process(round).add("wall_time_ms", {round % 2 == 0 ? 2000.0 : 20.0 * own});
            maker.add("render_ms", {own});
        }
    }
    const auto judge = [&](const std::string& claim) {
        return judgeOne(
            "sweep: {build: [old, new]}\nmeasure: {lane: timing, processes: 6}\nlayout:\n"
            "  rows: build\n  columns: {own: {metric: render_ms}, wall: {metric: wall_time_ms}}\n"
            "claims: {X: {says: as claimed, kind: algorithmic, " +
                claim + "}}\n",
            maker.records(), kGpu);
    };
    EXPECT_EQ(judge("ratio: new / old, across: build, of: own, at_least: 1.4").verdict,
              Verdict::Holds);
    EXPECT_EQ(judge("ratio: build=new / build=old, of: own, at_least: 1.6").verdict, Verdict::Fails)
        << "rows are compared by their values, too";
    EXPECT_EQ(judge("ratio: build=new / build=old, of: wall, at_least: 1.2").verdict,
              Verdict::Ambiguous);
    EXPECT_THAT(errorText([&] { judge("ratio: build=new / build=olt, of: own, at_least: 1"); }),
                HasSubstr("'olt' is no column"));
}

/// Of twenty rows that are alike one fails by itself: six seeds of one sign are one in 64.
TEST(Claims, OneOfManyRowsThatFailsByChanceIsAmbiguous) {
    const auto judge = [](double larger, int rows) {
        tables::RecordMaker maker;
        for (int n = 1; n <= rows; ++n) {
            maker.beginCase("", "{\"n\":" + std::to_string(n) + "}");
            maker.seeds(config::Measure::Seeds::Process);
            for (int round = 0; round < 6; ++round) {
                const double wave = ((n * 7 + round * 5 + n * round) % 11) / 110.0;
                maker.process(round).add("e", {n == 1 ? larger + 0.005 * round : 0.95 + wave}, "",
                                         "1");
            }
        }
        return judgeOne("sweep: {n: {range: [1, " + std::to_string(rows) +
                            "]}}\nlayout: {rows: n, columns: {e: {metric: e}}}\n"
                            "claims: {X: {says: as claimed, bound: e, at_most: 1}}\n",
                        maker.records());
    };
    EXPECT_EQ(judge(1.02, 1).verdict, Verdict::Fails);
    ClaimResult result = judge(1.02, 20);
    EXPECT_EQ(result.verdict, Verdict::Ambiguous) << result.measured;
    EXPECT_THAT(result.reason, HasSubstr("n 1; fails by itself, but the farthest of"));
    result = judge(1.5, 20);
    EXPECT_EQ(result.verdict, Verdict::Fails) << result.reason;
    EXPECT_THAT(result.reason, HasSubstr("worst at n 1"));
}

/// Where every case failed there is no row, and nobody laid any out.
TEST(Claims, WhereNothingWasMeasuredTheyAreUnmeasured) {
    const TemporaryFolder folder;
    const auto file =
        folder.write("s.yaml",
                     "sweep_of: s\ntitle: Mine\ntechnique: x\nsweep: {way: [a, b]}\n"
                     "claims: {better: {says: b is better, order: [b, a], of: rmse}}\n");
    const config::Experiment experiment = config::loadExperiment(file, {}, folder.path());
    const tables::Table table = tables::buildTable(experiment, tables::Recorded());
    const auto results = evaluateClaims(experiment, table, kSoftware);
    ASSERT_EQ(results.size(), 1U);
    EXPECT_EQ(results[0].verdict, Verdict::Unmeasured);
    EXPECT_EQ(results[0].reason, "nothing was measured");
}

TEST(Claims, AlgorithmicOnesAreJudgedByProcessTimeOnASoftwareDevice) {
    // By the clock a neighbour hides the slope; the work shows it.
    const Timed wall = [](double n, int round) {
        return 10.0 * ((round * 7 + int(n) * 3) % 5 + 1);
    };
    const Timed work = [](double n, int) { return 20.0 * n; };
    const auto records = timedRows(6, wall, work);
    const std::string claim = "trend: ms, over: n, at_least: 0.9, at_most: 1.1";
    ClaimResult result = judgeTimed(claim + ", kind: algorithmic", records);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "exponent 1 [1, 1]");
    EXPECT_EQ(result.reason, "by the CPU time of the process");
    EXPECT_NE(judgeTimed(claim + ", kind: algorithmic", records, kGpu).verdict, Verdict::Holds);
    // A rate of frames is the inverse of their time.
    result = judgeTimed("bound: fps, at_most: 6.3, at: {n: 8}, kind: algorithmic", records);
    EXPECT_EQ(result.measured, "6.25 [6.25, 6.25]");
    // Where none was recorded, the clock judges and it is said.
    result = judgeTimed(claim + ", kind: algorithmic", timedRows(6, work));
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.reason, "by the clock: no CPU time was recorded of these");
}

/// What waits takes no CPU time: a program, and what was measured elsewhere, go by the clock.
TEST(Claims, TimesOfAProgramAreJudgedByTheClock) {
    const Timed wall = [](double n, int round) { return drift(round) * 400.0 / n; };
    const Timed work = [](double, int) { return 3.0; };
    const auto records = timedRows(6, wall, work);
    const auto judge = [&](const std::string& technique, const std::string& claim) {
        config::Experiment experiment = tables::experimentFrom(timedBody(claim));
        experiment.technique = technique;
        tables::Table table = tables::buildTable(experiment, records);
        table.isPublished = false;
        EXPECT_EQ(table.noise(tables::Clock::Process).has_value(), technique != "imported");
        return evaluateClaims(experiment, table, kSoftware).at(0);
    };
    const std::string slope = "trend: ms, over: n, at_least: -1.1, at_most: -0.8";
    const ClaimResult result = judge("imported", slope);
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "exponent -1 [-1, -1]");
    EXPECT_EQ(result.reason, "");
    EXPECT_TRUE(result.columnsByProcess.empty());
    EXPECT_EQ(judge("mock", slope).verdict, Verdict::Fails);
    // A time as such is judged, too.
    const std::string bound = "bound: ms, at_most: 1000, kind: absolute";
    EXPECT_EQ(judge("imported", bound).verdict, Verdict::Holds);
    EXPECT_EQ(judge("mock", bound).verdict, Verdict::NotApplicable);
    EXPECT_EQ(judge("imported", "trend: ms, over: n, at_most: 0, kind: architectural").verdict,
              Verdict::NotApplicable);
}

/// The numbers that a verdict rests on stand in the table.
TEST(Claims, WhatWasJudgedByCpuTimeIsShown) {
    const Timed time = [](double n, int) { return 20.0 * n; };
    const auto columnsOf = [&](const std::string& claim) {
        const config::Experiment experiment = tables::experimentFrom(timedBody(claim));
        tables::Table table = tables::buildTable(experiment, timedRows(6, time, time));
        const ClaimResult result = evaluateClaims(experiment, table, kSoftware).at(0);
        tables::showProcessTimes(result.columnsByProcess, table);
        std::vector<std::string> labels;
        for (const tables::TableColumn& column : table.columns) labels.push_back(column.label);
        if (labels[1] == "cpu_ms") EXPECT_EQ(table.rows[1].cells[1].measured, "40.0");
        return labels;
    };
    EXPECT_THAT(columnsOf("trend: ms, over: n, at_most: 2"), ElementsAre("ms", "cpu_ms", "fps"));
    EXPECT_THAT(columnsOf("order: [n=8, n=1], of: fps, kind: algorithmic"),
                ElementsAre("ms", "fps", "cpu_fps"));
    EXPECT_THAT(columnsOf("bound: ms, at_most: 9, kind: absolute"), ElementsAre("ms", "fps"));
}

TEST(Claims, ARoundThatIsNotANumberIsNotPassedOver) {
    const auto records = timedRows(6, [](double n, int round) { return round == 3 ? 0.0 : n; });
    const ClaimResult result =
        judgeTimed("trend: ms, over: n, at_least: 0.9, at_most: 1.1", records);
    EXPECT_EQ(result.verdict, Verdict::Unmeasured);
}

/// Values that are no times, and differ between processes all the same.
TEST(Claims, OtherValuesAreJudgedByTheirRounds) {
    const auto judge = [](std::initializer_list<double> values, const std::string& claim) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})");
        int process = 0;
        for (const double value : values) maker.process(process++).add("a", {value}, "", "byte");
        return judgePowers(claim + ", at: {n: 1}", maker.records());
    };
    EXPECT_EQ(judge({5, 5}, "bound: a, at_most: 6").measured, "5");
    EXPECT_EQ(judge({5, 5}, "bound: a, at_most: 6").reason, "") << "not one sample";
    EXPECT_EQ(judge({5, 7, 6}, "bound: a, at_most: 7").measured, "6 (5 … 7)");
    EXPECT_EQ(judge({5, 7, 6}, "bound: a, at_most: 9").verdict, Verdict::Ambiguous) << "too few";
    EXPECT_EQ(judge({5, 7, 6, 6, 6, 6}, "bound: a, at_most: 9").verdict, Verdict::Holds);
    EXPECT_EQ(judge({5, 7, 6, 6, 6, 6}, "bound: a, at_most: 6").measured, "6 [4.5, 7.5]")
        << "rounded";
    EXPECT_EQ(judge({5, 7, 6, 6.5, 6.25, 6.75}, "bound: a, at_most: 6").measured, "6.375 [5, 7]");
}

/// What is rare moves them by any amount.
TEST(Claims, StatisticsOverProcessesDecideNothing) {
    const auto judge = [](const std::string& format, const std::string& claim, double last) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})");
        for (int process = 0; process < 8; ++process) {
            const double a = process == 7 ? last : 1.0;
            maker.process(process).add("a", {a}, "", "byte").add("b", {1.0}, "", "byte");
        }
        return judgeOne(
            "sweep: {n: [1]}\nlayout: {rows: n, columns: {a: {metric: a}, b: {metric: b}, c: {of: "
            "a + b}}, cell: \"{" +
                format + ":.3f}\"}\nclaims: {C: {says: so, " + claim + "}}\n",
            maker.records());
    };
    for (const std::string format : {"mean", "max", "min"}) {
        for (const char* claim :
             {"bound: a, at_most: 100", "order: b < a", "ratio: a / b, at_least: 9",
              "exact: a, equals: 1", "bound: c, at_most: 100"}) {
            const ClaimResult result = judge(format, claim, 2.0);
            EXPECT_EQ(result.verdict, Verdict::Ambiguous) << format << ": " << claim;
            EXPECT_EQ(result.reason, "a " + format +
                                         " over processes has no interval, as what is rare moves "
                                         "it by any amount; '{median}' has one")
                << claim;
        }
        EXPECT_EQ(judge(format, "bound: a, at_most: 100", 1.0).verdict, Verdict::Holds) << format;
        EXPECT_EQ(judge(format, "exact: c, equals: 2", 1.0).verdict, Verdict::Holds) << format;
    }
    EXPECT_EQ(judge("median", "bound: a, at_most: 100", 2.0).verdict, Verdict::Holds);
}

/// Errors of two samplers that draw alike, a value a seed; `seeds` as a case has them.
tables::Recorded twoSamplers(config::Measure::Seeds seeds, int processes, std::uint64_t seed,
                             double ratio = 1.0) {
    Random random(seed);
    const auto draw = [&] { return 0.5 + 0.1 * double{random.uniform()}; };
    tables::RecordMaker maker;
    maker.beginCase("", R"({"n":1})").seeds(seeds);
    const double a = draw(), b = draw() * ratio;
    const bool isOne = seeds == config::Measure::Seeds::Case;
    for (int process = 0; process < processes; ++process) {
        const double hair = 1.0 + 1e-9 * process;  // as where threads add up in another order
        maker.process(process).add("a", {isOne ? a * hair : draw()}, "", "1");
        maker.add("b", {isOne ? b * hair : draw() * ratio}, "", "1");
    }
    return maker.records();
}

TEST(Claims, RandomNumbersOfOneSeedDecideNothing) {
    using Seeds = config::Measure::Seeds;
    const std::string more =
        "; an interval needs 6: `measure: {processes: 6}` where the seed is not swept, or as many "
        "values of 'seed' in a sweep or an import";
    for (const char* claim :
         {"order: a < b", "order: b < a", "ratio: a / b, at_least: 0.5", "bound: a, at_most: 9"}) {
        const auto judge = [&](const tables::Recorded& records) {
            return judgePowers(claim + std::string(", at: {n: 1}"), records);
        };
        ClaimResult result = judge(twoSamplers(Seeds::Case, 6, 1, 1.3));
        EXPECT_EQ(result.verdict, Verdict::Ambiguous) << claim;
        EXPECT_EQ(result.reason, "one sample of random numbers" + more);
        EXPECT_EQ(result.measured.find('['), std::string::npos) << result.measured;
        result = judge(twoSamplers(Seeds::Process, 5, 1, 1.3));
        EXPECT_EQ(result.verdict, Verdict::Ambiguous) << claim;
        EXPECT_EQ(result.reason, "5 seeds of random numbers" + more);
        // Nobody declares a seed, but the numbers tell that they are random.
        result = judge(twoSamplers(Seeds::None, 5, 1, 1.3));
        EXPECT_EQ(result.verdict, Verdict::Ambiguous) << claim;
        EXPECT_EQ(result.reason, "5 processes came to different numbers; " + tables::kNeedsSix);
        // What draws none is as it is.
        EXPECT_NE(judge(twoSamplers(Seeds::None, 1, 1, 1.3)).verdict, Verdict::Ambiguous) << claim;
    }
    const ClaimResult result =
        judgePowers("order: a < b, at: {n: 1}", twoSamplers(Seeds::Process, 6, 1, 1.3));
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.reason, "");
    EXPECT_THAT(result.measured, HasSubstr("["));
    // A count is what it is where nothing says that it is drawn.
    const std::string exact = "exact: a, equals: 9, at: {n: 1}";
    EXPECT_EQ(judgePowers(exact, twoSamplers(Seeds::None, 1, 1)).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers(exact, twoSamplers(Seeds::Case, 1, 1)).verdict, Verdict::Ambiguous);
    EXPECT_EQ(judgePowers(exact, twoSamplers(Seeds::Case, 6, 1)).verdict, Verdict::Ambiguous);
    EXPECT_EQ(judgePowers(exact, twoSamplers(Seeds::Process, 6, 1)).verdict, Verdict::Fails);
}

TEST(Claims, NumbersThatScatterWithoutASeedAreNotCertain) {
    const auto judge = [](const std::string& claim, double hair, int processes, int repeats) {
        tables::RecordMaker maker;
        for (const int n : {1, 2, 4, 8}) {
            maker.beginCase("", fmt::format(R"({{"n":{}}})", n));
            for (int process = 0; process < processes; ++process) {
                std::vector<double> values;
                for (int i = 0; i < repeats; ++i)
                    values.push_back((1.0 + hair * (process + i)) / n);
                maker.process(process).add("a", values, "", "1").add("b", {1.0}, "", "1");
            }
        }
        return judgePowers(claim, maker.records());
    };
    const std::string falls = "trend: a, over: n, direction: decreasing";
    EXPECT_EQ(judge(falls, 1e-15, 3, 1).verdict, Verdict::Holds) << "the order of a sum";
    EXPECT_EQ(judge(falls, 1e-15, 1, 3).verdict, Verdict::Holds);
    EXPECT_EQ(judge(falls, 1e-3, 6, 1).verdict, Verdict::Holds);
    EXPECT_EQ(judge(falls, 1e-3, 6, 1).reason, "");
    EXPECT_EQ(judge(falls, 1e-3, 3, 1).verdict, Verdict::Ambiguous);
    EXPECT_EQ(judge(falls, 1e-3, 3, 1).reason,
              "3 processes came to different numbers; " + tables::kNeedsSix);
    EXPECT_EQ(judge(falls, 1e-3, 1, 3).verdict, Verdict::Ambiguous);
    EXPECT_EQ(judge(falls, 1e-3, 1, 3).reason,
              "one process of numbers that differ when they are taken again; " + tables::kNeedsSix);
    EXPECT_EQ(judge(falls, 1e-8, 3, 1).verdict, Verdict::Ambiguous) << "however little";
    EXPECT_EQ(judge("bound: b, at_most: 1", 1e-3, 1, 3).verdict, Verdict::Holds) << "is of b alone";
}

/// One of them may lie anywhere where the others scatter.
TEST(Claims, OneProcessBesideManyDecidesNothing) {
    for (const char* metric : {"rmse", "wall_time_ms"}) {
        tables::RecordMaker maker;
        for (const int n : {1, 2}) {
            maker.beginCase("", fmt::format(R"({{"n":{}}})", n));
            for (int process = 0; process < (n == 1 ? 1 : 8); ++process) {
                maker.process(process).add(metric, {(1.0 + 0.01 * process) * n}, "", "ms");
            }
        }
        const ClaimResult result = judgeOne(
            fmt::format(
                "sweep: {{n: [1, 2]}}\nlayout: {{rows: n, columns: {{a: {{metric: {}}}}}}}\n"
                "claims: {{C: {{says: so, order: [n=1, n=2]{}}}}}\n",
                metric, metric[0] == 'w' ? ", kind: algorithmic" : ""),
            maker.records());
        EXPECT_EQ(result.verdict, Verdict::Ambiguous) << metric;
    }
}

TEST(Claims, WhatIsExactIsSoInEachProcess) {
    const auto judge = [](std::initializer_list<double> values) {
        tables::RecordMaker maker;
        maker.beginCase("", R"({"n":1})");
        int process = 0;
        for (const double value : values) maker.process(process++).add("a", {value}, "", "1");
        return judgePowers("exact: a, equals: 5, at: {n: 1}", maker.records()).verdict;
    };
    EXPECT_EQ(judge({5, 5, 5, 5, 5, 5}), Verdict::Holds);
    EXPECT_EQ(judge({5, 5, 5, 5, 5, 5, 5, 5, 5, 6}), Verdict::Ambiguous);
    EXPECT_EQ(judge({5, 6}), Verdict::Ambiguous);
    EXPECT_EQ(judge({4, 6}), Verdict::Ambiguous) << "two of what differs";
    EXPECT_EQ(judge({4, 6, 4, 6, 6, 4}), Verdict::Fails) << "in none";
    EXPECT_EQ(judge({6, 6}), Verdict::Fails);
}

/// Of two samplers that are alike six seeds say in one case of twenty that one is better; a
/// difference of three standard deviations they find.
TEST(Claims, OfRandomNumbersSixSeedsRarelyTellWhatIsNotThere) {
    using Seeds = config::Measure::Seeds;
    constexpr int kTrials = test::kIsSanitized ? 4 : 1000;
    for (const Seeds seeds : {Seeds::Process, Seeds::None}) {  // declared or not
        std::map<Verdict, int> alike, apart;
        for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
            const auto judge = [&](double ratio) {
                return judgePowers("order: a < b, at: {n: 1}", twoSamplers(seeds, 6, seed, ratio))
                    .verdict;
            };
            ++alike[judge(1.0)];
            ++apart[judge(1.2)];
        }
        EXPECT_EQ(apart[Verdict::Fails], 0);
        if (test::kIsSanitized) continue;
        EXPECT_LE(alike[Verdict::Holds] + alike[Verdict::Fails], 0.07 * kTrials);
        EXPECT_GE(apart[Verdict::Holds], 0.9 * kTrials);
    }
}

/// Shown with one digit, a and b are the same number, and a is 2 as asked; as measured they are
/// not.
TEST(Claims, AreJudgedOnWhatWasMeasuredNotOnWhatIsShown) {
    const auto records = powers([](double) { return 2.04; }, [](double) { return 1.96; });
    EXPECT_EQ(judgePowers("order: b < a", records).verdict, Verdict::Holds);
    EXPECT_EQ(judgePowers("ratio: a / b, at_least: 1.04", records).verdict, Verdict::Holds);
    EXPECT_EQ(judgePowers("ratio: a / b, at_least: 1.0409", records).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers("bound: a, at_most: 2.03", records).verdict, Verdict::Fails);
    EXPECT_EQ(judgePowers("exact: a, equals: 2", records).verdict, Verdict::Fails);
}

/// Rows `method` × `scene`, columns a and b; one claim that compares methods.
std::string acrossBody(const std::string& claim) {
    return R"(
sweep: {method: [old, new], scene: [s, t]}
layout:
  rows: [method, scene]
  columns: {a: {metric: a}, b: {metric: b}}
printed:
  values: |
    method,scene,a,b
    old,s,1,2
    new,s,10,4
claims:
  X: {says: as claimed, )" +
           claim + "}\n";
}

TEST(Claims, AcrossComparesRows) {
    tables::RecordMaker maker;
    maker.beginCase("s", R"({"method":"old"})").add("a", {1.0}).add("b", {2.0});
    maker.beginCase("s", R"({"method":"new"})").add("a", {10.0}).add("b", {3.0});
    maker.beginCase("t", R"({"method":"old"})").add("a", {1.0}).add("b", {2.0});
    maker.beginCase("t", R"({"method":"new"})").add("a", {20.0}).add("b", {1.0});
    const auto judge = [&](const std::string& claim) {
        return judgeOne(acrossBody(claim), maker.records());
    };
    ClaimResult result = judge("order: [method=old, method=new]");
    EXPECT_EQ(result.verdict, Verdict::Fails);
    EXPECT_EQ(result.measured, "smallest gap -50 %");
    EXPECT_EQ(result.reason, "worst at t, b; one sample; holds on 1 of 2 scenes, not on t");
    EXPECT_EQ(judge("order: [method=old, method=new], of: a").verdict, Verdict::Holds);
    EXPECT_EQ(judge("order: [method=old, method=new], at: {scene: s}").verdict, Verdict::Holds);
    EXPECT_EQ(judge("order: [method=old, method=new], at: {scene: s}").required,
              "method: old < new");
    result = judge("across: method, ratio: new / old, at_least: 20, of: a, at: {scene: t}");
    EXPECT_EQ(result.verdict, Verdict::Holds);
    EXPECT_EQ(result.measured, "20");
    // The printed numbers have moved along.
    EXPECT_EQ(judge("across: method, exact: new, equals: printed, of: a").verdict, Verdict::Holds);
    result = judge("across: method, exact: new, equals: printed");
    EXPECT_EQ(result.measured, "largest difference 1");
}

TEST(Claims, BadOperandsAreErrors) {
    // A swept column is known to the config only by its values, so this is checked here again.
    config::Experiment experiment = tables::experimentFrom(powersBody("bound: a, at_most: 5"));
    const tables::Table table = tables::buildTable(experiment, {});
    const auto error = [&](const std::string& operand) {
        experiment.claims[0].operands[0] = operand;
        experiment.claims[0].location = {"t.yaml", 4, 2};
        return errorText([&] { evaluateClaims(experiment, table, kSoftware); });
    };
    EXPECT_EQ(error("a + time"), "no error") << "a profile may have taken it away";
    const ClaimResult absent = evaluateClaims(experiment, table, kSoftware)[0];
    EXPECT_EQ(absent.verdict, Verdict::Unmeasured);
    EXPECT_EQ(absent.reason,
              "not among what was measured: 'time' is no column (columns: a, b, c-c)");
    EXPECT_EQ(whatIsAbsent(experiment.claims[0], table),
              "'time' is no column (columns: a, b, c-c)");
    EXPECT_EQ(error("a +"), "no error") << "refused before, where columns were known";
    EXPECT_THAT(evaluateClaims(experiment, table, kSoftware)[0].reason,
                StartsWith("'a +' is no expression: "));
    EXPECT_THAT(whatIsAbsent(experiment.claims[0], table), StartsWith("'a +' is no expression: "));
    EXPECT_EQ(error("max(a, c-c) * 2"), "no error");
    experiment.claims[0].at = {{"m", {Node::number(1.0)}}};
    EXPECT_EQ(error("a"),
              "t.yaml:4:2: claim 'X': at: 'm' is no row axis; did you mean 'n'? (row axes: n)");
}

TEST(Claims, WhatWhenLeavesOutStandsBesideNothing) {
    config::Experiment experiment = tables::experimentFrom(
        "sweep: {m: [a, b], seed: [1, 2], when: {seed: {m: b}}}\nlayout: {rows: [m, seed], "
        "columns: {e: {metric: e}}}\nclaims: {C: {says: so, order: [a, b], of: e}}\n");
    experiment.claims[0].location = {"t.yaml", 4, 2};
    EXPECT_EQ(errorText([&] { requireJudgeable(experiment, tables::buildTable(experiment, {})); }),
              "t.yaml:4:2: claim 'C' has no row of all that it compares: 'when' of the sweep "
              "leaves some of it without 'seed'; allowed: a layout whose rows do not name it, with "
              "its values in the column: 'where: {seed: […]}'");
}

TEST(Claims, WhatWhenLeavesOutIsNoRow) {
    const auto refused = [](const std::string& layout, const std::string& claim) {
        config::Experiment experiment = tables::experimentFrom(
            "sweep: {m: [a, b, c], n: [1, 2], when: {n: {m: [b, c]}}}\nlayout: {" + layout +
            "}\nclaims: {C: {says: so, " + claim + "}}\n");
        experiment.claims[0].location = {"t.yaml", 4, 2};
        return errorText([&] { requireJudgeable(experiment, tables::buildTable(experiment, {})); });
    };
    const std::string rows = "rows: [m, n], columns: {e: {metric: e}, r: {of: 'e / e[m=a]'}}";
    const std::string beside =
        "t.yaml:4:2: claim 'C' has no row of all that it compares: 'when' of the sweep leaves some "
        "of it without 'n'; allowed: ";
    const std::string column =
        beside +
        "rows of both, with a column 'of: \"e / e[m=a]\"' in the layout, and a bound of it";
    EXPECT_EQ(refused(rows, "order: [a, b], of: e"), column);
    EXPECT_EQ(refused(rows, "ratio: m=a / m=b, of: e, at_most: 1, at: {n: 2}"), column);
    EXPECT_EQ(refused(rows, "bound: r, at_most: 1, at: {m: b, n: 2}"), "no error");
    EXPECT_EQ(refused(rows, "order: [b, c], of: e"), "no error");
    const std::string columns = "rows: n, columns: m, cell: {metric: e}";
    EXPECT_EQ(refused(columns, "order: a < b"),
              beside +
                  "rows of both, with a column 'of: \"x / x[AXIS=VALUE]\"' in the layout, and a "
                  "bound of it");
    EXPECT_EQ(refused(columns, "bound: a, at_most: 1, at: {n: 2}"), beside + "'at' without 'n'");
    EXPECT_EQ(refused(columns, "bound: a, at_most: 1"), "no error");
    for (const char* claim :
         {"bound: e, at_most: 1", "exact: e, equals: 1", "bound: r, at_most: 1"}) {
        EXPECT_EQ(refused(rows, std::string(claim) + ", at: {m: a, n: 2}"),
                  "t.yaml:4:2: claim 'C' is judged nowhere: no row is of {m: a, n: 2}; there are: "
                  "{m: a}, {m: b, n: 1}, {m: b, n: 2}, {m: c, n: 1}, {m: c, n: 2}")
            << claim;
    }
    // Of rows by an axis that has no value there.
    for (const char* claim : {"order: [n=2, n=1], of: e", "ratio: n=2 / n=1, of: e, at_most: 1",
                              "bound: 2, across: n, of: e, at_most: 1"}) {
        EXPECT_EQ(refused(rows, std::string(claim) + ", at: {m: a}"), beside + "at: {m: [b, c]}")
            << claim;
        EXPECT_EQ(refused(rows, std::string(claim) + ", at: {m: [b, c]}"), "no error") << claim;
        EXPECT_EQ(refused(rows, claim), "no error") << claim;
    }
    const std::string one = ", and has one where 'when' of the sweep leaves it without 'n'";
    EXPECT_EQ(refused(rows, "independent: e, of: m, at_most: 1%"),
              "t.yaml:4:2: claim 'C' needs 2 rows along 'm'" + one + "; allowed: at: {n: [1, 2]}");
    EXPECT_EQ(refused(rows, "independent: e, of: m, at_most: 1%, at: {n: [1, 2]}"), "no error");
    EXPECT_EQ(refused(rows, "independent: e, of: n, at_most: 1%, at: {m: a}"),
              "t.yaml:4:2: claim 'C' needs 2 rows along 'n'" + one);
    const std::string along = "needs numbers along 'n', which holds '–'";
    for (const auto& [claim, why] :
         {std::pair("trend: e, over: n, at_most: 0", along),
          {"independent: e, of: n, at_most: 1%", "needs 2 rows along 'n'" + one}}) {
        EXPECT_EQ(refused(rows, claim),
                  "t.yaml:4:2: claim 'C' " + why + "; allowed: at: {m: [b, c]}");
        EXPECT_EQ(refused(rows, std::string(claim) + ", at: {m: [b, c]}"), "no error");
    }
    EXPECT_EQ(refused(rows, "trend: b, across: m, of: e, over: n, at_most: 0"), "no error");
}

/// Of the file as it stands.
TEST(Claims, WhatHasNoValueSomewhereIsRefused) {
    const auto refused = [](const std::string& claim) {
        std::vector<config::Experiment> one = {tables::experimentFrom(
            "sweep: {m: [a, b, c], n: [1, 2], when: {n: {m: [b, c]}}}\nlayout: {rows: [m, n], "
            "columns: {e: {metric: e}, r: {of: 'e / e[n=1]'}}}\nclaims: {C: {says: so, " +
            claim + "}}\n")};
        one[0].claims[0].location = {"t.yaml", 4, 2};
        const std::vector<tables::Table> tables = {tables::buildTable(one[0], {})};
        return errorText([&] { requireRows(one, tables); });
    };
    const std::string why = "t.yaml:4:2: claim 'C' is judged in no profile: ";
    for (const auto& [claim, column] : {std::pair("trend: e, over: 2^n, at_most: 0", "n"),
                                        {"bound: r, at_most: 1", "r"},
                                        {"exact: r, equals: 1", "r"}}) {
        EXPECT_EQ(refused(claim),
                  why + "'" + column + "' has no value at m=a, n=–; allowed: at: {m: [b, c]}");
        EXPECT_EQ(refused(std::string(claim) + ", at: {m: [b, c]}"), "no error");
    }
    EXPECT_EQ(refused("order: [n=2, n=1], of: e, at: {m: a}"),
              "t.yaml:4:2: claim 'C' has no row of all that it compares: 'when' of the sweep "
              "leaves some of it without 'n'; allowed: at: {m: [b, c]}");
}

/// By whatever the sweep leaves out.
TEST(Claims, OfWhichNoProfileHasARowIsRefused) {
    const auto refused = [](const std::string& claim, const std::string& quick) {
        std::vector<config::Experiment> profiles;
        std::vector<tables::Table> tables;
        for (const std::string& excluded : {std::string("{m: a, n: 2}"), quick}) {
            profiles.push_back(
                tables::experimentFrom("sweep: {m: [a, b], n: [1, 2], exclude: [" + excluded +
                                       "]}\nlayout: {rows: [m, n], columns: {e: {metric: e}}}\n"
                                       "claims: {C: {says: so, " +
                                       claim + "}}\n"));
            profiles.back().claims[0].location = {"t.yaml", 4, 2};
            tables.push_back(tables::buildTable(profiles.back(), {}));
        }
        return errorText([&] { requireRows(profiles, tables); });
    };
    const std::string why = "t.yaml:4:2: claim 'C' is judged in no profile: ";
    EXPECT_EQ(
        refused("bound: e, at_most: 1, at: {m: a, n: 2}", "{m: a, n: 2}"),
        why + "no row is of {m: a, n: 2}; there are: {m: a, n: 1}, {m: b, n: 1}, {m: b, n: 2}");
    EXPECT_EQ(refused("bound: e, at_most: 1, at: {m: a, n: 2}", "{m: b, n: 1}"), "no error");
    EXPECT_EQ(refused("order: [a, b], of: e, at: {n: 2}", "{m: a, n: 2}"),
              why + "no row has all that it compares");
    const std::string along = "independent: e, of: m, at_most: 1%";
    EXPECT_EQ(refused(along + ", at: {n: 2}", "{m: a, n: 2}"),
              why + "needs at least 2 rows, found 1");
    EXPECT_EQ(refused(along, "{m: a, n: 2}"),
              why + "needs at least 2 rows, found 1; allowed: at: {n: 1}");
    EXPECT_EQ(refused(along + ", at: {n: 1}", "{m: b, n: 1}"), "no error") << "in one profile";
    EXPECT_EQ(refused("order: [a, b], of: e", "{m: a, n: 2}"), "no error");
}

/// Of numbers that were measured elsewhere, and that nobody laid out.
TEST(Claims, WhatNoRowHasByAColumnOfTheFileIsRefused) {
    const auto refused = [](const std::string& claim) {
        tables::RecordMaker maker("sweep/s");
        for (const auto& [m, n, run] :
             {std::tuple("b", 1, 0), {"b", 2, 1}, {"c", 1, 2}, {"c", 2, 3}}) {
            maker.beginCase("", fmt::format(R"({{"m":"{}","n":{},"run":{}}})", m, n, run));
            maker.add("e", {1.0 + run}, "", "1");
        }
        tables::Recorded records = maker.records();
        for (config::Case& one : records.cases) one.axes = one.params;
        const TemporaryFolder folder;
        const auto file = folder.write(
            "s.yaml",
            "sweep_of: s\ntitle: t\ntechnique: imported\nsweep: {m: [b, c], n: [1, 2]}\n"
            "claims: {C: {says: so, " +
                claim + "}}\n");
        config::Experiment experiment = config::loadExperiment(file, {}, folder.path());
        experiment.claims[0].location = {"t.yaml", 4, 2};
        return errorText([&] {
            requireInOneRow(experiment, tables::buildTable(experiment, records.cases, records));
        });
    };
    const std::string why =
        "t.yaml:4:2: claim 'C': what it compares stands in rows that differ by 'run' (0, 1, 2, 3), "
        "a column of the file; allowed: in 'sweep', as a parameter; what repeats a case has its "
        "number in the column 'process', or in 'seed' where each has random numbers of its own";
    EXPECT_EQ(refused("order: [b, c], of: e"), why);
    EXPECT_EQ(refused("trend: e, over: n, direction: increasing"), why);
    EXPECT_EQ(refused("bound: e, at_most: 1"), "no error");
}

TEST(Claims, WhatIsNoExpressionOrReadsNoColumnIsRefusedBeforeAnythingIsMeasured) {
    config::Experiment experiment = tables::experimentFrom(powersBody("bound: a, at_most: 5"));
    const tables::Table table = tables::buildTable(experiment, {});
    experiment.claims[0].location = {"t.yaml", 4, 2};
    const auto refused = [&](const std::string& operand) {
        experiment.claims[0].operands[0] = operand;
        return errorText([&] { requireJudgeable(experiment, table); });
    };
    EXPECT_THAT(refused("foo(a)"), StartsWith("t.yaml:4:2: claim 'X': 'foo' is no function"));
    for (const char* operand : {"a +", "(a", "a b"}) {
        EXPECT_THAT(
            refused(operand),
            StartsWith(fmt::format("t.yaml:4:2: claim 'X': '{}' is no expression: ", operand)));
    }
    EXPECT_THAT(refused("a b"), HasSubstr("\"b\"")) << "by its name, not the parser's";
    EXPECT_EQ(refused("1 + 1"),
              "t.yaml:4:2: claim 'X': '1 + 1' reads no column; the rows of an axis are compared "
              "with 'across: AXIS'");
    EXPECT_EQ(refused("max(a, b)"), "no error");
    EXPECT_EQ(refused("a + time"), "no error") << "a profile may have taken it away";
}

/// Without a layout the columns are known once there is a table.
TEST(Claims, ARowInThePlaceOfAColumnIsHinted) {
    config::Experiment experiment = tables::experimentFrom(
        "sweep: {m: [oct, snorm]}\nlayout: {rows: m, columns: {a: {metric: bytes}}}\n"
        "claims: {X: {says: s, origin: ours, order: a < 2 * a}}\n");
    experiment.claims[0].operands = {"oct", "snorm"};
    EXPECT_EQ(whatIsAbsent(experiment.claims[0], tables::buildTable(experiment, {})),
              "'oct' is no column (columns: a); 'oct' is a value of row axis 'm': add 'across: m'");
}

/// Each function that the documentation names.
TEST(Claims, ExpressionsCallFunctions) {
    config::Experiment experiment = tables::experimentFrom(powersBody("bound: a, at_most: 5"));
    const tables::Table table = tables::buildTable(
        experiment, powers([](double) { return 4.0; }, [](double) { return 100.0; }));
    const auto measured = [&](const std::string& operand) {
        experiment.claims[0].operands[0] = operand;
        return evaluateClaims(experiment, table, kSoftware)[0].measured;
    };
    const std::map<std::string, std::string> expected = {
        {"abs(-a)", "4"},       {"avg(a, b)", "52"},  {"exp(a - 4)", "1"},  {"ln(exp(a))", "4"},
        {"log10(b)", "2"},      {"log2(a)", "2"},     {"max(a, b)", "100"}, {"min(a, b)", "4"},
        {"rint(a + 0.4)", "4"}, {"sign(-a)", "-1"},   {"sqrt(a)", "2"},     {"sum(a, b)", "104"},
        {"a ^ 2 / 8 - 1", "1"}, {"(a < b) + 1", "2"}, {"a > b", "0"}};
    std::set<std::string> called;
    for (const auto& [operand, value] : expected) {
        EXPECT_EQ(measured(operand), value) << operand;
        called.insert(operand.substr(0, operand.find('(')));
    }
    for (const std::string_view name : kFunctions) {
        EXPECT_TRUE(called.contains(std::string(name))) << name;
    }
}

TEST(Claims, ANumberThatIsAColumnIsNoNumber) {
    const auto table = [](const char* sizes) {
        return std::string("sweep: {size: ") + sizes +
               "}\nlayout: {columns: size, cell: {metric: triangles}}\n";
    };
    tables::RecordMaker maker;
    maker.beginCase("s", R"({"size":8})").add("triangles", {3.0});
    maker.beginCase("s", R"({"size":16})").add("triangles", {2.0});
    const auto judged = [&](const char* sizes, const std::string& operand) {
        config::Experiment experiment = tables::experimentFrom(
            table(sizes) + "claims: {X: {says: so, bound: 1 + 1, at_most: 5}}\n");
        experiment.claims[0].operands = {operand};
        return evaluateClaims(experiment, tables::buildTable(experiment, maker.records()),
                              kSoftware)[0];
    };
    EXPECT_EQ(judged("[8, 16]", "8").measured, "3");
    EXPECT_EQ(judged("[8, 16]", "'8' + 8.0").measured, "11");
    EXPECT_EQ(judged("[8, 16]", "8 + 1").reason,
              "not among what was measured: '8' may be the column or the number (quoted it is the "
              "column; written otherwise, as 8.0, the number)");
    // A sweep took the columns away for which the numbers stood.
    maker.beginCase("s", R"({"size":32})").add("triangles", {2.0});
    const ClaimResult absent = judged("[32, 64]", "4");
    EXPECT_EQ(absent.verdict, Verdict::Unmeasured);
    EXPECT_THAT(absent.reason, StartsWith("not among what was measured: '4' is no column"));
}

TEST(Claims, AClaimOnPartOfItsRowsSaysSoAndDoesNotCountAsAHold) {
    const auto experiment = [](const char* scenes, const char* sizes) {
        return tables::experimentFrom(fmt::format(
            "sweep: {{scene: [{}], n: [{}]}}\nlayout: {{rows: [scene, n], columns: {{a: {{metric: "
            "a}}}}}}\nclaims:\n  T: {{says: s, trend: a, over: n, direction: increasing}}\n  B: "
            "{{says: s, bound: a, at_most: 1, at: {{scene: s}}}}\n",
            scenes, sizes));
    };
    tables::RecordMaker maker;
    for (const int n : {1, 2}) {
        maker.beginCase("s", fmt::format("{{\"n\":{}}}", n)).add("a", {1.0 * n});
    }
    const config::Experiment paper = experiment("s, t", "1, 2, 4");
    const auto judged = [&](const char* scenes, const char* sizes) {
        config::Experiment own = experiment(scenes, sizes);
        own.paperDocument = paper.paperDocument;
        own.paperCases = tables::planOf(paper, {});
        return evaluateClaims(own, tables::buildTable(own, maker.records()), kSoftware,
                              tables::planOf(own, maker.records()));
    };
    const auto part = judged("s", "1, 2");
    EXPECT_EQ(part[0].rows, "1 of 2 values of scene, 2 of 3 values of n");
    EXPECT_EQ(part[0].verdict, Verdict::Holds);
    EXPECT_EQ(part[0].reason, "one sample; on 1 of 2 values of scene, 2 of 3 values of n");
    EXPECT_FALSE(part[0].isCounted());
    EXPECT_EQ(part[1].rows, "2 of 3 values of n");
    EXPECT_EQ(part[1].verdict, Verdict::Fails);
    EXPECT_TRUE(part[1].isCounted()) << "what fails on a part fails";
    EXPECT_EQ(originSummaryLine(part),
              "of the documents' own claims 1 fails; of these on part of their rows, or said twice "
              "1 holds");
    for (const ClaimResult& claim : judged("s, t", "1, 2, 4")) EXPECT_EQ(claim.rows, "");
    for (const ClaimResult& claim : judged("s, t", "1, 2, 4, 8")) EXPECT_EQ(claim.rows, "");
    for (const ClaimResult& claim : judged("s, t", "1, 2, 8, 16")) {
        EXPECT_EQ(claim.rows, "2 of 3 values of n") << "other values are none of these";
    }
    maker = tables::RecordMaker();
    EXPECT_EQ(judged("s, t", "8, 16, 32, 64")[0].rows, "0 of 6 rows");
}

TEST(Claims, ThePartOfTheRowsIsThatOfThePaperWhateverAProfileLaysOut) {
    const auto part = [](const std::string& own, const std::string& paper) {
        const std::string whole =
            "params: {k: 2}\nsweep: {n: [1, 2, 4]}\nlayout: {rows: n, columns: {a: {metric: a}}}\n"
            "claims: {B: {says: s, bound: a, at_most: 1}}\n";
        config::Experiment here = tables::experimentFrom(own.empty() ? whole : own);
        const config::Experiment all = tables::experimentFrom(paper.empty() ? whole : paper);
        here.paperDocument = all.paperDocument;
        here.paperCases = tables::planOf(all, {});
        const auto planned = tables::planOf(here, {});
        return evaluateClaims(here, tables::buildTable(here, planned, {}), kSoftware, planned)[0]
            .rows;
    };
    EXPECT_EQ(part("", ""), "");
    const auto at = [](const std::string& values) {
        return "params: {k: 2}\nsweep: {n: [1, 2, 4]}\nlayout: {rows: n, columns: {a: {metric: "
               "a}}}\n"
               "claims: {B: {says: s, bound: a, at_most: 1, at: {n: [" +
               values + "]}}}\n";
    };
    EXPECT_EQ(part(at("1, 2"), ""), "2 of 3 values of n") << "it reads fewer of the same";
    EXPECT_EQ(part("", at("1, 2")), "");
    EXPECT_EQ(part(at("1, 4"), at("1, 2")), "1 of 2 values of n");
    // An axis that one of them sweeps and the other has at a value.
    const auto one = [](const std::string& value) {
        return "params: {k: 2, n: " + value +
               "}\nlayout: {columns: {a: {metric: a}}}\n"
               "claims: {B: {says: s, bound: a, at_most: 1}}\n";
    };
    EXPECT_EQ(part(one("2"), ""), "1 of 3 values of n");
    EXPECT_EQ(part(one("8"), ""), "0 of 3 rows");
    EXPECT_EQ(part("", one("2")), "");
    EXPECT_EQ(part("", one("8")), "0 of 1 rows");
    const auto both = [](const std::string& k) {
        return "sweep: {n: [1, 2, 4], k: [" + k +
               "]}\nlayout: {rows: [n, k], columns: {a: {metric: a}}}\n"
               "claims: {B: {says: s, bound: a, at_most: 1}}\n";
    };
    EXPECT_EQ(part(both("2, 3"), ""), "");
    EXPECT_EQ(part(both("3, 4"), ""), "0 of 3 rows");
    EXPECT_EQ(part("", both("2, 3")), "1 of 2 values of k");
}

TEST(Claims, OfSeveralScenesAVerdictNamesThoseOnWhichItDoesNotHold) {
    const auto judged = [](const std::string& claim, double a, double b, double c,
                           const std::string& unfit = "[]") {
        tables::RecordMaker maker;
        for (const auto& [scene, value] :
             {std::pair("outdoor/nest", a), {"city", b}, {"tree", c}}) {
            for (const int n : {1, 2}) {
                maker.beginCase(scene, fmt::format("{{\"n\":{}}}", n)).add("a", {value * n});
            }
        }
        return judgeOne(
            "sweep: {scene: [outdoor/nest, city, tree], n: [1, 2]}\nlayout: {rows: [scene, n], "
            "columns: {a: {metric: a}}}\nclaims:\n  X: {says: s, " +
                claim + "}\nprinted: {unfit: " + unfit + "}\n",
            maker.records());
    };
    const std::string bound = "bound: a, at_most: 4";
    EXPECT_EQ(judged(bound, 1, 2, 2).holdsOn, "") << "all";
    EXPECT_EQ(judged(bound, 3, 3, 3).holdsOn, "") << "none, each at one n";
    const ClaimResult some = judged(bound, 3, 1, 1);
    EXPECT_EQ(some.verdict, Verdict::Fails);
    EXPECT_EQ(some.holdsOn, "2 of 3 scenes, not on nest");
    EXPECT_EQ(some.reason, "worst at nest, n 2; one sample; holds on 2 of 3 scenes, not on nest");
    EXPECT_EQ(claimSummaryLine({some, judged(bound, 3, 3, 3)}), "2 fail (1 holds on some scenes)");
    EXPECT_EQ(judged("trend: a, over: n, at_least: 0.9, at_most: 1.1", 1, 1, -1).holdsOn,
              "2 of 3 scenes, not on tree");
    EXPECT_EQ(judged("order: [scene=city, scene=tree]", 1, 2, 1).holdsOn, "") << "between scenes";

    // A scene that could not be fitted judges nothing of a document, and it is told what it is
    // there.
    const std::string ofText = bound + ", origin: derived";
    const ClaimResult others = judged(ofText, 1, 1, 3, "[tree]");
    EXPECT_EQ(others.verdict, Verdict::Holds);
    EXPECT_EQ(others.holdsOn, "");
    EXPECT_EQ(others.reason,
              "worst at nest, n 2; one sample; not judged on tree (fails there), which could not "
              "be fitted to what is printed");
    EXPECT_EQ(judged(ofText, 3, 1, 1, "[tree]").holdsOn, "1 of 2 scenes, not on nest");
    const ClaimResult none = judged(ofText + ", at: {scene: tree}", 1, 1, 3, "[tree]");
    EXPECT_EQ(none.verdict, Verdict::NotApplicable);
    EXPECT_NE(none.measured, "");
    EXPECT_EQ(none.reason,
              "not judged on tree (fails there), which could not be fitted to what is printed");
    EXPECT_EQ(judged(bound + ", origin: ours", 1, 1, 3, "[tree]").verdict, Verdict::Fails);
}

TEST(Claims, OneTruthCountsOnce) {
    std::vector<ClaimResult> results(3);
    for (ClaimResult& result : results) {
        result.table = "p/1";
        result.origin = config::ClaimSpec::Origin::Document;
        result.verdict = Verdict::Holds;
    }
    results[0].id = "A";
    results[1].sameAs = results[2].sameAs = "p/1 A";
    results[2].verdict = Verdict::Fails;
    markRepeats(results);
    EXPECT_TRUE(results[0].isCounted());
    EXPECT_FALSE(results[1].isCounted());
    EXPECT_TRUE(results[2].isCounted()) << "another verdict";
    std::swap(results[0].verdict, results[2].verdict);
    markRepeats(results);
    EXPECT_TRUE(results[0].isCounted());
    EXPECT_FALSE(results[2].isCounted()) << "a hold beside what fails";
    std::swap(results[0].verdict, results[2].verdict);
    results[1].sameAs = "p/2 A";
    markRepeats(results);
    EXPECT_TRUE(results[1].isCounted()) << "the other is not of this run";
    results[1].origin = config::ClaimSpec::Origin::Existence;
    EXPECT_EQ(originSummaryLine(results),
              "of the documents' own claims 1 holds, 1 fails; that can hardly fail 1 holds");
}

TEST(Claims, WhatAVerdictRestsOn) {
    ClaimResult result;
    for (const char* none :
         {"", "none of the 5 tried", "none (2 of 5 tried)", "not tried", kRestsOnUnknown}) {
        result.restsOn = none;
        EXPECT_FALSE(result.restsOnAssumption()) << none;
    }
    result.restsOn = "normal_bins (of 5 tried)";
    EXPECT_TRUE(result.restsOnAssumption());
}

TEST(Claims, AChanceIsAPlainPercentage) {
    for (const auto& [within, text] :
         {std::pair(0.9, " is as far off by chance in 100 % of tables"), {0.02, " in 4 % of "}}) {
        Judgement one, other;
        one.verdict = Verdict::Fails;
        one.drawsWithin = other.drawsWithin = within;
        Judgement* both[] = {&one, &other};
        forgiveChance(both);
        EXPECT_EQ(one.verdict, Verdict::Ambiguous);
        EXPECT_THAT(one.why, HasSubstr(text));
    }
}

TEST(Claims, Summary) {
    EXPECT_EQ(claimSummaryLine({}), "no claims");
    std::vector<ClaimResult> results(4);
    results[0].verdict = results[1].verdict = Verdict::Holds;
    results[2].verdict = Verdict::Fails;
    results[3].verdict = Verdict::NotApplicable;
    EXPECT_EQ(claimSummaryLine(results), "2 hold, 1 fails, 1 not-applicable");
    results[0].origin = results[2].origin = config::ClaimSpec::Origin::Document;
    results[3].origin = config::ClaimSpec::Origin::Definition;
    EXPECT_EQ(originSummaryLine(results),
              "of the documents' own claims 1 holds, 1 fails; our aims 1 holds; definitions 1 "
              "not-applicable");
}

}  // namespace
}  // namespace gfxrepro::claims
