#include "techniques/voxelization/formula.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "engine/core/random.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

constexpr double kFloatEpsilon = std::numeric_limits<float>::epsilon();

std::string errorOf(const std::string& formula) {
    return errorText([&] { Formula(formula, {"x", "y"}, SourceLocation{"a.yaml", 3, 14}); });
}

TEST(Formula, SaysWhereAFormulaIsWrong) {
    const std::string allowed =
        "; allowed: numbers, x, y, pi, abs, cos, exp, log, max, min, sin, sqrt, tan, + - * / ^ ( )";
    EXPECT_EQ(errorOf("x + foo"),
              "a.yaml:3:14: formula 'x + foo', character 5: unknown name 'foo'" + allowed);
    EXPECT_EQ(errorOf("x +"),
              "a.yaml:3:14: formula 'x +', character 4: the formula ends early" + allowed);
    EXPECT_EQ(errorOf(""),
              "a.yaml:3:14: formula '', character 1: the formula ends early" + allowed);
    EXPECT_EQ(errorOf("2x"), "a.yaml:3:14: formula '2x', character 2: unexpected 'x'" + allowed);
    EXPECT_EQ(errorOf("--x"), "a.yaml:3:14: formula '--x', character 2: unexpected '-'" + allowed);
    EXPECT_EQ(errorOf("(x"), "a.yaml:3:14: formula '(x', character 3: ')' is missing" + allowed);
    EXPECT_EQ(errorOf("max(x)"),
              "a.yaml:3:14: formula 'max(x)', character 6: unexpected ')'" + allowed);
    EXPECT_EQ(errorOf("x, y"),
              "a.yaml:3:14: formula 'x, y', character 2: unexpected ','" + allowed);
    EXPECT_EQ(errorOf("x ? y : 1"),
              "a.yaml:3:14: formula 'x ? y : 1', character 3: unexpected '?'" + allowed);
    EXPECT_EQ(errorOf("x = y"),
              "a.yaml:3:14: formula 'x = y', character 3: unexpected '='" + allowed);
    EXPECT_EQ(
        errorOf("1e99"),
        "a.yaml:3:14: formula '1e99', character 1: the number is out of the range of a float" +
            allowed);
    EXPECT_EQ(errorOf(std::string(5000, 'x')),
              "a.yaml:3:14: a formula of 5000 characters; at most 4096 are allowed");
}

TEST(Formula, BoundsTheNesting) {
    EXPECT_NE(errorOf(std::string(2000, '(')).find("character 101: nested deeper than 100"),
              std::string::npos);
    std::string tower = "2";
    for (int i = 0; i < 200; ++i) tower += "^2";
    EXPECT_NE(errorOf(tower).find("nested deeper than 100"), std::string::npos);
    EXPECT_EQ(errorOf(std::string(50, '(') + "x" + std::string(50, ')')), "no error");
}

/// A formula with its value and a bound of what float arithmetic may lose.
struct Sample {
    std::string text;
    int precedence = 4;  // 1 sum, 2 product, 3 sign, 4 power, 5 atom
    double value = 0;
    double error = 0;
};

std::string wrapped(const Sample& sample, int needed) {
    return sample.precedence < needed ? "(" + sample.text + ")" : sample.text;
}

/// Random formulas with the fewest parentheses, so that a wrong precedence shows.
Sample randomFormula(Random& random, const std::array<double, 3>& at, int depth) {
    const auto rounded = [](Sample sample) {
        sample.error += 4 * kFloatEpsilon * std::abs(sample.value);
        return sample;
    };
    const std::uint32_t kind = depth == 0 ? random.index(2) : 2 + random.index(9);
    if (kind == 0) {
        const std::uint32_t variable = random.index(3);
        return {std::string(1, static_cast<char>('x' + variable)), 5, at[variable], 0};
    }
    if (kind == 1) {
        const std::string digits = fmt::format("{:.2f}", random.uniform(0.0F, 4.0F));
        return rounded({digits, 5, std::stod(digits), 0});
    }
    const Sample a = randomFormula(random, at, depth - 1);
    if (kind == 2) return {"-" + wrapped(a, 4), 3, -a.value, a.error};
    if (kind == 3) {
        const int n = static_cast<int>(random.index(5));
        return rounded({wrapped(a, 5) + "^" + std::to_string(n), 4, std::pow(a.value, n),
                        n * std::pow(std::abs(a.value) + a.error, std::max(n - 1, 0)) * a.error});
    }
    if (kind == 4) {
        // llvmpipe's sine is a polynomial good to about 1e-6.
        return {"sin(" + a.text + ")", 5, std::sin(a.value),
                a.error + kFloatEpsilon * std::abs(a.value) * 4 + 4e-6};
    }
    const Sample b = randomFormula(random, at, depth - 1);
    switch (kind) {
        case 5:
        case 6:
            return rounded(
                {wrapped(a, 1) + " + " + wrapped(b, 2), 1, a.value + b.value, a.error + b.error});
        case 7:
            return rounded(
                {wrapped(a, 1) + " - " + wrapped(b, 2), 1, a.value - b.value, a.error + b.error});
        case 8:
            return rounded(
                {wrapped(a, 2) + "*" + wrapped(b, 3), 2, a.value * b.value,
                 std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error});
        case 9: {
            const double quotient = a.value / b.value;
            const double smallest = std::abs(b.value) - b.error;
            return rounded({wrapped(a, 2) + " / " + wrapped(b, 3), 2, quotient,
                            smallest > 0 ? (a.error + std::abs(quotient) * b.error) / smallest
                                         : std::numeric_limits<double>::infinity()});
        }
        default:
            return {"max(" + a.text + ", " + b.text + ")", 5, std::max(a.value, b.value),
                    std::max(a.error, b.error)};
    }
}

/// One invocation a formula: out[i] = formula i at the given point.
std::vector<float> evaluateOnDevice(const std::vector<std::string>& formulas,
                                    const std::array<double, 3>& at) {
    std::string functions;
    std::string cases;
    for (std::size_t i = 0; i < formulas.size(); ++i) {
        const Formula expression(formulas[i], {"x", "y", "z"}, {});
        functions += expression.glslFunction("f" + std::to_string(i)) + "\n";
        cases += fmt::format("values[{0}] = f{0}(point.x, point.y, point.z);\n", i);
    }
    const gl::Pass pass = ShaderFolder(
                              "#version 450 core\nlayout(local_size_x = 1) in;\n"
                              "#include \"voxelization/formula.glsl\"\n#pragma snippet functions\n"
                              "layout(std430) writeonly buffer Values { float values[]; };\n"
                              "uniform vec3 point;\nvoid main() {\n#pragma snippet cases\n}\n")
                              .pass({}, {{"functions", functions}, {"cases", cases}});
    const gl::Buffer values(formulas.size() * sizeof(float));
    pass.set("point", glm::vec3(at[0], at[1], at[2]));
    pass.dispatch({1, 1, 1}, {{"Values", values}});
    return values.read<float>(formulas.size());
}

TEST_F(GlTest, FormulasHaveThePrecedenceOfMathematics) {
    const std::vector<std::pair<std::string, float>> formulas{
        {"-x^2", -9.0F},    {"2^3^2", 512.0F}, {"2^-x", 0.125F}, {"x--y^2", 7.0F},
        {"x/-y*z", -7.5F},  {"8/4/2", 1.0F},   {"x-y-z", -4.0F}, {"max(x, min(y, z)) + .5e1", 8.0F},
        {"sin(pi/2)", 1.0F}};
    std::vector<std::string> texts;
    for (const auto& [text, value] : formulas) texts.push_back(text);
    const std::vector<float> values = evaluateOnDevice(texts, {3.0, 2.0, 5.0});
    for (std::size_t i = 0; i < formulas.size(); ++i) {
        EXPECT_NEAR(values[i], formulas[i].second, 4e-6F * std::abs(formulas[i].second))
            << formulas[i].first;
    }
}

TEST_F(GlTest, TheQuarticOfTheThesisHasItsValues) {
    const std::vector<std::string> quartic{"x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8"};
    EXPECT_NEAR(evaluateOnDevice(quartic, {0.0, 0.0, 0.0})[0], 11.8F, 1e-5F);
    EXPECT_NEAR(evaluateOnDevice(quartic, {1.0, -1.0, 2.0})[0], -0.2F, 1e-5F);
}

TEST_F(GlTest, RandomFormulasHaveTheSameValueInShadersAsInMuParser) {
    Random random(7);
    const std::array<double, 3> at{1.25, -0.75, 2.5};  // exact as floats
    std::vector<Sample> samples;
    while (samples.size() < 200) {
        Sample sample = randomFormula(random, at, 3);
        // Others (1/(x-x), towers of powers) have no digits that could be compared.
        if (std::isfinite(sample.error) && sample.error < 1e-3 * (1 + std::abs(sample.value))) {
            samples.push_back(std::move(sample));
        }
    }
    std::vector<std::string> formulas;
    for (const Sample& sample : samples) formulas.push_back(sample.text);
    const std::vector<float> values = evaluateOnDevice(formulas, at);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double cpu = HostFormula(formulas[i])({at[0], at[1], at[2]});
        EXPECT_NEAR(cpu, samples[i].value, 1e-9 * (1 + std::abs(samples[i].value))) << formulas[i];
        EXPECT_NEAR(values[i], cpu, samples[i].error + 1e-6) << formulas[i];
    }
}

TEST_F(GlTest, PowersOfNegativeBasesAndOtherFunctionsAgreeWithMuParser) {
    const std::vector<std::string> formulas{
        "y^3",          "y^-2",    "y^2.0",   "y^(1+2)",     "x^0.5",
        "x^y",          "y^(x-x)", "0^2.5",   "sqrt(x)",     "exp(y)",
        "log(z)",       "abs(y)",  "tan(y)",  "cos(z)",      "min(x,y)",
        "-y^2",         "2^3^0.5", "-x^-y^2", "pi*x",        "1e-3*x",
        "12345678 + x", "y^64",    "y^65",    "2*-x^2/-4-1", "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8"};
    const std::array<double, 3> at{1.25, -0.75, 2.5};
    const std::vector<float> values = evaluateOnDevice(formulas, at);
    for (std::size_t i = 0; i < formulas.size(); ++i) {
        const double cpu = HostFormula(formulas[i])({at[0], at[1], at[2]});
        // pow() is exp2(exponent * log2(base)) on devices: its error grows with the exponent.
        EXPECT_NEAR(values[i], cpu, 3e-5 * std::abs(cpu) + 1e-6) << formulas[i];
    }
}

}  // namespace
}  // namespace gfxrepro::voxelization
