#include "runner/claims/kinds/operands.h"

#include "engine/core/text.h"
#include "tests/support/support.h"

namespace gfxrepro::claims {
namespace {

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

}  // namespace
}  // namespace gfxrepro::claims
