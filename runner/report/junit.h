// junit.xml: every case and every claim is a test with a name of its own.
#pragma once

#include <string>
#include <vector>

#include "runner/claims/claims.h"
#include "runner/records/case_result.h"

namespace gfxrepro::report {

/// The text of junit.xml.
std::string junitXml(const std::vector<records::CaseResult>& cases,
                     const std::vector<claims::ClaimResult>& results);

}  // namespace gfxrepro::report
