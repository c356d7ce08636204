// claims.csv, and what is kept beside it of runs, read back.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
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

/// By what a table was measured that results/reference keeps.
struct KeptRun {
    std::string table, commit, started, deviceClass, device, gl, cpu;
    long cores;
    std::vector<std::string> scans;  // scenes that were files
    std::string command;
};

/// A cell of a table that results/reference keeps; `row` as "scene=a; step=1".
struct KeptCell {
    std::string table, row, column, printed;
    std::optional<double> measured, low, high;
    bool isInterval = false;  // what low and high are; else a range
};

/// cells.csv as scripts/keep writes it. Throws Error with file and line.
std::vector<KeptCell> readKeptCells(const std::filesystem::path& file);

/// runs.csv as scripts/keep writes it. Throws Error with file and line.
std::vector<KeptRun> readKeptRuns(const std::filesystem::path& file);

}  // namespace gfxrepro::claims
