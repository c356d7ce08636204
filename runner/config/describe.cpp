// The schema in words.
#include <algorithm>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/config/params.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

struct Line {
    std::string key, type, fallback, meaning;
};

std::vector<Line> declaredLines(const std::string& section, const Params& params) {
    std::vector<Line> lines;
    for (const ParamInfo& info : params.declared()) {
        std::string type = info.range.empty() ? info.type : info.range;
        if (!info.unit.empty()) type += " " + info.unit;
        lines.push_back({section + "." + info.name, type, info.defaultValue, info.doc});
    }
    return lines;
}

void add(std::vector<Line>& lines, std::vector<Line> more) {
    for (Line& line : more) lines.push_back(std::move(line));
}

std::vector<Line> headLines() {
    return {
        {"table", "PAPER/NUMBER", "", "names the experiment; exactly one of these four"},
        {"figure", "PAPER/NUMBER", "", "a figure"},
        {"section", "PAPER/NUMBER", "", "numbers in running text"},
        {"sweep_of", "NAME", "", "an experiment of one's own; its id is sweep/NAME"},
        {"title", "line", "required", "what is shown, in the paper's words"},
        {"extends", "file | [files]", "[]",
         "files laid under this one, later over earlier; in configs/, then beside this file"},
        {"technique", "name", "required", "what measures; without it the file is only `printed`"},
        {"scene", "reference", "none", "a catalogued name, or a file beside this one"},
        {"params", "{name: value}", "{}", "of the technique: `gfxrepro describe TECHNIQUE`"},
        {"sweep", "{axis: values}", "{}", "axes multiply; an axis is a parameter, or one of:"},
        {"sweep.scene", "values", "", "scenes"},
        {"sweep.output.width", "values", "", "likewise sweep.output.height"},
        {"", "", "", "values: [a, b], {range: [first, last, step]}, {log2: [first, last]}"},
        {"sweep.zip", "[{axis: values}]", "", "each block: axes that go together"},
        {"sweep.list", "[[{axis: value}]]", "", "each block: points spelt out; keys may differ"},
        {"sweep.exclude", "[{axis: value}]", "", "drops points that match all pairs"},
        {"sweep.when", "{axis: {other: value}}", "", "the axis varies only there"},
    };
}

std::vector<Line> layoutLines() {
    return {
        {"profiles.quick", "part of a config", "none", "laid over the file by --profile quick"},
        {"profiles.paper", "part of a config", "none", "laid over the file by --profile paper"},
        {"layout.axes", "{axis: {label: selection}}", "{}", "axes of labels, for rows and columns"},
        {"layout.rows", "axis | [axes] | {label: selection}", "one row", "what the rows stand for"},
        {"layout.columns", "axis | [axes] | {label: selection}", "one column",
         "axes: declared above, or swept, a parameter, scene, frame"},
        {"layout.cell", "format | selection", "{median:.4g}", "what every cell shows"},
        {"selection", "metric | map of:", "", "the column's part wins over the row's, then cell"},
        {"selection.metric", "name", "", "of the technique's metrics"},
        {"selection.pass", "name", "whole case", "step of the algorithm"},
        {"selection.format", "text", "", "median mean min max sum count in braces: {mean:.2f}"},
        {"selection.scale", "number", "1", "multiplies every value"},
        {"selection.where", "{axis: value}", "{}", "only these cases"},
    };
}

std::vector<Line> printedLines() {
    return {
        {"printed.hardware", "text", "\"\"", "what the paper measured on"},
        {"printed.remark", "text", "\"\"", "misprints and the like"},
        {"printed.values", "CSV block", "", "a header of row axes and columns, then the rows"},
        {"assumptions.NAME", "{value, range, unit, why}", "",
         "what the paper left open; why is required"},
    };
}

std::vector<Line> claimLines() {
    return {
        {"claims.ID.says", "line", "required", "the claim in the paper's sense"},
        {"claims.ID.at", "{row axis: value | [values]}", "all rows", "rows that are read"},
        {"claims.ID.across", "row axis", "none",
         "a, b are its labels instead of columns; those become the row axis `column`"},
        {"claims.ID.statistic", "name", "the first", "of cells with several"},
        {"claims.ID.device", "any | gpu", "any", "where it must hold"},
        {"claims.ID.profile", "quick | full | paper", "all", "the only profile it is judged in"},
        {"", "", "", "and exactly one of (a, b: expressions over columns):"},
        {"claims.ID.order", "a < b < c", "", ""},
        {"claims.ID.ratio", "a / b", "", "at_least: x, at_most: x, between: [low, high]"},
        {"claims.ID.trend", "a", "",
         "over: axis or column; exponent: [low, high]; direction: increasing | decreasing; "
         "strictly: true"},
        {"claims.ID.independent", "a | [a, b]", "", "of: axis or column; within: 25%"},
        {"claims.ID.bound", "a", "", "above: x, below: x"},
        {"claims.ID.exact", "a", "", "equals: number | printed"},
        {"claims.ID.tolerance", "a", "", "within: 5% (of the printed value)"},
        {"claims.ID.crossover", "[a, b]", "", "over: axis or column; between: [low, high]"},
    };
}

std::vector<Line> plotLines() {
    return {
        {"plots", "[plot]", "[]", "curves of the table's numbers, with their intervals"},
        {"plot.x", "row axis | column", "required", "a row axis has to be of numbers"},
        {"plot.y", "column | [columns]", "required", "a curve each; the first statistic of a cell"},
        {"plot.by", "row axis", "none", "of each y a curve a value"},
        {"plot.panels", "row axis | [axes]", "none", "a panel for each combination of values"},
        {"plot.at", "{row axis: value | [values]}", "all rows", "rows that are read"},
        {"plot.log", "[x, y]", "[]", "axes that are logarithmic"},
        {"plot.title", "line", "the file's", "above the curves"},
    };
}

/// Columns on a screen: `…` is one of them and three bytes.
std::size_t widthOf(const std::string& text) {
    std::size_t width = 0;
    for (const char c : text) width += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return width;
}

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, widthOf(text)) + 2, ' ');
}

}  // namespace

std::string describeConfig() {
    std::vector<Line> lines = headLines();
    Params output(Node(), "output");
    readOutput(output);
    add(lines, declaredLines("output", output));
    Params measure(Node(), "measure");
    readMeasure(measure);
    add(lines, declaredLines("measure", measure));
    add(lines, layoutLines());
    add(lines, printedLines());
    add(lines, claimLines());
    add(lines, plotLines());

    lines.insert(lines.begin(), {"key", "type", "default", "meaning"});
    std::size_t key = 0, type = 0, fallback = 0;
    for (const Line& line : lines) {
        key = std::max(key, widthOf(line.key));
        type = std::max(type, widthOf(line.type));
        fallback = std::max(fallback, widthOf(line.fallback));
    }
    std::string text;
    for (const Line& line : lines) {
        std::string row = padded(line.key, key) + padded(line.type, type) +
                          padded(line.fallback, fallback) + line.meaning;
        row.erase(row.find_last_not_of(' ') + 1);
        text += row + "\n";
    }
    return text;
}

}  // namespace gfxrepro::config
