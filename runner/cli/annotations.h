// What GitHub shows beside the lines of a change: workflow commands on standard error, where
// GITHUB_ACTIONS is set, nothing elsewhere.
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "runner/claims/claims.h"
#include "runner/records/records.h"

namespace gfxrepro::cli {

/// Whether anybody reads them.
bool areAnnotationsWanted();

/// "::error file=configs/a.yaml,line=3,col=5,title=T::message": files below the workspace
/// (GITHUB_WORKSPACE) relative to it; what is not known is left out.
std::string annotation(std::string_view level, const SourceLocation& where, std::string_view title,
                       std::string_view message);

/// Writes it, of level error.
void annotateError(const SourceLocation& where, std::string_view title, std::string_view message);

/// Of what ends the program.
void annotate(const std::exception& error);

/// Of a run: an error for each case and each claim that failed; of a claim that is known to fail, a
/// notice.
void annotate(const std::vector<records::CaseEnd>& cases);
void annotate(const std::vector<claims::ClaimResult>& claims);

}  // namespace gfxrepro::cli
