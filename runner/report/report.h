// report.html: what a person looks at after a run, or to lay several runs side by side.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "runner/claims/claims.h"
#include "runner/config/documents.h"
#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/report/curves.h"
#include "runner/report/gallery.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

/// A finished run: all that its pages show. Of the manifest are shown, where there: commit, build,
/// cpu, cores, memory_bytes, gl.renderer, gl.version, profile, started, scenes.
struct ReportRun {
    std::filesystem::path folder;
    claims::ReportContext context;
    nlohmann::ordered_json manifest;
    std::vector<config::Experiment> experiments;
    std::vector<tables::Table> tables;  // beside `experiments`
    /// Of these tables; or as they were kept, of a run of which only its verdicts are at hand.
    std::vector<claims::ClaimResult> claims;
    std::vector<Curve> curves;  // of a run alone; those of several are laid over one another
    std::vector<records::Record> records;
    std::vector<config::Case> cases;  // of its plan
    /// For a shell: what measures a table or a case again, by its id.
    std::map<std::string, std::string> commands = {};
    std::map<std::string, std::vector<std::string>> events = {};  // of a case, for people
    std::vector<tables::Table> keptTables = {};  // of kept results: their cells, no experiments
};

/// A number of two runs: "sweep/mine … wall_time_ms", "slower", "× 1.2 [1.1, 1.3]".
struct ComparedNumber {
    std::string title, verdict, says;
    bool isAlarm = false;
};

/// A file that is to be sent is no larger, if its pictures can be small enough: mail takes no more.
inline constexpr std::uintmax_t kSentBytes = 25'000'000;

struct ReportOptions {
    std::vector<config::Document> documents = {};  // titles and chapters, for the first screen
    bool embeds = false;                           // every picture inside of the file
    PicturesDone progress = {};                    // of each run
    /// The folder of findings, which claims are shown by; empty where it is not at hand.
    std::filesystem::path findings = {};
    /// Of a comparison of two runs: what became of each number, for its page; empty without one.
    std::vector<ComparedNumber> compared = {};
    std::string comparedInAll = {};  // "2 slower, 40 same"
};

/// One file that asks no network and no other file but images: what reproduced and what did not,
/// then a page per table; of one table its page first. Images lie inside up to 20 MB; beyond, the
/// page shows thumbnails, and links both, relative to `file`. With `embeds` they always lie inside,
/// beyond 20 MB reduced so that the file can be sent (reducedPxOf), which the page says, and
/// nothing else is written. What else is made for it (FLIP maps, thumbnails) goes into
/// madeFolder(). Several runs are lettered A, B, … and stand side by side. Throws Error when a file
/// cannot be written.
void writeReport(const std::filesystem::path& file, std::span<const ReportRun> runs,
                 const ReportOptions& options = {});

/// Where curves, FLIP maps and thumbnails of the run at `index` go for a report that will be
/// `file`: the run's own folder, where the file lies there too; else beside the file, which leaves
/// the run as it is: "all.html" → all-files/A.
std::filesystem::path madeFolder(const std::filesystem::path& runDir, std::size_t index,
                                 const std::filesystem::path& file);

}  // namespace gfxrepro::report
