#include <fmt/format.h>

#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/csv.h"
#include "runner/report/report.h"

namespace gfxrepro::report {

namespace {

Verdict verdictFromName(const std::string& name, const SourceLocation& where) {
    std::vector<std::string> known;
    for (const Verdict verdict : {Verdict::Holds, Verdict::Fails, Verdict::Ambiguous,
                                  Verdict::NotApplicable, Verdict::Unmeasured}) {
        if (verdictName(verdict) == name) return verdict;
        known.emplace_back(verdictName(verdict));
    }
    throw Error(where, fmt::format("'{}' is no verdict ({})", name, joined(known)));
}

}  // namespace

std::vector<ClaimResult> readClaims(const std::filesystem::path& file) {
    enum Column { Id, TableId, Device, Profile, Word, Measured, Required, Margin, Reason, Count };
    const std::string text = readFile(file);
    CsvReader reader(text, file.string());
    std::vector<std::string> fields;
    std::vector<ClaimResult> claims;
    reader.next(fields);  // the header
    while (reader.next(fields)) {
        if (fields.size() != Count) {
            throw Error(reader.location(),
                        fmt::format("expected {} columns, found {}", int{Count}, fields.size()));
        }
        ClaimResult& claim = claims.emplace_back();
        claim.id = fields[Id];
        claim.table = fields[TableId];
        claim.verdict = verdictFromName(fields[Word], reader.location());
        claim.measured = fields[Measured];
        claim.required = fields[Required];
        claim.margin = fields[Margin];
        claim.reason = fields[Reason];
    }
    return claims;
}

}  // namespace gfxrepro::report
