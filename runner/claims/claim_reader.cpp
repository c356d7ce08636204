#include "runner/claims/claim_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "engine/core/text.h"
#include "runner/tables/case_records.h"
#include "runner/tables/labels.h"

namespace gfxrepro::claims {

namespace {

/// The table with a column of each row axis of numbers, but where `when` of the sweep leaves it
/// out: for what a trend is over.
tables::Table withAxesAsColumns(tables::Table table) {
    for (std::size_t axis = 0; axis < table.rowAxes.size(); ++axis) {
        const bool isOfNumbers = std::ranges::all_of(table.rows, [&](const tables::TableRow& row) {
            const std::string& label = row.labels[axis];
            return parseDouble(label).has_value() || label == tables::kLeftOut;
        });
        if (!isOfNumbers || table.findColumn(table.rowAxes[axis])) continue;
        table.columns.push_back({table.rowAxes[axis], ""});
        for (tables::TableRow& row : table.rows) {
            tables::Cell& cell = row.cells.emplace_back();
            cell.isNowhere = row.labels[axis] == tables::kLeftOut;
            if (cell.isNowhere) continue;
            cell.status = records::Status::Ok;
            cell.measured = row.labels[axis];
            cell.isAtPrintedParameters = true;
            static_cast<tables::Summary&>(cell.values.emplace_back()) =
                tables::summaryOf(*parseDouble(row.labels[axis]), {}, false);
        }
    }
    return table;
}

}  // namespace

tables::Table tableFor(const ClaimSpec& claim, const tables::Table& table) {
    const bool isOverExpression =
        claim.over && !table.findColumn(*claim.over) &&
        std::ranges::find(table.rowAxes, *claim.over) == table.rowAxes.end();
    // What is not laid out is known of once it was measured.
    if (table.columns.empty()) return table;
    if (!claim.across) return isOverExpression ? withAxesAsColumns(table) : table;
    const auto found = std::find(table.rowAxes.begin(), table.rowAxes.end(), *claim.across);
    if (found == table.rowAxes.end()) {
        throw Error(claim.location, "claim '" + claim.id + "': across: '" + *claim.across +
                                        "' is no row axis (row axes: " + joined(table.rowAxes) +
                                        ")");
    }
    tables::Table turned =
        tables::transposed(table, static_cast<std::size_t>(found - table.rowAxes.begin()));
    const bool isOverOther = isOverExpression && !turned.findColumn(*claim.over) &&
                             std::ranges::find(turned.rowAxes, *claim.over) == turned.rowAxes.end();
    return isOverOther ? withAxesAsColumns(std::move(turned)) : turned;
}

ClaimReader::ClaimReader(const ClaimSpec& claim, const tables::Table& table)
    : claim_(claim), table_(table) {
    const std::string owner = "claim '" + claim.id + "'";
    for (const std::string& operand : claim.operands) {
        operands_.emplace_back(operand, table, claim.location, owner);
    }
    // Of numbers another profile's sweep may have columns, where some are numbers here.
    const bool areColumnsWords =
        !table.columns.empty() && std::ranges::none_of(table.columns, [](const auto& column) {
            return parseDouble(column.label).has_value();
        });
    if (areColumnsWords && std::ranges::all_of(operands_, [](const Operand& operand) {
            return operand.columns().empty();
        })) {
        throw ExpressionError(claim.location, owner,
                              fmt::format("'{}' reads no column; the rows of an axis are "
                                          "compared with 'across: AXIS'",
                                          joined(claim.operands, "', '")));
    }
    for (const auto& [axis, values] : claim.at) rowAxis(axis, "at");
    if (!claim.over) return;
    const auto found = std::find(table.rowAxes.begin(), table.rowAxes.end(), *claim.over);
    if (found != table.rowAxes.end()) {
        overAxis_ = static_cast<std::size_t>(found - table.rowAxes.begin());
    } else {
        overColumn_.emplace_back(*claim.over, table, claim.location, owner);
    }
}

std::size_t ClaimReader::rowAxis(const std::string& name, const char* key) const {
    const auto found = std::find(table_.rowAxes.begin(), table_.rowAxes.end(), name);
    if (found == table_.rowAxes.end()) {
        fail(std::string(key) + ": '" + name + "' is no row axis" +
             suggestion(name, table_.rowAxes) + " (row axes: " + joined(table_.rowAxes) + ")");
    }
    return static_cast<std::size_t>(found - table_.rowAxes.begin());
}

Rows ClaimReader::rows() const {
    Rows rows;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
        bool isRead = true;
        for (const auto& [axis, values] : claim_.at) {
            const std::string& label = table_.rows[row].labels[rowAxis(axis, "at")];
            isRead = isRead && std::any_of(values.begin(), values.end(), [&](const auto& value) {
                         return tables::canonicalText(value) == label;
                     });
        }
        if (isRead) rows.push_back(row);
    }
    return rows;
}

std::string ClaimReader::whyNoRow() const {
    if (readsAny()) return "";
    Node::Map asked;
    for (const auto& [axis, values] : claim_.at) {
        if (axis == kColumnAxis) continue;
        asked.emplace_back(axis, values.size() == 1 ? values[0] : Node::sequence(values));
    }
    std::vector<std::string> there;
    for (const tables::TableRow& row : table_.rows) {
        Node::Map own;
        for (const auto& [axis, values] : claim_.at) {
            if (axis == kColumnAxis) continue;
            const std::string& label = row.labels[rowAxis(axis, "at")];
            if (label != tables::kLeftOut) own.emplace_back(axis, Node::scalar(label));
        }
        const std::string text = Node::map(own).toFlowText();
        if (std::ranges::find(there, text) == there.end()) there.push_back(text);
    }
    return fmt::format("no row is of {}; there are: {}", Node::map(asked).toFlowText(),
                       there.empty() ? "none" : tables::shortened(there, ", "));
}

namespace {

std::string whyFewRows(const ClaimPart& part, std::size_t rows) {
    if (rows >= part.minRows) return "";
    return fmt::format("needs at least {} rows, found {}", part.minRows, rows);
}

}  // namespace

/// The row axes along which `over` changes: itself, or, if it is a column, each on which that
/// column depends.
std::vector<bool> ClaimReader::axesAlongX() {
    std::vector<bool> along(table_.rowAxes.size(), false);
    if (overAxis_) along[*overAxis_] = true;
    if (overColumn_.empty()) return along;
    const Rows read = rows();
    std::map<std::size_t, std::optional<double>> x;
    for (const std::size_t row : read) {
        if (problemOf(overColumn_[0], row).empty()) x[row] = abscissa(row).point;
    }
    for (const std::size_t a : read) {
        for (const std::size_t b : read) {
            std::vector<std::size_t> different;
            for (std::size_t axis = 0; axis < along.size(); ++axis) {
                if (table_.rows[a].labels[axis] != table_.rows[b].labels[axis]) {
                    different.push_back(axis);
                }
            }
            if (different.size() == 1 && x[a] != x[b]) along[different[0]] = true;
        }
    }
    return along;
}

std::vector<Rows> ClaimReader::groups() {
    std::vector<bool> along = axesAlongX();
    if (claim_.kind->isOfAllRows) along.assign(along.size(), true);
    std::vector<Rows> groups;
    std::map<std::vector<std::string>, std::size_t> indices;
    for (const std::size_t row : rows()) {
        std::vector<std::string> key;
        for (std::size_t axis = 0; axis < along.size(); ++axis) {
            if (!along[axis]) key.push_back(table_.rows[row].labels[axis]);
        }
        const auto [found, isNew] = indices.try_emplace(std::move(key), groups.size());
        if (isNew) groups.emplace_back();
        groups[found->second].push_back(row);
    }
    return groups;
}

std::string ClaimReader::groupName(const Rows& rows) const {
    std::vector<std::string> parts;
    for (std::size_t axis = 0; axis < table_.rowAxes.size(); ++axis) {
        const std::string& label = table_.rows[rows[0]].labels[axis];
        const bool isShared = std::all_of(rows.begin(), rows.end(), [&](std::size_t row) {
            return table_.rows[row].labels[axis] == label;
        });
        if (isShared) {
            parts.push_back(tables::shownValue(table_.rowAxes[axis], label, table_.words));
        }
    }
    return joined(parts);
}

std::string ClaimReader::sceneOf(const Rows& rows) const {
    const auto axis = std::ranges::find(table_.rowAxes, "scene") - table_.rowAxes.begin();
    if (axis == std::ssize(table_.rowAxes)) return "";
    const auto labelOf = [&](std::size_t row) {
        return table_.rows[row].labels[static_cast<std::size_t>(axis)];
    };
    const std::string scene = labelOf(rows[0]);
    if (!std::ranges::all_of(rows, [&](std::size_t row) { return labelOf(row) == scene; }))
        return "";
    return tables::shownValue("scene", scene, table_.words);
}

Rows ClaimReader::unfitOf(const Rows& rows) const {
    if (!claim_.isReadOffDocument()) return {};
    Rows unfit;
    std::ranges::copy_if(rows, std::back_inserter(unfit),
                         [&](std::size_t row) { return table_.rows[row].isUnfit; });
    return unfit;
}

bool isCalibrated(const tables::Cell& cell) {
    return cell.isPlanned && cell.isCalibrated;
}

Rows ClaimReader::rowsOrAll() const {
    Rows read = rows();
    if (!read.empty()) return read;
    read.resize(table_.rows.size());
    std::iota(read.begin(), read.end(), std::size_t{0});
    return read;
}

bool ClaimReader::readsSome(const std::function<bool(const tables::Cell&)>& isSuch,
                            const Rows& read) const {
    const auto readsOne = [&](const Operand& operand) {
        return std::ranges::any_of(operand.columns(), [&](std::size_t column) {
            return std::ranges::any_of(
                read, [&](std::size_t row) { return isSuch(table_.rows[row].cells[column]); });
        });
    };
    return std::ranges::any_of(operands_, readsOne) || std::ranges::any_of(overColumn_, readsOne);
}

bool ClaimReader::readsTime() const {
    return readsSome([](const tables::Cell& cell) { return cell.isTime; }, rowsOrAll());
}

bool ClaimReader::readsOnly(std::string_view metric) const {
    const auto isOther = [&](const tables::Cell& cell) {
        return cell.isPlanned && cell.metric != metric;
    };
    return std::ranges::all_of(operands_, &Operand::isColumn) && !readsSome(isOther);
}

std::optional<std::string> ClaimReader::wordAlongOver() const {
    const std::vector<ClaimPart> parts = partsOf(claim_);
    if (!overAxis_ || std::ranges::none_of(parts, &ClaimPart::needsX)) return std::nullopt;
    for (const std::size_t row : plannedRows()) {
        const std::string& label = table_.rows[row].labels[*overAxis_];
        if (!parseDouble(label)) return label;
    }
    return std::nullopt;
}

bool ClaimReader::isOverItself() const {
    return !overColumn_.empty() && std::ranges::any_of(operands_, [&](const Operand& operand) {
        return operand.isColumn() && overColumn_[0].isColumn() &&
               operand.columns() == overColumn_[0].columns();
    });
}

bool ClaimReader::readsCalibrated() const {
    const Rows read = rows();
    return readsSome(isCalibrated) && std::ranges::all_of(operands_, [&](const Operand& operand) {
               return std::ranges::all_of(operand.columns(), [&](std::size_t column) {
                   return std::ranges::all_of(read, [&](std::size_t row) {
                       const tables::Cell& cell = table_.rows[row].cells[column];
                       return cell.isCalibrated || !cell.isPlanned;
                   });
               });
           });
}

/// By which factor the operand grows as all times double, where its cells are `base` and above; a
/// zero by any.
std::optional<double> ClaimReader::growthAsTimesDouble(Operand& operand, std::size_t row,
                                                       double base) {
    std::vector<double> before, after;
    for (const std::size_t column : operand.columns()) {
        base *= 1.7;  // no two alike: their difference is no 0
        before.push_back(base);
        after.push_back(std::ldexp(base, table_.rows[row].cells[column].timePower));
    }
    const double first = operand.evaluate(before), second = operand.evaluate(after);
    if (first == 0.0 && second == 0.0) return std::nullopt;
    return second / first;
}

bool ClaimReader::asksForATimeAsSuch() {
    using Compares = Kind::Compares;
    const Compares compares = claim_.kind->compares;
    const auto areAlike = [](const std::vector<double>& growths) {
        constexpr double kTolerance = 1e-9;
        return std::ranges::all_of(growths, [&](double growth) {
            return std::abs(growth - growths.front()) < kTolerance;
        });
    };
    for (const std::size_t row : rowsOrAll()) {
        std::vector<double> growths;
        if (compares == Compares::Values) growths.push_back(1.0);
        for (Operand& operand : operands_) {
            if (compares == Compares::Rows) growths.clear();
            // A sum with a number grows by less somewhere, a comparison with one at its number.
            for (int exponent = -10; exponent <= 30; ++exponent) {
                const std::optional<double> growth =
                    growthAsTimesDouble(operand, row, std::ldexp(1.0, exponent));
                if (growth) growths.push_back(*growth);
            }
            if (!areAlike(growths)) return true;
        }
    }
    return false;
}

std::optional<ClaimSpec::TimeKind> ClaimReader::timeKind() {
    if (claim_.timeKind || !readsTime() || !asksForATimeAsSuch()) return claim_.timeKind;
    return ClaimSpec::TimeKind::Absolute;
}

std::vector<ClaimReader::TimeCell> ClaimReader::timePlaces() const {
    std::vector<TimeCell> places;
    for (const auto* operands : {&operands_, &overColumn_}) {
        for (const Operand& operand : *operands) {
            for (const std::size_t column : operand.columns()) {
                for (const std::size_t row : rows()) {
                    const tables::Cell& cell = table_.rows[row].cells[column];
                    if (cell.isOk() && cell.isTime) places.push_back({row, column, &cell});
                }
            }
        }
    }
    return places;
}

std::vector<std::string> ClaimReader::timeColumns() const {
    std::set<std::string> labels;
    for (const TimeCell& place : timePlaces()) {
        labels.insert(claim_.across ? table_.rows[place.row].labels.back()
                                    : table_.columns[place.column].label);
    }
    return {labels.begin(), labels.end()};
}

bool ClaimReader::isAtPrintedParameters() const {
    return std::ranges::all_of(
        timePlaces(), [](const TimeCell& place) { return place.cell->isAtPrintedParameters; });
}

bool ClaimReader::readByProcess() {
    if (std::ranges::any_of(timePlaces(),
                            [](const TimeCell& place) { return place.cell->byProcess.empty(); })) {
        return false;
    }
    clock_ = tables::Clock::Process;
    return true;
}

bool ClaimReader::isPlanned(const ClaimPart& part, std::size_t row) const {
    for (const std::size_t operand : part.operands) {
        for (const std::size_t column : operands_[operand].columns()) {
            const tables::Cell& cell = table_.rows[row].cells[column];
            if (!cell.isPlanned && !cell.isUnrecorded) return false;
        }
    }
    return true;
}

Rows ClaimReader::plannedRows() const {
    const std::vector<ClaimPart> parts = partsOf(claim_);
    Rows planned = rows();
    std::erase_if(planned, [&](std::size_t row) {
        return std::ranges::none_of(parts,
                                    [&](const ClaimPart& part) { return isPlanned(part, row); });
    });
    return planned;
}

std::string ClaimReader::problemOf(const Operand& operand, std::size_t row) const {
    for (const std::size_t column : operand.columns()) {
        const tables::Cell& cell = table_.rows[row].cells[column];
        if (!cell.isOk()) {
            const std::string name = table_.rowName(row);
            return table_.columns[column].label + (name.empty() ? "" : " at " + name) + ": " +
                   std::string(records::statusName(cell.status)) +
                   (cell.message.empty() ? "" : " (" + cell.message + ")");
        }
    }
    return "";
}

std::optional<double> ClaimReader::expected(std::size_t operand, std::size_t row) {
    if (claim_.low) return claim_.low;  // a given number, in the place of the printed one
    std::vector<double> printed;
    for (const std::size_t column : operands_[operand].columns()) {
        const tables::Cell& cell = table_.rows[row].cells[column];
        if (cell.printedValues.empty() || !cell.printedValues[0]) return std::nullopt;
        printed.push_back(*cell.printedValues[0]);
    }
    return operands_[operand].evaluate(printed);
}

Sampled ClaimReader::abscissa(std::size_t row) {
    if (!overColumn_.empty()) return overColumn_[0].evaluate(table_.rows[row], clock_);
    if (!overAxis_) fail("expected `over:`, a row axis or a column");
    const std::string& label = table_.rows[row].labels[*overAxis_];
    const auto value = parseDouble(label);
    if (!value) {
        fail("over: the row axis '" + *claim_.over + "' holds '" + label + "', expected numbers");
    }
    return {*value, {}};
}

std::string ClaimReader::whyUnread(const ClaimPart& part, const Rows& rows) const {
    std::size_t count = 0;
    bool isXKnown = true;
    for (const std::size_t row : rows) {
        if (!isPlanned(part, row)) continue;
        ++count;
        std::vector<const Operand*> read;
        for (const std::size_t operand : part.operands) read.push_back(&operands_[operand]);
        if (part.needsX && !overColumn_.empty()) read.push_back(&overColumn_[0]);
        for (const Operand* operand : read) {
            for (const std::size_t column : operand->columns()) {
                if (!table_.rows[row].cells[column].isNowhere) continue;
                return fmt::format("'{}' has no value at {}", table_.columns[column].label,
                                   table_.rowName(row));
            }
        }
        isXKnown &= overColumn_.empty() || problemOf(overColumn_[0], row).empty();
    }
    return count == 0 || !isXKnown ? "" : whyFewRows(part, count);
}

ClaimReader::Reading ClaimReader::read(const ClaimPart& part, const Rows& rows) {
    Reading reading;
    reading.group.operands.resize(part.operands.size() + (part.needsExpected ? 1 : 0));
    for (const std::size_t row : rows) {
        if (!isPlanned(part, row)) continue;
        for (const std::size_t operand : part.operands) {
            reading.problem = problemOf(operands_[operand], row);
            if (!reading.problem.empty()) return reading;
        }
        if (part.needsX && !overColumn_.empty()) {
            reading.problem = problemOf(overColumn_[0], row);
            if (!reading.problem.empty()) return reading;
        }
        if (part.needsExpected) {
            const auto value = expected(part.operands[0], row);
            if (!value) continue;  // lost in print
            reading.group.operands.back().push_back({*value, {}});
        }
        for (std::size_t i = 0; i < part.operands.size(); ++i) {
            reading.group.operands[i].push_back(
                operands_[part.operands[i]].evaluate(table_.rows[row], clock_));
        }
        if (part.needsX) reading.group.x.push_back(abscissa(row));
        reading.rows.push_back(row);
    }
    if (!reading.rows.empty()) reading.problem = whyFewRows(part, reading.rows.size());
    return reading;
}

}  // namespace gfxrepro::claims
