// One cell: which records it takes, and what they give.
#pragma once

#include <optional>
#include <string>

#include "runner/config/experiment.h"
#include "runner/tables/cell_format.h"
#include "runner/tables/table.h"
#include "runner/tables/table_axes.h"

namespace gfxrepro::tables {

/// Which cases the cell shows.
Where whereOf(const config::Layout& layout, const Key& row, const Key& column);

/// What a cell shows, after the parts of its column, its row and `cell` are laid over one another.
struct CellQuery {
    std::string metric;
    std::string pass;
    CellFormat format;
    double scale = 1.0;
    bool isScaled = false;
    std::optional<config::Against> against;
    bool isRateOfTime = false;  // the records are ms, the cell shows how many a second
    Where where;
};

/// Throws Error at the selection's place when no part gives a metric, or for a bad format.
CellQuery makeQuery(const config::Layout& layout, const Key& row, const Key& column);

Cell buildCell(const CellQuery& query, const LayoutCases& cases);

/// Where the scenes come from of the cases that a row takes.
SceneSource sceneSourceOf(const config::Layout& layout, const Key& row, const LayoutCases& cases);

}  // namespace gfxrepro::tables
