// The tables of several runs laid over one another.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runner/report/model.h"

namespace gfxrepro::report {

/// A row or column that any of them has. Runs of
/// other profiles have other rows.
class Overlay {
  public:
    explicit Overlay(const Page& page);

    const std::vector<std::size_t>& runs() const { return runs_; }
    const std::vector<tables::TableColumn>& columns() const { return columns_; }
    const std::vector<std::vector<std::string>>& rows() const { return rows_; }

    /// A row of the i-th table; null where it has none.
    const tables::TableRow* find(std::size_t i, const std::vector<std::string>& labels) const {
        const auto row = rowOf_[i].find(labels);
        return row == rowOf_[i].end() ? nullptr : row->second;
    }
    const tables::Cell* find(std::size_t i, const tables::TableRow* row,
                             const std::string& column) const {
        if (!row) return nullptr;
        for (std::size_t c = 0; c < tables_[i]->columns.size(); ++c) {
            if (tables_[i]->columns[c].label == column) return &row->cells[c];
        }
        return nullptr;
    }
    /// What the paper printed there; the same in every run that has the cell.
    std::optional<std::string> printed(const std::vector<std::string>& labels,
                                       const std::string& column) const {
        for (std::size_t i = 0; i < tables_.size(); ++i) {
            const tables::Cell* cell = find(i, find(i, labels), column);
            if (cell && cell->printed) return cell->printed;
        }
        return std::nullopt;
    }
    bool hasPrinted(const std::string& column) const { return printedColumns_.contains(column); }
    bool isOnlyPrinted() const { return tables_.front()->isOnlyPrinted; }
    const tables::Table& first() const { return *tables_.front(); }
    bool isEmpty() const { return tables_.empty() || columns_.empty() || rows_.empty(); }
    /// What stands under one column's head: the printed number, then a number a run.
    std::size_t widthOf(const std::string& column) const {
        return isOnlyPrinted() ? 1 : (hasPrinted(column) ? 1 : 0) + runs_.size();
    }

  private:
    std::vector<std::size_t> runs_;  // beside tables_: its index in the model
    std::vector<const tables::Table*> tables_;
    std::vector<std::map<std::vector<std::string>, const tables::TableRow*>> rowOf_;  // likewise
    std::set<std::string> printedColumns_;
    std::vector<tables::TableColumn> columns_;
    std::vector<std::vector<std::string>> rows_;
};

/// The heads of its columns: a line for each column axis, and one for printed and measured.
std::string headHtml(const Overlay& overlay, bool isComparison);

}  // namespace gfxrepro::report
