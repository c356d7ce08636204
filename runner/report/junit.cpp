// junit.xml of a run: a test a case, a test a claim.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runner/report/markup.h"
#include "runner/report/report.h"

namespace gfxrepro::report {

namespace {

struct Test {
    std::string table;
    std::string name;
    CaseResult::Outcome outcome = CaseResult::Outcome::Measured;
    std::string message;
};

std::vector<Test> testsOf(const std::vector<CaseResult>& cases) {
    std::map<std::string, int> known;
    std::vector<Test> tests;
    for (const CaseResult& one : cases) {
        // Those of several seeds of a scene have one title; others differ by what XML cannot write.
        const int count = ++known[escapeXml(one.title)];
        tests.push_back({one.table, one.title + (count > 1 ? fmt::format(" ({})", count) : ""),
                         one.outcome, one.text});
    }
    return tests;
}

std::vector<Test> testsOf(const std::vector<ClaimResult>& claims) {
    std::vector<Test> tests;
    for (const ClaimResult& claim : claims) {
        Test test{claim.table, fmt::format("{} claim {}", claim.table, claim.id),
                  CaseResult::Outcome::Skipped, ""};
        if (claim.verdict == Verdict::Holds) test.outcome = CaseResult::Outcome::Measured;
        if (claim.verdict == Verdict::Fails) test.outcome = CaseResult::Outcome::Failed;
        test.message =
            fmt::format("{}: measured {}, required {}{}", verdictName(claim.verdict),
                        claim.measured.empty() ? "nothing" : claim.measured, claim.required,
                        claim.reason.empty() ? "" : fmt::format(" ({})", claim.reason)) +
            (claim.because.empty() ? "" : fmt::format("; known: {}", claim.because));
        tests.push_back(std::move(test));
    }
    return tests;
}

std::string suite(const char* name, const std::vector<Test>& tests) {
    const auto count = [&](CaseResult::Outcome outcome) {
        return std::ranges::count(tests, outcome, &Test::outcome);
    };
    std::string text = fmt::format(
        "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n", name, tests.size(),
        count(CaseResult::Outcome::Failed), count(CaseResult::Outcome::Skipped));
    for (const Test& test : tests) {
        text += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escapeXml(test.table),
                            escapeXml(test.name));
        if (test.outcome == CaseResult::Outcome::Measured) {
            text += "/>\n";
            continue;
        }
        text += fmt::format("><{} message=\"{}\"/></testcase>\n",
                            test.outcome == CaseResult::Outcome::Failed ? "failure" : "skipped",
                            escapeXml(test.message));
    }
    return text + "</testsuite>\n";
}

}  // namespace

std::string junitXml(const std::vector<CaseResult>& cases,
                     const std::vector<ClaimResult>& results) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n" +
           suite("cases", testsOf(cases)) + suite("claims", testsOf(results)) + "</testsuites>\n";
}

}  // namespace gfxrepro::report
