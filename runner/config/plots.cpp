#include <fmt/format.h>
#include <algorithm>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

const Names kPlotAxes = {"x", "y"};

/// The first value of an axis that is no number, if its values are known.
const Node* firstText(const std::string& axis, const TableNames& names) {
    const auto known = names.rowValues.find(axis);
    if (known == names.rowValues.end()) return nullptr;
    for (const Node& value : known->second) {
        if (!value.isScalar() || !parseDouble(value.text())) return &value;
    }
    return nullptr;
}

struct PlotKeys {
    GivenKey x, y, by, panels, at, log, slope, title;
};
const KeyTable<PlotKeys>& plotTable() {
    using namespace types;
    using P = PlotKeys;
    static const KeyTable<P> table{
        {"plot", "plot.", "", false},
        {{&P::x, "x", "row axis | column", "required", "a row axis has to be of numbers", text()},
         {&P::y, "y", "column | [columns]", "required",
          "a curve each; the first statistic of a cell", oneOrMore(text())},
         {&P::by, "by", "row axis", "none", "of each y a curve a value", text()},
         {&P::panels, "panels", "row axis | [axes]", "none",
          "a panel for each combination of values", oneOrMore(text())},
         {&P::at, "at", "{row axis: value | [values]}", "all rows", "rows that are read", pairs()},
         {&P::log, "log", "x | y | [x, y]", "[]", "axes that are logarithmic",
          anyOf({choice(kPlotAxes), setOf(choice(kPlotAxes))})},
         {&P::slope,
          numberKey("slope", {}, "none",
                    "exponent of x that is expected: a dashed line through the mean of each "
                    "curve's points, on two logarithmic axes")},
         {&P::title, "title", "line", "the file's", "above the curves", text()}}};
    return table;
}

/// Reads one plot. `what_` begins the messages: "plot 1".
class PlotReader {
  public:
    PlotReader(std::size_t number, const Node& node, const TableNames& names)
        : node_(node), names_(names), what_(fmt::format("plot {}", number)) {}

    PlotSpec read() {
        plot_.location = node_.location();
        const PlotKeys given = plotTable().read(node_, what_);
        readX(*given.x, given.x.in(what_));
        readY(*given.y, given.y.in(what_));
        if (given.by) plot_.by = readAxis(*given.by, given.by.in(what_));
        for (const Node& axis : given.panels ? listed(*given.panels) : Node::Sequence()) {
            plot_.panels.push_back(readAxis(axis, given.panels.in(what_)));
        }
        if (given.at) plot_.at = readRowFilter(*given.at, given.at.in(what_), names_);
        if (given.log) readLog(*given.log, given.log.in(what_));
        if (given.slope) {
            plot_.slope = given.slope.number(what_);
            if (!plot_.isLogX || !plot_.isLogY) {
                throw Error(given.slope->location(),
                            given.slope.in(what_) +
                                " is a straight line on logarithmic axes alone; "
                                "allowed: with log: [x, y]");
            }
        }
        if (given.title) plot_.title = lineOf(*given.title, given.title.in(what_));
        requirePlaces();
        return std::move(plot_);
    }

  private:
    static Node::Sequence listed(const Node& node) {
        return node.isSequence() ? node.items() : Node::Sequence{node};
    }

    bool isColumn(const std::string& name) const {
        return !names_.hasAllColumns || contains(names_.columns, name);
    }

    /// What `x` may be: the row axes of numbers, then the columns.
    Names abscissae() const {
        Names known;
        for (const std::string& axis : names_.rowAxes) {
            if (!firstText(axis, names_)) known.push_back(axis);
        }
        known.insert(known.end(), names_.columns.begin(), names_.columns.end());
        return known;
    }

    void readX(const Node& node, const std::string& what) {
        const std::string& name = lineOf(node, what);
        if (contains(names_.rowAxes, name)) {
            if (const Node* text = firstText(name, names_)) {
                throw Error(
                    node.location(),
                    fmt::format("{}: x is row axis '{}', whose {} is no number; allowed: {}", what_,
                                name, text->toFlowText(), joined(abscissae())));
            }
            use(name, node);
        } else if (!isColumn(name)) {
            throw Error(node.location(),
                        fmt::format("{}: x is '{}', neither a row axis nor a column{}", what_, name,
                                    suggestionOrAll(name, abscissae())));
        }
        plot_.x = name;
    }

    void readY(const Node& node, const std::string& what) {
        for (const Node& item : listed(node)) {
            const std::string& name = lineOf(item, what);
            if (!isColumn(name)) {
                throw Error(item.location(), fmt::format("{}: unknown column '{}'{}", what_, name,
                                                         suggestionOrAll(name, names_.columns)));
            }
            if (contains(plot_.y, name)) {
                throw Error(item.location(),
                            fmt::format("{}: column '{}' stands twice", what_, name));
            }
            plot_.y.push_back(name);
        }
        if (plot_.y.empty()) throwNotAllowed(node, what, "a column, or a list");
    }

    std::string readAxis(const Node& node, const std::string& what) {
        const std::string& name = lineOf(node, what);
        if (!contains(names_.rowAxes, name)) {
            throwNotAllowed(node, what, joined(names_.rowAxes, " | "));
        }
        use(name, node);
        return name;
    }

    void use(const std::string& axis, const Node& node) {
        if (contains(used_, axis)) {
            throw Error(node.location(),
                        fmt::format("{}: row axis '{}' is used twice", what_, axis));
        }
        used_.push_back(axis);
    }

    void readLog(const Node& node, const std::string& what) {
        for (const Node& item : listed(node)) {
            const bool isX = choiceOf(item, kPlotAxes, what) == 0;
            bool& isLog = isX ? plot_.isLogX : plot_.isLogY;
            if (isLog) throw Error(item.location(), what + ": '" + item.text() + "' stands twice");
            isLog = true;
        }
    }

    /// Two rows at one place of a curve would be drawn over each other.
    void requirePlaces() const {
        if (!contains(names_.rowAxes, plot_.x)) return;
        for (const std::string& axis : names_.rowAxes) {
            const auto known = names_.rowValues.find(axis);
            if (known == names_.rowValues.end() || known->second.size() == 1) continue;
            const bool isChosen =
                std::any_of(plot_.at.begin(), plot_.at.end(), [&](const auto& chosen) {
                    return chosen.first == axis && chosen.second.size() == 1;
                });
            if (contains(used_, axis) || isChosen) continue;
            throw Error(node_.location(),
                        fmt::format("{}: row axis '{}' has no place; allowed: in by or panels, or "
                                    "one value in at",
                                    what_, axis));
        }
    }

    const Node& node_;
    const TableNames& names_;
    std::string what_;
    PlotSpec plot_;
    Names used_;
};

}  // namespace

std::vector<PlotSpec> readPlots(const Node& node, const TableNames& names) {
    if (!node.isSequence()) throwNotAllowed(node, "plots", "a list of plots");
    std::vector<PlotSpec> plots;
    for (const Node& plot : node.items()) {
        plots.push_back(PlotReader(plots.size() + 1, plot, names).read());
    }
    return plots;
}

SchemaSection plotKeys() {
    return plotTable().section();
}

}  // namespace gfxrepro::config
