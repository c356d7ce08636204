// How near a document's numbers were met: a sentence, and a plot whose points lead to the cells.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/records/csv.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/report/svg.h"
#include "runner/report/writers.h"
#include "runner/tables/labels.h"
#include "runner/tables/nearness.h"

namespace gfxrepro::report {

using tables::NearCell;

namespace {

/// A table's points, of one kind.
struct NearRow {
    const Page* page;
    std::size_t run;
    std::vector<NearCell> cells;
};

/// "bird nest, light to scene 0.5".
std::string rowWords(const tables::Table& table, std::size_t row) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < table.rowAxes.size(); ++i) {
        words.push_back(
            tables::shownValue(table.rowAxes[i], table.rows[row].labels[i], table.words));
    }
    return joined(words);
}

std::string columnWords(const tables::Table& table, std::size_t column) {
    return tables::quantityOf(table.columns[column], table.words).text();
}

/// Draws them on one axis, a line a table: numbers above, times below.
class NearDrawing {
  public:
    NearDrawing(const std::vector<NearRow>& numbers, const std::vector<NearRow>& times)
        : groups_{{"Numbers that are no times", &numbers}, {"Times and rates", &times}} {
        std::vector<double> ratios = {tables::kTwiceLow / 1.5, 1.5 * tables::kTwiceHigh};
        double widest = 0.0;
        for (const auto& [name, rows] : groups_) {
            for (const NearRow& row : *rows) {
                widest = std::max(widest, textWidth(row.page->label));
                for (const NearCell& cell : row.cells) ratios.push_back(cell.ratio());
            }
        }
        plane_.x = axisOf(ratios, true, false);
        plane_.left = widest + 10.0;
        plane_.width = kNarrowPx - plane_.left - 10.0;
    }

    std::string draw(const std::string& title) {
        std::string content;
        for (const auto& [name, rows] : groups_) {
            if (rows->empty()) continue;
            end_ += kLinePx;
            content += svgText(plane_.left + 6.0, end_ - 4.0, "start", name, "font-weight=\"600\"");
            for (const NearRow& row : *rows) content += rowSvg(row);
            end_ += 6.0;
        }
        const std::vector<Tick> ticks = ticksOf(plane_.x, plane_.width, Along::X);
        plane_.height = end_;
        content = band(tables::kTwiceLow, tables::kTwiceHigh) +
                  band(tables::kTenthLow, tables::kTenthHigh) + middle() +
                  axesSvg(plane_, ticks, {}) + content;
        content += svgText(plane_.left + 0.5 * plane_.width, end_ + 36.0, "middle",
                           "measured ÷ printed; bands: 10 %, factor 2");
        return svgElement(kNarrowPx, end_ + 42.0, title, content);
    }

  private:
    std::string band(double low, double high) const {
        const double left = plane_.xOf(low);
        return fmt::format(
            "<rect x=\"{:.5g}\" y=\"0\" width=\"{:.5g}\" height=\"{:.5g}\" "
            "fill-opacity=\".09\"/>\n",
            left, plane_.xOf(high) - left, plane_.height);
    }
    std::string middle() const {
        return svgLine(plane_.xOf(1.0), 0.0, plane_.xOf(1.0), plane_.height,
                       "stroke=\"currentColor\" stroke-opacity=\".5\"");
    }
    /// Points that would cover each other stand above and below.
    std::string rowSvg(const NearRow& row) {
        constexpr double kRadius = 2.6, kStep = 5.0, kLeast = 15.0, kMost = 44.0;
        std::map<int, std::vector<const NearCell*>> heaps;
        std::size_t most = 1;
        for (const NearCell& cell : row.cells) {
            auto& heap = heaps[static_cast<int>(std::floor(xOf(cell) / kStep))];
            heap.push_back(&cell);
            most = std::max(most, heap.size());
        }
        const double height = std::clamp(kStep * static_cast<double>(most) + 5.0, kLeast, kMost);
        const double step =
            most > 1 ? std::min(kStep, (height - 5.0) / static_cast<double>(most)) : 0.0;
        const double y = end_ + 0.5 * height;
        std::string svg = fmt::format("<a href=\"#{}\">{}</a>\n", escapeXml(row.page->slug),
                                      svgText(plane_.left - 8.0, y + 4.0, "end", row.page->label,
                                              "text-decoration=\"underline\""));
        const tables::Table& table = row.page->parts[row.run].table;
        for (const auto& [place, heap] : heaps) {
            for (std::size_t i = 0; i < heap.size(); ++i) {
                const double side = i % 2 == 0 ? 0.5 : -0.5;
                const double up = side * step * static_cast<double>(i + i % 2);
                const NearCell& cell = *heap[i];
                svg += fmt::format(
                    "<a href=\"#{}\" tabindex=\"-1\"><circle cx=\"{:.5g}\" cy=\"{:.5g}\" r=\"{}\" "
                    "fill=\"{}\" fill-opacity=\".75\"><title>{}</title></circle></a>\n",
                    cellAnchor(*row.page, row.run, cell.row, cell.column), xOf(cell), y + up,
                    kRadius, cell.isTime ? "#d55e00" : "#1f77c9",
                    escapeXml(fmt::format("{}, {}: {}: {:.6g} measured, {:.6g} printed, ×{:.3g}",
                                          row.page->label, rowWords(table, cell.row),
                                          columnWords(table, cell.column), cell.measured,
                                          cell.printed, cell.ratio())));
            }
        }
        end_ += height;
        return svg;
    }
    /// What is 0 or of another sign stands at the left edge.
    double xOf(const NearCell& cell) const {
        return plane_.x.shows(cell.ratio()) ? plane_.xOf(cell.ratio()) : plane_.left;
    }

    std::vector<std::pair<const char*, const std::vector<NearRow>*>> groups_;
    Plane plane_;
    double end_ = 0.0;
};

constexpr std::string_view kNearColumns =
    "table,row,column,printed,measured,ratio,is_time,within_10_percent,within_factor_2\n";

void addCsv(const tables::Table& table, const tables::Nearness& near, std::string& text) {
    const auto yes = [](bool is) { return is ? "yes" : "no"; };
    for (const NearCell& cell : near.cells) {
        records::CsvRow row(text);
        row.text(table.id).text(table.rowName(cell.row)).text(table.columns[cell.column].label);
        row.number(cell.printed).number(cell.measured).number(cell.ratio()).text(yes(cell.isTime));
        row.text(yes(cell.isWithin(tables::kTenthLow, tables::kTenthHigh)));
        row.text(yes(cell.isWithin(tables::kTwiceLow, tables::kTwiceHigh))).end();
    }
}

}  // namespace

std::string cellAnchor(const Page& page, std::size_t run, std::size_t row, std::size_t column) {
    return escapeXml(fmt::format("{}-{}-{}-{}", Model::letter(run), page.slug, row, column));
}

std::string nearnessHtml(const DocumentPages& document, const Model& model, std::size_t run) {
    std::vector<tables::Nearness> all;
    std::vector<NearRow> numbers, times;
    std::string csv(kNearColumns);
    for (const Page* page : document.pages()) {
        const RunPart& part = page->parts[run];
        if (!part.experiment) continue;
        all.push_back(tables::nearnessOf(*part.experiment, part.table));
        addCsv(part.table, all.back(), csv);
        NearRow number{page, run, {}}, time = number;
        for (const NearCell& cell : all.back().cells) {
            (cell.isTime ? time : number).cells.push_back(cell);
        }
        if (!number.cells.empty()) numbers.push_back(std::move(number));
        if (!time.cells.empty()) times.push_back(std::move(time));
    }
    const std::string line = tables::nearnessLine(all);
    if (line.empty()) return "";
    return fmt::format(
        "<figure class=\"near\">{}<figcaption>{}{} A point leads to its cell. <a "
        "download=\"{}.csv\" "
        "href=\"data:text/csv;base64,{}\">As CSV</a></figcaption></figure>\n",
        NearDrawing(numbers, times)
            .draw(fmt::format("{}: measured ÷ printed, by table", document.id)),
        model.boldLetter(run), escapeXml(line), escapeXml(document.id + "-nearness"), base64(csv));
}

void writeNearness(const std::filesystem::path& runDir,
                   const std::vector<config::Experiment>& experiments,
                   const std::vector<tables::Table>& tables) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    std::string csv(kNearColumns);
    for (std::size_t i = 0; i < tables.size(); ++i) {
        addCsv(tables[i], tables::nearnessOf(experiments[i], tables[i]), csv);
    }
    const std::filesystem::path file = runDir / "nearness.csv";
    if (csv.size() > kNearColumns.size()) {
        writeFileAtomic(file, csv);
    } else {
        std::filesystem::remove(file);  // of results before these
    }
}

}  // namespace gfxrepro::report
