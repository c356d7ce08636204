// The parts of the file, each as HTML text.
#pragma once

#include <string>
#include <string_view>

#include "runner/report/model.h"

namespace gfxrepro::report {

// Files beside this one, put into the program when it is built.
extern const std::string_view kStyle;   // report.css: light, dark, narrow, print
extern const std::string_view kScript;  // report.js: pages, filters, cases, viewer
extern const std::string_view kViewer;  // viewer.html: where two images are compared

/// What reproduced and what did not, of each document and chapter, with pictures; then every claim
/// in words; what is missing; what ran on what.
std::string overviewHtml(const Model& model);
/// A table with its claims, curves, assumptions, images and cases.
std::string pageHtml(const Page& page, const Model& model);

/// A line a run: device, processor, profile, day, how much was measured.
std::string machineHtml(const Model& model);
/// A line a run: how many printed numbers of tables were measured, and at the printed parameters.
std::string printedHtml(const Model& model);
/// What ran on what: a line a fact, a column a run.
std::string factsHtml(const Model& model);

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
/// Every case: its id, the command that runs it again, its log.
std::string casesHtml(const Page& page, const Model& model);

/// The verdict as a sign and its word, or another text, in its colour.
std::string verdictBadge(claims::Verdict verdict, const std::string& word = "");
/// "✓"
std::string verdictSign(claims::Verdict verdict);
/// "A-0123456789ab": a case's place in the file.
std::string caseAnchor(std::size_t run, const std::string& caseId);
/// "quick, llvmpipe (LLVM 15.0.6, 256 bits)".
std::string runName(const ReportRun& run);

}  // namespace gfxrepro::report
