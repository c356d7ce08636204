#include "runner/claims/kept_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/config/schema.h"
#include "runner/records/csv.h"

namespace gfxrepro::claims {

Verdict verdictAt(const SourceLocation& where, const std::string& name) {
    try {
        return verdictFromName(name);
    } catch (const Error& error) {
        throw Error(where, error.what());
    }
}

namespace {

/// The enumerator whose name it is; none for an empty or unknown one.
template <class Value, std::size_t kCount>
std::optional<Value> valueOf(const std::array<std::string_view, kCount>& names,
                             const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Value>(found - names.begin());
}

/// By column.
using Row = std::map<std::string, std::string>;

/// Calls `take(row, where)` for each row of a file that has just these columns.
template <class Take>
void readRows(const std::filesystem::path& file, std::span<const std::string_view> columns,
              const Take& take) {
    const std::string text = readFile(file);
    records::CsvReader reader(text, file.string());
    std::vector<std::string> header, fields;
    reader.next(header);
    if (!std::ranges::equal(header, columns)) {
        throw Error({file.string(), 1},
                    fmt::format("the columns are {}; allowed: {}", fmt::join(header, ","),
                                fmt::join(columns, ",")));
    }
    while (reader.next(fields)) {
        if (fields.size() != header.size()) {
            throw Error(reader.location(),
                        fmt::format("expected {} columns, found {}", header.size(), fields.size()));
        }
        Row row;
        for (std::size_t i = 0; i < fields.size(); ++i) row[header[i]] = fields[i];
        take(row, reader.location());
    }
}

constexpr std::array<std::string_view, 11> kRunsColumns = {
    "table", "commit", "started", "class",      "device", "gl",
    "cpu",   "cores",  "scans",   "parameters", "command"};

}  // namespace

std::vector<ClaimResult> readClaims(const std::filesystem::path& file) {
    using Spec = config::ClaimSpec;
    std::vector<ClaimResult> claims;
    readRows(file, kClaimsColumns, [&](Row& row, const SourceLocation& where) {
        ClaimResult& claim = claims.emplace_back();
        claim.id = row["claim"];
        claim.text = row["says"];
        claim.table = row["table"];
        claim.verdict = verdictAt(where, row["verdict"]);
        claim.measured = row["measured"];
        claim.required = row["required"];
        claim.margin = row["margin"];
        claim.reason = row["reason"];
        claim.because = row["because"];
        claim.restsOn = row["rests_on"];
        claim.rows = row["rows"];
        claim.holdsOn = row["holds_on"];
        claim.sameAs = row["same_as"];
        claim.known.reset();
        if (!row["known"].empty()) claim.known = verdictAt(where, row["known"]);
        claim.origin =
            valueOf<Spec::Origin>(config::kOrigins, row["origin"]).value_or(claim.origin);
        claim.boundFrom = valueOf<Spec::BoundSource>(config::kBoundSources, row["bound_from"]);
        claim.timeKind = valueOf<Spec::TimeKind>(config::kTimeKinds, row["kind"]);
    });
    markRepeats(claims);
    return claims;
}

std::vector<KeptCell> readKeptCells(const std::filesystem::path& file) {
    constexpr std::array<std::string_view, 11> kColumns = {
        "table", "row",  "source", "column", "printed", "measured",
        "low",   "high", "bounds", "status", "marks"};
    std::vector<KeptCell> cells;
    readRows(file, kColumns, [&](Row& row, const SourceLocation&) {
        cells.push_back({row["table"], row["row"], row["column"], row["printed"],
                         parseDouble(row["measured"]), parseDouble(row["low"]),
                         parseDouble(row["high"]), row["bounds"] == "95 % interval"});
    });
    return cells;
}

std::vector<KeptRun> readKeptRuns(const std::filesystem::path& file) {
    std::vector<KeptRun> runs;
    readRows(file, kRunsColumns, [&](Row& row, const SourceLocation& where) {
        const std::optional<double> cores = parseDouble(row["cores"]);
        if (!cores) throw Error(where, "cores: '" + row["cores"] + "' is no number");
        runs.push_back({row["table"], row["commit"], row["started"], row["class"], row["device"],
                        row["gl"], row["cpu"], std::lround(*cores), split(row["scans"], ' '),
                        row["command"]});
    });
    return runs;
}

}  // namespace gfxrepro::claims
