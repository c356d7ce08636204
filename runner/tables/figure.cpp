#include "runner/tables/figure.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/core/text.h"
#include "runner/records/csv.h"
#include "runner/tables/case_records.h"
#include "runner/tables/labels.h"

namespace gfxrepro::tables {

// What a table and a plot come to.

namespace {

/// What all names begin with, up to a blank: "intensity mean ".
std::string sharedHead(const std::vector<std::string>& names) {
    std::string head = names[0].substr(0, names[0].rfind(' ') + 1);
    while (!head.empty()) {
        const bool isShared = std::all_of(names.begin(), names.end(), [&](const auto& name) {
            return name.starts_with(head) && name.size() > head.size() &&
                   !parseDouble(name.substr(head.size()));
        });
        if (isShared) return head;
        head.pop_back();
        head.erase(head.rfind(' ') + 1);
    }
    return head;
}

/// Without what they share: the unit of all stands at the axis, and words that all begin with tell
/// none from another.
std::vector<std::string> columnNames(const std::vector<Quantity>& columns) {
    const auto isAlike = [&](const Quantity& one) { return one.unit == columns[0].unit; };
    const bool haveOneUnit = std::ranges::all_of(columns, isAlike);
    std::vector<std::string> names;
    for (const Quantity& column : columns) {
        names.push_back(haveOneUnit ? column.words : column.text());
    }
    const std::string head = names.size() > 1 ? sharedHead(names) : "";
    for (std::string& name : names) name.erase(0, head.size());
    return names;
}

std::vector<std::string> columnLabels(const Table& table) {
    std::vector<std::string> labels;
    for (const TableColumn& column : table.columns) labels.push_back(column.label);
    return labels;
}

/// Makes the figure of one table row by row.
class FigureMaker {
  public:
    FigureMaker(const config::PlotSpec& plot, const Table& table) : plot_(plot), table_(table) {
        xAxis_ = axisOf(plot.x);
        if (!xAxis_) xColumn_ = columnOf(plot.x);
        for (const std::string& name : plot.y) {
            columns_.push_back(columnOf(name));
            quantityOfColumn_.push_back(quantityOf(table.columns[columns_.back()], table.words));
        }
        if (plot.by) byAxis_ = axisOf(*plot.by);
        nameValues();
    }

    Figure make() {
        figure_.isLogX = plot_.isLogX;
        figure_.isLogY = plot_.isLogY;
        const std::vector<const TableRow*> rows = readRows(table_.rows);
        nameCurves(rows);
        for (const TableRow* row : rows) addRow(*row);
        for (const TableRow* row : readRows(table_.printedRows)) addPrintedRow(*row);
        finish();
        return std::move(figure_);
    }

  private:
    std::optional<std::size_t> axisOf(const std::string& name) const {
        const auto found = std::find(table_.rowAxes.begin(), table_.rowAxes.end(), name);
        if (found == table_.rowAxes.end()) return std::nullopt;
        return static_cast<std::size_t>(found - table_.rowAxes.begin());
    }

    std::size_t columnOf(const std::string& name) const {
        if (const auto found = table_.findColumn(name)) return *found;
        throw Error(plot_.location, fmt::format("plot: unknown column '{}'; allowed: {}", name,
                                                joined(columnLabels(table_))));
    }

    std::vector<const TableRow*> readRows(const std::vector<TableRow>& all) const {
        std::vector<const TableRow*> rows;
        for (const TableRow& row : all) {
            bool isRead = true;
            for (const auto& [name, values] : plot_.at) {
                const auto axis = axisOf(name);
                isRead = isRead && axis &&
                         std::any_of(values.begin(), values.end(), [&](const auto& value) {
                             return canonicalText(value) == row.labels[*axis];
                         });
            }
            if (isRead) rows.push_back(&row);
        }
        return rows;
    }

    void nameValues() {
        for (std::size_t axis = 0; axis < table_.rowAxes.size(); ++axis) {
            std::set<std::string> values;
            for (const auto* rows : {&table_.rows, &table_.printedRows}) {
                for (const TableRow& row : *rows) values.insert(row.labels[axis]);
            }
            shownValues_.push_back(shownNames(values, table_.words));
        }
    }

    /// "bird nest", "reference size 512".
    std::string valueName(std::size_t axis, const std::string& value) const {
        const bool isNumber = parseDouble(value).has_value();
        return isNumber ? shownValue(table_.rowAxes[axis], value, table_.words)
                        : shownValues_[axis].at(value);
    }

    /// The curves are the columns, of each value of `by` in turn.
    void nameCurves(const std::vector<const TableRow*>& rows) {
        const std::vector<std::string> names = columnNames(quantityOfColumn_);
        if (!byAxis_) {
            figure_.curveNames = names;
            return;
        }
        for (const TableRow* row : rows) {
            const std::string& value = row->labels[*byAxis_];
            const auto [place, isNew] = firstCurve_.try_emplace(value, figure_.curveNames.size());
            if (!isNew) continue;
            for (const std::string& name : names) {
                const std::string group = valueName(*byAxis_, value);
                figure_.curveNames.push_back(
                    names.size() == 1 ? group : fmt::format("{}, {}", group, name));
            }
        }
    }

    std::string panelTitle(const TableRow& row) const {
        std::vector<std::string> parts;
        for (const std::string& axis : plot_.panels) {
            if (const auto at = axisOf(axis)) parts.push_back(valueName(*at, row.labels[*at]));
        }
        return joined(parts);
    }

    /// The place of the panel of that title; one past the last if there is none.
    std::size_t findPanel(const std::string& title) const {
        const auto found = std::find_if(figure_.panels.begin(), figure_.panels.end(),
                                        [&](const auto& panel) { return panel.title == title; });
        return static_cast<std::size_t>(found - figure_.panels.begin());
    }

    std::size_t panelOf(const TableRow& row) {
        const std::string title = panelTitle(row);
        const std::size_t place = findPanel(title);
        if (place < figure_.panels.size()) return place;
        FigurePanel panel;
        panel.title = title;
        for (const std::string& name : figure_.curveNames) panel.curves.push_back({name, {}, {}});
        figure_.panels.push_back(std::move(panel));
        quantities_.emplace_back();
        return place;
    }

    /// The x of a row as measured; of a cell that is not ok, none.
    std::optional<double> abscissa(const TableRow& row) const {
        if (xAxis_) return parseDouble(row.labels[*xAxis_]);
        const Cell& cell = row.cells[xColumn_];
        return cell.isOk() ? std::optional(cell.values[0].value) : std::nullopt;
    }

    /// The x that the paper printed in this row, else ours.
    std::optional<double> printedAbscissa(const TableRow& row) const {
        if (!xAxis_ && !row.cells[xColumn_].printedValues.empty()) {
            if (const auto x = row.cells[xColumn_].printedValues[0]) return x;
        }
        return abscissa(row);
    }

    bool isDrawable(double x, double y) {
        if (!std::isfinite(x) || !std::isfinite(y)) {
            ++notFinite_;
            return false;
        }
        if ((plot_.isLogX && x <= 0.0) || (plot_.isLogY && y <= 0.0)) {
            ++notPositive_;
            return false;
        }
        return true;
    }

    void addRow(const TableRow& row) {
        const std::size_t panel = panelOf(row);
        const std::size_t first = byAxis_ ? firstCurve_.at(row.labels[*byAxis_]) : 0;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const Cell& cell = row.cells[columns_[i]];
            FigureCurve& curve = figure_.panels[panel].curves[first + i];
            addMeasured(row, cell, curve);
            addPrinted(row, cell, curve);
            if (cell.isPlanned) quantities_[panel].insert({cell.metric, cell.unit});
        }
    }

    /// What was printed beyond this run is drawn beside what was measured, not apart from it.
    void addPrintedRow(const TableRow& row) {
        const std::size_t panel = findPanel(panelTitle(row));
        const auto first = byAxis_ ? firstCurve_.find(row.labels[*byAxis_]) : firstCurve_.end();
        if (panel == figure_.panels.size() || (byAxis_ && first == firstCurve_.end())) return;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const std::size_t curve = (byAxis_ ? first->second : 0) + i;
            addPrinted(row, row.cells[columns_[i]], figure_.panels[panel].curves[curve]);
        }
    }

    void addMeasured(const TableRow& row, const Cell& cell, FigureCurve& curve) {
        if (!cell.isPlanned) return;
        ++planned_;
        const std::optional<double> x = abscissa(row);
        FigurePoint point;
        if (x) point.x = *x;
        if (!cell.isOk()) {
            point.remark = records::statusName(cell.status);
            ++notOk_[point.remark];
        } else if (!x) {
            ++withoutX_;
        } else if (isDrawable(*x, cell.values[0].value)) {
            point.y = cell.values[0].value;
            point.interval = cell.values[0].interval;
            point.bounds = cell.bounds();
            if (!xAxis_) {
                point.xInterval = row.cells[xColumn_].values[0].interval;
                point.xBounds = row.cells[xColumn_].bounds();
            }
        } else {
            point.remark = "cannot be drawn";
        }
        if (x && std::isfinite(*x) && !(plot_.isLogX && *x <= 0.0)) curve.points.push_back(point);
    }

    void addPrinted(const TableRow& row, const Cell& cell, FigureCurve& curve) {
        if (cell.printedValues.empty() || !cell.printedValues[0]) return;
        const std::optional<double> x = printedAbscissa(row);
        if (!x || !isDrawable(*x, *cell.printedValues[0])) return;
        FigurePoint point;
        point.x = *x;
        point.y = cell.printedValues[0];
        curve.printed.push_back(point);
    }

    /// What a panel's y axis stands for: the metric if there is one for all, else a unit.
    std::string yLabel(const std::set<std::pair<std::string, std::string>>& quantities) const {
        if (plot_.y.size() == 1) {
            const TableColumn& column = table_.columns[columns_[0]];
            if (column.parts.size() > 1) return quantityOfColumn_[0].text();
            const std::string unit = quantities.size() == 1 ? quantities.begin()->second : "";
            return quantityOf(column.label, table_.words, unit).text();
        }
        if (quantities.size() == 1 && !quantities.begin()->first.empty()) {
            const auto& [metric, unit] = *quantities.begin();
            return quantityOf(metric, table_.words, unit).text();
        }
        std::set<std::string> units;
        for (const std::string& column : plot_.y) units.insert(quantityOf(column).unit);
        return units.size() > 1 ? "" : unitLabel(*units.begin());
    }

    void finish() {
        const std::string xUnit = xAxis_ ? "" : table_.columns[xColumn_].unit;
        figure_.xLabel = quantityOf(plot_.x, table_.words, xUnit).text();
        const auto byX = [](const FigurePoint& a, const FigurePoint& b) { return a.x < b.x; };
        for (std::size_t i = 0; i < figure_.panels.size(); ++i) {
            FigurePanel& panel = figure_.panels[i];
            panel.yLabel = yLabel(quantities_[i]);
            for (FigureCurve& curve : panel.curves) {
                std::stable_sort(curve.points.begin(), curve.points.end(), byX);
                std::stable_sort(curve.printed.begin(), curve.printed.end(), byX);
            }
        }
        std::erase_if(figure_.panels, [](const FigurePanel& panel) { return !panel.hasPoints(); });
        addNotes();
    }

    void addNotes() {
        int count = 0;
        std::vector<std::string> parts;
        for (const auto& [status, times] : notOk_) {
            count += times;
            parts.push_back(fmt::format("{} {}", times, status));
        }
        if (count > 0) {
            figure_.notes.push_back(
                fmt::format("left out: {} of {} values ({})", count, planned_, joined(parts)));
        }
        if (notPositive_ > 0) {
            figure_.notes.push_back(
                fmt::format("left out: {} {} not positive on a logarithmic axis", notPositive_,
                            notPositive_ == 1 ? "value" : "values"));
        }
        if (withoutX_ > 0) {
            figure_.notes.push_back(fmt::format("left out: {} without {}", withoutX_,
                                                quantityOf(plot_.x, table_.words).words));
        }
        if (notFinite_ > 0) {
            figure_.notes.push_back(fmt::format("left out: {} not finite", notFinite_));
        }
    }

    const config::PlotSpec& plot_;
    const Table& table_;
    std::optional<std::size_t> xAxis_;
    std::size_t xColumn_ = 0;  // where x is no row axis
    std::vector<std::size_t> columns_;
    std::vector<Quantity> quantityOfColumn_;                       // beside `columns_`
    std::vector<std::map<std::string, std::string>> shownValues_;  // beside Table::rowAxes
    std::optional<std::size_t> byAxis_;
    std::map<std::string, std::size_t> firstCurve_;  // by value of `by`
    /// Beside the panels: the metrics and units of their cells.
    std::vector<std::set<std::pair<std::string, std::string>>> quantities_;
    std::map<std::string, int> notOk_;
    int planned_ = 0;
    int notPositive_ = 0;
    int notFinite_ = 0;
    int withoutX_ = 0;
    Figure figure_;
};

}  // namespace

bool FigurePanel::hasPoints() const {
    return std::any_of(curves.begin(), curves.end(), [](const FigureCurve& curve) {
        return !curve.printed.empty() ||
               std::any_of(curve.points.begin(), curve.points.end(),
                           [](const FigurePoint& point) { return point.y.has_value(); });
    });
}

std::string whatIsAbsent(const config::PlotSpec& plot, const Table& table) {
    std::vector<std::string> wanted = plot.y;
    if (std::ranges::find(table.rowAxes, plot.x) == table.rowAxes.end()) wanted.push_back(plot.x);
    for (const std::string& name : wanted) {
        if (table.findColumn(name)) continue;
        return fmt::format("'{}' is no column (columns: {})", name, joined(columnLabels(table)));
    }
    return "";
}

Figure makeFigure(const config::PlotSpec& plot, const Table& table) {
    return FigureMaker(plot, table).make();
}

// A line of an expected slope.

namespace {

std::vector<FigurePoint> referenceOf(const std::vector<FigurePoint>& points, double slope) {
    std::vector<FigurePoint> drawn;
    double logX = 0.0, logY = 0.0;
    for (const FigurePoint& point : points) {
        if (!point.y) continue;
        drawn.push_back(point);
        logX += std::log(point.x);
        logY += std::log(*point.y);
    }
    if (drawn.size() < 2) return {};
    logX /= static_cast<double>(drawn.size());
    logY /= static_cast<double>(drawn.size());
    std::vector<FigurePoint> ends(2);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        ends[i].x = (i == 0 ? drawn.front() : drawn.back()).x;
        ends[i].y = std::exp(logY + slope * (std::log(ends[i].x) - logX));
    }
    return ends;
}

}  // namespace

void addReference(Figure& figure, double slope) {
    for (FigurePanel& panel : figure.panels) {
        for (FigureCurve& curve : panel.curves) {
            curve.reference = referenceOf(curve.points, slope);
            if (!curve.reference.empty()) figure.slope = slope;
        }
    }
}

Figure overlaid(const std::vector<Figure>& figures, const std::vector<std::string>& letters) {
    if (figures.size() == 1) return figures.front();
    std::vector<std::string> names;
    for (const Figure& figure : figures) {
        for (const std::string& name : figure.curveNames) {
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        }
    }
    Figure all = figures.front();
    all.runCount = figures.size();
    all.curveNames.clear();
    all.panels.clear();
    std::set<std::string> withPrinted;  // panel and curve
    for (std::size_t run = 0; run < figures.size(); ++run) {
        const Figure& figure = figures[run];
        for (const std::string& name : names) all.curveNames.push_back(letters[run] + ": " + name);
        for (const FigurePanel& panel : figure.panels) {
            const auto isSame = [&](const FigurePanel& other) {
                return other.title == panel.title && other.yLabel == panel.yLabel;
            };
            auto place = std::ranges::find_if(all.panels, isSame);
            if (place == all.panels.end()) {
                place = all.panels.insert(place, {panel.title, panel.yLabel, {}, panel.marks});
                place->curves.resize(names.size() * figures.size());
            }
            for (std::size_t i = 0; i < panel.curves.size(); ++i) {
                const auto name = std::ranges::find(names, figure.curveNames[i]) - names.begin();
                FigureCurve& curve =
                    place->curves[run * names.size() + static_cast<std::size_t>(name)];
                curve = panel.curves[i];
                curve.name = letters[run] + ": " + figure.curveNames[i];
                const std::string key =
                    panel.title + '\n' + panel.yLabel + '\n' + panel.curves[i].name;
                if (!curve.printed.empty() && !withPrinted.insert(key).second)
                    curve.printed.clear();
            }
        }
        if (run == 0) continue;
        for (const std::string& note : figure.notes)
            all.notes.push_back(letters[run] + ": " + note);
    }
    return all;
}

std::string slopeName(double slope) {
    return fmt::format("slope {}{}", slope < 0.0 ? "−" : "",
                       records::shortestText(std::abs(slope)));
}

}  // namespace gfxrepro::tables
