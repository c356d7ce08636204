// The pictures of a page as HTML.
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
#include "runner/report/picture_grid.h"
#include "runner/tables/labels.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

namespace {

/// Of a claim that two have one mean: the noisy pictures themselves say less, and stand folded.
bool isOfMeans(const Shot& shot) {
    return shot.baseName.ends_with(metrics::kDifferencesSuffix);
}

/// The pictures of a page, of all runs. The viewer reads what it needs from the data attributes.
class Pictures {
  public:
    Pictures(const Page& page, const Model& model)
        : page_(page),
          all_(shotsOf(page, model)),
          shots_(all_.shots),
          words_(page.parts[all_.runs.front()].table.words) {
        const config::Experiment* experiment = page.parts[all_.runs.front()].experiment;
        const std::set<std::size_t> main =
            mainShots(shots_, experiment ? experiment->shows : std::vector<std::string>());
        main_ = pictureGrid(page, all_, words_, main);
        std::set<std::size_t> shown;
        collect(main_, shown);
        std::set<std::size_t> rest;
        for (std::size_t i = 0; i < shots_.size(); ++i) {
            if (!shown.contains(i) && !isRepeated(i, shown)) rest.insert(i);
        }
        rest_ = pictureGrid(page, all_, words_, rest);
        findTruths();
        if (experiment) findMissing(experiment->shows);
    }

    std::string html() const {
        std::string html = gridHtml(main_);
        std::string further = gridHtml(rest_);
        if (!further.empty() && !html.empty()) {
            further = "<details class=\"further\"><summary>Further pictures of these cases: " +
                      escapeXml(namesOf(rest_)) + "</summary>\n" + further + "</details>\n";
        }
        return html + further + missing_;
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

    std::string idOf(std::size_t i) const {
        return fmt::format("{}-{}-{}", Model::letter(all_.runs[i]), page_.slug, all_.places[i]);
    }

    /// A picture, what it shows, and below it how far it is from its truth.
    std::string figureHtml(std::size_t i, const std::string& says) const {
        const Shot& shot = shots_[i];
        const std::string title = titleOf(i);
        std::string data = fmt::format(
            " id=\"{}\" data-run=\"{}\" data-case=\"{}\" data-title=\"{}\" data-name=\"{}\"",
            escapeXml(idOf(i)), page_.parts.size() > 1 ? Model::letter(all_.runs[i]) : "",
            escapeXml(page_.parts[all_.runs[i]].shots[all_.places[i]].caseId), escapeXml(title),
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
    const PageShots all_;
    const std::vector<Shot>& shots_;
    const tables::Words& words_;
    PictureGrid main_;  // what the page shows first
    PictureGrid rest_;
    std::string missing_;                        // in words
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
    const auto hasNone = [](const RunPart& part) { return part.shots.empty(); };
    if (std::ranges::all_of(page.parts, hasNone)) return "";
    const std::string html = Pictures(page, model).html();
    if (html.empty()) return "";
    std::string says =
        "<span class=\"on-screen\">A click on a picture lays it beside its truth or another "
        "one.</span>";
    if (model.isComparison()) says += " Pictures of one case stand beside each other.";
    const GalleryPlace& place = model.places.front();
    if (place.embedding == GalleryPlace::Embedding::Reduced) {
        says += fmt::format(
            " Of larger pictures this file has copies of {} pixels a side at most; errors are of "
            "the whole ones.",
            place.reducedPx);
    }
    return fmt::format("<h3>Images</h3>\n<p class=\"soft small\">{}</p>\n{}", says, html);
}

}  // namespace gfxrepro::report
