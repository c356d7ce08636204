#include "runner/html/model.h"

#include <algorithm>
#include <map>
#include <set>

#include "runner/core/files.h"
#include "runner/report/fit.h"
#include "runner/report/gnuplot.h"
#include "runner/report/plot.h"
#include "runner/report/report.h"

namespace gfxrepro::html {

namespace fs = std::filesystem;

namespace {

/// Beyond this the images stay files of their own: browsers open larger pages badly.
constexpr std::uintmax_t kEmbeddedImagesBytes = 20'000'000;

std::uintmax_t imagesBytes(const ReportRun& run) {
    std::uintmax_t total = 0;
    for (const report::ImageEntry& image : report::readImages(run.folder)) {
        std::error_code isAbsent;
        const std::uintmax_t size = fs::file_size(run.folder / image.png, isAbsent);
        if (!image.png.empty() && !isAbsent) total += size;
    }
    return total;
}

/// The cases of a table whose last record of a process is no measurement.
std::vector<Failure> failuresOf(const std::string& table,
                                const std::vector<report::Record>& records) {
    std::map<std::pair<std::string, int>, const report::Record*> last;
    std::vector<std::pair<std::string, int>> order;
    for (const report::Record& record : records) {
        if (record.table != table) continue;
        const auto [place, isNew] = last.try_emplace({record.caseId, record.process}, &record);
        if (isNew) order.push_back(place->first);
        place->second = &record;
    }
    std::vector<Failure> failures;
    for (const auto& key : order) {
        const report::Record& record = *last[key];
        if (record.status == report::Status::Ok) continue;
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
    page.parts.resize(model.runs.size());
    return model.pages.emplace_back(std::move(page));
}

/// Where plots, FLIP maps and thumbnails of a run go: its folder, where the page lies there too;
/// else beside the page, which leaves the run as it is: "all.html" → all-files/A.
fs::path madeFolder(const fs::path& runDir, std::size_t index, const fs::path& file) {
    const auto folderOf = [](const fs::path& path) {
        return fs::weakly_canonical(fs::absolute(path));
    };
    const fs::path beside = folderOf(file).parent_path();
    if (beside == folderOf(runDir / "plan.json").parent_path()) return runDir;
    return file.parent_path() / (file.stem().string() + "-files") / Model::letter(index);
}

/// A file as the page at `page` names it.
std::string shownFrom(const fs::path& page, const fs::path& file) {
    return fs::relative(fs::absolute(file), fs::absolute(page).parent_path()).generic_string();
}

void addRun(std::size_t index, const GalleryPlace& place, std::chrono::milliseconds& patience,
            Model& model) {
    const ReportRun& run = model.runs[index];
    std::vector<report::Table> tables =
        report::buildTables(run.experiments, run.planned, run.records);
    report::addNotes(run.context.tableNotes, tables);
    const fs::path& made = place.madeDir;
    const std::vector<report::PlotFile> plots =
        report::writePlots(made, tables, run.experiments, patience);
    const std::vector<Shot> shots = gatherShots(place);
    const bool isAlone = !place.isKept;
    for (std::size_t i = 0; i < run.experiments.size(); ++i) {
        const config::Experiment& experiment = run.experiments[i];
        Page& page = pageOf(experiment.id, model);
        page.label = experiment.label();
        page.title = experiment.title;
        RunPart& part = page.parts[index];
        part.experiment = &experiment;
        part.table = tables[i];
        part.claims = report::evaluateClaims(experiment, tables[i], run.context);
        part.failures = failuresOf(experiment.id, run.records);
        std::ranges::copy_if(shots, std::back_inserter(part.shots),
                             [&](const Shot& shot) { return shot.table == experiment.id; });
        for (const report::PlotFile& plot : plots) {
            if (plot.table != experiment.id) continue;
            part.curves.push_back(
                {plot.title, plot.svg.empty() ? "" : readFile(made / plot.svg), plot.problem,
                 plot.script.empty() || isAlone ? "" : shownFrom(place.page, made / plot.script)});
        }
        for (const ReportCase& item : run.cases) {
            if (item.table == experiment.id) part.cases.push_back(&item);
        }
    }
    for (const report::ClaimResult& claim : run.keptClaims) {
        pageOf(claim.table, model).parts[index].claims.push_back(claim);
    }
}

}  // namespace

const RunPart* Page::shown() const {
    const auto part = std::ranges::find_if(parts, [](const auto& p) { return p.experiment; });
    return part == parts.end() ? nullptr : &*part;
}

bool Page::isOwn() const {
    const RunPart* part = shown();
    return part && !part->experiment->isPublished();
}

std::string Page::heading() const {
    return isOwn() ? title : label + ". " + title;
}

std::string Model::letter(std::size_t run) {
    std::string before = run < 26 ? "" : letter(run / 26 - 1);
    return before += static_cast<char>('A' + run % 26);
}

std::vector<const Page*> DocumentPages::pages() const {
    std::vector<const Page*> all;
    for (const Chapter& chapter : chapters) {
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
        auto chapter = std::ranges::find(of->chapters, title, &DocumentPages::Chapter::title);
        if (chapter == of->chapters.end()) {
            chapter = of->chapters.insert(chapter, DocumentPages::Chapter{title, {}});
        }
        chapter->pages.push_back(&page);
    }
    for (DocumentPages& of : result) {
        const auto known = std::ranges::find(documents, of.id, &config::Document::id);
        if (known == documents.end()) continue;
        std::ranges::stable_sort(of.chapters, {}, [&](const DocumentPages::Chapter& one) {
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
    std::chrono::milliseconds patience = report::kGnuplotPatience;
    std::uintmax_t bytes = 0;
    for (const ReportRun& run : runs) bytes += imagesBytes(run);
    const Embedding embedding = bytes <= kEmbeddedImagesBytes ? Embedding::Whole
                                : options.embeds              ? Embedding::Reduced
                                                              : Embedding::None;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const fs::path& folder = runs[i].folder;
        model.places.push_back(
            {folder, made.empty() ? madeFolder(folder, i, file) : made / Model::letter(i), file,
             embedding, made.empty()});
        addRun(i, model.places.back(), patience, model);
    }
    return model;
}

}  // namespace gfxrepro::html
