#include <fmt/format.h>
#include <algorithm>
#include <array>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

constexpr std::array<std::string_view, 2> kPlotAxes = {"x", "y"};

/// The first value of an axis that is no number, if its values are known.
const Node* firstText(const std::string& axis, const TableNames& names) {
    const auto known = names.rowValues.find(axis);
    if (known == names.rowValues.end()) return nullptr;
    for (const Node& value : known->second) {
        if (!value.isScalar() || !parseDouble(value.text())) return &value;
    }
    return nullptr;
}

/// Reads one plot. `what_` begins the messages: "plot 1".
class PlotReader {
  public:
    PlotReader(std::size_t number, const Node& node, const TableNames& names)
        : node_(node), names_(names), what_(fmt::format("plot {}", number)) {}

    PlotSpec read() {
        plot_.location = node_.location();
        readKeys(keys(), node_, what_, *this);
        requirePlaces();
        return std::move(plot_);
    }

    static const std::vector<ReadKey<PlotReader>>& keys() {
        using namespace types;
        using R = PlotReader;
        using Text = const std::string&;
        static const std::vector<ReadKey<R>> all = {
            {{"x", "row axis | column", "required", "a row axis has to be of numbers", text()},
             [](R& r, const Node& node, Text what) { r.readX(node, what); }},
            {{"y", "column | [columns]", "required", "a curve each; the first statistic of a cell",
              oneOrMore(text())},
             [](R& r, const Node& node, Text what) { r.readY(node, what); }},
            {{"by", "row axis", "none", "of each y a curve a value", text()},
             [](R& r, const Node& node, Text what) { r.plot_.by = r.readAxis(node, what); }},
            {{"panels", "row axis | [axes]", "none", "a panel for each combination of values",
              oneOrMore(text())},
             [](R& r, const Node& node, Text what) {
                 for (const Node& axis : listed(node)) {
                     r.plot_.panels.push_back(r.readAxis(axis, what));
                 }
             }},
            {{"at", "{row axis: value | [values]}", "all rows", "rows that are read", pairs()},
             [](R& r, const Node& node, Text what) {
                 r.plot_.at = readRowFilter(node, what, r.names_);
             }},
            {{"log", "x | y | [x, y]", "[]", "axes that are logarithmic",
              anyOf({choice(kPlotAxes), setOf(choice(kPlotAxes))})},
             [](R& r, const Node& node, Text what) { r.readLog(node, what); }},
            {{"slope", "number", "none",
              "exponent of x that is expected: a dashed line through the mean of each curve's "
              "points, on two logarithmic axes",
              number()},
             [](R& r, const Node& node, Text what) {
                 r.plot_.slope = numberIn(node, {}, what);
                 if (r.plot_.isLogX && r.plot_.isLogY) return;
                 throw Error(node.location(), what +
                                                  " is a straight line on logarithmic axes alone; "
                                                  "allowed: with log: [x, y]");
             }},
            {{"title", "line", "the file's", "above the curves", text()},
             [](R& r, const Node& node, Text what) { r.plot_.title = lineOf(node, what); }}};
        return all;
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
    return sectionOf("plot", "plot.", PlotReader::keys());
}

}  // namespace gfxrepro::config
