// What the pages show, gathered: for every table, each run's part of it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runner/html/gallery.h"
#include "runner/html/report.h"
#include "runner/report/table.h"

namespace gfxrepro::html {

/// A case that did not end well.
struct Failure {
    std::string caseId;
    std::string name;
    report::Status status = report::Status::Ok;
    std::string message;
};

/// A figure of a table.
struct Curve {
    std::string title;
    std::string svg;      // empty when it could not be drawn
    std::string problem;  // why not
    std::string script;   // for gnuplot, relative to the run's folder
};

/// What one run has of a table.
struct RunPart {
    const config::Experiment* experiment = nullptr;  // null: the run has only its verdicts, if any
    report::Table table;
    std::vector<report::ClaimResult> claims;
    std::vector<Shot> shots;
    std::vector<Curve> curves;
    std::vector<Failure> failures;
    std::vector<const ReportCase*> cases;
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

struct Model {
    std::span<const ReportRun> runs;
    std::vector<Page> pages;

    bool isComparison() const { return runs.size() > 1; }
    /// One experiment of one's own, on whose page the report opens.
    bool isOneOwn() const { return !isComparison() && pages.size() == 1 && pages[0].isOwn(); }
    /// "A", "B", … "Z", "AA", …
    static std::string letter(std::size_t run);
};

/// Builds the tables and judges the claims. `file` is where the report will lie.
Model buildModel(std::span<const ReportRun> runs, const std::filesystem::path& file);

}  // namespace gfxrepro::html
