#include "runner/tables/printed.h"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/printed_section.h"
#include "runner/records/csv.h"
#include "runner/tables/labels.h"

namespace gfxrepro::tables {

// What is printed beside what was measured.

namespace {

using Cells = std::vector<std::string>;

/// What a printed row has in the column of that name; null where nothing was printed of it.
const std::string* printedIn(const Cells& printedRow, const std::string& name,
                             const config::Printed& printed) {
    const auto found = std::ranges::find(printed.header, name);
    if (found == printed.header.end()) return nullptr;
    return &printedRow[static_cast<std::size_t>(found - printed.header.begin())];
}

bool isRowOf(const Cells& printedRow, const config::Printed& printed, const Table& table,
             const TableRow& row) {
    for (std::size_t i = 0; i < table.rowAxes.size(); ++i) {
        const std::string* label = printedIn(printedRow, table.rowAxes[i], printed);
        if (label && canonicalCell(*label) != row.labels[i]) return false;
    }
    return true;
}

/// In words the columns of `printed` that the table does not have: a profile or a sweep took them
/// away.
Cells absentColumns(const config::Printed& printed, const Table& table) {
    Cells absent;
    for (const std::string& name : printed.header) {
        const bool isAxis = std::ranges::find(table.rowAxes, name) != table.rowAxes.end();
        if (!isAxis && !table.findColumn(name)) absent.push_back(shownName(name, table.words));
    }
    return absent;
}

/// Where the printed rows stand, in their order.
std::vector<SourceLocation> linesOf(const Node& values) {
    std::vector<SourceLocation> lines;
    const std::vector<std::string> texts = split(values.text(), '\n');
    bool isHeader = true;
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string_view line = trimmed(texts[i]);
        if (line.empty() || line.front() == '#') continue;
        if (!isHeader) lines.push_back(values.lineLocation(i));
        isHeader = isHeader && line.back() == ',';
    }
    return lines;
}

/// What the tables have on their row axes: "scene a | b; step 1 | 2".
std::string allowedRows(std::span<const Table> tables) {
    std::vector<std::string> axes;
    for (std::size_t axis = 0; axis < tables.front().rowAxes.size(); ++axis) {
        Cells labels;
        for (const Table& table : tables) {
            for (const TableRow& row : table.rows) {
                if (axis >= row.labels.size()) continue;  // a profile's layout
                const bool isNew = std::ranges::find(labels, row.labels[axis]) == labels.end();
                if (isNew) labels.push_back(row.labels[axis]);
            }
        }
        axes.push_back(tables.front().rowAxes[axis] + " " + joined(labels, " | "));
    }
    return joined(axes, "; ");
}

void requireNumbers(const Table& table, const TableRow& row, const SourceLocation& where) {
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const Cell& cell = row.cells[i];
        const bool isWhole = std::ranges::all_of(
            cell.printedValues, [](const auto& value) { return value.has_value(); });
        if (!cell.printed || isWhole) continue;
        throw Error(where, fmt::format("printed: {} is '{}'; allowed: as the cell's format writes "
                                       "numbers, or empty where it is lost",
                                       table.columns[i].label, *cell.printed));
    }
}

}  // namespace

void layPrintedBeside(const config::Experiment& experiment, Table& table) {
    const config::Printed& printed = experiment.printed;
    if (printed.rows.empty()) return;
    if (const Cells absent = absentColumns(printed, table); !absent.empty()) {
        table.notes.push_back("printed columns that are not part of this run: " + joined(absent));
    }
    const auto layInto = [&](TableRow& row, const Cells& printedRow) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const auto& [label, unit, doc, better, key] = table.columns[i];
            const std::string* value = printedIn(printedRow, label, printed);
            if (!value || value->empty()) continue;
            row.cells[i].printed = *value;
            row.cells[i].printedValues =
                makeQuery(experiment.layout, row.labels, key).format.parse(*value);
        }
    };
    for (const Cells& printedRow : printed.rows) {
        bool isPlaced = false;
        for (TableRow& row : table.rows) {
            if (!isRowOf(printedRow, printed, table, row)) continue;
            isPlaced = true;
            layInto(row, printedRow);
        }
        if (isPlaced) continue;
        Cell unplanned;
        unplanned.isPlanned = false;
        TableRow row{{}, SceneSource::Unknown, std::vector<Cell>(table.columns.size(), unplanned)};
        for (const std::string& axis : table.rowAxes) {
            const std::string* label = printedIn(printedRow, axis, printed);
            row.labels.push_back(label ? canonicalCell(*label) : "");
        }
        layInto(row, printedRow);
        table.printedRows.push_back(std::move(row));
    }
}

void layPrintedAlone(const config::Printed& printed, Table& table) {
    if (printed.rows.empty()) return;
    table.isOnlyPrinted = true;
    table.rowAxes = {printed.header[0]};
    for (std::size_t i = 1; i < printed.header.size(); ++i) {
        table.columns.push_back(
            {printed.header[i], "", {}, config::Better::Neither, {printed.header[i]}});
    }
    for (const Cells& printedRow : printed.rows) {
        TableRow row{{printedRow[0]}, SceneSource::Unknown, {}};
        for (std::size_t i = 1; i < printedRow.size(); ++i) {
            Cell& cell = row.cells.emplace_back();
            cell.isPlanned = false;
            if (!printedRow[i].empty()) cell.printed = printedRow[i];
        }
        table.rows.push_back(std::move(row));
    }
}

void requirePrintedValues(const config::Experiment& experiment, std::span<const Table> tables) {
    const config::Printed& printed = experiment.printed;
    if (printed.rows.empty()) return;
    const std::vector<SourceLocation> lines = linesOf(config::printedValuesOf(experiment.document));
    for (std::size_t i = 0; i < printed.rows.size(); ++i) {
        bool isMeasured = false;
        for (const Table& table : tables) {
            for (const auto* rows : {&table.rows, &table.printedRows}) {
                for (const TableRow& row : *rows) {
                    if (!isRowOf(printed.rows[i], printed, table, row)) continue;
                    isMeasured |= rows == &table.rows;
                    requireNumbers(table, row, lines[i]);
                }
            }
        }
        if (isMeasured) continue;
        throw Error(lines[i], fmt::format("printed: no profile measures the row '{}'; allowed: {}",
                                          joined(printed.rows[i], ","), allowedRows(tables)));
    }
}

// At which parameters both were measured.

namespace {

/// Each once, in the order in which they come.
template <class T>
void addOnce(T value, std::vector<T>& values) {
    if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
}

using Json = nlohmann::ordered_json;

/// What techniques call the parameter that saves pictures and changes no number.
constexpr const char* kPictures = "pictures";

/// At what a case was measured: name and value as text, in an order that reads well.
using Settings = std::vector<std::pair<std::string, std::string>>;

std::string settingText(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return records::shortestText(value.get<double>());
    if (!value.is_array()) return value.dump();
    std::vector<std::string> items;
    for (const Json& item : value) items.push_back(settingText(item));
    return fmt::format("[{}]", joined(items));
}

/// Under which name settings have what `printed.at` names.
std::string settingNameOf(const std::string& name) {
    if (name == "output.frames") return "frames";
    return name.starts_with("output.") ? "output" : name;
}

/// Lays what `printed.at` says over a case.
void layPrintedOver(const config::Printed& printed, std::string& scene, Json& params,
                    Json& frames) {
    for (const auto& [name, value] : printed.at) {
        if (name == "scene") {
            scene = value.text();
        } else if (name == "output.frames") {
            frames = value.toJson();
        } else if (name == "output.width" || name == "output.height") {
            params["output"][name.substr(name.find('.') + 1)] = value.toJson();
        } else {
            params[name] = value.toJson();
        }
    }
}

/// What records say of a case beside its parameters.
bool isNoParameter(const std::string& name) {
    return name == "output" || name == kPictures || name == config::kStandsFor ||
           name == config::kSceneSample;
}

/// A parameter that is null or empty is one that a case has not got: the tables of a run that was
/// exported, which tells these apart no more, and imported again say the same.
bool isNothing(const Json& value) {
    const bool isEmptyText = value.is_string() && value.get<std::string>().empty();
    return isEmptyText || (!value.is_string() && value.empty());
}

/// Of a generated scene at another seed ("outdoor/city@3") the name in the table: another sample of
/// it, not another parameter. Its generator's parameters are among the case's.
std::string sceneNameOf(const CaseRecords& item, const Json& params) {
    const auto named = params.find(config::kStandsFor);
    if (named == params.end()) return item.scene;
    const std::string name = settingText(*named);
    return scene::sceneName(item.scene) == name ? name : item.scene;
}

Settings settingsOf(const CaseRecords& item, int frameCount, const config::Printed& printed) {
    Json params = item.params.toJson();
    std::string scene = sceneNameOf(item, params);
    Json frames = frameCount;
    layPrintedOver(printed, scene, params, frames);
    Settings settings;
    if (!scene.empty()) settings.emplace_back("scene", scene);
    if (const auto output = params.find("output"); output != params.end()) {
        settings.emplace_back("output", fmt::format("{}×{}", settingText((*output)["width"]),
                                                    settingText((*output)["height"])));
    }
    for (const auto& [name, value] : params.items()) {
        if (isNoParameter(name) || isNothing(value)) continue;
        settings.emplace_back(name, settingText(value));
    }
    settings.emplace_back("frames", settingText(frames));
    return settings;
}

std::vector<Settings> settingsOf(const std::vector<const CaseRecords*>& cases, int frameCount,
                                 const config::Printed& printed) {
    std::vector<Settings> settings;
    for (const CaseRecords* item : cases) addOnce(settingsOf(*item, frameCount, printed), settings);
    return settings;
}

/// The values of a parameter in several cases.
std::vector<std::string> valuesOf(const std::string& name, const std::vector<Settings>& cases) {
    std::vector<std::string> values;
    for (const Settings& settings : cases) {
        for (const auto& [known, value] : settings) {
            if (known == name) addOnce(value, values);
        }
    }
    return values;
}

template <class T>
bool isSameSet(std::vector<T> a, std::vector<T> b) {
    std::ranges::sort(a);
    std::ranges::sort(b);
    return a == b;
}

/// Whatever the order of their parameters.
bool areSameCases(std::vector<Settings> a, std::vector<Settings> b) {
    for (auto* cases : {&a, &b}) {
        for (Settings& settings : *cases) std::ranges::sort(settings);
    }
    return isSameSet(std::move(a), std::move(b));
}

/// `isOfConfig` tells of a parameter whether no print has it.
std::vector<Departure> departuresOf(const std::vector<Settings>& measured,
                                    const std::vector<Settings>& printed,
                                    const std::function<bool(const std::string&)>& isOfConfig) {
    std::vector<std::string> names;
    for (const auto* cases : {&printed, &measured}) {
        for (const Settings& settings : *cases) {
            for (const auto& [name, value] : settings) addOnce(name, names);
        }
    }
    std::vector<Departure> departures;
    for (const std::string& name : names) {
        Departure departure{name, valuesOf(name, measured), valuesOf(name, printed),
                            isOfConfig(name)};
        if (!isSameSet(departure.measured, departure.printed)) {
            departures.push_back(std::move(departure));
        }
    }
    if (departures.empty()) {
        departures.push_back({"cases",
                              {std::to_string(measured.size())},
                              {std::to_string(printed.size())},
                              std::ranges::any_of(names, isOfConfig)});
    }
    return departures;
}

/// Whether a layout has such a row or column at all; values of swept axes may still be others.
bool hasKey(const std::vector<config::LayoutAxis>& axes,
            const std::vector<config::LayoutAxis>& asked, const Key& key) {
    if (axes.size() != asked.size()) return false;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].name != asked[i].name || axes[i].isSweepAxis() != asked[i].isSweepAxis()) {
            return false;
        }
        if (axes[i].isSweepAxis()) continue;
        const auto isLabel = [&](const auto& label) { return label.first == key[i]; };
        if (std::ranges::none_of(axes[i].labels, isLabel)) return false;
    }
    return true;
}

bool hasRun(const CaseRecords& item) {
    return std::ranges::any_of(item.processes,
                               [](const auto& process) { return !process.second.failure; });
}

}  // namespace

PrintedParameters::PrintedParameters(const config::Experiment& experiment) {
    if (experiment.paperCases.empty()) return;
    config::Experiment paper =
        config::experimentFromDocument(experiment.paperDocument, experiment.file);
    cases_ = gatherCases(paper, experiment.paperCases, {});
    layout_ = std::move(paper.layout);
    printed_ = std::move(paper.printed);
    for (const config::Assumption& assumption : paper.assumptions) {
        open_.insert(settingNameOf(assumption.name));
    }
    for (const auto& [name, value] : printed_.at) {
        open_.erase(settingNameOf(name));
        given_.insert(settingNameOf(name));
    }
}

void PrintedParameters::compare(const config::Layout& layout, const Key& row, const Key& column,
                                const LayoutCases& cases, Cell& cell) const {
    if (!isKnown() || cell.values.empty()) return;
    if (!hasKey(layout_.rows, layout.rows, row) || !hasKey(layout_.columns, layout.columns, column))
        return;
    std::vector<const CaseRecords*> run = casesAt(whereOf(layout, row, column), cases);
    std::erase_if(run, [](const CaseRecords* item) { return !hasRun(*item); });
    const std::vector<Settings> measured = settingsOf(run, cases.frameCount, {});
    const std::vector<Settings> printed =
        settingsOf(casesAt(whereOf(layout_, row, column), cases_), cases_.frameCount, printed_);
    if (printed.empty()) return;
    cell.isAtPrintedParameters = areSameCases(measured, printed);
    if (!cell.isAtPrintedParameters) {
        cell.departures = departuresOf(
            measured, printed, [&](const std::string& name) { return !given_.contains(name); });
    }
    for (const Settings& settings : printed) {
        for (const auto& [name, value] : settings) {
            const bool isSaid = std::ranges::find(cell.departures, name, &Departure::parameter) !=
                                cell.departures.end();
            if (name == "scene" || isSaid || !open_.contains(name)) continue;
            addOnce(name, cell.openParameters);
        }
    }
}

// What tables say of these parameters.

namespace {

/// More values of a parameter than these are cut short in a sentence.
constexpr std::size_t kSaidValues = 4;

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
        for (const std::string& name : cell.openParameters) addOnce(name, open);
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
                                       Departure{departure.parameter, {}, {}, departure.isOfConfig})
                                 : *known;
            for (const std::string& value : departure.measured) addOnce(value, all.measured);
            for (const std::string& value : departure.printed) addOnce(value, all.printed);
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
    return sentence(tally,
                    table.hasPrinted() && !table.isPrintUnsaid
                        ? "the printed parameters"
                        : "the parameters of the profile paper",
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
        const std::string_view whose = departure.isOfConfig ? "the config's " : "printed ";
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
    if (experiment.kind != config::ExperimentKind::Table) return;
    for (const auto* rows : {&table.rows, &table.printedRows}) {
        for (const TableRow& row : *rows) {
            for (const Cell& cell : row.cells) {
                if (!cell.printed) continue;
                ++printed;
                if (cell.values.empty()) continue;
                ++measured;
                const bool isAtConfigs = cell.isAtPrintedParameters && table.isPrintUnsaid;
                if (!table.knowsPrintedParameters || isAtConfigs) {
                    ++unknown;
                } else if (cell.isAtPrintedParameters) {
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

namespace {

std::string withTimes(const std::string& line, const Table& table) {
    return line.empty() || table.timesOf.empty() ? line + table.timesOf
                                                 : line + ". " + table.timesOf;
}

}  // namespace

std::string parametersLine(const Table& table) {
    if (table.isPublished && tallyOf(table.rows).count() == 0) return "Nothing of it is measured.";
    const std::string text = withTimes(line(table, table.rows), table);
    return text.empty() ? "" : text + '.';
}

std::string parametersLine(const Table& table, const TableRow& row) {
    return withTimes(line(table, {&row, 1}), table);
}

}  // namespace gfxrepro::tables
