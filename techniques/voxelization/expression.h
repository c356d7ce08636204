// Formulas given in a config ("x^4 - 5*x^2"), evaluated on the CPU and as GLSL.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.h"

namespace gfxrepro::voxelization {

/// A real function of a few named variables: + - * / ^, unary minus, parentheses, decimal numbers,
/// pi, sin cos tan sqrt exp log abs min max. ^ binds tightest and to the right; -x^2 is -(x^2).
///
/// muParser validates and evaluates. The text for shaders comes from a translator of our own,
/// because muParser hands out neither a tree nor its byte code.
class Expression {
  public:
    /// `where` is the place of the formula in its config. Throws Error with that place, the
    /// character in the formula and what is allowed.
    Expression(const std::string& formula, std::vector<std::string> variables,
               const SourceLocation& where);
    Expression(Expression&&) noexcept;
    Expression& operator=(Expression&&) noexcept;
    ~Expression();

    const std::string& formula() const;

    /// One value a variable, in the order of the constructor. Not-a-number outside the domain.
    double evaluate(std::span<const double> values) const;

    /// `float NAME(float x, …) { … }`; needs expression.glsl. Precise: equal arguments give equal
    /// bits wherever it is called. Outside the domain of log and
    /// sqrt the value is undefined, as these are in GLSL.
    std::string glslFunction(const std::string& name) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gfxrepro::voxelization
