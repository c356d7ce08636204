// The parts of the file, each as HTML text.
#pragma once

#include <string>
#include <string_view>

#include "runner/html/model.h"

namespace gfxrepro::html {

// Files beside this one, put into the program when it is built.
extern const std::string_view kStyle;   // report.css: light, dark, narrow, print
extern const std::string_view kScript;  // report.js: pages, filters, cases, viewer
extern const std::string_view kViewer;  // viewer.html: where two images are compared

/// Devices, counts of verdicts, the grid of all claims, what is missing.
std::string overviewHtml(const Model& model);
/// A table with its claims, curves, assumptions, images and cases.
std::string pageHtml(const Page& page, const Model& model);

/// The table itself: printed and measured numbers of every run side by side.
std::string tableHtml(const Page& page, const Model& model);
/// Images, a case a row, with error maps where a truth is known.
std::string imagesHtml(const Page& page, const Model& model);
/// Every case: its id, the command that runs it again, its log.
std::string casesHtml(const Page& page, const Model& model);

/// The verdict as a coloured word.
std::string verdictBadge(report::Verdict verdict);
/// "A-0123456789ab": a case's place in the file.
std::string caseAnchor(std::size_t run, const std::string& caseId);
/// "quick, llvmpipe (LLVM 15.0.6, 256 bits)".
std::string runName(const ReportRun& run);

}  // namespace gfxrepro::html
