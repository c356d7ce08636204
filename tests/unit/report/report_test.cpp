#include "runner/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/image/png_io.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/records/images.h"
#include "runner/report/markup.h"
#include "runner/report/writers.h"
#include "runner/tables/labels.h"
#include "runner/tables/table.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::report {
namespace {

using records::Status;

const claims::ReportContext kContext{"llvmpipe", "software", "quick", "abc123",
                                     "gfxrepro reproduce"};

const std::string kClaimsHeader = fmt::format("{}\n", fmt::join(claims::kClaimsColumns, ","));

config::Experiment experiment() {
    return tables::withPaperCases(tables::experimentFrom(R"(
sweep: {scene: [models/duck, "<b>&|_%", models/lost]}
layout:
  rows: scene
  columns:
    error: {metric: error, format: "{mean:.2f}/{max:.0f}"}
    draw_ms: {metric: gpu_time_ms, format: "{median:.1f}"}
printed:
  hardware: "Radeon <9800> & co"
  values: |
    scene,error,draw_ms
    models/duck,3.00/106,16.0
claims:
  A: {says: "a < b & \"c\"", bound: draw_ms, at_most: 10, at: {scene: models/duck}, origin: ours, kind: algorithmic}
  B: {says: no, bound: draw_ms, at_most: 1, at: {scene: models/duck}, origin: ours, kind: algorithmic}
  C: {says: maybe, bound: draw_ms, at_most: 1, at: {scene: models/lost}, origin: ours, kind: algorithmic}
assumptions:
  padding: {value: 1, range: [0, 2], unit: voxels, why: "not <said>"}
)"),
                                  {{"models/duck", "{}"}, {"<b>&|_%", "{}"}});
}

tables::Recorded records(double drawMs = 8.0) {
    tables::RecordMaker maker;
    maker.beginCase("models/duck").add("error", {1.0, 1.0, 4.0}).add("gpu_time_ms", {drawMs});
    maker.add("scene_source", {1.0}, "", "enum");
    for (int process = 1; process < 6; ++process) {
        maker.process(process).add("gpu_time_ms", {drawMs});
    }
    maker.beginCase("<b>&|_%").add("error", {2.5}).add("gpu_time_ms", {1.0 / 3.0});
    maker.beginCase("models/lost").fail(Status::Crash, "signal <11>");
    return maker.records();
}

/// What the run came to with these records.
void judge(ReportRun& run, const tables::Recorded& recorded) {
    run.records = recorded;
    run.tables = tables::buildTables(run.experiments, recorded);
    run.claims = claims::evaluateClaims(run.experiments, run.tables, run.context);
    run.curves = drawCurves(run.folder, run.tables, run.experiments);
}

ReportRun runIn(const fs::path& folder, double drawMs = 8.0) {
    ReportRun run{.folder = folder,
                  .context = kContext,
                  .manifest = {{"cpu", "Xeon <script>"},
                               {"scenes", {{"models/duck", {{"kind", "stand-in"}}}}}},
                  .experiments = {experiment()}};
    config::Case& shown = run.cases.emplace_back();
    shown.id = records()[0].caseId;
    shown.experiment = "zju2005/9.9";
    shown.axes = parseYaml("scene: models/duck", "axes");
    run.commands = {{"zju2005/9.9", "gfxrepro reproduce zju2005/9.9 --profile quick"},
                    {shown.id, "gfxrepro run 'a<b'"}};
    run.events = {{shown.id, {"ok"}}};
    judge(run, records(drawMs));
    return run;
}

/// A grey picture, `differing` in one pixel.
image::Image8 picture(std::uint8_t differing) {
    image::Image8 result(8, 8, 3, std::uint8_t{128});
    result.at(0, 0, 0) = differing;
    return result;
}

struct Report : FolderTest {
    /// A report of one run, read back.
    std::string pageOf(const ReportRun& run) const {
        writeReport(folder.path() / "report.html", {&run, 1});
        return readFile(folder.path() / "report.html");
    }
};

TEST_F(Report, IsOneSafeFile) {
    ReportRun run = runIn(folder.path());
    image::writePng(folder.path() / "images/a.png", picture(128));
    records::ImageWriter(folder.path())
        .append({{"case", "zju2005/9.9", 0, "surface", "images/a.png", "",
                  "zju2005/9.9 scene=<img onerror=x>"}});
    const std::string html = pageOf(run);
    for (const char* part : {
             "src=\"data:image/png;base64,iVBORw0KGgo",
             "alt=\"&lt;img, x&gt; · surface\"",
             "<td>Xeon &lt;script&gt;</td>",
             "<td>1 in the place of models that were not at hand <span "
             "class=\"soft\">(models/duck)</span></td>",
             "title=\"&lt;b&gt;&amp;|_%\">&lt;b&gt;&amp;|_%</th>",
             "title=\"models/duck\">duck <abbr title=\"another model in its place\">†</abbr>",
             "<span class=\"badge fails\"><span aria-hidden=\"true\">✗</span> fails</span>",
             "<td title=\"padding\">padding</td><td>1 voxels</td><td>[0, 2]</td><td>not "
             "&lt;said&gt;</td>",
             "<span class=\"status\">crash</span> — signal &lt;11&gt;",
             "cells without a value: 2 crash; 1 of its cases failed",
             "gfxrepro reproduce zju2005/9.9 --profile quick",
             "<pre class=\"command\">gfxrepro run &#39;a&lt;b&#39;</pre>\n<pre class=\"log\">ok",
             "<span class=\"ratio\" title=\"measured ÷ printed\">×0.5</span>",
             "<p class=\"parameters\">Of 2 printed cells of tables 2 were measured again: 2 at the "
             "printed parameters.</p>",
             "<p class=\"parameters\">Measured at the printed parameters.</p>\n<div",
         }) {
        EXPECT_THAT(html, HasSubstr(part));
    }
    for (const char* forbidden : {"<script>alert", "<b>&|", "onerror=x>", "src=\"http",
                                  "href=\"http", "url(http", "@import", "<link rel=\"style"}) {
        EXPECT_THAT(html, Not(HasSubstr(forbidden)));
    }
    // A browser runs its own script alone, and fetches nothing.
    const std::size_t begin = html.find("<script>") + 8, end = html.find("</script>", begin);
    const std::string digits = sha256(html.substr(begin, end - begin));
    std::string digest;
    for (std::size_t i = 0; i < digits.size(); i += 2) {
        digest += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
    }
    EXPECT_THAT(
        html,
        HasSubstr("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "));
    EXPECT_THAT(html, HasSubstr("; script-src 'sha256-" + base64(digest) + "'\">"));
}

TEST_F(Report, SaysWhyAStatementOfTheDocumentIsNotCounted) {
    ReportRun run = runIn(folder.path());
    run.claims[0].origin = config::ClaimSpec::Origin::Document;
    run.claims[0].sameAs = "zju2005/1 A";
    run.claims[0].isRepeat = true;
    run.claims[1].origin = config::ClaimSpec::Origin::Document;
    run.claims[1].verdict = claims::Verdict::Holds;
    run.claims[1].rows = "1 of 2 values of <scene>";
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr(">A, of the document; a time that counts of work decide; counted "
                                "as zju2005/1 A</span>"));
    EXPECT_THAT(html, HasSubstr(">B, of the document; a time that counts of work decide; on 1 of 2 "
                                "values of &lt;scene&gt;</span>"));
    EXPECT_THAT(html, Not(HasSubstr("<li class=\"claim\"")));
}

/// What an input was fitted to is no finding.
TEST_F(Report, MarksWhatIsCalibrated) {
    ReportRun run = runIn(folder.path());
    const std::string legend = "‡ calibrated: an input of ours, at the value that its config gives";
    EXPECT_THAT(pageOf(run), Not(HasSubstr(legend)));
    run.experiments[0] = tables::withPaperCases(tables::experimentFrom(R"(
sweep: {scene: [models/duck, "<b>&|_%", models/lost]}
layout:
  rows: scene
  columns: {draw_ms: {metric: gpu_time_ms, format: "{median:.1f}"}}
printed: {calibrated: [{scene: models/duck}], values: "scene,draw_ms\nmodels/duck,16.0"}
)"),
                                                {{"models/duck", "{}"}});
    judge(run, records());
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr(">8.0 <abbr title=\"calibrated\">‡</abbr>"));
    EXPECT_THAT(html, Not(HasSubstr(">0.3 <abbr")));
    EXPECT_THAT(html, HasSubstr("<p class=\"soft small\">" + legend));
}

TEST_F(Report, MarksTimesThatAreNotOfOneClock) {
    ReportRun run = runIn(folder.path());
    const std::string legend = "timed while the GPU&#39;s clock moved between 0.345 and 1.98 GHz";
    EXPECT_THAT(pageOf(run), Not(HasSubstr(legend)));
    for (const std::string& caseId : run.tables[0].rows[0].cells[0].caseIds) {
        tables::markMovedClocks({{caseId, {0.345e9, 1.98e9}}}, run.tables[0]);
    }
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr(">8.0 <abbr title=\"" + legend + "\">§</abbr>"));
    EXPECT_THAT(html, Not(HasSubstr(">0.3 <abbr")));
    EXPECT_THAT(html, HasSubstr("<p class=\"soft small\">§ " + legend + ".</p>"));
}

/// A number of other parameters is no multiple of what is printed.
TEST_F(Report, NoRatioAtOtherParameters) {
    ReportRun run = runIn(folder.path());
    const Node printed = run.experiments[0].paperCases[0].params;
    run.experiments[0].paperCases[0].params.set("light_grid", Node::number(16));
    judge(run, records());
    std::string html = pageOf(run);
    EXPECT_THAT(html, Not(HasSubstr("class=\"ratio\"")));
    EXPECT_THAT(html, HasSubstr("<p class=\"parameters\">Measured at light grid none (the "
                                "config&#39;s 16).</p>\n<div"));
    EXPECT_THAT(html, HasSubstr(" title=\"at light grid none (the config&#39;s 16)\">8.0"));
    EXPECT_THAT(html, HasSubstr("Of 2 printed cells of tables 2 were measured again: 2 at other "
                                "parameters, which each table names.</p>"));

    run.experiments[0].paperCases[0].params = printed;
    judge(run, records());
    const auto page = [&] { return pageOf(run); };
    EXPECT_THAT(page(), HasSubstr("class=\"ratio\""));
    const auto forAllCells = [&](const auto& change) {
        for (tables::TableRow& row : run.tables[0].rows) std::ranges::for_each(row.cells, change);
    };
    forAllCells([](tables::Cell& cell) { cell.openParameters = {"light_grid"}; });
    EXPECT_THAT(page(), Not(HasSubstr("class=\"ratio\""))) << "of what is not given";
    forAllCells([](tables::Cell& cell) {
        cell.openParameters.clear();
        cell.isCalibrated = true;
    });
    EXPECT_THAT(page(), Not(HasSubstr("class=\"ratio\""))) << "of an input that was fitted to it";

    run.experiments[0].paperCases.clear();  // of a plan of before they were kept
    judge(run, records());
    html = pageOf(run);
    EXPECT_THAT(html, Not(HasSubstr("class=\"ratio\"")));
    EXPECT_THAT(html,
                HasSubstr("<p class=\"parameters\">Whether it was measured at the printed "
                          "parameters is not known: the run&#39;s plan does not have them.</p>"));
}

TEST_F(Report, CellsNameTheirCases) {
    const ReportRun run = runIn(folder.path());
    const std::string html = pageOf(run);
    const std::string anchor = "A-" + run.cases[0].id;
    EXPECT_THAT(html, HasSubstr("data-cases=\"" + anchor.substr(0, anchor.find('{'))));
    EXPECT_THAT(html, HasSubstr("<article class=\"case\" id=\"A-case:models/duck"));
}

TEST_F(Report, ImagesWithATruthGetAFlipMap) {
    const ReportRun run = runIn(folder.path());
    fs::create_directories(folder.path() / "images/x");
    image::writePng(folder.path() / "images/x/result.png", picture(255));
    image::writePng(folder.path() / "images/x/truth.png", picture(128));
    records::ImageWriter(folder.path())
        .append({{"c", "zju2005/9.9", 0, "result", "images/x/result.png", "", "t"},
                 {"c", "zju2005/9.9", 0, "truth", "images/x/truth.png", "", "t", "result"}});
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr("data-name=\"result\" data-truth=\"A-zju2005-9.9-1\""));
    EXPECT_THAT(html, HasSubstr("class=\"error\" data-of=\"A-zju2005-9.9-0\"><img src=\"data:"));
    EXPECT_THAT(html, ContainsRegex("FLIP 0\\.[0-9]+ to truth"));
    EXPECT_THAT(html, Not(HasSubstr("FLIP 0.0000")));
    const image::Image8 map = image::readPng8(folder.path() / "thumbnails/x/result-flip.png");
    EXPECT_EQ(map.width(), 8);
    EXPECT_GT(int{map.at(0, 0, 0)}, 40) << "the pixel that differs";
    EXPECT_LT(int{map.at(7, 7, 0)}, int{map.at(0, 0, 0)});
}

TEST_F(Report, LargeGalleriesLieBesideThePage) {
    const ReportRun run = runIn(folder.path());
    image::Image8 noise(600, 620, 3);  // a megabyte, taken 20 times
    std::uint32_t state = 1;
    for (std::uint8_t& value : noise.values()) {
        state = state * 1664525U + 1013904223U;
        value = static_cast<std::uint8_t>(state >> 24U);
    }
    fs::create_directories(folder.path() / "images");
    image::writePng(folder.path() / "images/a b#1.png", noise);
    for (int i = 1; i <= 20; ++i) {
        const std::string name = fmt::format("images/a b#{}.png", i);
        if (i > 1) {
            fs::create_hard_link(folder.path() / "images/a b#1.png", folder.path() / name);
        }
        records::ImageWriter(folder.path())
            .append({{"case", "zju2005/9.9", 0, std::to_string(i), name, "", "t"}});
    }
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr("<img src=\"thumbnails/a%20b%231.png\""));
    EXPECT_THAT(html, HasSubstr("data-full=\"images/a%20b%231.png\""));
    EXPECT_LT(html.size(), 150'000U);
    const image::Image8 thumbnail = image::readPng8(folder.path() / "thumbnails/a b#1.png");
    EXPECT_EQ(thumbnail.width(), 495);
    EXPECT_EQ(thumbnail.height(), 512);
    EXPECT_NEAR(thumbnail.at(80, 80, 0), 150, 100) << "the mean light of some random values";
}

TEST_F(Report, EmbedsEveryPictureWhereItIsAsked) {
    const TemporaryFolder out;
    const ReportRun run = runIn(folder.path());
    image::Image8 noise(600, 620, 3);
    std::uint32_t state = 1;
    for (std::uint8_t& value : noise.values()) {
        state = state * 1664525U + 1013904223U;
        value = static_cast<std::uint8_t>(state >> 24U);
    }
    for (int i = 1; i <= 20; ++i) {  // a megabyte each: more than a page takes unasked
        const std::string name = fmt::format("images/{}.png", i);
        fs::create_directories(folder.path() / "images");
        image::writePng(folder.path() / name, noise);
        records::ImageWriter(folder.path())
            .append(
                {{"case", "zju2005/9.9", 0, std::to_string(i), name, "", "t", i == 1 ? "2" : ""}});
    }
    writeReport(out.path() / "one.html", {&run, 1}, {{}, true});
    const std::string html = readFile(out.path() / "one.html");
    std::size_t images = 0;
    for (std::size_t at = html.find("<img src=\""); at != html.npos;
         at = html.find("<img src=\"", at + 1)) {
        EXPECT_EQ(html.compare(at, 32, "<img src=\"data:image/png;base64,"), 0);
        ++images;
    }
    EXPECT_EQ(images, 21U) << "with the error map of the second";
    EXPECT_THAT(html, Not(HasSubstr("data-full=")));
    EXPECT_THAT(html, HasSubstr("width=\"309\" height=\"319\""));
    int files = 0;
    for (const auto& file : fs::directory_iterator(out.path())) {
        EXPECT_EQ(file.path().filename(), "one.html");
        ++files;
    }
    EXPECT_EQ(files, 1);
    EXPECT_FALSE(fs::exists(folder.path() / "thumbnails"));
}

/// A picture of its own brightness.
image::Image8 grey(std::uint8_t value) {
    return image::Image8(8, 8, 3, value);
}

/// Two scenes by two methods, one truth a scene, two measures of each picture.
TEST_F(Report, PicturesLieAsTheTable) {
    ReportRun run = runIn(folder.path());
    run.experiments = {tables::experimentFrom(R"(
sweep: {scene: [models/duck, models/hugo], method: [coarse, fine]}
layout:
  axes: {measure: {error: {metric: error}, voxels: {metric: voxels}}}
  rows: [scene, measure]
  columns: method
)")};
    tables::RecordMaker maker;
    std::vector<records::ImageEntry> images;
    for (const char* scene : {"models/duck", "models/hugo"}) {
        for (const char* method : {"coarse", "fine"}) {
            maker.beginCase(scene, fmt::format(R"({{"method":"{}"}})", method)).add("error", {1.0});
            const std::string id = maker.records().back().caseId;
            for (const bool isTruth : {false, true}) {
                const std::string file = fmt::format("images/{}.png", images.size());
                fs::create_directories(folder.path() / "images");
                const auto value = static_cast<std::uint8_t>(isTruth ? scene[7] : images.size());
                image::writePng(folder.path() / file, grey(value));
                images.push_back({id, "zju2005/9.9", 0, isTruth ? "truth" : "result", file, "",
                                  fmt::format("zju2005/9.9 {} {}", scene, method),
                                  isTruth ? "result" : ""});
            }
        }
    }
    judge(run, maker.records());
    records::ImageWriter(folder.path()).append(images);
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr("<th scope=\"col\">truth</th><th scope=\"col\">coarse</th><th "
                                "scope=\"col\">fine</th></tr></thead>"));
    std::vector<std::string> order;
    for (const char* part :
         {">duck</th></tr>", "data-title=\"models/duck coarse\" data-name=\"truth\"",
          "data-title=\"models/duck coarse\" data-name=\"result\"",
          "data-title=\"models/duck fine\" data-name=\"result\"", ">hugo</th></tr>",
          "data-title=\"models/hugo coarse\" data-name=\"truth\"",
          "data-title=\"models/hugo fine\" data-name=\"result\""}) {
        ASSERT_THAT(html, HasSubstr(part));
        order.push_back(fmt::format("{:09}", html.find(part)));
    }
    EXPECT_TRUE(std::ranges::is_sorted(order)) << testing::PrintToString(order);
    EXPECT_THAT(html, Not(HasSubstr("data-title=\"models/duck fine\" data-name=\"truth\"")))
        << "the truth of both stands once";
}

/// What the document shows comes first; the other pictures of the cases are folded.
TEST_F(Report, ShowsTheDocumentsPicturesAndFoldsTheOthers) {
    ReportRun run = runIn(folder.path());
    const std::string id = run.records[0].caseId;
    fs::create_directories(folder.path() / "images");
    std::vector<records::ImageEntry> images;
    for (const char* name : {"result", "truth", "classes_0", "reflection"}) {
        const std::string file = fmt::format("images/{}.png", name);
        image::writePng(folder.path() / file, grey(static_cast<std::uint8_t>(40 + images.size())));
        images.push_back({id, "zju2005/9.9", 0, name, file, "", "t",
                          std::string(name) == "truth" ? "result" : ""});
    }
    records::ImageWriter(folder.path()).append(images);
    const auto orderOf = [&](const std::vector<std::string>& shows) {
        run.experiments[0].shows = shows;
        const std::string html = pageOf(run);
        std::map<std::size_t, std::string> order;
        for (const char* name : {"result", "truth", "classes_0", "reflection"}) {
            order[html.find(fmt::format("data-name=\"{}\"", tables::shownName(name)))] = name;
        }
        order[html.find("<summary>Further pictures")] = "|";
        std::string text;
        for (const auto& [at, name] : order) text += name + ' ';
        return text;
    };
    EXPECT_EQ(orderOf({}), "truth result | classes_0 reflection ");
    EXPECT_EQ(orderOf({"classes"}), "classes_0 | truth result reflection ");
    EXPECT_EQ(orderOf({"no_such"}), "truth result | classes_0 reflection ");
    EXPECT_THAT(readFile(folder.path() / "report.html"),
                HasSubstr("None of these cases saved the picture 'no_such', which `shows` names; "
                          "they saved classes_0, reflection, result, truth."));
}

TEST_F(Report, HeadsOfSeveralLevelsAndLabelsStandOnce) {
    ReportRun run = runIn(folder.path());
    run.experiments = {tables::experimentFrom(R"(
sweep: {scene: [outdoor/bird_nest], padding: [1, 2], method: [one_layer, two_layers]}
layout:
  axes: {measure: {mean: {metric: error}, draw_ms: {metric: gpu_time_ms}}}
  rows: [scene, padding]
  columns: [method, measure]
)")};
    tables::RecordMaker maker;
    for (const int padding : {1, 2}) {
        for (const char* method : {"one_layer", "two_layers"}) {
            maker
                .beginCase("outdoor/bird_nest",
                           fmt::format(R"({{"padding":{},"method":"{}"}})", padding, method))
                .add("error", {1.0})
                .add("gpu_time_ms", {2.0});
        }
    }
    judge(run, maker.records());
    const std::string html = pageOf(run);
    for (const char* part : {
             "<th class=\"group\" scope=\"colgroup\" colspan=\"2\">one layer</th><th "
             "class=\"group\" scope=\"colgroup\" colspan=\"2\">two layers</th>",
             "title=\"one_layer_draw_ms\">draw <span class=\"sub\">[ms]</span>",
             "<th scope=\"rowgroup\" class=\"first\" rowspan=\"2\" "
             "title=\"outdoor/bird_nest\">bird nest</th>",
         }) {
        EXPECT_THAT(html, HasSubstr(part));
    }
    EXPECT_EQ(html.find(">bird nest</th>"), html.rfind(">bird nest</th>"));
}

TEST_F(Report, LabelsAreReadForNames) {
    ReportRun run = runIn(folder.path());
    run.experiments[0].labels = {
        {"scene", "model"}, {"models/duck", "rubber duck"}, {"draw_ms", "time to draw"}};
    run.experiments[0].claims[0].boundFrom = config::ClaimSpec::BoundSource::Print;
    judge(run, records());
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr("title=\"scene\">model</th>"));
    EXPECT_THAT(html, HasSubstr("title=\"models/duck\">rubber duck"));
    EXPECT_THAT(html, HasSubstr(">time to draw <span"));
    EXPECT_THAT(html, HasSubstr("<span class=\"soft\">asked for </span>time to draw [ms] ≤ 10 (the "
                                "bound is from the printed numbers)</p>"));
    EXPECT_THAT(html, Not(HasSubstr(">rests on <"))) << "that none was tried is said once";
    EXPECT_THAT(html, HasSubstr("title=\"&lt;b&gt;&amp;|_%\">&lt;b&gt;&amp;|_%</th>"))
        << "what has none stays";
}

/// Before the numbers what became of the statements, each a click away.
TEST_F(Report, APageBeginsWithItsVerdict) {
    ReportRun run = runIn(folder.path());
    run.experiments[0].claims[0].origin = config::ClaimSpec::Origin::Document;
    run.experiments[0].claims[1].origin = config::ClaimSpec::Origin::Document;
    run.experiments[0].claims[1].timeKind = config::ClaimSpec::TimeKind::Architectural;
    run.experiments[0].printed.remark = "misprinted";
    judge(run, records());
    const std::string html = pageOf(run);
    std::size_t at = html.find("<section class=\"page\" id=\"zju2005-9.9\">");
    for (const char* part : {
             "<p class=\"verdict-line\">Of 2 statements of the document 1 holds <a class=\"mark "
             "holds\" href=\"#zju2005-9.9:A\" title=\"a &lt; b &amp; &quot;c&quot;\" "
             "aria-label=\"holds: a &lt; b &amp; &quot;c&quot;\">✓</a>, 1 asks for a GPU <a "
             "class=\"mark not-applicable\" href=\"#zju2005-9.9:B\"",
             "Of 1 further claim that is not counted 1 was not measured ",
             "<table class=\"results\">",
             "<summary>Remarks: ",
             "misprinted",
             "<li class=\"claim\" id=\"zju2005-9.9:A\"",
             "<p><span class=\"soft\">measured </span>8",
             "<li class=\"claim\" id=\"zju2005-9.9:B\"",
             "<span class=\"soft\">measured </span>8",  // beside what it asks of a GPU
             "<span class=\"soft\">asked for </span>draw [ms] ≤ 1",
         }) {
        const std::size_t next = html.find(part, at);
        ASSERT_NE(next, html.npos) << part;
        at = next;
    }
}

/// Of cells at the printed parameters how near they come: a sentence, points that lead to them,
/// CSV.
TEST_F(Report, SaysHowNearADocumentsNumbersCome) {
    ReportRun run = runIn(folder.path());
    run.experiments.push_back(run.experiments[0]);  // else its page comes first, and has all
    run.experiments[1].id = "zju2005/9.8";
    run.experiments[1].kind = config::ExperimentKind::Figure;
    judge(run, records());
    const std::string html = pageOf(run);
    for (const char* part : {
             "How near: 1 printed number that is no time was measured at the parameters that the "
             "document gives: none lies within 10 % of the printed one, 1 within a factor of 2. Of "
             "1 time or rate, printed on another machine, none lies within 10 % of the printed "
             "one, 1 within a factor of 2.",
             "<a href=\"#A-zju2005-9.9-0-1\" tabindex=\"-1\"><circle ",
             "<title>Table 9.9, duck: draw [ms]: 8 measured, 16 printed, ×0.5</title>",
             " id=\"A-zju2005-9.9-0-1\"",
             "<a download=\"zju2005-nearness.csv\" href=\"data:text/csv;base64,",
         }) {
        EXPECT_THAT(html, HasSubstr(part));
    }
    writeNearness(folder.path(), run.experiments, run.tables);
    const std::string csv = readFile(folder.path() / "nearness.csv");
    EXPECT_THAT(csv, HasSubstr("zju2005/9.9,scene=models/duck,draw_ms,16,8,0.5,yes,no,yes\n"));
    EXPECT_THAT(html, HasSubstr(base64(csv))) << "of one document the same";

    run.experiments[0].paperCases[0].params.set("light_grid", Node::number(16));
    judge(run, records());
    EXPECT_THAT(pageOf(run), Not(HasSubstr("How near")));
    writeNearness(folder.path(), run.experiments, run.tables);
    EXPECT_FALSE(fs::exists(folder.path() / "nearness.csv"));
}

/// The steps of a frame stand behind what they come to.
TEST_F(Report, OfAnOwnSweepTheStepsAreFolded) {
    const auto file =
        folder.write("s.yaml", "sweep_of: s\ntitle: Mine\ntechnique: x\nsweep: {size: [1, 2]}\n");
    ReportRun run = runIn(folder.path());
    run.experiments = {config::loadExperiment(file, {}, folder.path())};
    tables::RecordMaker maker("sweep/s");
    for (const int size : {1, 2}) {
        maker.beginCase("", fmt::format("{{\"size\": {}}}", size)).lane("timing");
        maker.add("gpu_time_ms", {0.25 * size}, "draw").add("wall_time_ms", {0.5 * size});
        maker.add("error", {1.0 * size}, "", "1");
    }
    const tables::Recorded recorded = maker.records();
    judge(run, recorded);
    const std::string html = pageOf(run);
    const std::size_t folded =
        html.find("<details class=\"steps\"><summary>Times of 1 step of a frame");
    ASSERT_NE(folded, html.npos);
    EXPECT_LT(html.find("title=\"error\">"), folded);
    EXPECT_LT(html.find("title=\"frame_ms\">"), folded);
    EXPECT_GT(html.find("title=\"draw_ms\">"), folded);
    EXPECT_EQ(html.find("title=\"draw_ms\">"), html.rfind("title=\"draw_ms\">"));
}

/// What a chapter holds and what it does not, in words, with the pictures that show it.
TEST_F(Report, FirstScreenSaysWhatReproduced) {
    ReportRun run = runIn(folder.path());
    run.experiments.push_back(run.experiments[0]);
    run.experiments[1].id = "zju2005/figure-1";
    for (config::Experiment& one : run.experiments) {
        for (config::ClaimSpec& claim : one.claims) {
            claim.origin = config::ClaimSpec::Origin::Document;
        }
    }
    run.experiments[0].claims[1].because = {{"fails", std::nullopt, std::nullopt, std::nullopt,
                                             "the time is of another machine", "zju2005.md#b"}};
    fs::create_directories(folder.path() / "images");
    image::writePng(folder.path() / "images/a.png", grey(100));
    records::ImageWriter(folder.path())
        .append({{"case", "zju2005/9.9", 0, "surface_0", "images/a.png", "", "t"}});
    const config::Document document{
        "zju2005", "Thesis on <models>", {{"Later", {"9.9"}}, {"Earlier", {"figure-1"}}}};
    run.context.tried[{"zju2005/9.9", "A"}] = {claims::Verdict::Holds, "padding (of 3 tried)"};
    judge(run, records());
    const fs::path findings = folder.path().parent_path() / "a b";
    writeReport(folder.path() / "report.html", {&run, 1}, {{document}, false, {}, findings});
    const std::string html = readFile(folder.path() / "report.html");
    writeReport(folder.path() / "sent.html", {&run, 1}, {{document}, true, {}, findings});
    EXPECT_THAT(readFile(folder.path() / "sent.html"),
                HasSubstr("shown by </span>results/findings/zju2005.md#b</p>"));
    EXPECT_THAT(html, HasSubstr("<figcaption>surface 0 · t</figcaption>"));
    std::size_t at = 0;
    for (const char* part : {
             "llvmpipe on Xeon &lt;script&gt; · quick profile · commit abc123 · 2 experiments",
             "<h2>zju2005. Thesis on &lt;models&gt;</h2>",
             "<span class=\"holds\"",
             "<span class=\"fails\"",
             "could be judged here",
             "Of those that hold, 1 rests on a value of ours that the document leaves open. ",
             "</span> <a href=\"#zju2005-9.9\">Table 9.9</a> A table: “no”</li>",
             "<span>Later</span>",
             "<span>Earlier</span>",
             "<div class=\"highlights\">",
             "<h3>What the verdicts mean</h3>",
             "<h2>Every claim, in words</h2>",
             "<h3>Later</h3>",
             "<span class=\"says\">no</span> <span class=\"soft code\"><a "
             "href=\"#zju2005-9.9:B\">B</a>, of the document; a time that counts of work "
             "decide</span>\n<p><span class=\"soft\">why: </span>",
             "the time is of another machine (",
             "<h3>Earlier</h3>",
             "<p><span class=\"soft\">shown by </span><a "
             "href=\"../a%20b/zju2005.md#b\">results/findings/zju2005.md#b</a></p>",
         }) {
        const std::size_t next = html.find(part, at);
        ASSERT_NE(next, html.npos) << part;
        at = next;
    }
}

/// One number of a picture on a page: the table's.
TEST_F(Report, TheErrorBelowAPictureIsTheRecordedOne) {
    ReportRun run = runIn(folder.path());
    const std::string id = records()[0].caseId;
    image::writePng(folder.path() / "images/a.png", picture(128));
    image::writePng(folder.path() / "images/t.png", picture(0));
    records::ImageWriter(folder.path())
        .append({{id, "zju2005/9.9", 0, "surface", "images/a.png", "", "duck"},
                 {id, "zju2005/9.9", 0, "truth", "images/t.png", "", "duck", "surface"}});
    tables::RecordMaker maker;
    maker.beginCase("models/duck").add("flip", {0.1234}, "surface", "1");
    run.records.push_back(maker.records().back());
    run.records.back().caseId = id;
    EXPECT_THAT(pageOf(run), HasSubstr("<figcaption>error: FLIP 0.1234 to truth</figcaption>"));
}

TEST_F(Report, WhatIsWithinTheNoiseIsGrey) {
    ReportRun run = runIn(folder.path());
    run.tables[0].notes = {"A is faster than B.", "C and B cannot be told apart."};
    run.tables[0].toldNotes = 1;
    run.tables[0].rows[0].cells[1].isWithinNoise = true;
    const std::string html = pageOf(run);
    EXPECT_THAT(html, HasSubstr("<p class=\"told\">A is faster than B.</p>"));
    EXPECT_LT(html.find("A is faster than B."), html.find("<table class=\"results\">"));
    EXPECT_THAT(
        html,
        HasSubstr(
            "<summary>Remarks: 1</summary>\n<p><span class=\"soft\"></span>C and B cannot be"));
    EXPECT_THAT(html, ContainsRegex("<td class=\"num soft\"[^>]*>8.0"));
    EXPECT_THAT(html, HasSubstr("a grey ratio is within the noise"));
}

TEST_F(Report, RunsStandSideBySide) {
    const TemporaryFolder a, b, out;
    std::vector<ReportRun> runs = {runIn(a.path()), runIn(b.path(), 12.0)};
    runs[1].experiments[0].paperCases[0].params.set("light_grid", Node::number(16));
    judge(runs[1], records(12.0));
    runs[1].tables[0].notes.emplace_back("Noise of this one.");
    writeReport(out.path() / "both.html", runs);
    const std::string html = readFile(out.path() / "both.html");
    EXPECT_THAT(html, HasSubstr("<th class=\"sub\" scope=\"col\">printed</th><th class=\"sub\" "
                                "scope=\"col\">A</th><th class=\"sub\" scope=\"col\">B</th>"));
    EXPECT_THAT(html,
                HasSubstr("<li class=\"claim uncounted differs\" data-verdict=\"holds fails\""))
        << "claim A, 8 against 12";
    for (const char* part : {
             "<p class=\"parameters\"><b>A</b> Of 2 printed cells of tables 2 were measured again: "
             "2 at the printed parameters.</p>",
             "<p class=\"parameters\"><b>B</b> Of 2 printed cells of tables 2 were measured again: "
             "2 at other parameters, which each table names.</p>",
             "<p class=\"parameters\"><b>A</b> Measured at the printed parameters.</p>\n"
             "<p class=\"parameters\"><b>B</b> Measured at light grid none (the config&#39;s "
             "16).</p>",
             "×0.5</span>",  // 8 of 16
             "<span class=\"soft\">B: </span>Noise of this one.</p>",
         }) {
        EXPECT_THAT(html, HasSubstr(part));
    }
    EXPECT_THAT(html, Not(HasSubstr("×0.75</span>"))) << "12 of 16, at other parameters";
    EXPECT_THAT(html, HasSubstr("<b>A</b> quick, llvmpipe"));
    EXPECT_THAT(html, HasSubstr("<p class=\"told differences\">1 of 3 verdicts differ:</p>"));
    EXPECT_THAT(html, HasSubstr("<span class=\"ratio of-runs\">÷ A 1.5"));
    EXPECT_LT(html.find("<section class=\"page\" id=\"zju2005-9.9\">"),
              html.find("<section class=\"page\" id=\"overview\">"))
        << "runs of one table open on its numbers";
}

TEST_F(Report, IdsAreUniqueAlsoWithCurvesOfSeveralRuns) {
    const TemporaryFolder a, b, out;
    std::vector<ReportRun> runs = {runIn(a.path()), runIn(b.path(), 12.0)};
    const config::PlotSpec plot{.x = "error", .y = {"draw_ms"}};
    for (ReportRun& run : runs) {
        run.experiments[0].plots = {plot, plot};
    }
    writeReport(out.path() / "both.html", runs);
    const std::string html = readFile(out.path() / "both.html");
    std::set<std::string> ids;
    std::size_t curves = 0;
    for (std::size_t at = 0; (at = html.find(" id=\"", at)) != html.npos;) {
        at += 5;
        const std::string id = html.substr(at, html.find('"', at) - at);
        EXPECT_TRUE(ids.insert(id).second) << id << " twice";
    }
    for (std::size_t at = 0; (at = html.find("<figure class=\"curve\"><svg", at)) != html.npos;
         ++at) {
        ++curves;
    }
    EXPECT_EQ(curves, 2U) << "a plot is one figure of all runs";
    EXPECT_THAT(html, HasSubstr("<figcaption>A table</figcaption>"));
}

TEST_F(Report, KeptVerdictsStandBesideARun) {
    const TemporaryFolder a, kept;
    const auto file = kept.write(
        "claims.csv",
        kClaimsHeader +
            "A,,zju2005/9.9,gpu,quick,,,,fails,,12,draw_ms ≤ 10,-2,,,bias (of 3 tried),,,\n"
            "Z,,zju2005/1.1,gpu,quick,,,,holds,,1,x,1,,,,,,\n");
    ReportRun other;
    other.folder = kept.path();
    other.context = kContext;
    other.manifest = nlohmann::ordered_json::object();
    other.claims = claims::readClaims(file);
    const std::vector<ReportRun> runs = {other, runIn(a.path())};
    writeReport(a.path() / "both.html", runs);
    const std::string html = readFile(a.path() / "both.html");
    EXPECT_THAT(html, HasSubstr("<span class=\"says\">a &lt; b &amp; &quot;c&quot;</span>"));
    EXPECT_THAT(html, HasSubstr("<section class=\"page\" id=\"zju2005-1.1\">"));
    EXPECT_THAT(html, HasSubstr("<span class=\"soft\">rests on </span>bias (of 3 tried)</p>"));
}

TEST_F(Report, RefusesVerdictsThatAreNone) {
    const auto errorOf = [&](const std::string& text) {
        const auto file = folder.write("claims.csv", text);
        return errorText([&] { claims::readClaims(file); }, folder.path());
    };
    EXPECT_EQ(errorOf(kClaimsHeader + "A,,t,,,,,,perhaps,,,,,,,,,,\n"),
              "DIR/claims.csv:2: 'perhaps' is no verdict (holds, fails, ambiguous, not-applicable, "
              "unmeasured)");
    EXPECT_EQ(errorOf("claim,table,verdict\nA,t,holds\n"),
              "DIR/claims.csv:1: the columns are claim,table,verdict; allowed: "
              "claim,says,table,device,profile,origin,bound_from,kind,verdict,known,measured,"
              "required,margin,reason,because,rests_on,rows,holds_on,same_as");
}

TEST_F(Report, RunsThatAreKeptAreReadBack) {
    const std::string header =
        "table,commit,started,class,device,gl,cpu,cores,scans,parameters,command\n";
    const auto file = folder.write(
        "runs.csv", header + "p/1,0a1b,2026-01-02T03:04:05Z,gpu,\"A, B\",4.5,C,16,s t,,gfxrepro\n");
    const std::vector<claims::KeptRun> runs = claims::readKeptRuns(file);
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_EQ(runs[0].device, "A, B");
    EXPECT_EQ(runs[0].cores, 16);
    EXPECT_THAT(runs[0].scans, ElementsAre("s", "t"));
    EXPECT_EQ(runs[0].command, "gfxrepro");
    folder.write("runs.csv", header + "p/1,0a1b,,gpu,A,4.5,C,many,,,\n");
    EXPECT_EQ(errorText([&] { claims::readKeptRuns(file); }, folder.path()),
              "DIR/runs.csv:2: cores: 'many' is no number");
}

}  // namespace
}  // namespace gfxrepro::report
