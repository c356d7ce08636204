#include "runner/cluster/predictions.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "engine/core/near_file.h"
#include "engine/core/text.h"
#include "engine/metrics/statistics.h"
#include "runner/records/csv.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::cluster {

namespace fs = std::filesystem;

std::string_view sourceName(Prediction::Source source) {
    static constexpr std::string_view kNames[] = {"same case", "same case, other run", "median",
                                                  "file"};
    return kNames[static_cast<std::size_t>(source)];
}

namespace {

constexpr std::string_view kFileHeader = "title,time_s,memory_bytes,source";

double iterationsOf(const config::Measure& measure) {
    return measure.warmup() + static_cast<double>(measure.repeats) * measure.frames;
}

/// What `past` took, for the iterations and frames that `measure` asks for.
double scaledTimeS(const PastCase& past, const config::Measure& measure) {
    const config::Measure& then = past.item.measure;
    const double iterations = std::max(iterationsOf(then), 1.0);
    return past.cost.loadS + past.cost.setupS +
           past.cost.renderS * iterationsOf(measure) / iterations +
           past.cost.recordS * measure.frames / std::max(then.frames, 1);
}

/// Everything that a time depends on but for the build, the device and how often it is measured.
std::string contentOf(const config::Case& item) {
    return item.technique + item.scene.toFlowText() + item.params.toFlowText() +
           std::to_string(item.outputWidthPx) + 'x' + std::to_string(item.outputHeightPx);
}

/// The costs in a run's journal, by case. Lines that are torn or without a cost are passed over.
std::map<std::string, std::vector<run::Cost>> journalCosts(const fs::path& runDir) {
    std::map<std::string, std::vector<run::Cost>> costs;
    run::forEachEvent(runDir / "journal.jsonl", [&](const run::Json& event) {
        if (!event.contains("cost") || !event.contains("case")) return;
        costs[event.at("case").get<std::string>()].push_back(run::costFromJson(event.at("cost")));
    });
    return costs;
}

/// Of a run that is looked at without being asked for.
constexpr std::uintmax_t kMostManifestBytes = std::uintmax_t{64} << 20;

bool isRunOf(const fs::path& folder, const std::string& deviceClass) {
    const fs::path manifestFile = folder / "manifest.json";
    if (!fs::exists(folder / "plan.json") || !fs::exists(manifestFile)) return false;
    if (fs::file_size(manifestFile) > kMostManifestBytes) return false;
    return run::readManifest(manifestFile).at("device_class") == deviceClass;
}

std::map<std::string, Prediction> readPredictions(const fs::path& file) {
    const std::string text = readFile(file);
    records::CsvReader reader(text, file.string());
    std::vector<std::string> fields;
    std::map<std::string, Prediction> predictions;
    if (!reader.next(fields) || joined(fields, ",") != kFileHeader) {
        throw Error(file.string() + ": neither a run directory nor a file of predictions");
    }
    while (reader.next(fields)) {
        const auto timeS = fields.size() == 4 ? parseDouble(fields[1]) : std::nullopt;
        const auto bytes = fields.size() == 4 ? parseInteger(fields[2]) : std::nullopt;
        if (!timeS || !bytes) throw Error(reader.location(), "is no line of predictions");
        predictions[fields[0]] = {*timeS, *bytes, Prediction::Source::File,
                                  fields[3] != sourceName(Prediction::Source::Median)};
    }
    return predictions;
}

}  // namespace

run::Cost usualCost(const std::vector<run::Cost>& costs) {
    double recordS = 0.0;
    for (const run::Cost& cost : costs) recordS += cost.recordS / static_cast<double>(costs.size());
    const auto of = [&](auto member) {
        std::vector<double> values;
        for (const run::Cost& cost : costs) values.push_back(static_cast<double>(cost.*member));
        return metrics::median(std::move(values));
    };
    return {of(&run::Cost::loadS),
            of(&run::Cost::setupS),
            of(&run::Cost::renderS),
            recordS,
            std::ranges::max(costs, {}, &run::Cost::peakBytes).peakBytes,
            of(&run::Cost::onceS)};
}

std::vector<PastCase> readPastCases(const fs::path& runDir) {
    if (!fs::exists(runDir / "plan.json")) {
        throw Error(runDir.string() + ": is not a run directory (it has no plan.json)" +
                    suggestedFile(runDir));
    }
    run::requireModestFiles(runDir);
    const std::map<std::string, std::vector<run::Cost>> costs = journalCosts(runDir);
    std::vector<PastCase> past;
    if (costs.empty()) return past;
    for (config::Case& item : run::Plan::fromJsonFile(runDir / "plan.json").cases) {
        const auto found = costs.find(item.id);
        if (found == costs.end()) continue;
        const run::Cost cost = usualCost(found->second);
        past.push_back({std::move(item), cost});
    }
    return past;
}

std::vector<fs::path> newestRuns(const fs::path& folder, const std::string& deviceClass,
                                 std::size_t count) {
    std::vector<std::pair<fs::file_time_type, fs::path>> runs;
    std::error_code problem;
    fs::directory_iterator entry(folder, problem);
    for (; !problem && entry != fs::directory_iterator(); entry.increment(problem)) {
        // Whatever lies there, another user's or broken, stops no run: it is none to learn from.
        try {
            if (!isRunOf(entry->path(), deviceClass)) continue;
            runs.emplace_back(fs::last_write_time(entry->path() / "manifest.json"), entry->path());
        } catch (const std::exception&) {
        }
    }
    std::ranges::sort(runs, std::greater());
    std::vector<fs::path> newest;
    for (std::size_t i = 0; i < std::min(count, runs.size()); ++i) newest.push_back(runs[i].second);
    return newest;
}

Predictor::Predictor(std::vector<PastCase> past) : past_(std::move(past)) {
    for (std::size_t i = 0; i < past_.size(); ++i) {
        byId_.try_emplace(past_[i].item.id, i);
        byContent_.try_emplace(contentOf(past_[i].item), i);
    }
}

Predictor Predictor::from(const std::vector<fs::path>& sources) {
    std::vector<PastCase> past;
    std::map<std::string, Prediction> file;
    for (const fs::path& source : sources) {
        if (fs::is_regular_file(source)) {
            file.merge(readPredictions(source));
        } else {
            std::vector<PastCase> more = readPastCases(source);
            std::ranges::move(more, std::back_inserter(past));
        }
    }
    Predictor predictor(std::move(past));
    predictor.file_ = std::move(file);
    return predictor;
}

std::optional<Prediction> Predictor::predict(const config::Case& item) const {
    if (const auto found = file_.find(item.title()); found != file_.end()) return found->second;
    const auto as = [&](std::size_t index, Prediction::Source source) {
        const PastCase& past = past_[index];
        return Prediction{scaledTimeS(past, item.measure), past.cost.peakBytes, source};
    };
    if (const auto found = byId_.find(item.id); found != byId_.end()) {
        return as(found->second, Prediction::Source::SameCase);
    }
    if (const auto found = byContent_.find(contentOf(item)); found != byContent_.end()) {
        return as(found->second, Prediction::Source::OtherRun);
    }
    return median(item);
}

std::optional<Prediction> Predictor::median(const config::Case& item) const {
    if (past_.empty()) return std::nullopt;
    std::vector<double> timesS[2], bytes[2];  // of all cases; of this technique
    for (const PastCase& past : past_) {
        for (int i = 0; i < (past.item.technique == item.technique ? 2 : 1); ++i) {
            timesS[i].push_back(scaledTimeS(past, item.measure));
            bytes[i].push_back(static_cast<double>(past.cost.peakBytes));
        }
    }
    const int which = timesS[1].empty() ? 0 : 1;
    return Prediction{metrics::median(timesS[which]),
                      static_cast<long long>(metrics::median(bytes[which])),
                      Prediction::Source::Median, false};
}

void writePredictions(const fs::path& path, const run::Plan& plan, const Predictor& predictor) {
    std::string text = std::string(kFileHeader) + '\n';
    for (const config::Case& item : plan.cases) {
        const std::optional<Prediction> known = predictor.predict(item);
        if (!known) continue;
        records::CsvRow row(text);
        row.text(item.title()).number(known->timeS).integer(known->memoryBytes);
        row.text(sourceName(known->source)).end();
    }
    writeFileAtomic(path, text);
}

std::vector<double> caseTimesS(const run::Plan& plan, const Predictor& predictor) {
    std::vector<double> timesS;
    for (const config::Case& item : plan.cases) {
        const std::optional<Prediction> known = predictor.predict(item);
        timesS.push_back(item.measure.processes *
                         (known ? known->timeS : iterationsOf(item.measure)));
    }
    return timesS;
}

double remainingS(double totalS, double doneS, double elapsedS, int jobs) {
    if (doneS <= 0.0) return totalS / jobs;
    return elapsedS * std::max(totalS - doneS, 0.0) / doneS;
}

}  // namespace gfxrepro::cluster
