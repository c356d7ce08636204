#include "runner/report/plot.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include "runner/config/reference_slope.h"
#include "runner/core/files.h"
#include "runner/report/gnuplot.h"
#include "runner/tables/default_layout.h"
#include "runner/tables/figure.h"
#include "runner/tables/reference_line.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

/// A name for ids: letters, digits and _.
std::string idOf(const std::string& stem) {
    std::string id = "plot_" + stem;
    std::replace_if(
        id.begin(), id.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
    return id;
}

/// All plots of a report wait for gnuplots that sleep no longer than for one.
Drawn runPatiently(const fs::path& script, std::chrono::milliseconds& patience) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    Drawn drawn = runGnuplot(script, kGnuplotLimit + patience);
    const auto taken = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin);
    const auto beyond = std::max<std::chrono::milliseconds>(taken - kGnuplotLimit, {});
    patience -= std::min(patience, beyond);
    return drawn;
}

PlotFile writePlot(const fs::path& runDir, const tables::Table& table, const config::PlotSpec& plot,
                   std::optional<double> slope, const std::string& stem,
                   std::chrono::milliseconds& patience) {
    PlotFile file;
    file.table = table.id;
    file.title = plot.title.empty() ? table.title : plot.title;
    const std::string svg = fmt::format("plots/{}.svg", stem);
    const std::string absent = tables::whatIsAbsent(plot, table);
    tables::Figure figure = absent.empty() ? tables::makeFigure(plot, table) : tables::Figure();
    if (slope) tables::addReference(figure, *slope);
    file.notes = figure.notes;
    if (figure.panels.empty()) {
        file.problem =
            absent.empty() ? "no value was measured" : "not among what was measured: " + absent;
        fs::remove(runDir / svg);  // of a run before this one
        return file;
    }
    file.script = fmt::format("plots/{}.gp", stem);
    const std::string source = fmt::format("{}: {}", table.label, file.title);
    writeFileAtomic(runDir / file.script, gnuplotScript(figure, idOf(stem), source));
    const Drawn drawn = runPatiently(runDir / file.script, patience);
    file.problem = drawn.problem;
    if (drawn.problem.empty()) {
        file.svg = svg;
        writeFileAtomic(runDir / svg, adaptedSvg(drawn.svg, idOf(stem)));
    } else {
        fs::remove(runDir / svg);
    }
    return file;
}

}  // namespace

std::vector<PlotFile> writePlots(const fs::path& runDir, const std::vector<tables::Table>& tables,
                                 const std::vector<config::Experiment>& experiments,
                                 std::chrono::milliseconds& patience) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    std::vector<PlotFile> files;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        const bool areOwn = !experiments[i].hasDefaultLayout();
        const std::vector<config::PlotSpec> plots =
            areOwn ? experiments[i].plots : tables::defaultPlots(tables[i]);
        for (std::size_t n = 0; n < plots.size(); ++n) {
            const std::string suffix = n == 0 ? "" : fmt::format("-{}", n + 1);
            const auto slope =
                areOwn ? config::referenceSlope(experiments[i], n) : std::optional<double>();
            files.push_back(
                writePlot(runDir, tables[i], plots[n], slope, tables[i].slug + suffix, patience));
        }
    }
    return files;
}

}  // namespace gfxrepro::report
