// What tables say of the parameters at which they were measured.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/text.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed_parameters.h"

namespace gfxrepro::tables {

namespace {

/// More values of a parameter than these are cut short in a sentence.
constexpr std::size_t kSaidValues = 4;

void addTextOnce(const std::string& value, std::vector<std::string>& values) {
    if (std::ranges::find(values, value) == values.end()) values.push_back(value);
}

/// What a sentence about cells is made from.
struct Tally {
    int same = 0;
    int asGiven = 0;  // likewise, but for what the document does not give
    int different = 0;
    int alone = 0;  // without a counterpart in the profile `paper`
    std::vector<std::string> open;
    std::vector<Departure> departures;

    int count() const { return same + asGiven + different + alone; }
    void add(const Cell& cell) {
        for (const std::string& name : cell.openParameters) addTextOnce(name, open);
        if (cell.isAtPrintedParameters) {
            ++(cell.openParameters.empty() ? same : asGiven);
        } else if (cell.departures.empty()) {
            ++alone;
        } else {
            ++different;
        }
        for (const Departure& departure : cell.departures) {
            const auto known =
                std::ranges::find(departures, departure.parameter, &Departure::parameter);
            Departure& all = known == departures.end()
                                 ? departures.emplace_back(
                                       Departure{departure.parameter, {}, {}, departure.isOpen})
                                 : *known;
            for (const std::string& value : departure.measured) addTextOnce(value, all.measured);
            for (const std::string& value : departure.printed) addTextOnce(value, all.printed);
        }
    }
};

/// Of the cells beside a printed value; of all where there are none.
Tally tallyOf(std::span<const TableRow> rows) {
    Tally all, besidePrinted;
    for (const TableRow& row : rows) {
        for (const Cell& cell : row.cells) {
            if (cell.values.empty()) continue;
            all.add(cell);
            if (cell.printed) besidePrinted.add(cell);
        }
    }
    return besidePrinted.count() > 0 ? besidePrinted : all;
}

std::string valuesText(const std::vector<std::string>& values, const Words& words) {
    if (values.empty()) return "none";
    std::vector<std::string> said;
    for (const std::string& value : values) said.push_back(valueInWords(value, words));
    if (said.size() <= kSaidValues) return joined(said, " / ");
    return fmt::format("{} / {} / … / {}", said[0], said[1], said.back());
}

/// `printed` are the words for the parameters that measured ones are held against.
std::string sentence(const Tally& tally, const std::string& printed, const Words& words) {
    if (tally.alone == tally.count()) {
        return "Measured where the profile paper has no case";
    }
    std::string text = "Measured at ";
    const auto add = [&](int cells, const std::string& at) {
        if (cells == 0) return;
        text += at;
        if (cells < tally.count()) text += fmt::format(" in {} of {} cells", cells, tally.count());
    };
    add(tally.same, printed);
    if (tally.same > 0 && tally.asGiven > 0) text += ", ";
    add(tally.asGiven,
        fmt::format("{} as far as they are given (not: {})", printed, openText(tally.open, words)));
    if (tally.different > 0) {
        text += (tally.same + tally.asGiven > 0 ? ", in the others at " : "") +
                departuresText(tally.departures, words);
        if (tally.asGiven == 0 && !tally.open.empty()) {
            text += fmt::format("; not given: {}", openText(tally.open, words));
        }
    }
    if (tally.alone > 0) {
        text += fmt::format("; {} cell{} where the profile paper has no case", tally.alone,
                            tally.alone == 1 ? "" : "s");
    }
    return text;
}

std::string line(const Table& table, std::span<const TableRow> rows) {
    if (!table.isPublished) return "";
    const Tally tally = tallyOf(rows);
    if (tally.count() == 0) return "";
    if (!table.knowsPrintedParameters) {
        return "Whether it was measured at the printed parameters is not known: the run's plan "
               "does not have them";
    }
    const bool isPrinted = std::ranges::any_of(table.rows, [](const TableRow& row) {
        return std::ranges::any_of(row.cells,
                                   [](const Cell& cell) { return cell.printed.has_value(); });
    });
    return sentence(tally,
                    isPrinted ? "the printed parameters" : "the parameters of the profile paper",
                    table.words);
}
}  // namespace

std::string openText(const std::vector<std::string>& parameters, const Words& words) {
    std::vector<std::string> said;
    for (const std::string& name : parameters) said.push_back(quantityOf(name, words).words);
    return joined(said);
}

std::string departuresText(const std::vector<Departure>& departures, const Words& words) {
    std::vector<std::string> parts;
    std::string_view said;  // holds for what follows
    for (const Departure& departure : departures) {
        const std::string_view whose = departure.isOpen ? "paper profile " : "printed ";
        Quantity quantity = quantityOf(departure.parameter, words);
        if (departure.measured.empty()) quantity.unit.clear();
        parts.push_back(
            fmt::format("{} ({}{})", quantity.with(valuesText(departure.measured, words)),
                        whose == said ? "" : whose, valuesText(departure.printed, words)));
        said = whose;
    }
    return joined(parts);
}
void PrintedCells::add(const config::Experiment& experiment, const Table& table) {
    if (experiment.kind != config::Experiment::Kind::Table) return;
    for (const auto* rows : {&table.rows, &table.printedRows}) {
        for (const TableRow& row : *rows) {
            for (const Cell& cell : row.cells) {
                if (!cell.printed) continue;
                ++printed;
                if (cell.values.empty()) continue;
                ++measured;
                if (!table.knowsPrintedParameters) ++unknown;
                if (cell.isAtPrintedParameters) {
                    ++(cell.openParameters.empty() ? atPrinted : asGiven);
                }
            }
        }
    }
}

PrintedCells countPrintedCells(std::span<const config::Experiment> experiments,
                               std::span<const Table> tables) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    PrintedCells count;
    for (std::size_t i = 0; i < tables.size(); ++i) count.add(experiments[i], tables[i]);
    return count;
}

std::string printedCellsLine(const PrintedCells& count) {
    if (count.printed == 0) return "";
    std::vector<std::string> parts;
    const auto add = [&](int cells, const char* at) {
        if (cells > 0) parts.push_back(fmt::format("{} {}", cells, at));
    };
    add(count.atPrinted, "at the printed parameters");
    add(count.asGiven, "at the parameters that the document gives, which leaves some open");
    add(count.measured - count.atPrinted - count.asGiven - count.unknown,
        "at other parameters, which each table names");
    add(count.unknown, "at parameters of which it is not known");
    const std::string how = parts.empty() ? "" : ": " + joined(parts, "; ");
    return fmt::format("Of {} printed cell{} of tables {} {} measured again{}.", count.printed,
                       count.printed == 1 ? "" : "s",
                       count.measured == 0 ? "none" : std::to_string(count.measured),
                       count.measured < 2 ? "was" : "were", how);
}

std::string parametersLine(const Table& table) {
    if (table.isPublished && tallyOf(table.rows).count() == 0) return "Nothing of it is measured.";
    const std::string text = line(table, table.rows);
    return text.empty() ? "" : text + '.';
}

std::string parametersLine(const Table& table, const TableRow& row) {
    return line(table, {&row, 1});
}

}  // namespace gfxrepro::tables
