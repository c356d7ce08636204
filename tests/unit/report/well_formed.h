// Whether a text is well-formed XML, as far as SVGs go: no doctype, no processing instructions.
#pragma once

#include <set>
#include <string>

namespace gfxrepro::test {

/// Empty if it is, and no id stands twice; else what is wrong. Adds the ids to `ids`.
std::string xmlProblem(const std::string& xml, std::set<std::string>& ids);

}  // namespace gfxrepro::test
