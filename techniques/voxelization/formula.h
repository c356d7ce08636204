// Formulas given in a config ("x^4 - 5*x^2") as GLSL.
#pragma once

#include <string>
#include <vector>

#include "engine/core/error.h"

namespace gfxrepro::voxelization {

/// A real function of a few named variables: + - * / ^, unary minus, parentheses, decimal numbers,
/// pi, sin cos tan sqrt exp log abs min max. ^ binds tightest and to the right; -x^2 is -(x^2).
class Formula {
  public:
    /// `where` is the place of the formula in its config. Throws Error with that place, the
    /// character in the formula and what is allowed.
    Formula(const std::string& formula, std::vector<std::string> variables,
            const SourceLocation& where);

    const std::string& formula() const { return formula_; }

    /// `float NAME(float x, …) { … }`; needs formula.glsl. Precise: equal arguments give equal
    /// bits wherever it is called. Outside the domain of log and
    /// sqrt the value is undefined, as these are in GLSL.
    std::string glslFunction(const std::string& name) const;

  private:
    std::string formula_;
    std::vector<std::string> variables_;
    std::string glsl_;
};

}  // namespace gfxrepro::voxelization
