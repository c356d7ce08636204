// What the pages show, gathered: for every table, each run's part of it.
#pragma once

#include <span>
#include <string>
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
    std::vector<const Curve*> curves;
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
    struct Chapter {
        std::string title;  // empty: pages that no chapter names
        std::vector<const Page*> pages;
    };
    std::string id;     // "zju2005"; "sweep"
    std::string title;  // empty where `documents` does not know it
    std::vector<Chapter> chapters;

    std::vector<const Page*> pages() const;
};

struct Model {
    std::span<const ReportRun> runs;
    std::vector<Page> pages;
    std::vector<GalleryPlace> places;  // beside `runs`
    std::vector<config::Document> documents;
    std::string findings = {};  // the address of their folder from the file; empty: no links

    bool isComparison() const { return runs.size() > 1; }
    /// One table, on whose page the report opens.
    bool isOneTable() const { return pages.size() == 1; }
    std::vector<DocumentPages> byDocument() const;
    /// "A", "B", … "Z", "AA", …
    static std::string letter(std::size_t run);
};

/// `file` is where the report will lie; `made` takes what is made for it of each run, where it is
/// not empty; else madeFolder() does.
Model buildModel(std::span<const ReportRun> runs, const std::filesystem::path& file,
                 const ReportOptions& options, const std::filesystem::path& made);

}  // namespace gfxrepro::report
