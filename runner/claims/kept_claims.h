// claims.csv, read back.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "runner/claims/claims.h"

namespace gfxrepro::claims {

/// The columns of claims.csv.
inline constexpr std::array<std::string_view, 19> kClaimsColumns = {
    "claim",   "says",     "table", "device",   "profile",  "origin", "bound_from",
    "kind",    "verdict",  "known", "measured", "required", "margin", "reason",
    "because", "rests_on", "rows",  "holds_on", "same_as"};

/// The verdict of that name. Throws Error at `where` for a name that is none.
Verdict verdictAt(const SourceLocation& where, const std::string& name);

/// claims.csv as writeClaims() wrote it. Throws Error with file and line.
std::vector<ClaimResult> readClaims(const std::filesystem::path& file);

}  // namespace gfxrepro::claims
