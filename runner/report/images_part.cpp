// The pictures of a page, which lie beside each other as the rows and columns of its table do.
#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/core/text.h"
#include "engine/metrics/mean_test.h"
#include "runner/report/gallery.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/tables/labels.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

namespace {

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
    std::map<std::string, Found> found;
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        for (std::size_t c = 0; c < table.rows[r].cells.size(); ++c) {
            for (const std::string& id : table.rows[r].cells[c].caseIds) {
                if (!cases.contains(id)) continue;
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

/// The truth of each shot, by place in the list.
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

/// Of a claim that two have one mean: the noisy pictures themselves say less, and stand folded.
bool isOfMeans(const Shot& shot) {
    return shot.baseName.ends_with(metrics::kDifferencesSuffix);
}

/// The grid of the chosen ones among a run's shots of the table; truths of these come with them.
PictureGrid pictureGrid(const tables::Table& table, const std::vector<Shot>& shots,
                        const std::set<std::size_t>& chosen) {
    std::set<std::string> cases;
    for (const std::size_t i : chosen) cases.insert(shots[i].caseId);
    std::map<std::string, Place> places = placesOf(table, cases);
    std::vector<Labels> columns = distinct(places, &Place::column, &Place::firstColumn);
    if (columns.size() == 1) {
        layAlongColumns(places);
        columns = distinct(places, &Place::column, &Place::firstColumn);
    }
    const std::vector<Labels> rows = distinct(places, &Place::row, &Place::firstRow);
    PictureGrid grid;
    for (const Labels& column : columns) grid.columns.push_back(textOf(column, table.words));
    for (const Labels& row : rows)
        grid.rows.push_back({rows.size() > 1 ? textOf(row, table.words) : "", {}});
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

/// The pictures of one run on a page. The viewer reads what it needs from the data attributes.
class Pictures {
  public:
    Pictures(const Page& page, std::size_t run, const Model& model)
        : page_(page),
          shots_(page.parts[run].shots),
          words_(page.parts[run].table.words),
          letter_(model.isComparison() ? Model::letter(run) : ""),
          prefix_(Model::letter(run) + "-" + page.slug) {
        const RunPart& part = page.parts[run];
        const std::set<std::size_t> main = mainShots(
            shots_, part.experiment ? part.experiment->shows : std::vector<std::string>());
        main_ = pictureGrid(part.table, shots_, main);
        std::set<std::size_t> shown;
        collect(main_, shown);
        std::set<std::size_t> rest;
        for (std::size_t i = 0; i < shots_.size(); ++i) {
            if (!shown.contains(i) && !isRepeated(i, shown)) rest.insert(i);
        }
        rest_ = pictureGrid(part.table, shots_, rest);
        findTruths();
        if (part.experiment) findMissing(part.experiment->shows);
    }

    std::string html() const {
        std::string html = gridHtml(main_);
        std::string further = gridHtml(rest_);
        if (!further.empty() && !html.empty()) {
            further = "<details class=\"further\"><summary>Further pictures of these cases: " +
                      escapeXml(namesOf(rest_)) + "</summary>\n" + further + "</details>\n";
        }
        html += further + missing_;
        if (html.empty() || letter_.empty()) return html;
        return fmt::format("<h4>{}</h4>\n{}", letter_, html);
    }

  private:
    using Cell = std::vector<std::size_t>;

    /// Says which of the pictures that are to be shown no case saved.
    void findMissing(const std::vector<std::string>& shows) {
        for (const std::string& name : shows) {
            const auto isMeant = [&](const Shot& shot) { return isCalled(shot, name); };
            if (std::ranges::any_of(shots_, isMeant)) continue;
            std::set<std::string> names;
            for (const Shot& shot : shots_) names.insert(shot.baseName);
            missing_ += fmt::format(
                "<p class=\"soft small\">None of these cases saved the picture '{}', which `shows` "
                "names; they saved {}.</p>\n",
                escapeXml(name), escapeXml(joined(std::vector(names.begin(), names.end()))));
        }
    }

    static void collect(const PictureGrid& grid, std::set<std::size_t>& shown) {
        const auto add = [&](const Cell& cell) { shown.insert(cell.begin(), cell.end()); };
        std::ranges::for_each(grid.truths, add);
        for (const PictureRow& row : grid.rows) {
            for (const PictureLine& line : row.lines) {
                add(line.truth);
                std::ranges::for_each(line.cells, add);
            }
        }
        add(grid.others);
    }

    /// A truth whose picture is among those.
    bool isRepeated(std::size_t i, const std::set<std::size_t>& shown) const {
        return shots_[i].isTruth() && std::ranges::any_of(shown, [&](std::size_t other) {
                   return shots_[other].content == shots_[i].content;
               });
    }

    /// "error, reflection": what a grid shows.
    std::string namesOf(const PictureGrid& grid) const {
        std::set<std::size_t> shown;
        collect(grid, shown);
        std::vector<std::string> names;
        for (const std::size_t i : shown) {
            const std::string name = tables::shownName(shots_[i].baseName, words_);
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        }
        return joined(names);
    }

    std::string gridHtml(const PictureGrid& grid) const {
        std::string html;
        if (grid.rows.size() == 1) {
            for (const PictureLine& line : grid.rows[0].lines) html += flowHtml(grid, line);
        } else if (!grid.rows.empty()) {
            html += tableHtml(grid);
        }
        if (!grid.others.empty()) {
            html += "<div class=\"gallery\">\n";
            for (const std::size_t i : grid.others) {
                html += figureHtml(
                    i, fmt::format("{} · {}", nameOf(shots_[i].name), caseOf(shots_[i])));
            }
            html += "</div>\n";
        }
        return html;
    }

    /// The shot that stands for a truth: where it is shown once for several, that one.
    void findTruths() {
        std::map<std::string, std::size_t> shown;  // by content
        for (const PictureGrid* grid : {&main_, &rest_}) {
            std::set<std::size_t> all;
            collect(*grid, all);
            for (const std::size_t i : all) {
                if (shots_[i].isTruth()) shown.try_emplace(shots_[i].content, i);
            }
        }
        for (const auto& [shot, truth] : truthsOf(shots_)) {
            const auto once = shown.find(shots_[truth].content);
            truths_[shot] = once == shown.end() ? truth : once->second;
        }
    }

    /// "soft shadow, frame 2" of "soft_shadow, frame 2".
    std::string nameOf(const std::string& name) const {
        const std::size_t end = std::min(name.find(", frame "), name.size());
        return tables::shownName(name.substr(0, end), words_) + name.substr(end);
    }

    std::string caseOf(const Shot& shot) const {
        return tables::shownCase(shot.caseTitle, page_.id, words_);
    }

    /// Of a truth what the titles of those share of which it is the truth.
    std::string titleOf(std::size_t i) const {
        std::optional<std::vector<std::string>> common;
        for (const auto& [shot, truth] : truths_) {
            if (truth != i) continue;
            const std::vector<std::string> parts = split(caseOf(shots_[shot]), ',');
            if (!common) common = parts;
            std::erase_if(*common, [&](const std::string& part) {
                return std::ranges::find(parts, part) == parts.end();
            });
        }
        return common && !common->empty() ? std::string(trimmed(joined(*common, ",")))
                                          : caseOf(shots_[i]);
    }

    std::string idOf(std::size_t i) const { return fmt::format("{}-{}", prefix_, i); }

    /// A picture, what it shows, and below it how far it is from its truth.
    std::string figureHtml(std::size_t i, const std::string& says) const {
        const Shot& shot = shots_[i];
        const std::string title = titleOf(i);
        std::string data = fmt::format(
            " id=\"{}\" data-run=\"{}\" data-case=\"{}\" data-title=\"{}\" data-name=\"{}\"",
            escapeXml(idOf(i)), letter_, escapeXml(shot.caseId), escapeXml(title),
            escapeXml(nameOf(shot.name)));
        if (!shot.full.empty()) data += fmt::format(" data-full=\"{}\"", shot.full);
        if (!shot.light.empty()) data += fmt::format(" data-light=\"{}\"", joined(shot.light, " "));
        const auto truth = truths_.find(i);
        if (truth != truths_.end()) {
            data += fmt::format(" data-truth=\"{}\"", escapeXml(idOf(truth->second)));
        }
        if (!shot.errors.empty()) data += fmt::format(" data-errors=\"{}\"", shot.errors);
        std::string html = fmt::format(
            "<figure><button class=\"shot\"{}><img src=\"{}\" alt=\"{}\" width=\"{}\" "
            "height=\"{}\" loading=\"lazy\"></button><figcaption>{}</figcaption>\n",
            data, shot.thumbnail, escapeXml(title + " · " + nameOf(shot.name)), shot.width,
            shot.height, escapeXml(says));
        if (!shot.flip.empty()) {
            html = fmt::format(
                "<div>{}</figure>\n<figure class=\"of-error\"><button class=\"error\" "
                "data-of=\"{}\"><img src=\"{}\" alt=\"where {} differs "
                "from "
                "{}\" width=\"{}\" height=\"{}\" loading=\"lazy\"></button><figcaption>error: FLIP "
                "{:.4f} to {}</figcaption>\n",
                html, escapeXml(idOf(i)), shot.flip, escapeXml(nameOf(shot.name)),
                escapeXml(nameOf(shot.truth)), shot.width, shot.height, shot.flipMean,
                escapeXml(nameOf(shot.truth)));
        }
        return html + (shot.flip.empty() ? "</figure>\n" : "</figure></div>\n");
    }

    /// What stands under a picture: its name, where that tells more than its column, and its case
    /// where a cell holds several.
    std::string saysOf(std::size_t i, const Cell& cell, const std::string& column) const {
        const auto isNamedAlike = [&](std::size_t other) {
            return shots_[other].name == shots_[i].name;
        };
        const bool isOne = std::ranges::count_if(cell, isNamedAlike) == 1;
        const std::string name = nameOf(shots_[i].name);
        std::string says = column.empty() ? name : fmt::format("{}: {}", column, name);
        if (isOfMeans(shots_[i])) {
            says += fmt::format(
                ": the mean of all less that of the truths, tile by tile in standard errors; red "
                "is darker than the truth, blue brighter, full colour {:g} or more",
                metrics::kShownErrors);
        }
        if (!isOne) says += " · " + caseOf(shots_[i]);
        return says;
    }

    /// One row: as many beside each other as the window has place for.
    std::string flowHtml(const PictureGrid& grid, const PictureLine& line) const {
        std::string html = "<div class=\"gallery\">\n";
        for (const std::size_t i : line.truth) html += figureHtml(i, nameOf(shots_[i].name));
        for (std::size_t c = 0; c < line.cells.size(); ++c) {
            for (const std::size_t i : line.cells[c]) {
                html += figureHtml(i, saysOf(i, line.cells[c], grid.columns[c]));
            }
        }
        return html + "</div>\n";
    }

    std::string cellHtml(const Cell& cell) const {
        std::string html = "<td>";
        for (const std::size_t i : cell) html += figureHtml(i, saysOf(i, cell, ""));
        return html + "</td>";
    }

    std::string tableHtml(const PictureGrid& grid) const {
        const auto hasTruth = [](const PictureRow& row) {
            return std::ranges::any_of(row.lines,
                                       [](const auto& line) { return !line.truth.empty(); });
        };
        const bool isTruthBefore = std::ranges::any_of(grid.rows, hasTruth);
        const std::size_t width = grid.columns.size() + (isTruthBefore ? 1 : 0);
        std::string html = fmt::format(
            "<div class=\"scroll\"><table class=\"pictures\" style=\"--columns:{}\">\n<thead><tr>",
            width);
        if (isTruthBefore) html += "<th scope=\"col\">truth</th>";
        for (const std::string& column : grid.columns) {
            html += fmt::format("<th scope=\"col\">{}</th>", escapeXml(column));
        }
        html += "</tr></thead>\n";
        if (!grid.truths.empty()) {
            html += fmt::format(
                "<tbody><tr><th scope=\"rowgroup\" colspan=\"{}\">truth</th></tr>\n<tr>", width);
            for (const Cell& cell : grid.truths) html += cellHtml(cell);
            html += "</tr></tbody>\n";
        }
        for (const PictureRow& row : grid.rows) {
            html += fmt::format("<tbody><tr><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n",
                                width, escapeXml(row.label));
            for (const PictureLine& line : row.lines) {
                html += "<tr>";
                if (isTruthBefore) html += cellHtml(line.truth);
                for (const Cell& cell : line.cells) html += cellHtml(cell);
                html += "</tr>\n";
            }
            html += "</tbody>\n";
        }
        return html + "</table></div>\n";
    }

    const Page& page_;
    const std::vector<Shot>& shots_;
    const tables::Words& words_;
    PictureGrid main_;  // what the page shows first
    PictureGrid rest_;
    std::string missing_;  // in words
    std::string letter_;
    std::string prefix_;
    std::map<std::size_t, std::size_t> truths_;  // of each shot, the one that is shown
};

}  // namespace

bool isCalled(const Shot& shot, const std::string& name) {
    return shot.baseName == name || shot.baseName.starts_with(name + '_');
}

std::set<std::size_t> mainShots(const std::vector<Shot>& shots,
                                const std::vector<std::string>& names) {
    std::set<std::size_t> named, ofMeans, withTruth, first;
    std::map<std::string, std::string> firstName;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const Shot& shot = shots[i];
        const auto isMeant = [&](const std::string& name) { return isCalled(shot, name); };
        if (std::ranges::any_of(names, isMeant)) named.insert(i);
        if (shot.isTruth()) continue;
        if (isOfMeans(shot)) ofMeans.insert(i);
        if (!shot.truth.empty()) withTruth.insert(i);
        const auto [name, isNew] = firstName.try_emplace(shot.caseId, shot.baseName);
        if (name->second == shot.baseName) first.insert(i);
    }
    for (const auto* some : {&named, &ofMeans, &withTruth}) {
        if (!some->empty()) return *some;
    }
    return first;
}

std::string imagesHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        if (page.parts[run].shots.empty()) continue;
        html += Pictures(page, run, model).html();
    }
    if (html.empty()) return "";
    std::string says =
        "<span class=\"on-screen\">A click on a picture lays it beside its truth or another "
        "one.</span>";
    const GalleryPlace& place = model.places.front();
    if (place.embedding == GalleryPlace::Embedding::Reduced) {
        says += fmt::format(
            " Of larger pictures this file has copies of {} pixels a side at most; errors are of "
            "the whole ones.",
            place.reducedPx);
    }
    return fmt::format("<h3>Images</h3>\n<p class=\"soft small\">{}</p>\n", says) + html;
}

}  // namespace gfxrepro::report
