// What `check` refuses of a claim: whose it is, where its number comes from, what it reads.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "runner/claims/claim_reader.h"
#include "runner/claims/claim_same_mean.h"
#include "runner/claims/claims.h"

namespace gfxrepro::claims {

using config::ClaimSpec;

namespace {

/// Labels that only a measurement knows (of a parameter left to its default) are not in a table
/// without records.
bool isReadable(const ClaimSpec& claim, const tables::Table& table) {
    try {
        const ClaimReader reader(claim, table);
        return true;
    } catch (const Error&) {
        return false;
    }
}

/// Fewer than an interval takes decide no time on any device.
int processesOfPaper(const config::Experiment& experiment) {
    if (experiment.paperDocument.isNull()) return config::kFewestRounds;
    return config::experimentFromDocument(experiment.paperDocument, experiment.file)
        .measure.processes;
}

/// Why a claim's kind of time is not that of what it reads; empty if it is.
std::string whyWrongKind(const ClaimSpec& claim, ClaimReader& reader) {
    if (reader.readsTime() && !claim.timeKind) {
        return "reads a time and needs 'kind': algorithmic | architectural | absolute";
    }
    if (!reader.readsTime() && claim.timeKind) return "has a 'kind' and reads no time";
    if (claim.timeKind && *claim.timeKind != ClaimSpec::TimeKind::Absolute &&
        reader.asksForATimeAsSuch()) {
        return "holds a time against a number, which neither a count of work nor another machine "
               "decides; its 'kind' is absolute";
    }
    return "";
}

/// The table with what was printed where measurements stand, each a number without an interval.
tables::Table asPrinted(tables::Table table) {
    std::ranges::move(table.printedRows, std::back_inserter(table.rows));
    for (tables::TableRow& row : table.rows) {
        for (tables::Cell& cell : row.cells) {
            cell.isTime = false;
            cell.values.clear();
            const bool isPrinted = !cell.printedValues.empty() && cell.printedValues[0];
            cell.isPlanned = isPrinted;
            cell.status = isPrinted ? records::Status::Ok : records::Status::Missing;
            if (!isPrinted) continue;
            tables::Measured& number = cell.values.emplace_back();
            number.value = *cell.printedValues[0];
            number.interval = {number.value, number.value};
        }
    }
    return table;
}

/// A bound that is from print is met by what was printed, but for an aim of ours to better it:
/// what the claim comes to there if not; empty if it is, and where not all that it reads is there.
std::string whyNotOfPrint(const ClaimSpec& claim, const tables::Table& table) {
    if (claim.statistic || claim.origin == ClaimSpec::Origin::Ours) return "";
    ReportContext context;
    context.deviceClass = "gpu";
    context.profile = claim.profile.value_or("paper");
    config::Experiment alone;
    alone.claims = {claim};
    alone.claims[0].timeKind.reset();
    const ClaimResult result = evaluateClaims(alone, asPrinted(table), context)[0];
    return result.verdict == Verdict::Fails ? result.measured : "";
}

/// Scenes that a verdict in the profile, or in any, is taken over.
int seedsAtMost(const config::Experiment& experiment, const std::optional<std::string>& profile) {
    int seeds = experiment.measure.sceneSeeds;
    if (profile.value_or("paper") != "paper" || experiment.paperDocument.isNull()) return seeds;
    return std::max(seeds, config::experimentFromDocument(experiment.paperDocument, experiment.file)
                               .measure.sceneSeeds);
}

}  // namespace

void requireProvenance(const config::Experiment& experiment, const tables::Table& table) {
    const bool isOfDocument = experiment.kind != config::Experiment::Kind::Sweep;
    const int paperProcesses = processesOfPaper(experiment);
    tables::Table read;  // outlives its reader
    for (const ClaimSpec& claim : experiment.claims) {
        const auto complain = [&](const std::string& what) {
            throw Error(claim.location, fmt::format("claim '{}' {}", claim.id, what));
        };
        if (isOfDocument && !claim.origin) {
            complain("needs 'origin': document | derived | ours | definition | calibrated");
        }
        if (isOfDocument && claim.hasBound() && !claim.boundFrom) {
            complain("requires a number and needs 'bound_from': print | text | ours");
        }
        if (claim.boundFrom == ClaimSpec::BoundSource::Print && experiment.printed.rows.empty()) {
            complain("has its bound from print, and the table has no printed values: text | ours");
        }
        if (claim.type == ClaimSpec::Type::Tolerance && *claim.high >= 1.0) {
            complain("is within 100 % of what is printed or more, so that nothing is too little");
        }
        for (const ClaimSpec::Known& known : claim.because) {
            if (claim.device == ClaimSpec::Device::Gpu && known.device == "software") {
                complain("has a reason for software ('because'), and a GPU alone judges it");
            }
            if (claim.profile && known.profile && known.profile != claim.profile) {
                complain(fmt::format("has a reason in the profile {}, and is judged in {} alone",
                                     *known.profile, *claim.profile));
            }
        }
        if (!isReadable(claim, read = tableFor(claim, table))) continue;
        ClaimReader reader(claim, read);
        if (!reader.readsAny()) continue;  // its rows are not of this profile
        if (claim.type == ClaimSpec::Type::SameMean) {
            const std::string why = whyNotTestable(experiment, claim, reader);
            if (!why.empty()) complain(why);
        }
        if (claim.boundFrom == ClaimSpec::BoundSource::Print && !reader.readsPrinted()) {
            complain(
                "has its bound from print, and reads no cell with a printed value: text | ours");
        }
        if (claim.boundFrom == ClaimSpec::BoundSource::Print) {
            const std::string printed = whyNotOfPrint(claim, table);
            if (!printed.empty()) {
                complain("has its bound from print, and what is printed does not meet it: " +
                         printed);
            }
        }
        for (const ClaimSpec::Known& known : claim.because) {
            if (known.verdict != verdictName(Verdict::Ambiguous) || reader.readsTime()) continue;
            if (reader.readsShare() || seedsAtMost(experiment, known.profile) > 1) continue;
            complain(
                "is known as ambiguous, and reads neither a time nor a share, of one scene: a "
                "number without an interval holds or fails");
        }
        if (table.isPublished && claim.origin == ClaimSpec::Origin::Calibrated &&
            !reader.readsCalibrated()) {
            complain(
                "is of a calibrated input, and reads cells that 'printed.calibrated' does not "
                "mark");
        }
        if (const std::string why = whyWrongKind(claim, reader); !why.empty()) complain(why);
        if (isOfDocument && claim.timeKind && paperProcesses < config::kFewestRounds) {
            complain(
                fmt::format("is of a time: the paper profile needs processes: {} or more, has {}",
                            config::kFewestRounds, paperProcesses));
        }
    }
}

}  // namespace gfxrepro::claims
