// A table as LaTeX, for papers.
#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "engine/core/text.h"
#include "runner/report/markup.h"
#include "runner/report/writers.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

namespace {

/// TeX's own names hold letters only; \csname takes the keys as they are. A key that is not there
/// is an error, where \csname alone would make an empty macro of it. Global, because the file is
/// read within a table. No line ends in a blank, which would widen a box around the table.
constexpr std::string_view kMacros =
    "\\ifdefined\\gfxrepro\\else\n"
    "\\gdef\\gfxreproset#1#2{\\expandafter\\gdef\\csname gfxrepro/#1\\endcsname{#2}}%\n"
    "\\gdef\\gfxrepro#1{\\ifcsname gfxrepro/#1\\endcsname"
    "\\csname gfxrepro/#1\\endcsname\\else\\errmessage{gfxrepro: no number #1}\\fi}%\n"
    "\\gdef\\gfxreprohead#1#2{\\begin{tabular}[b]{@{}#1@{}}#2\\end{tabular}}%\n"
    "\\fi\n";

/// Of calibrated cells, as TeX sets it.
constexpr const char* kMark = "\\textsuperscript{\\ddag}";
/// Of times that are not of one clock.
constexpr const char* kClockMark = "\\textsuperscript{\\S}";

/// In `\footnotesize` of an article, in points: a letter; and the blank at each side of a column,
/// which is set narrower than usual.
constexpr double kLetterPt = 4.25, kColumnSepPt = 4.0;
/// How wide a table may be on A4.
constexpr double kUprightPt = 485.0, kAcrossPt = 740.0;
/// A letter of a line of bounds, in letters of a number.
constexpr double kBoundsLetter = 0.88;

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

/// The labels of the rows as keys have them; scenes of one's own as their files, wherever these
/// lie.
std::vector<std::vector<std::string>> labelsOf(
    const tables::Table& table, const std::vector<std::map<std::string, std::string>>& shown) {
    std::vector<std::vector<std::string>> rows;
    for (const tables::TableRow& row : table.rows) rows.push_back(row.labels);
    for (std::vector<std::string>& labels : rows) {
        for (std::size_t i = 0; i < labels.size(); ++i) {
            if (labels[i].starts_with('/')) labels[i] = shown[i].at(labels[i]);
        }
    }
    return rows;
}

std::vector<std::map<std::string, std::string>> shownLabelsOf(const tables::Table& table) {
    std::vector<std::vector<std::string>> rows;
    for (const tables::TableRow& row : table.rows) rows.push_back(row.labels);
    return tables::shownLabels(rows, table.words);
}

std::string cite(const std::string& key) {
    return fmt::format("\\gfxrepro{{{}}}", key);
}

/// A head in lines of at most so many letters, or of one word.
std::vector<std::string> linesOf(const std::string& text, std::size_t letters) {
    std::vector<std::string> lines;
    for (const std::string& word : split(text, ' ')) {
        const bool fits =
            !lines.empty() && columnsOf(lines.back()) + 1 + columnsOf(word) <= letters;
        if (fits) {
            lines.back() += ' ' + word;
        } else {
            lines.push_back(word);
        }
    }
    return lines;
}

std::size_t longestOf(const std::vector<std::string>& lines) {
    std::size_t letters = 0;
    for (const std::string& line : lines) letters = std::max(letters, columnsOf(line));
    return letters;
}

/// A column of the tabular.
struct SetColumn {
    std::string head = {};    // of a quantity
    std::string kind = {};    // "printed" or "measured", where both are there
    std::size_t letters = 0;  // of the widest below
    bool isLabel = false;
    bool isFirstOfTwo = false;  // the next one has the same head
};

class LatexWriter {
  public:
    LatexWriter(const tables::Table& table, const std::vector<std::string>& runNotes)
        : table_(table),
          runNotes_(runNotes),
          shown_(shownLabelsOf(table)),
          rowLabels_(labelsOf(table, shown_)) {
        std::set<std::string> rows, columns = {kNotes};
        for (const std::vector<std::string>& labels : rowLabels_) {
            std::vector<std::string> parts;
            for (const std::string& label : labels) parts.push_back(latexKeyPart(label));
            rowKeys_.push_back(unique(joined(parts, "/"), rows));
        }
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            columnKeys_.push_back(unique(latexKeyPart(table.columns[i].label), columns));
            isPrinted_.push_back(std::ranges::any_of(table.rows, [&](const tables::TableRow& row) {
                return row.cells[i].printed.has_value();
            }));
        }
        findColumns();
        notes_ = notes();
    }

    std::string write() {
        writeHead();
        if (!parameters_.empty()) set(table_.id, escapeLatex(parameters_));
        if (!notes_.empty()) set(table_.id + '/' + kNotes, notes_);
        for (std::size_t row = 0; row < table_.rows.size(); ++row) {
            for (std::size_t i = 0; i < table_.columns.size(); ++i) {
                writeNumbers(table_.rows[row].cells[i], key(row, i));
            }
        }
        const std::vector<std::vector<std::size_t>> blocks = blocksOf();
        if (blocks.size() > 1) text_ += "\\begin{tabular}{@{}l@{}}\n";
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            if (i > 0) text_ += "\\\\[8pt]\n";
            writeColumns(blocks[i]);
            for (std::size_t row = 0; row < table_.rows.size(); ++row) writeRow(row, blocks[i]);
            text_ += "\\bottomrule\n\\end{tabular}%\n";
        }
        if (blocks.size() > 1) text_ += "\\end{tabular}%\n";
        return std::move(text_);
    }

  private:
    static constexpr const char* kNotes = "notes";

    std::string key(std::size_t row, std::size_t column) const {
        std::vector<std::string> parts = {table_.id};
        if (!rowKeys_[row].empty()) parts.push_back(rowKeys_[row]);
        parts.push_back(columnKeys_[column]);
        return joined(parts, "/");
    }

    /// What stands below the table, in one paragraph.
    std::string notes() const {
        std::vector<std::string> notes;
        if (!parameters_.empty()) notes.push_back(cite(table_.id));
        if (table_.hasCalibrated()) {
            notes.push_back(fmt::format("{} {}.", kMark, tables::kCalibratedLegend));
        }
        if (const auto clock = tables::movedClock(table_)) {
            notes.push_back(
                fmt::format("{} {}.", kClockMark, escapeLatex(tables::movedClockLegend(*clock))));
        }
        if (const std::string note = tables::seedNote(table_); !note.empty()) {
            notes.push_back(escapeLatex(note));
        }
        for (const std::string& note : tables::cellNotes(table_)) {
            notes.push_back(escapeLatex(note));
        }
        for (const std::string& note : runNotes_) {
            notes.push_back(fmt::format("Note: {}.", escapeLatex(note)));
        }
        return joined(notes, " ");
    }

    /// Labels first; printed and measured stand in columns of their own, so that numbers align.
    void findColumns() {
        for (std::size_t i = 0; i < table_.rowAxes.size(); ++i) {
            SetColumn column{.head = tables::shownName(table_.rowAxes[i], table_.words),
                             .isLabel = true};
            for (const tables::TableRow& row : table_.rows) {
                column.letters = std::max(column.letters, columnsOf(shown_[i].at(row.labels[i])));
            }
            columns_.push_back(std::move(column));
        }
        if (table_.hasSources()) {
            SetColumn column{.head = "source", .isLabel = true};
            for (const tables::TableRow& row : table_.rows) {
                column.letters =
                    std::max(column.letters, columnsOf(tables::sceneSourceName(row.source)));
            }
            columns_.push_back(std::move(column));
        }
        for (std::size_t i = 0; i < table_.columns.size(); ++i) {
            SetColumn printed{tables::quantityOf(table_.columns[i], table_.words).text(),
                              "printed"};
            SetColumn measured{printed.head, "measured"};
            for (const tables::TableRow& row : table_.rows) {
                const tables::Cell& cell = row.cells[i];
                printed.letters = std::max(printed.letters, columnsOf(cell.printed.value_or("")));
                if (!cell.isPlanned) continue;
                measured.letters =
                    std::max({measured.letters, columnsOf(cell.measured), lettersOfBounds(cell)});
            }
            printed.isFirstOfTwo = isPrinted_[i] && !table_.isOnlyPrinted;
            if (printed.isFirstOfTwo) {
                printed.letters = std::max(printed.letters, columnsOf(printed.kind));
                measured.letters = std::max(measured.letters, columnsOf(measured.kind));
            } else {
                printed.kind.clear();
                measured.kind.clear();
            }
            if (isPrinted_[i] || table_.isOnlyPrinted) columns_.push_back(std::move(printed));
            if (!table_.isOnlyPrinted) columns_.push_back(std::move(measured));
        }
    }

    static std::size_t lettersOfBounds(const tables::Cell& cell) {
        if (!cell.hasShownBounds()) return 0;
        const std::size_t letters =
            columnsOf(cell.low) + columnsOf(cell.high) + (cell.hasInterval() ? 4 : 5);
        return static_cast<std::size_t>(kBoundsLetter * static_cast<double>(letters));
    }

    /// Nearly: TeX alone knows.
    static double widthPt(const SetColumn& column) {
        const std::size_t head = column.kind.empty() ? longestOf(headOf(column)) : 0;
        return kLetterPt * static_cast<double>(std::max(head, column.letters)) + 2.0 * kColumnSepPt;
    }
    /// Of the labels, or of what stands behind them.
    double widthPt(bool ofLabels) const {
        double width = 0.0;
        for (const SetColumn& column : columns_) {
            if (column.isLabel == ofLabels) width += widthPt(column);
        }
        return width;
    }
    double widthPt() const { return widthPt(true) + widthPt(false); }
    bool isAcross() const { return widthPt() > kUprightPt && widthPt() <= kAcrossPt; }

    /// What is too wide even across stands in blocks below each other, upright, all with the labels
    /// and of about one width.
    std::vector<std::vector<std::size_t>> blocksOf() const {
        const double labels = widthPt(true), all = widthPt(false);
        const bool isOne = widthPt() <= kAcrossPt || labels >= kUprightPt;
        const double count = isOne ? 1.0 : std::ceil(all / (kUprightPt - labels));
        std::vector<std::size_t> first;
        for (std::size_t i = 0; i < columns_.size() && columns_[i].isLabel; ++i) first.push_back(i);
        std::vector<std::vector<std::size_t>> blocks = {first};
        double before = 0.0;  // of the blocks that are full, and of this one
        for (std::size_t i = first.size(); i < columns_.size(); ++i) {
            const bool isPair = columns_[i].isFirstOfTwo;
            const double width = widthPt(columns_[i]) + (isPair ? widthPt(columns_[i + 1]) : 0.0);
            const double share = all / count * static_cast<double>(blocks.size());
            const bool isEmpty = blocks.back().size() == first.size();
            if (!isOne && !isEmpty && before + width / 2.0 > share) blocks.push_back(first);
            before += width;
            blocks.back().push_back(i);
            if (isPair) blocks.back().push_back(++i);
        }
        return blocks;
    }

    /// As narrow as its numbers, or as its longest word.
    static std::vector<std::string> headOf(const SetColumn& column, std::size_t letters = 0) {
        constexpr std::size_t kFewest = 6;
        return linesOf(column.head, std::max({kFewest, column.letters, letters}));
    }

    void writeHead() {
        const bool hasCells = !table_.rows.empty() && !table_.columns.empty();
        const std::string example = hasCells ? key(0, 0) : table_.id;
        const std::string environment = isAcross() ? "sidewaystable*" : "table*";
        text_ += fmt::format(
            "% {}. Made by gfxrepro.\n"
            "% Needs \\usepackage{{booktabs}}{}; \\input of this file sets the table. To paste:\n"
            "%   \\begin{{{}}}\\centering\\footnotesize\\setlength{{\\tabcolsep}}{{{}pt}}\n"
            "%     \\caption{{{}}}\\label{{tab:{}}}\\smallskip\n"
            "%     \\input{{tables/{}}}\n",
            inOneLine(fmt::format("{}. {}", table_.label, table_.title)),
            isAcross() ? " and, for this wide one, \\usepackage{rotating}" : "", environment,
            kColumnSepPt, escapeLatex(table_.title), latexKeyPart(table_.slug), table_.slug);
        if (!notes_.empty()) {
            text_ += fmt::format("%     \\par\\smallskip\\parbox{{\\linewidth}}{{{}}}\n",
                                 cite(table_.id + '/' + kNotes));
        }
        text_ += fmt::format("%   \\end{{{}}}\n", environment) +
                 "% Each number is a macro, for the text below the \\input; keys are "
                 "table/row/column:\n";
        if (!table_.isOnlyPrinted) {
            text_ += fmt::format(
                "%   {}  as measured\n"
                "%   likewise {}/low and /high, the ends of its bounds,\n"
                "%   and /bounds, what they are: 95 % interval (of times that of this "
                "sitting), the range of too few processes, or one seed, which has none;\n"
                "%   and, of several statistics in a cell, each below the cell's key\n",
                cite(example), example);
        }
        if (std::ranges::find(isPrinted_, true) != isPrinted_.end()) {
            text_ += fmt::format("%   {}  as printed\n", cite(example + "/printed"));
        }
        if (!parameters_.empty()) {
            text_ += fmt::format("%   {}  at which parameters it was measured\n", cite(table_.id));
        }
        if (!notes_.empty()) {
            text_ += fmt::format("%   {}  what is to stand below the table\n",
                                 cite(table_.id + '/' + kNotes));
        }
        text_ += kMacros;
    }

    void set(const std::string& key, const std::string& latex) {
        text_ += fmt::format("\\gfxreproset{{{}}}{{{}}}%\n", key, latex);
    }
    void setText(const std::string& key, const std::string& value) { set(key, escapeLatex(value)); }

    void writeNumbers(const tables::Cell& cell, const std::string& key) {
        if (cell.printed) setText(key + "/printed", *cell.printed);
        if (!cell.isPlanned) return;
        setText(key, cell.measured);
        if (cell.isCalibrated) setText(key + "/calibrated", "yes");
        if (cell.movedClock) setText(key + "/clock", tables::clockText(*cell.movedClock));
        if (!cell.low.empty()) {
            setText(key + "/low", cell.low);
            setText(key + "/high", cell.high);
            setText(key + "/bounds", std::string(tables::boundsName(cell.bounds())));
        } else if (cell.isOfOneSeed()) {
            setText(key + "/bounds", "one seed");
        }
        if (cell.values.size() < 2) return;
        for (const tables::Measured& measured : cell.values) {
            setText(fmt::format("{}/{}", key, measured.statistic), measured.text);
            if (measured.low.empty()) continue;
            setText(fmt::format("{}/{}/low", key, measured.statistic), measured.low);
            setText(fmt::format("{}/{}/high", key, measured.statistic), measured.high);
        }
    }

    static std::string headLatex(const std::vector<std::string>& lines, char alignment) {
        std::vector<std::string> escaped;
        // Braces: after \\ a bracket or star would be its argument.
        for (const std::string& line : lines)
            escaped.push_back(fmt::format("{{{}}}", escapeLatex(line)));
        if (lines.size() == 1) return escaped.front();
        return fmt::format("\\gfxreprohead{{{}}}{{{}}}", alignment, joined(escaped, "\\\\"));
    }

    void writeColumns(const std::vector<std::size_t>& block) {
        text_ += "\\begin{tabular}{";
        for (const std::size_t i : block) text_ += columns_[i].isLabel ? 'l' : 'r';
        text_ += "}\n\\toprule\n";
        std::vector<std::string> head, rules, kinds;
        for (std::size_t i = 0; i < block.size(); ++i) {
            const SetColumn& column = columns_[block[i]];
            if (column.isFirstOfTwo) {
                const std::size_t letters = column.letters + 2 + columns_[block[i + 1]].letters;
                head.push_back(fmt::format("\\multicolumn{{2}}{{c}}{{{}}}",
                                           headLatex(headOf(column, letters), 'c')));
                rules.push_back(fmt::format("\\cmidrule(lr){{{}-{}}}", i + 1, i + 2));
            } else if (column.kind.empty()) {
                head.push_back(headLatex(headOf(column), column.isLabel ? 'l' : 'r'));
            }
            kinds.push_back(column.kind);
        }
        writeLine(head);
        if (!rules.empty()) {
            text_ += joined(rules, "") + '\n';
            writeLine(kinds);
        }
        text_ += "\\midrule\n";
    }

    /// The numbers, and their bounds in a line of their own.
    void writeRow(std::size_t index, const std::vector<std::size_t>& block) {
        const tables::TableRow& row = table_.rows[index];
        std::vector<std::string> numbers, bounds;  // of all columns
        for (std::size_t i = 0; i < row.labels.size(); ++i) {
            numbers.push_back(fmt::format("{{{}}}", escapeLatex(shown_[i].at(row.labels[i]))));
        }
        if (table_.hasSources()) numbers.emplace_back(tables::sceneSourceName(row.source));
        bounds.resize(numbers.size());
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            const tables::Cell& cell = row.cells[i];
            if (isPrinted_[i] || table_.isOnlyPrinted) {
                numbers.push_back(cell.printed ? cite(key(index, i) + "/printed") : "");
                bounds.emplace_back();
            }
            if (table_.isOnlyPrinted) continue;
            numbers.push_back(numberOf(cell, key(index, i)));
            bounds.push_back(boundsOf(cell, key(index, i)));
        }
        writeLine(partOf(numbers, block));
        const std::vector<std::string> below = partOf(bounds, block);
        if (std::ranges::all_of(below, &std::string::empty)) return;
        writeLine(below);
        if (index + 1 < table_.rows.size()) text_ += "\\addlinespace[2pt]\n";
    }

    static std::string numberOf(const tables::Cell& cell, const std::string& key) {
        if (!cell.isPlanned) return "";
        return cite(key) + (cell.isCalibrated ? kMark : "") + (cell.movedClock ? kClockMark : "");
    }

    static std::string boundsOf(const tables::Cell& cell, const std::string& key) {
        if (!cell.isPlanned || !cell.hasShownBounds()) return "";
        return fmt::format(fmt::runtime(cell.hasInterval() ? "\\scriptsize [{}, {}]"
                                                           : "\\scriptsize ({} \\ldots\\ {})"),
                           cite(key + "/low"), cite(key + "/high"));
    }

    static std::vector<std::string> partOf(const std::vector<std::string>& cells,
                                           const std::vector<std::size_t>& block) {
        std::vector<std::string> part;
        for (const std::size_t i : block) part.push_back(cells[i]);
        return part;
    }

    /// A cell a line, as people read sources.
    void writeLine(const std::vector<std::string>& cells) {
        std::string line = cells.front();
        for (std::size_t i = 1; i < cells.size(); ++i) {
            line += cells[i].empty() ? "&" : (line.empty() ? "& " : "\n& ") + cells[i];
        }
        text_ += line + " \\\\\n";
    }

    const tables::Table& table_;
    const std::vector<std::string>& runNotes_;
    const std::vector<std::map<std::string, std::string>>
        shown_;                                              // as people read them, an axis each
    const std::vector<std::vector<std::string>> rowLabels_;  // beside the rows
    const std::string parameters_ = tables::parametersLine(table_);
    std::vector<std::string> rowKeys_;     // beside the rows
    std::vector<std::string> columnKeys_;  // beside the columns
    std::vector<bool> isPrinted_;          // beside the columns: some row has a printed number
    std::vector<SetColumn> columns_;
    std::string notes_;
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
