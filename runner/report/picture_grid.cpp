#include "runner/report/picture_grid.h"

#include <algorithm>
#include <optional>

#include "engine/core/text.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

PageShots shotsOf(const Page& page, const Model& model) {
    PageShots all;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        all.prefixes.push_back(model.isComparison() ? Model::letter(run) + "-" : "");
        const std::vector<Shot>& shots = page.parts[run].shots;
        for (std::size_t i = 0; i < shots.size(); ++i) {
            all.shots.push_back(shots[i]);
            all.shots.back().caseId = all.prefixes[run] + shots[i].caseId;
            all.runs.push_back(run);
            all.places.push_back(i);
        }
    }
    return all;
}

std::map<std::size_t, std::size_t> truthsOf(const std::vector<Shot>& shots) {
    std::map<std::pair<std::string, std::string>, std::size_t> byName;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        byName.try_emplace({shots[i].caseId, shots[i].name}, i);
    }
    std::map<std::size_t, std::size_t> truths;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        if (shots[i].truth.empty()) continue;
        const auto truth = byName.find({shots[i].caseId, shots[i].truth});
        if (truth != byName.end()) truths.emplace(i, truth->second);
    }
    return truths;
}

namespace {

using Labels = std::vector<std::optional<std::string>>;  // none: the case is under several

/// Where a case lies in the table.
struct Place {
    Labels row, column;
    std::size_t firstRow = 0, firstColumn = 0;
};

/// Leaves what both say.
void keepCommon(const std::vector<std::string>& labels, std::optional<Labels>& common) {
    if (!common) {
        common.emplace(labels.begin(), labels.end());
        return;
    }
    for (std::size_t i = 0; i < common->size() && i < labels.size(); ++i) {
        if ((*common)[i] != labels[i]) (*common)[i].reset();
    }
}

std::map<std::string, Place> placesOf(const tables::Table& table,
                                      const std::set<std::string>& cases) {
    struct Found {
        std::optional<Labels> row, column;
        std::size_t firstRow = 0, firstColumn = 0;
    };
    // A column of ratios to one row takes that row's cases in all rows: they lie where others say.
    std::map<std::pair<std::string, std::size_t>, std::size_t> rowsOf;  // of a case in a column
    std::map<std::string, std::size_t> fewestRows;
    for (const tables::TableRow& row : table.rows) {
        for (std::size_t c = 0; c < row.cells.size(); ++c) {
            for (const std::string& id : row.cells[c].caseIds) ++rowsOf[{id, c}];
        }
    }
    for (const auto& [place, count] : rowsOf) {
        const auto [fewest, isNew] = fewestRows.try_emplace(place.first, count);
        fewest->second = std::min(fewest->second, count);
    }
    std::map<std::string, Found> found;
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        for (std::size_t c = 0; c < table.rows[r].cells.size(); ++c) {
            for (const std::string& id : table.rows[r].cells[c].caseIds) {
                if (!cases.contains(id) || rowsOf[{id, c}] > fewestRows[id]) continue;
                const auto [item, isNew] = found.try_emplace(id, Found{{}, {}, r, c});
                keepCommon(table.rows[r].labels, item->second.row);
                keepCommon(table.columns[c].parts, item->second.column);
                item->second.firstColumn = std::min(item->second.firstColumn, c);
            }
        }
    }
    std::map<std::string, Place> places;
    for (auto& [id, item] : found) {
        for (std::size_t i = 0; i < item.row->size(); ++i) {  // a number says nothing alone
            auto& label = (*item.row)[i];
            if (label && parseDouble(*label))
                label = tables::shownValue(table.rowAxes[i], *label, table.words);
        }
        places.emplace(id, Place{*item.row, *item.column, item.firstRow, item.firstColumn});
    }
    return places;
}

/// The distinct labels of a side, in the order of the table.
std::vector<Labels> distinct(const std::map<std::string, Place>& places, Labels Place::*labels,
                             std::size_t Place::*first) {
    std::map<Labels, std::size_t> at;
    for (const auto& [id, place] : places) {
        const auto [known, isNew] = at.try_emplace(place.*labels, place.*first);
        known->second = std::min(known->second, place.*first);
    }
    std::vector<Labels> result;
    for (const auto& [text, order] : at) result.push_back(text);
    std::ranges::stable_sort(result, {}, [&](const Labels& text) { return at.at(text); });
    return result;
}

/// Moves the last axis of the rows that tells cases apart into the columns.
void layAlongColumns(std::map<std::string, Place>& places) {
    if (places.empty()) return;
    std::size_t axis = places.begin()->second.row.size();
    const auto isAlike = [&](std::size_t i) {
        return std::ranges::all_of(places, [&](const auto& item) {
            return item.second.row[i] == places.begin()->second.row[i];
        });
    };
    while (axis > 0 && isAlike(axis - 1)) --axis;
    if (axis == 0) return;
    for (auto& [id, place] : places) {
        place.column = {place.row[axis - 1]};
        place.firstColumn = place.firstRow;
        place.row.erase(place.row.begin() + static_cast<std::ptrdiff_t>(axis - 1));
    }
}

std::string textOf(const Labels& labels, const tables::Words& words) {
    std::vector<std::string> said;
    for (const auto& label : labels) {
        if (label && !label->empty()) said.push_back(tables::shownName(*label, words));
    }
    return joined(said);
}

/// The one truth of these shots; none where they have none, or several.
std::optional<std::size_t> commonTruth(const std::vector<std::size_t>& members,
                                       const std::vector<Shot>& shots,
                                       const std::map<std::size_t, std::size_t>& truths) {
    std::optional<std::size_t> common;
    for (const std::size_t i : members) {
        const auto truth = truths.find(i);
        if (truth == truths.end()) return std::nullopt;
        if (common && shots[*common].content != shots[truth->second].content) return std::nullopt;
        if (!common) common = truth->second;
    }
    return common;
}

std::vector<std::size_t> membersOf(const PictureLine& line) {
    std::vector<std::size_t> members;
    for (const auto& cell : line.cells) members.insert(members.end(), cell.begin(), cell.end());
    return members;
}

/// Puts truths where they stand once: above the columns, before a line, or after each picture.
void addTruths(const std::vector<Shot>& shots, PictureGrid& grid) {
    const std::map<std::size_t, std::size_t> truths = truthsOf(shots);
    std::set<std::string> names;
    for (const PictureRow& row : grid.rows) {
        for (const PictureLine& line : row.lines) names.insert(line.name);
    }
    const auto isOneEach = [&] {
        return std::ranges::all_of(grid.rows, [&](const PictureRow& row) {
            return std::ranges::all_of(row.lines, [&](const PictureLine& line) {
                return commonTruth(membersOf(line), shots, truths).has_value();
            });
        });
    };
    if (grid.rows.size() > 1 && names.size() == 1 && !isOneEach()) {
        std::vector<std::vector<std::size_t>> above;
        for (std::size_t c = 0; c < grid.columns.size(); ++c) {
            std::vector<std::size_t> members;
            for (const PictureRow& row : grid.rows) {
                const auto& cell = row.lines.front().cells[c];
                members.insert(members.end(), cell.begin(), cell.end());
            }
            const auto truth = commonTruth(members, shots, truths);
            if (truth) above.push_back({*truth});
        }
        if (above.size() == grid.columns.size()) {
            grid.truths = std::move(above);
            return;
        }
    }
    for (PictureRow& row : grid.rows) {
        for (PictureLine& line : row.lines) {
            const std::vector<std::size_t> members = membersOf(line);
            if (const auto truth = commonTruth(members, shots, truths)) {
                line.truth = {*truth};
                continue;
            }
            for (auto& cell : line.cells) {
                std::vector<std::size_t> withTruths;
                for (const std::size_t i : cell) {
                    withTruths.push_back(i);
                    if (truths.contains(i)) withTruths.push_back(truths.at(i));
                }
                cell = std::move(withTruths);
            }
        }
    }
}

/// Of all runs; those of one place stand beside each other.
std::map<std::string, Place> placesOf(const Page& page, const PageShots& all,
                                      const std::set<std::size_t>& chosen) {
    std::map<std::string, Place> places;
    std::map<std::string, std::size_t> runOf;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        std::set<std::string> cases;
        for (const std::size_t i : chosen) {
            if (all.runs[i] != run) continue;
            cases.insert(page.parts[run].shots[all.places[i]].caseId);
        }
        for (auto& [id, place] : placesOf(page.parts[run].table, cases)) {
            runOf[all.prefixes[run] + id] = run;
            places.emplace(all.prefixes[run] + id, std::move(place));
        }
    }
    if (distinct(places, &Place::column, &Place::firstColumn).size() == 1) layAlongColumns(places);
    if (page.parts.size() == 1) return places;
    for (auto& [id, place] : places) {
        place.column.insert(place.column.begin(), Model::letter(runOf[id]));
        place.firstColumn = place.firstColumn * page.parts.size() + runOf[id];
    }
    return places;
}

}  // namespace

PictureGrid pictureGrid(const Page& page, const PageShots& all, const tables::Words& words,
                        const std::set<std::size_t>& chosen) {
    const std::vector<Shot>& shots = all.shots;
    const std::map<std::string, Place> places = placesOf(page, all, chosen);
    const std::vector<Labels> columns = distinct(places, &Place::column, &Place::firstColumn);
    const std::vector<Labels> rows = distinct(places, &Place::row, &Place::firstRow);
    PictureGrid grid;
    for (const Labels& column : columns) grid.columns.push_back(textOf(column, words));
    for (const Labels& row : rows)
        grid.rows.push_back({rows.size() > 1 ? textOf(row, words) : "", {}});
    const std::map<std::size_t, std::size_t> truths = truthsOf(shots);
    std::set<std::size_t> shownAsTruth;
    for (const auto& [shot, truth] : truths) {
        if (chosen.contains(shot)) shownAsTruth.insert(truth);
    }
    for (const std::size_t i : chosen) {
        if (shownAsTruth.contains(i)) continue;
        const auto place = places.find(shots[i].caseId);
        if (place == places.end()) {
            grid.others.push_back(i);
            if (truths.contains(i)) grid.others.push_back(truths.at(i));
            continue;
        }
        const auto r =
            static_cast<std::size_t>(std::ranges::find(rows, place->second.row) - rows.begin());
        const auto c = static_cast<std::size_t>(std::ranges::find(columns, place->second.column) -
                                                columns.begin());
        std::vector<PictureLine>& lines = grid.rows[r].lines;
        auto line = std::ranges::find(lines, shots[i].name, &PictureLine::name);
        if (line == lines.end()) {
            lines.push_back({shots[i].name, {}, {}});
            line = lines.end() - 1;
            line->cells.resize(columns.size());
        }
        line->cells[c].push_back(i);
    }
    std::erase_if(grid.rows, [](const PictureRow& row) { return row.lines.empty(); });
    addTruths(shots, grid);
    return grid;
}

}  // namespace gfxrepro::report
