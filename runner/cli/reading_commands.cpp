// Tables, claims and report, made again from a run's records; no GPU needed.
#include "runner/cli/reading_commands.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/outcome/results.h"
#include "runner/report/report.h"
#include "runner/report/writers.h"
#include "runner/run/run.h"
#include "runner/tables/printed.h"
#include "runner/tables/table.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

/// More names of failing claims than these bury the summary.
constexpr std::size_t kSaidFailing = 20;

/// "2 crash, 1 timeout"; the most frequent first.
std::string failuresText(const run::Completeness& counts) {
    std::vector<std::pair<records::Status, int>> failures(counts.failures.begin(),
                                                          counts.failures.end());
    std::ranges::stable_sort(failures, std::greater<>{}, &std::pair<records::Status, int>::second);
    std::vector<std::string> texts;
    for (const auto& [status, count] : failures) {
        texts.push_back(fmt::format("{} {}", count, records::statusName(status)));
    }
    return joined(texts);
}

/// Says what is missing; the exit code of a command that has nothing worse to report.
int completenessCode(const run::StoredRun& run) {
    const run::Completeness counts = run::completeness(run);
    if (counts.isComplete()) return kExitOk;
    say("incomplete: {} not run, {} failed{}{}\n", counts.missing, counts.failed,
        counts.failed > 0 ? fmt::format(" ({})", failuresText(counts)) : "",
        counts.measured() == 0 ? "; no case has a result" : "");
    return kExitIncomplete;
}

/// What the claim says; its name where that is not known.
const std::string& wordsOf(const claims::ClaimResult& claim) {
    return claim.text.empty() ? claim.id : claim.text;
}

/// Names the claims that fail, and gives their number.
std::size_t sayFailing(const std::vector<claims::ClaimResult>& claims) {
    std::size_t failing = 0;
    for (const claims::ClaimResult& claim : claims) {
        if (claim.verdict != claims::Verdict::Fails || ++failing > kSaidFailing) continue;
        say("  {} fails: {} ({}); measured {}, required {}\n", claim.table, wordsOf(claim),
            claim.id, claim.measured, claim.required);
        if (const std::string why = claims::whyText(claim); !why.empty()) say("    why: {}\n", why);
    }
    if (failing > kSaidFailing) {
        say("  and {} more that fail, in the report\n", failing - kSaidFailing);
    }
    return failing;
}

/// How many claims hold, paper by paper where there are several, and what the other words mean.
void sayVerdicts(const std::vector<claims::ClaimResult>& claims) {
    std::map<std::string, std::vector<claims::ClaimResult>> ofPaper;
    std::set<claims::Verdict> verdicts;
    for (const claims::ClaimResult& claim : claims) {
        ofPaper[claim.table.substr(0, claim.table.find('/'))].push_back(claim);
        verdicts.insert(claim.verdict);
    }
    if (ofPaper.size() > 1) {
        for (const auto& [paper, own] : ofPaper) {
            say("  {:<12}{}\n", paper, claims::originSummaryLine(own));
        }
    }
    say("claims: {}\n", claims::originSummaryLine(claims));
    for (const claims::ClaimResult& claim : claims) {
        if (!claim.isNews()) continue;
        say("  news: {} {}: {} ({}); known: {}\n", claim.table, claims::verdictName(claim.verdict),
            wordsOf(claim), claim.id, claims::verdictName(*claim.known));
    }
    static const std::pair<claims::Verdict, const char*> kMeanings[] = {
        {claims::Verdict::Ambiguous, "too few rounds or too much noise to tell: more rounds may"},
        {claims::Verdict::Unmeasured, "a case that it needs has no result"},
        {claims::Verdict::NotApplicable, "asks for a GPU, or for another profile"},
    };
    for (const auto& [verdict, meaning] : kMeanings) {
        if (verdicts.contains(verdict)) say("  {}: {}\n", claims::verdictName(verdict), meaning);
    }
}

/// Once a command, where verdicts stand without it.
void sayWhatIsNotKnown(const std::vector<claims::ClaimResult>& claims) {
    const auto isUnknown = [](const claims::ClaimResult& claim) {
        return claim.restsOn == claims::kRestsOnUnknown;
    };
    if (std::ranges::none_of(claims, isUnknown)) return;
    say("on which assumptions verdicts rest is not known: there is no {}\n",
        (dataFolder("configs").parent_path() / "results/sensitivity").string());
}

/// The verdicts; the exit code when all cases were measured.
int sayClaims(const std::vector<claims::ClaimResult>& claims) {
    for (const claims::ClaimResult& claim : claims) {
        const std::string why =
            claim.verdict == claims::Verdict::Holds ? claim.reason : claims::whyText(claim);
        say("{} {}{}: {} ({}){}\n", claim.table, claims::verdictName(claim.verdict),
            claim.isNews() ? " (news)" : "", wordsOf(claim), claim.id,
            why.empty() ? "" : fmt::format("; {}", why));
    }
    say("{}\n", claims::originSummaryLine(claims));
    sayWhatIsNotKnown(claims);
    const bool anyFails = std::any_of(claims.begin(), claims.end(), [](const auto& claim) {
        return claim.verdict == claims::Verdict::Fails;
    });
    return anyFails ? kExitClaimFailed : kExitOk;
}

/// Of each column or row that is empty for asking for what has other names that, once.
std::map<std::string, std::string> misnamedIn(const tables::Table& table) {
    const auto isEmptyCell = [](const tables::Cell& cell) { return cell.values.empty(); };
    std::map<std::string, std::string> problems;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const bool isColumnEmpty = std::ranges::all_of(
            table.rows, [&](const tables::TableRow& row) { return row.cells[i].values.empty(); });
        for (std::size_t k = 0; k < table.rows.size(); ++k) {
            const tables::TableRow& row = table.rows[k];
            if (!row.cells[i].isMisnamed) continue;
            if (!isColumnEmpty && !std::ranges::all_of(row.cells, isEmptyCell)) continue;
            problems.emplace(isColumnEmpty ? fmt::format("column '{}'", table.columns[i].label)
                                           : fmt::format("row '{}'", table.rowName(k)),
                             row.cells[i].message);
        }
    }
    return problems;
}

/// Says what tables, and claims about one that nobody laid out, call by no name that was recorded;
/// the exit code then, else `code`.
int codeOfNames(const std::vector<tables::Table>& tables,
                const std::vector<config::Experiment>& experiments, int code) {
    for (std::size_t i = 0; i < tables.size(); ++i) {
        std::map<std::string, std::string> problems = misnamedIn(tables[i]);
        const config::Experiment& experiment = experiments[i];
        const bool isKnown = config::isMeasuredHere(experiment) || !experiment.hasDefaultLayout();
        for (const config::ClaimSpec& claim : experiment.claims) {
            const std::string absent = isKnown ? "" : claims::whatIsAbsent(claim, tables[i]);
            if (!absent.empty()) problems.emplace(fmt::format("claim '{}'", claim.id), absent);
        }
        for (const auto& [name, problem] : problems) {
            tell("error: {}: {}: {}\n", tables[i].id, name, problem);
        }
        if (!problems.empty()) code = kExitUsage;
    }
    return code;
}

/// Judges the records by configs that are not those that the run froze before it measured. What
/// comes of it stands apart, below `out`, and says so.
int judgeAfterwards(const fs::path& runDir, const std::vector<std::string>& configs,
                    const fs::path& out) {
    const run::StoredRun run = run::readRun(runDir);
    run::Request request = run.plan.request;
    request.configs = findPaperConfigs(configs);
    std::vector<config::Experiment> experiments = loadExperiments(request, run.plan.profile);
    for (config::Experiment& experiment : experiments) {
        const auto measured =
            std::ranges::find(run.plan.experiments, experiment.id, &config::Experiment::id);
        if (measured != run.plan.experiments.end()) {
            experiment.paperDocument = measured->paperDocument;
            experiment.paperCases = measured->paperCases;
            experiment.outputs = measured->outputs;
            continue;
        }
        throw Error(fmt::format("{}: {} is not among what {} measured", experiment.file.string(),
                                experiment.id, runDir.string()));
    }
    outcome::Results judged = outcome::resultsOf(run, experiments);
    const std::string mark = "judged after the run, by a config that it did not know";
    std::vector<std::string> notes = run::notesOf(run.manifest);
    notes.insert(notes.begin(), mark);
    for (tables::Table& table : judged.tables) {
        table.notes.insert(table.notes.begin(), notes.begin(), notes.end());
    }
    for (claims::ClaimResult& claim : judged.claims) {
        claim.reason = mark + (claim.reason.empty() ? "" : "; " + claim.reason);
    }
    outcome::takeFolder(out, runDir, run.manifest);
    const fs::path folder = out / "judged-afterwards";
    fs::remove_all(folder);
    report::writeTables(folder, judged.tables, notes);
    report::writeClaims(folder, run::caseResults(run, runDir), judged.claims, judged.context,
                        run.manifest.value("started", ""));
    const int verdict = sayClaims(judged.claims);
    sayNotes(run.manifest);
    say("judged after the run: {}\n", (folder / "claims.csv").string());
    const int code = completenessCode(run);
    return codeOfNames(judged.tables, experiments, code == kExitOk ? verdict : code);
}

/// How much of the tables was measured as it is printed.
void sayPrintedCells(const tables::PrintedCells& count) {
    const std::string line = tables::printedCellsLine(count);
    if (!line.empty()) say("{}\n", line);
}

/// A report does not go over that of a run that it does not show.
void requireNoOtherRun(const fs::path& folder, const std::vector<report::ReportRun>& runs) {
    const bool isShown = std::ranges::any_of(runs, [&](const report::ReportRun& run) {
        std::error_code isAbsent;
        return fs::equivalent(folder, run.folder, isAbsent);
    });
    if (isShown || !fs::exists(folder / "plan.json")) return;
    throw Error(folder.string() + ": holds another run; give another folder");
}

void sayReport(const fs::path& file) {
    say("report: {}\n", file.string());
}

/// Of a file that is to be sent its size, too.
void saySentReport(const fs::path& file) {
    const auto bytes = fs::file_size(file);
    say("report: {} ({:.1f} MB)\n", file.string(), static_cast<double>(bytes) / 1e6);
    if (bytes <= report::kSentBytes) return;
    tell(
        "warning: {} is larger than the {} MB that most mail takes; send one table's: `gfxrepro "
        "reproduce TABLE`, then `report --embed` of that run, or pack the run's folder\n",
        file.string(), report::kSentBytes / 1'000'000);
}

/// Of cases that recorded nothing: no file is written.
bool isEmpty(const tables::Table& table) {
    return table.columns.empty();
}

/// Says now and then how far the pictures of a large run are.
void sayPictures(std::size_t done, std::size_t all) {
    constexpr std::size_t kEvery = 250;
    if (done % kEvery == 0 && done < all) tell("report: {} of {} pictures\n", done, all);
}

}  // namespace

void noteOtherMachines(std::vector<report::ReportRun>& runs) {
    std::vector<std::string> machines;
    for (const report::ReportRun& run : runs) {
        const std::string machine = run::machineName(run.manifest);
        if (std::ranges::find(machines, machine) == machines.end()) machines.push_back(machine);
    }
    if (machines.size() < 2) return;
    runs.front().manifest["notes"].push_back("the runs are of several machines: " +
                                             joined(machines, "; "));
}

void requireReport(const fs::path& file) {
    std::error_code isAbsent;
    if (!fs::exists(file, isAbsent)) return;
    constexpr std::size_t kHeadBytes = 4096;
    const MappedFile there(file);
    if (there.text().substr(0, kHeadBytes).find("<title>gfxrepro: ") != std::string_view::npos) {
        return;
    }
    throw Error(file.string() + ": is there and is not a report; give another file");
}

void sayNotes(const run::Json& manifest) {
    for (const std::string& note : run::notesOf(manifest)) say("warning: {}\n", note);
}

int conclude(const fs::path& runDir) {
    const run::StoredRun run = run::readRun(runDir);
    const outcome::Results results = outcome::writeResults(runDir, run, {});
    sayNotes(run.manifest);
    const std::size_t failing = sayFailing(results.claims);
    sayVerdicts(results.claims);
    sayWhatIsNotKnown(results.claims);
    sayPrintedCells(results.printedCells);
    if (!std::ranges::all_of(results.tables, isEmpty)) {
        say("tables: {} (CSV, Markdown, LaTeX)\n", (runDir / "tables").string());
    }
    sayReport(runDir / "report.html");
    return codeOfNames(results.tables, run.plan.experiments,
                       failing > 0 ? kExitClaimFailed : kExitOk);
}

int table(const std::string& runDir, const std::string& out) {
    const run::StoredRun run = run::readRun(runDir);
    const outcome::Results results = outcome::writeResults(
        runDir, run, {.tables = true, .claims = false, .report = false, .out = out});
    const std::string folder = (fs::path(out) / "tables").string();
    for (std::size_t i = 0; i < results.tables.size(); ++i) {
        const config::Experiment& experiment = run.plan.experiments[i];
        if (isEmpty(results.tables[i])) {
            say("{}: no table, for no case has a result\n", experiment.id);
        } else {
            say("{}: {}/{}.csv .md .tex\n", experiment.id, folder, experiment.slug());
        }
    }
    sayPrintedCells(results.printedCells);
    sayNotes(run.manifest);
    return codeOfNames(results.tables, run.plan.experiments, completenessCode(run));
}

int claims(const std::string& runDir, const std::vector<std::string>& configs,
           const std::string& out) {
    if (!configs.empty()) return judgeAfterwards(runDir, configs, out.empty() ? runDir : out);
    const run::StoredRun run = run::readRun(runDir);
    const outcome::Results results = outcome::writeResults(
        runDir, run, {.tables = false, .claims = true, .report = false, .out = out});
    const int verdict = sayClaims(results.claims);
    sayPrintedCells(results.printedCells);
    sayNotes(run.manifest);
    const int code = completenessCode(run);
    return codeOfNames(results.tables, run.plan.experiments, code == kExitOk ? verdict : code);
}

int report(const std::vector<std::string>& runDirs, const std::string& out, bool embeds) {
    if (runDirs.size() == 1 && out.empty()) {
        run::StoredRun run = run::readRun(runDirs.front());
        run::noteChangedImages(run.manifest, runDirs.front());
        const outcome::Results results = outcome::writeResults(
            runDirs.front(), run,
            {.tables = false, .claims = false, .embeds = embeds, .progress = sayPictures});
        sayNotes(run.manifest);
        (embeds ? saySentReport : sayReport)(fs::path(runDirs.front()) / "report.html");
        return codeOfNames(results.tables, run.plan.experiments, completenessCode(run));
    }
    std::vector<report::ReportRun> runs;
    int code = kExitOk;
    for (const std::string& dir : runDirs) {
        if (!fs::exists(fs::path(dir) / "plan.json")) {  // kept results
            runs.push_back(outcome::keptRun(dir));
            continue;
        }
        run::StoredRun run = run::readRun(dir);
        run::noteChangedImages(run.manifest, dir);
        const outcome::Results results = outcome::resultsOf(run);
        runs.push_back(outcome::reportRun(dir, run, results));
        if (code == kExitOk) code = completenessCode(run);
        code = codeOfNames(results.tables, run.plan.experiments, code);
    }
    noteOtherMachines(runs);
    for (const report::ReportRun& run : runs) sayNotes(run.manifest);
    const fs::path file = out.empty() ? fs::path("report.html") : fs::path(out);
    requireNoOtherRun(fs::absolute(file).parent_path(), runs);
    const fs::path made = file.parent_path() / (file.stem().string() + "-files");
    std::set<std::string> lines;
    for (const report::ReportRun& run : runs) {
        lines.insert(outcome::madeFromLine(run.folder, run.manifest));
    }
    const std::string from = joined(std::vector<std::string>(lines.begin(), lines.end()), "");
    if (!out.empty()) {
        if (!embeds) outcome::requireMadeFrom(made, from);
        requireReport(file);
    }
    if (runs.size() == 1) {
        const fs::path drawn = embeds ? fs::path() : report::madeFolder(runs[0].folder, 0, file);
        runs[0].curves = report::drawCurves(drawn, runs[0].tables, runs[0].experiments);
    }
    report::writeReport(file, runs, outcome::reportOptions(embeds, sayPictures));
    if (!embeds && fs::exists(made)) outcome::noteMadeFrom(made, from);
    (embeds ? saySentReport : sayReport)(file);
    return code;
}

}  // namespace gfxrepro::cli
