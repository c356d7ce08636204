#include "runner/report/report.h"

#include <fmt/format.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/records/records.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

// What the pages show.

namespace {

/// Beyond this the images stay files of their own: browsers open larger pages badly.
constexpr std::uintmax_t kEmbeddedImagesBytes = 20'000'000;

std::uintmax_t imagesBytes(const ReportRun& run) {
    std::uintmax_t total = 0;
    for (const records::ImageEntry& image : records::readImages(run.folder)) {
        std::error_code isAbsent;
        const std::uintmax_t size = fs::file_size(run.folder / image.png, isAbsent);
        if (!image.png.empty() && !isAbsent) total += size;
    }
    return total;
}

/// The cases of a table whose last record of a process is no measurement.
std::vector<Failure> failuresOf(const std::string& table,
                                const std::vector<records::Record>& records) {
    std::map<std::pair<std::string, int>, const records::Record*> last;
    std::vector<std::pair<std::string, int>> order;
    for (const records::Record& record : records) {
        if (record.table != table) continue;
        const auto [place, isNew] = last.try_emplace({record.caseId, record.process}, &record);
        if (isNew) order.push_back(place->first);
        place->second = &record;
    }
    std::vector<Failure> failures;
    for (const auto& key : order) {
        const records::Record& record = *last[key];
        if (record.status == records::Status::Ok) continue;
        std::string name = record.scene;
        if (!record.method.empty()) name += (name.empty() ? "" : ", ") + record.method;
        failures.push_back(
            {record.caseId, name.empty() ? table : name, record.status, record.message});
    }
    return failures;
}

/// The page of a table, made when it is first asked for.
Page& pageOf(const std::string& id, Model& model) {
    for (Page& page : model.pages) {
        if (page.id == id) return page;
    }
    Page page;
    page.id = id;
    page.label = id;
    page.slug = id;
    std::ranges::replace(page.slug, '/', '-');
    const auto isTaken = [&](const Page& other) { return other.slug == page.slug; };
    while (std::ranges::any_of(model.pages, isTaken)) page.slug += '-';
    page.parts.resize(model.runs.size());
    return model.pages.emplace_back(std::move(page));
}

/// What the viewer says of a picture beside its truth.
struct ErrorWords {
    std::string_view metric, name, unit;
};
constexpr ErrorWords kErrorWords[] = {
    {"flip", "FLIP", ""}, {"rmse", "RMSE", ""}, {"psnr_db", "PSNR", " dB"}};

/// The error that a table shows of a picture is that below the picture, too, and in the viewer; of
/// the last process, whose picture is there.
void takeRecordedErrors(const std::vector<records::Record>& records, std::vector<Shot>& shots) {
    using Place = std::tuple<std::string_view, std::string_view, int, std::string_view>;
    std::map<Place, const records::Record*> errors;
    for (const records::Record& record : records) {
        const bool isShown = std::ranges::find(kErrorWords, record.metric, &ErrorWords::metric) !=
                             std::end(kErrorWords);
        if (!isShown || std::isnan(record.value)) continue;
        const records::Record*& last =
            errors[{record.caseId, record.pass, record.frame, record.metric}];
        if (!last || last->process <= record.process) last = &record;
    }
    for (Shot& shot : shots) {
        std::vector<std::string> said;
        for (const auto& [metric, name, unit] : kErrorWords) {
            const auto found = errors.find({shot.caseId, shot.baseName, shot.frame, metric});
            const bool isFlip = metric == "flip";
            if (found != errors.end() && isFlip) shot.flipMean = found->second->value;
            if (found == errors.end() && !(isFlip && !shot.flip.empty())) continue;
            const double value = isFlip ? shot.flipMean : found->second->value;
            said.push_back(fmt::format("{} {:.4g}{}", name, value, unit));
        }
        shot.errors = joined(said, " · ");
    }
}

void addRun(std::size_t index, const GalleryPlace& place, const PicturesDone& progress,
            Model& model) {
    const ReportRun& run = model.runs[index];
    GFXREPRO_ASSERT_EQ(run.experiments.size(), run.tables.size());
    std::vector<Shot> shots = gatherShots(place, progress);
    takeRecordedErrors(run.records, shots);
    for (std::size_t i = 0; i < run.experiments.size(); ++i) {
        const config::Experiment& experiment = run.experiments[i];
        Page& page = pageOf(experiment.id, model);
        page.label = experiment.label();
        page.title = experiment.title;
        RunPart& part = page.parts[index];
        part.experiment = &experiment;
        part.table = run.tables[i];
        part.failures = failuresOf(experiment.id, run.records);
        std::ranges::copy_if(shots, std::back_inserter(part.shots),
                             [&](const Shot& shot) { return shot.table == experiment.id; });
        const auto isOfPage = [&](const Curve& curve) { return curve.table == experiment.id; };
        if (!model.isComparison()) {
            std::ranges::copy_if(run.curves, std::back_inserter(page.curves), isOfPage);
        }
        for (const config::Case& item : run.cases) {
            if (item.experiment == experiment.id) part.cases.push_back(&item);
        }
    }
    for (const tables::Table& table : run.keptTables) {
        pageOf(table.id, model).parts[index].table = table;
    }
    for (const claims::ClaimResult& claim : run.claims) {
        pageOf(claim.table, model).parts[index].claims.push_back(claim);
    }
}

}  // namespace

fs::path madeFolder(const fs::path& runDir, std::size_t index, const fs::path& file) {
    const auto folderOf = [](const fs::path& path) {
        return fs::weakly_canonical(fs::absolute(path));
    };
    const fs::path beside = folderOf(file).parent_path();
    if (beside == folderOf(runDir / "plan.json").parent_path()) return runDir;
    return file.parent_path() / (file.stem().string() + "-files") / Model::letter(index);
}

const RunPart* Page::shown() const {
    const auto part = std::ranges::find_if(parts, [](const auto& p) { return p.experiment; });
    return part == parts.end() ? nullptr : &*part;
}

bool Page::isOwn() const {
    const RunPart* part = shown();
    return part && part->experiment->kind == config::ExperimentKind::Sweep &&
           !part->experiment->isPublished();
}

std::string Page::heading() const {
    return isOwn() ? title : label + ". " + title;
}

std::string Model::letter(std::size_t run) {
    std::string before = run < 26 ? "" : letter(run / 26 - 1);
    return before += static_cast<char>('A' + run % 26);
}

std::string Model::prefix(std::size_t run) const {
    return isComparison() ? letter(run) + ": " : "";
}

std::string Model::boldLetter(std::size_t run) const {
    return isComparison() ? fmt::format("<b>{}</b> ", letter(run)) : "";
}

std::vector<const Page*> DocumentPages::pages() const {
    std::vector<const Page*> all;
    for (const ChapterPages& chapter : chapters) {
        all.insert(all.end(), chapter.pages.begin(), chapter.pages.end());
    }
    return all;
}

std::vector<DocumentPages> Model::byDocument() const {
    std::vector<DocumentPages> result;
    for (const Page& page : pages) {
        auto of = std::ranges::find(result, page.paper(), &DocumentPages::id);
        if (of == result.end()) of = result.insert(of, {page.paper(), "", {}});
        const std::string name = page.id.substr(page.id.find('/') + 1);
        std::string title;
        const auto known = std::ranges::find(documents, of->id, &config::Document::id);
        if (known != documents.end()) {
            of->title = known->title;
            for (const config::Chapter& chapter : known->chapters) {
                const auto& has = chapter.experiments;
                if (std::ranges::find(has, name) != has.end()) title = chapter.title;
            }
        }
        auto chapter = std::ranges::find(of->chapters, title, &DocumentPages::ChapterPages::title);
        if (chapter == of->chapters.end()) {
            chapter = of->chapters.insert(chapter, DocumentPages::ChapterPages{title, {}});
        }
        chapter->pages.push_back(&page);
    }
    for (DocumentPages& of : result) {
        const auto known = std::ranges::find(documents, of.id, &config::Document::id);
        if (known == documents.end()) continue;
        std::ranges::stable_sort(of.chapters, {}, [&](const DocumentPages::ChapterPages& one) {
            return std::ranges::find(known->chapters, one.title, &config::Chapter::title) -
                   known->chapters.begin();
        });
    }
    return result;
}

Model buildModel(std::span<const ReportRun> runs, const fs::path& file,
                 const ReportOptions& options, const fs::path& made) {
    using Embedding = GalleryPlace::Embedding;
    Model model{runs, {}, {}, options.documents};
    model.compared = options.compared;
    model.comparedInAll = options.comparedInAll;
    std::uintmax_t bytes = 0;
    for (const ReportRun& run : runs) bytes += imagesBytes(run);
    const Embedding embedding = bytes <= kEmbeddedImagesBytes ? Embedding::Whole
                                : options.embeds              ? Embedding::Reduced
                                                              : Embedding::None;
    std::vector<fs::path> folders;
    for (const ReportRun& run : runs) folders.push_back(run.folder);
    const int reducedPx =
        embedding == Embedding::Reduced ? reducedPxOf(folders, kSentBytes) : kShownPx;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const fs::path& folder = runs[i].folder;
        model.places.push_back(
            {folder, made.empty() ? madeFolder(folder, i, file) : made / Model::letter(i), file,
             embedding, reducedPx});
        addRun(i, model.places.back(), options.progress, model);
    }
    if (model.isComparison()) {
        std::vector<std::vector<tables::Table>> tables;
        std::vector<std::vector<config::Experiment>> experiments;
        for (const ReportRun& run : runs) {
            tables.push_back(run.tables);
            experiments.push_back(run.experiments);
        }
        for (Curve& curve : overlaidCurves(tables, experiments)) {
            pageOf(curve.table, model).curves.push_back(std::move(curve));
        }
    }
    if (options.findings.empty() || options.embeds) return model;
    const fs::path beside = fs::absolute(file).parent_path();
    model.findings = encodedAddress(fs::relative(fs::absolute(options.findings), beside));
    return model;
}

// The file.

namespace {

/// From page to page; shown where the script turns pages.
std::string navigationHtml(const Model& model) {
    std::string html =
        "<nav class=\"pages\" hidden><a href=\"#overview\">Overview</a>\n"
        "<a class=\"previous\">← previous</a> <a class=\"next\">next →</a>\n"
        "<select aria-label=\"page\"><option value=\"overview\">Overview</option>";
    for (const Page& page : model.pages) {
        const std::string paper = page.isOwn() ? "" : page.paper() + " · ";
        html += fmt::format("<option value=\"{}\">{}{}</option>", escapeXml(page.slug),
                            escapeXml(paper), escapeXml(page.heading()));
    }
    return html + "</select></nav>\n";
}

std::string pageTitle(const Model& model) {
    if (model.isOneTable()) return model.pages.front().heading();
    std::string names;
    for (const ReportRun& run : model.runs) {
        const std::string name = fs::absolute(run.folder).lexically_normal().filename().string();
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

/// A folder that goes when the report is written.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::string name = (fs::temp_directory_path() / "gfxrepro-report-XXXXXX").string();
        if (!::mkdtemp(name.data())) {
            throw Error(fmt::format("cannot create {}: {}", name, std::strerror(errno)));
        }
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code isLeft;
        fs::remove_all(path_, isLeft);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

std::string script() {
    return fmt::format("\n{}", kScript);
}

/// The script that the page may run, and no other: its SHA-256, base64.
std::string scriptDigest() {
    const std::string digits = sha256(script());
    std::string bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2) {
        bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
    }
    return base64(bytes);
}

}  // namespace

std::string pageLink(const Page& page) {
    return fmt::format("<a href=\"#{}\">{}</a>", escapeXml(page.slug), escapeXml(page.label));
}

std::string headOfFile(const std::string& title) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; base-uri "
        "'none'; "
        "form-action 'none'; img-src 'self' file: data:; style-src 'unsafe-inline'; "
        "script-src 'sha256-{}'\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n"
        "<title>gfxrepro: {}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        scriptDigest(), escapeXml(title), kStyle);
}

std::string caseAnchor(std::size_t run, const std::string& caseId) {
    return fmt::format("{}-{}", Model::letter(run), caseId);
}

void writeReport(const fs::path& file, std::span<const ReportRun> runs,
                 const ReportOptions& options) {
    std::optional<ScratchFolder> scratch;
    if (options.embeds) scratch.emplace();
    const Model model = buildModel(runs, file, options, scratch ? scratch->path() : fs::path());
    std::string html = headOfFile(pageTitle(model)) + navigationHtml(model) + "<main>\n";
    // The first section is the one that the report opens with.
    if (!model.isOneTable()) html += overviewHtml(model);
    for (const Page& page : model.pages) html += pageHtml(page, model);
    if (model.isOneTable()) html += overviewHtml(model);
    html += fmt::format(
        "</main>\n<aside class=\"cases-shown\" hidden></aside>\n{}<script>{}"
        "</script>\n</body>\n</html>\n",
        kViewer, script());
    writeFileAtomic(file, html);
}

}  // namespace gfxrepro::report
