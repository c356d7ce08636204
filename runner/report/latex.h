// A table as LaTeX: a macro for each number, and a tabular of these macros.
#pragma once

#include <string>

#include "runner/tables/table.h"

namespace gfxrepro::report {

/// tables/<slug>.tex. Its head says how the numbers are cited.
std::string tableLatex(const tables::Table& table);

/// Part of a macro's key: letters, digits and . + - _ stay, anything else becomes "-". They hold
/// nothing that LaTeX would expand.
std::string latexKeyPart(const std::string& label);

}  // namespace gfxrepro::report
