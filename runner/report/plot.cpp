#include "runner/report/plot.h"

#include <fmt/format.h>
#include <optional>

#include "engine/core/files.h"
#include "runner/config/experiment.h"
#include "runner/report/figure_svg.h"
#include "runner/report/svg.h"
#include "runner/tables/default_layout.h"
#include "runner/tables/figure.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

/// `file` is where it goes as one; empty: nowhere.
Curve drawCurve(const tables::Table& table, const config::PlotSpec& plot,
                std::optional<double> slope, const fs::path& file) {
    Curve curve{table.id, plot.title.empty() ? table.title : plot.title, "", ""};
    const std::string absent = tables::whatIsAbsent(plot, table);
    tables::Figure figure = absent.empty() ? tables::makeFigure(plot, table) : tables::Figure();
    if (figure.panels.empty()) {
        curve.problem =
            absent.empty() ? "no value was measured" : "not among what was measured: " + absent;
        if (!file.empty()) fs::remove(file);  // of a run before this one
        return curve;
    }
    if (slope) tables::addReference(figure, *slope);
    curve.svg = figureSvg(figure, curve.title, kWidePx);
    if (!file.empty()) writeFileAtomic(file, curve.svg);
    curve.svg += figureSvg(figure, curve.title, kNarrowPx);
    return curve;
}

}  // namespace

std::vector<Curve> drawCurves(const fs::path& folder, const std::vector<tables::Table>& tables,
                              const std::vector<config::Experiment>& experiments) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    std::vector<Curve> curves;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        const bool areOwn = !experiments[i].hasDefaultLayout();
        const std::vector<config::PlotSpec> plots =
            areOwn ? experiments[i].plots : tables::defaultPlots(tables[i]);
        for (std::size_t n = 0; n < plots.size(); ++n) {
            const std::string suffix = n == 0 ? "" : fmt::format("-{}", n + 1);
            const fs::path file = "plots/" + tables[i].slug + suffix + ".svg";
            const auto slope =
                areOwn ? config::referenceSlope(experiments[i], n) : std::optional<double>();
            curves.push_back(
                drawCurve(tables[i], plots[n], slope, folder.empty() ? fs::path() : folder / file));
        }
    }
    return curves;
}

}  // namespace gfxrepro::report
