#include "runner/report/writers.h"

#include <fmt/format.h>
#include <algorithm>
#include <set>

#include "engine/core/text.h"
#include "runner/report/markup.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

namespace {

/// TeX's own names hold letters only; \csname takes the keys as they are. A key that is not there
/// is an error, where \csname alone would make an empty macro of it. Global, because the file is
/// read within a table.
constexpr std::string_view kMacros =
    "\\ifdefined\\gfxrepro\\else\n"
    "\\gdef\\gfxreproset#1#2{\\expandafter\\gdef\\csname gfxrepro/#1\\endcsname{#2}}\n"
    "\\gdef\\gfxrepro#1{\\ifcsname gfxrepro/#1\\endcsname"
    "\\csname gfxrepro/#1\\endcsname\\else\\errmessage{gfxrepro: no number #1}\\fi}\n"
    "\\fi\n";

/// Of calibrated cells, as TeX sets it.
constexpr const char* kMark = "\\textsuperscript{\\ddag}";
/// Of times that are not of one clock.
constexpr const char* kClockMark = "\\textsuperscript{\\S}";

std::string inOneLine(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
}

/// `key`, or `key-2`, … where it is taken.
std::string unique(const std::string& key, std::set<std::string>& taken) {
    std::string candidate = key;
    for (int n = 2; !taken.insert(candidate).second; ++n) candidate = fmt::format("{}-{}", key, n);
    return candidate;
}

/// The labels of the rows; scenes of one's own as their files, wherever these lie.
std::vector<std::vector<std::string>> labelsOf(const tables::Table& table) {
    std::vector<std::vector<std::string>> rows;
    for (const tables::TableRow& row : table.rows) rows.push_back(row.labels);
    const auto shown = tables::shownLabels(rows, table.words);
    for (std::vector<std::string>& labels : rows) {
        for (std::size_t i = 0; i < labels.size(); ++i) {
            if (labels[i].starts_with('/')) labels[i] = shown[i].at(labels[i]);
        }
    }
    return rows;
}

std::string cite(const std::string& key) {
    return fmt::format("\\gfxrepro{{{}}}", key);
}

class LatexWriter {
  public:
    LatexWriter(const tables::Table& table, const std::vector<std::string>& runNotes)
        : table_(table), runNotes_(runNotes), rowLabels_(labelsOf(table)) {
        std::set<std::string> rows, columns;
        for (const std::vector<std::string>& labels : rowLabels_) {
            std::vector<std::string> parts;
            for (const std::string& label : labels) parts.push_back(latexKeyPart(label));
            rowKeys_.push_back(unique(joined(parts, "/"), rows));
        }
        for (const tables::TableColumn& column : table.columns) {
            columnKeys_.push_back(unique(latexKeyPart(column.label), columns));
        }
    }

    std::string write() {
        writeHead();
        if (!parameters_.empty()) set(table_.id, parameters_);
        for (std::size_t row = 0; row < table_.rows.size(); ++row) {
            for (std::size_t i = 0; i < table_.columns.size(); ++i) {
                writeNumbers(table_.rows[row].cells[i], key(row, i));
            }
        }
        writeColumns();
        for (std::size_t row = 0; row < table_.rows.size(); ++row) writeRow(row);
        text_ += "\\bottomrule\n\\end{tabular}\n";
        writeParameters();
        if (table_.hasCalibrated()) {
            text_ += fmt::format("\\par{{\\footnotesize {} {}.\\par}}\n", kMark,
                                 tables::kCalibratedLegend);
        }
        if (const auto clock = tables::movedClock(table_)) {
            text_ += fmt::format("\\par{{\\footnotesize {} {}.\\par}}\n", kClockMark,
                                 escapeLatex(tables::movedClockLegend(*clock)));
        }
        for (const std::string& note : runNotes_) {
            text_ += fmt::format("\\par{{\\footnotesize Note: {}.\\par}}\n", escapeLatex(note));
        }
        return std::move(text_);
    }

  private:
    std::string key(std::size_t row, std::size_t column) const {
        std::vector<std::string> parts = {table_.id};
        if (!rowKeys_[row].empty()) parts.push_back(rowKeys_[row]);
        parts.push_back(columnKeys_[column]);
        return joined(parts, "/");
    }

    void writeHead() {
        const bool hasCells = !table_.rows.empty() && !table_.columns.empty();
        const std::string example = hasCells ? key(0, 0) : table_.id;
        text_ += fmt::format(
            "% {}\n"
            "% Made by gfxrepro. Needs \\usepackage{{booktabs}}; \\input of this file sets the "
            "table.\n"
            "% Each number is a macro, for the text below the \\input; keys are "
            "table/row/column:\n",
            inOneLine(fmt::format("{}. {}", table_.label, table_.title)));
        if (!table_.isOnlyPrinted) {
            text_ += fmt::format(
                "%   {}  as measured\n"
                "%   likewise {}/low and /high, the ends of its bounds,\n"
                "%   and /bounds, what they are: 95 % interval (of times that of this "
                "sitting), or the range of too few processes;\n"
                "%   and, of several statistics in a cell, each below the cell's key\n",
                cite(example), example);
        }
        text_ += fmt::format("%   {}  as printed\n", cite(example + "/printed"));
        if (!parameters_.empty()) {
            text_ += fmt::format("%   {}  at which parameters it was measured\n", cite(table_.id));
        }
        text_ += kMacros;
    }

    void set(const std::string& key, const std::string& value) {
        text_ += fmt::format("\\gfxreproset{{{}}}{{{}}}\n", key, escapeLatex(value));
    }

    void writeNumbers(const tables::Cell& cell, const std::string& key) {
        if (cell.printed) set(key + "/printed", *cell.printed);
        if (!cell.isPlanned) return;
        set(key, cell.measured);
        if (cell.isCalibrated) set(key + "/calibrated", "yes");
        if (cell.movedClock) set(key + "/clock", tables::clockText(*cell.movedClock));
        if (!cell.low.empty()) {
            set(key + "/low", cell.low);
            set(key + "/high", cell.high);
            set(key + "/bounds", std::string(tables::boundsName(cell.bounds())));
        }
        if (cell.values.size() < 2) return;
        for (const tables::Measured& measured : cell.values) {
            set(fmt::format("{}/{}", key, measured.statistic), measured.text);
            if (measured.low.empty()) continue;
            set(fmt::format("{}/{}/low", key, measured.statistic), measured.low);
            set(fmt::format("{}/{}/high", key, measured.statistic), measured.high);
        }
    }

    /// Printed and measured stand in columns of their own, so that numbers align.
    void writeColumns() {
        const std::size_t labels = table_.rowAxes.size() + (table_.hasSources() ? 1 : 0);
        const std::size_t width = table_.isOnlyPrinted ? 1 : 2;
        text_ += fmt::format("\\begin{{tabular}}{{{}{}}}\n\\toprule\n", std::string(labels, 'l'),
                             std::string(width * table_.columns.size(), 'r'));
        std::vector<std::string> head, subhead;
        for (const std::string& axis : table_.rowAxes) head.push_back(escapeLatex(axis));
        if (table_.hasSources()) head.emplace_back("source");
        subhead.resize(head.size());
        for (const tables::TableColumn& column : table_.columns) {
            const std::string label = escapeLatex(column.label);
            head.push_back(
                table_.isOnlyPrinted ? label : fmt::format("\\multicolumn{{2}}{{c}}{{{}}}", label));
            subhead.insert(subhead.end(), {"printed", "measured"});
        }
        text_ += joined(head, " & ") + " \\\\\n";
        if (!table_.isOnlyPrinted) text_ += joined(subhead, " & ") + " \\\\\n";
        text_ += "\\midrule\n";
    }

    void writeRow(std::size_t index) {
        const tables::TableRow& row = table_.rows[index];
        std::vector<std::string> cells;
        // Braces: after \\ a bracket or star would be its argument.
        for (const std::string& label : rowLabels_[index]) {
            cells.push_back(fmt::format("{{{}}}", escapeLatex(label)));
        }
        if (table_.hasSources()) cells.emplace_back(tables::sceneSourceName(row.source));
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            const tables::Cell& cell = row.cells[i];
            cells.push_back(cell.printed ? cite(key(index, i) + "/printed") : "");
            if (!table_.isOnlyPrinted) cells.push_back(measuredCell(cell, key(index, i)));
        }
        text_ += joined(cells, " & ") + " \\\\\n";
    }

    static std::string measuredCell(const tables::Cell& cell, const std::string& key) {
        if (!cell.isPlanned) return "";
        const std::string number =
            cite(key) + (cell.isCalibrated ? kMark : "") + (cell.movedClock ? kClockMark : "");
        if (!cell.hasShownBounds()) return number;
        return fmt::format(fmt::runtime(cell.bounds() == tables::Bounds::Interval
                                            ? "{} {{\\scriptsize[{}, {}]}}"
                                            : "{} {{\\scriptsize({} \\ldots\\ {})}}"),
                           number, cite(key + "/low"), cite(key + "/high"));
    }

    /// Below the table, in its own paragraph.
    void writeParameters() {
        if (parameters_.empty()) return;
        text_ += fmt::format("\\par{{\\footnotesize {}\\par}}\n", cite(table_.id));
    }

    const tables::Table& table_;
    const std::vector<std::string>& runNotes_;
    const std::vector<std::vector<std::string>> rowLabels_;  // beside the rows
    const std::string parameters_ = tables::parametersLine(table_);
    std::vector<std::string> rowKeys_;     // beside the rows
    std::vector<std::string> columnKeys_;  // beside the columns
    std::string text_;
};

}  // namespace

std::string latexKeyPart(const std::string& label) {
    std::string part;
    for (const char c : label) {
        const auto byte = static_cast<unsigned char>(c);
        const bool isKept = byte < 0x80 && (std::isalnum(byte) != 0 || c == '.' || c == '+' ||
                                            c == '-' || c == '_');
        const bool isContinued = (byte & 0xC0) == 0x80;  // of one letter in UTF-8
        if (!isContinued) part += isKept ? c : '-';
    }
    return part.empty() ? "none" : part;
}

std::string tableLatex(const tables::Table& table, const std::vector<std::string>& runNotes) {
    return LatexWriter(table, runNotes).write();
}

}  // namespace gfxrepro::report
