// The parts of report.html.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "runner/config/experiment.h"
#include "runner/report/claims.h"
#include "runner/report/images.h"
#include "runner/report/records.h"
#include "runner/report/table.h"

namespace gfxrepro::report {

/// The style sheet: light and dark by the reader's setting, narrow screens, print.
std::string_view reportStyle();

/// Everything of one experiment that its section of the report shows.
struct ReportSection {
    const config::Experiment* experiment = nullptr;
    const Table* table = nullptr;
    std::vector<ClaimResult> claims;
    std::vector<ImageEntry> images;
    /// A case that did not end well: its title and why.
    struct Failure {
        std::string name;
        Status status = Status::Ok;
        std::string message;
    };
    std::vector<Failure> failures;
};

/// Heading, table, claims, remarks, assumptions, images, how to run it again.
std::string sectionHtml(const ReportSection& section, const ReportContext& context,
                        const std::filesystem::path& runDir, bool embedsImages);
/// `table.slug`: the section's place in the page.
std::string sectionAnchor(const ReportSection& section);
/// The verdict as a coloured word.
std::string verdictBadge(Verdict verdict);
/// Device, counts of verdicts, the grid of all claims, what is missing.
std::string summaryHtml(const std::vector<ReportSection>& sections, const ReportContext& context,
                        const nlohmann::ordered_json& manifest);

}  // namespace gfxrepro::report
