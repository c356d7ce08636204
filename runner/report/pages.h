// What the pages show, gathered: for every table, each run's part of it. And the parts of the file,
// each as HTML text.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/report/gallery.h"
#include "runner/report/report.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

/// A case that did not end well.
struct Failure {
    std::string caseId;
    std::string name;
    records::Status status = records::Status::Ok;
    std::string message;
};

/// What one run has of a table.
struct RunPart {
    const config::Experiment* experiment = nullptr;  // null: the run has only its verdicts, if any
    tables::Table table;
    std::vector<claims::ClaimResult> claims;
    std::vector<Shot> shots;
    std::vector<Failure> failures;
    std::vector<const config::Case*> cases;
};

/// A table, figure or section, with its part of every run.
struct Page {
    std::string id;    // "zju2005/2.1"
    std::string slug;  // "zju2005-2.1": its address in the file
    std::string label;
    std::string title;
    std::vector<RunPart> parts;  // beside Model::runs
    std::vector<Curve> curves;

    std::string paper() const { return id.substr(0, id.find('/')); }
    /// The first run's that has the table itself; null where none has.
    const RunPart* shown() const;
    /// An experiment of one's own, which stands for nothing published.
    bool isOwn() const;
    /// "Table 2.1. Voxelization"; of an experiment of one's own its title alone.
    std::string heading() const;
};

/// A document, or experiments of one's own, with the pages of each chapter; none is empty.
struct DocumentPages {
    struct ChapterPages {
        std::string title;  // empty: pages that no chapter names
        std::vector<const Page*> pages;
    };
    std::string id;     // "zju2005"; "sweep"
    std::string title;  // empty where `documents` does not know it
    std::vector<ChapterPages> chapters;

    std::vector<const Page*> pages() const;
};

struct Model {
    std::span<const ReportRun> runs;
    std::vector<Page> pages;
    std::vector<GalleryPlace> places;  // beside `runs`
    std::vector<config::Document> documents;
    std::vector<ComparedNumber> compared = {};  // as ReportOptions has it
    std::string comparedInAll = {};
    std::string findings = {};  // the address of their folder from the file; empty: no links

    bool isComparison() const { return runs.size() > 1; }
    /// One table, on whose page the report opens.
    bool isOneTable() const { return pages.size() == 1; }
    std::vector<DocumentPages> byDocument() const;
    /// "A", "B", … "Z", "AA", …
    static std::string letter(std::size_t run);
    /// "A: ", or in bold; empty where there is one run.
    std::string prefix(std::size_t run) const;
    std::string boldLetter(std::size_t run) const;
};

/// `file` is where the report will lie; `made` takes what is made for it of each run, where it is
/// not empty; else madeFolder() does.
Model buildModel(std::span<const ReportRun> runs, const std::filesystem::path& file,
                 const ReportOptions& options, const std::filesystem::path& made);

/// Whether `shows` means the shot by this name: "classes" is classes_0 and classes_1, too.
bool isCalled(const Shot& shot, const std::string& name);

/// The shots that a page shows first: those of the names (also "classes_0" of "classes"); where
/// none is of them those that tell where noisy pictures differ in the mean; else those that have a
/// truth; where none has, those of the first name of each case. Truths are not among them.
std::set<std::size_t> mainShots(const std::vector<Shot>& shots,
                                const std::vector<std::string>& names);

struct Highlight {
    const Page* page = nullptr;
    std::size_t run = 0;  // whose shot it is
    const Shot* shot = nullptr;
    const claims::ClaimResult* claim = nullptr;  // what it stands for
};

/// How much two pictures of a run differ, from 0 to 1.
using ShotDifference = std::function<double(std::size_t run, const Shot& a, const Shot& b)>;

/// How many stand for a document.
inline constexpr std::size_t kHighlights = 6;

/// Up to kHighlights pictures of the first run that has pictures of these pages, in their order:
/// half of them of tables of which a claim fails, where there are so many, the others of tables
/// whose claims hold. Of a page where all holds the picture nearest to its truth, else the one
/// farthest from it; without a truth the one with most to see, by its size as a file. Where fewer
/// pages have pictures, their next pictures follow, each for another claim of its page: those first
/// that are least like what is shown of the page.
std::vector<Highlight> highlightsOf(const std::vector<const Page*>& pages,
                                    const ShotDifference& difference);

// Files beside this one, put into the program when it is built.
extern const std::string_view kStyle;   // report.css: light, dark, narrow, print
extern const std::string_view kScript;  // viewer.js, report.js: pages, filters, cases
extern const std::string_view kViewer;  // viewer.html: where two images are compared

/// From the beginning of a file to its body: its title, and the style.
std::string headOfFile(const std::string& title);

/// What reproduced and what did not, of each document and chapter, with pictures; then every claim
/// in words; what is missing; what ran on what.
std::string overviewHtml(const Model& model);
/// A table with its claims, curves, assumptions, images and cases.
std::string pageHtml(const Page& page, const Model& model);

/// Of several runs "4 of 315 verdicts differ: …", each with what every run says; of a comparison of
/// two then its numbers. Empty for one run.
std::string differencesHtml(const Model& model);

/// A line a run: device, processor, profile, day, how much was measured.
std::string machineHtml(const Model& model);

/// Short: the words, the verdicts, and why it does not hold. Full: also what was measured.
enum class ClaimDetail { Short, Full };
/// The claims of a page in words, every run's verdict before them; empty without claims.
std::string claimsHtml(const Page& page, const Model& model, ClaimDetail detail);
/// What the script filters the claims by; without it there is nothing to press.
std::string filtersHtml(const Model& model);
/// What each verdict means.
std::string legendHtml();

/// The table itself: printed and measured numbers of every run side by side.
std::string tableHtml(const Page& page, const Model& model);
/// Images as the table lies, each truth once, with error maps below.
std::string imagesHtml(const Page& page, const Model& model);

/// The verdict as a sign and its word, in its colour.
std::string verdictBadge(claims::Verdict verdict);
/// "✓"
std::string verdictSign(claims::Verdict verdict);
/// "A-0123456789ab": a case's place in the file.
std::string caseAnchor(std::size_t run, const std::string& caseId);
/// A cell's place in the file: its row and column in the table of that run.
std::string cellAnchor(const Page& page, std::size_t run, std::size_t row, std::size_t column);
/// How near the run comes to the printed numbers of a document, as a sentence, a plot and CSV;
/// empty where nothing was measured at the printed parameters.
std::string nearnessHtml(const DocumentPages& document, const Model& model, std::size_t run);
/// A link to the page, of its label.
std::string pageLink(const Page& page);

}  // namespace gfxrepro::report
