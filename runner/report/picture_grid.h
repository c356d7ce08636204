// How the pictures of a table lie beside each other: as its rows and columns do.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "runner/report/gallery.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

/// Pictures of one name: a line of the grid. Shots are given by their places in the list.
struct PictureLine {
    std::string name;
    std::vector<std::vector<std::size_t>> cells;  // beside PictureGrid::columns
    /// The truth of all of them, if it is one picture; it stands once, before them.
    std::vector<std::size_t> truth;
};

struct PictureRow {
    std::string label;  // "living room"; empty where there is one row
    std::vector<PictureLine> lines;
};

/// A row or column of the table that the pictures do not tell apart is none here: rows of several
/// measures of one picture are one row. Where a single column is left, the last of the axes of rows
/// lies along the columns.
struct PictureGrid {
    std::vector<std::string> columns;  // one may be empty: nothing to be told apart
    /// One picture of truth for each column, the same in every row: stands once, above them.
    std::vector<std::vector<std::size_t>> truths;  // beside `columns`; or empty
    std::vector<PictureRow> rows;
    std::vector<std::size_t> others;  // of cases that no cell shows
};

/// The grid of the chosen ones among a run's shots of the table; truths of these come with them.
PictureGrid pictureGrid(const tables::Table& table, const std::vector<Shot>& shots,
                        const std::set<std::size_t>& chosen);

/// Whether `shows` means the shot by this name: "classes" is classes_0 and classes_1, too.
bool isCalled(const Shot& shot, const std::string& name);

/// The shots that a page shows first: those of the names (also "classes_0" of "classes"); where
/// none is of them those that have a truth; where none has, those of the first name of each case.
/// Truths are not among them.
std::set<std::size_t> mainShots(const std::vector<Shot>& shots,
                                const std::vector<std::string>& names);

}  // namespace gfxrepro::report
