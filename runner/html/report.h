// report.html: what a person looks at after a run, or to lay several runs side by side.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "runner/config/documents.h"
#include "runner/config/experiment.h"
#include "runner/report/case_records.h"
#include "runner/report/claims.h"

namespace gfxrepro::html {

/// A case of a run's plan: how it is run again, and what its log says.
struct ReportCase {
    std::string id;
    std::string table;    // "zju2005/2.1"
    std::string title;    // "zju2005/2.1 scene=models/duck"
    std::string command;  // for a shell
    std::vector<std::string> log;
};

/// A finished run: all that its pages show. Of the manifest are shown, where there: commit, build,
/// cpu, cores, memory_bytes, gl.renderer, gl.version, profile, started, scenes.
struct ReportRun {
    std::filesystem::path folder;
    report::ReportContext context;
    nlohmann::ordered_json manifest;
    std::vector<config::Experiment> experiments;
    std::vector<report::PlannedCase> planned;
    std::vector<report::Record> records;
    std::vector<ReportCase> cases;
    /// Verdicts as they were kept, of a run of which only these are at hand; else they are judged.
    std::vector<report::ClaimResult> keptClaims;
    std::map<std::string, std::string> commands = {};  // that measure a table again, by its id
};

struct ReportOptions {
    std::vector<config::Document> documents = {};  // titles and chapters, for the first screen
    bool embeds = false;                           // every picture inside of the file
};

/// One file that asks no network and no other file but images: what reproduced and what did not,
/// then a page a table; of one table its page first. Images lie inside up to 20 MB; beyond, the
/// page shows thumbnails, and links
/// both, relative to `file`. With `embeds` they always lie inside, beyond 20 MB at 512 pixels at
/// most, and nothing else is written. What else is made for it (plots, FLIP maps, thumbnails) goes
/// into the run's folder where `file` lies there; else beside `file`, into <stem>-files/, and the
/// run stays as it is. Several runs are lettered A, B, … and stand side by side. Throws Error when
/// a file cannot be written.
void writeReport(const std::filesystem::path& file, std::span<const ReportRun> runs,
                 const ReportOptions& options = {});

}  // namespace gfxrepro::html
