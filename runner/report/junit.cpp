// junit.xml of a run: a test a case, a test a claim.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runner/claims/claims.h"
#include "runner/report/markup.h"
#include "runner/report/writers.h"

namespace gfxrepro::report {

namespace {

struct Test {
    std::string table;
    std::string name;
    records::CaseEnd::Outcome outcome = records::CaseEnd::Outcome::Measured;
    std::string message;
};

std::vector<Test> testsOf(const std::vector<records::CaseEnd>& cases) {
    std::map<std::string, int> known;
    std::vector<Test> tests;
    for (const records::CaseEnd& one : cases) {
        // Those of several seeds of a scene have one title; others differ by what XML cannot write.
        const int count = ++known[escapeXml(one.title)];
        tests.push_back({one.table, one.title + (count > 1 ? fmt::format(" ({})", count) : ""),
                         one.outcome, one.text});
    }
    return tests;
}

std::vector<Test> testsOf(const std::vector<claims::ClaimResult>& claims) {
    std::vector<Test> tests;
    for (const claims::ClaimResult& claim : claims) {
        Test test{claim.table, fmt::format("{} claim {}", claim.table, claim.id),
                  records::CaseEnd::Outcome::Skipped, ""};
        if (claim.verdict == claims::Verdict::Holds)
            test.outcome = records::CaseEnd::Outcome::Measured;
        if (claim.verdict == claims::Verdict::Fails)
            test.outcome = records::CaseEnd::Outcome::Failed;
        test.message =
            fmt::format("{}: measured {}, required {}{}", claims::verdictName(claim.verdict),
                        claim.measured.empty() ? "nothing" : claim.measured, claim.required,
                        claim.reason.empty() ? "" : fmt::format(" ({})", claim.reason)) +
            (claim.because.empty() ? "" : fmt::format("; known: {}", claim.because));
        tests.push_back(std::move(test));
    }
    return tests;
}

std::string suite(const char* name, const std::vector<Test>& tests) {
    const auto count = [&](records::CaseEnd::Outcome outcome) {
        return std::ranges::count(tests, outcome, &Test::outcome);
    };
    std::string text = fmt::format(
        "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n", name, tests.size(),
        count(records::CaseEnd::Outcome::Failed), count(records::CaseEnd::Outcome::Skipped));
    for (const Test& test : tests) {
        text += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escapeXml(test.table),
                            escapeXml(test.name));
        if (test.outcome == records::CaseEnd::Outcome::Measured) {
            text += "/>\n";
            continue;
        }
        text +=
            fmt::format("><{} message=\"{}\"/></testcase>\n",
                        test.outcome == records::CaseEnd::Outcome::Failed ? "failure" : "skipped",
                        escapeXml(test.message));
    }
    return text + "</testsuite>\n";
}

}  // namespace

std::string junitXml(const std::vector<records::CaseEnd>& cases,
                     const std::vector<claims::ClaimResult>& results) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n" +
           suite("cases", testsOf(cases)) + suite("claims", testsOf(results)) + "</testsuites>\n";
}

}  // namespace gfxrepro::report
