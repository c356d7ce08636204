#include "runner/claims/kept_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/core/files.h"
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

}  // namespace

std::vector<ClaimResult> readClaims(const std::filesystem::path& file) {
    using Spec = config::ClaimSpec;
    const std::string text = readFile(file);
    records::CsvReader reader(text, file.string());
    std::vector<std::string> header, fields;
    std::vector<ClaimResult> claims;
    reader.next(header);
    if (!std::ranges::equal(header, kClaimsColumns)) {
        throw Error({file.string(), 1},
                    fmt::format("the columns are {}; allowed: {}", fmt::join(header, ","),
                                fmt::join(kClaimsColumns, ",")));
    }
    while (reader.next(fields)) {
        if (fields.size() != header.size()) {
            throw Error(reader.location(),
                        fmt::format("expected {} columns, found {}", header.size(), fields.size()));
        }
        std::map<std::string, std::string> row;
        for (std::size_t i = 0; i < fields.size(); ++i) row[header[i]] = fields[i];
        ClaimResult& claim = claims.emplace_back();
        claim.id = row["claim"];
        claim.text = row["says"];
        claim.table = row["table"];
        claim.verdict = verdictAt(reader.location(), row["verdict"]);
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
        if (!row["known"].empty()) claim.known = verdictAt(reader.location(), row["known"]);
        claim.origin =
            valueOf<Spec::Origin>(config::kOrigins, row["origin"]).value_or(claim.origin);
        claim.boundFrom = valueOf<Spec::BoundSource>(config::kBoundSources, row["bound_from"]);
        claim.timeKind = valueOf<Spec::TimeKind>(config::kTimeKinds, row["kind"]);
    }
    markRepeats(claims);
    return claims;
}

}  // namespace gfxrepro::claims
