// How the pictures of a page lie beside each other: as the rows and columns of its table do.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runner/report/gallery.h"
#include "runner/report/pages.h"
#include "runner/tables/labels.h"

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

/// The pictures of all runs of a page. Beside others a run's cases begin with its letter.
struct PageShots {
    std::vector<Shot> shots;
    std::vector<std::size_t> runs, places;  // beside `shots`: whose it is, and where among its
    std::vector<std::string> prefixes;      // "A-" of each run, or ""
};

PageShots shotsOf(const Page& page, const Model& model);

/// The truth of each shot, by place in the list.
std::map<std::size_t, std::size_t> truthsOf(const std::vector<Shot>& shots);

/// The grid of the chosen ones among the shots of a page; truths of these come with them.
PictureGrid pictureGrid(const Page& page, const PageShots& all, const tables::Words& words,
                        const std::set<std::size_t>& chosen);

}  // namespace gfxrepro::report
