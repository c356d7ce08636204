#include "runner/report/plot.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include "runner/core/files.h"
#include "runner/report/gnuplot.h"
#include "runner/tables/default_layout.h"
#include "runner/tables/figure.h"

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
                   const std::string& stem, std::chrono::milliseconds& patience) {
    PlotFile file;
    file.table = table.id;
    file.title = plot.title.empty() ? table.title : plot.title;
    const std::string svg = fmt::format("plots/{}.svg", stem);
    const std::string absent = tables::whatIsAbsent(plot, table);
    const tables::Figure figure =
        absent.empty() ? tables::makeFigure(plot, table) : tables::Figure();
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
        const std::vector<config::PlotSpec> plots = experiments[i].hasDefaultLayout()
                                                        ? tables::defaultPlots(tables[i])
                                                        : experiments[i].plots;
        for (std::size_t n = 0; n < plots.size(); ++n) {
            const std::string suffix = n == 0 ? "" : fmt::format("-{}", n + 1);
            files.push_back(
                writePlot(runDir, tables[i], plots[n], tables[i].slug + suffix, patience));
        }
    }
    return files;
}

}  // namespace gfxrepro::report
