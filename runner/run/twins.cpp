#include "runner/run/twins.h"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/hash.h"
#include "runner/run/recorder.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// 64 and 64.0 are one number.
void spellNumbersAlike(Json& value) {
    if (value.is_number()) value = value.get<double>();
    if (!value.is_structured()) return;
    for (Json& item : value) spellNumbersAlike(item);
}

void share(const fs::path& from, const fs::path& to) {
    std::error_code failure;
    fs::create_directories(to.parent_path());
    fs::remove(to, failure);  // of a try that was not recorded
    fs::create_hard_link(from, to, failure);
    if (failure) fs::copy_file(from, to, fs::copy_options::overwrite_existing, failure);
    if (failure) {
        throw Error("cannot write " + to.string() + ": " + failure.message());
    }
}

void shareArtifacts(const fs::path& runDir, const Case& measured, const Case& twin) {
    const fs::path from = runDir / ("artifacts/" + fileStem(measured));
    if (!fs::exists(from.parent_path())) return;
    const std::string prefix = from.filename().string();
    std::vector<fs::path> files;  // first: the twin's may lie in the same folder
    for (const auto& entry : fs::directory_iterator(from.parent_path())) {
        if (entry.path().filename().string().starts_with(prefix)) files.push_back(entry.path());
    }
    for (const fs::path& file : files) {
        const fs::path to = runDir / ("artifacts/" + fileStem(twin));
        share(file, to.string() + file.filename().string().substr(prefix.size()));
    }
}

}  // namespace

std::string workKey(const Case& item) {
    const config::Measure& measure = item.measure;
    if (measure.lane == config::Measure::Lane::Timing) return "";
    Json content = {
        {"technique", item.technique},
        {"scene", item.scene.toJson()},
        {"params", item.params.toJson()},
        {"output", {item.outputWidthPx, item.outputHeightPx}},
        {"measure",
         {measure.warmup, measure.repeats, measure.processes, measure.frames, measure.timeLimitS}}};
    if (!item.program.isNull()) {
        content["program"] = {item.program.toJson(), item.programKey};
    }
    content["params"].erase("pictures");
    spellNumbersAlike(content);
    if (measure.seeds == config::Measure::Seeds::Process) content["seeds"] = "process";
    content["seed"] = std::to_string(item.seed);
    return sha256(content.dump());
}

std::map<const Case*, std::string> keysOfTwins(const std::set<const Case*>& cases) {
    std::map<const Case*, std::string> keys;
    std::map<std::string, int> counts;
    for (const Case* item : cases) {
        std::string key = workKey(*item);
        if (key.empty()) continue;
        ++counts[key];
        keys.emplace(item, std::move(key));
    }
    std::erase_if(keys, [&](const auto& entry) { return counts[entry.second] == 1; });
    return keys;
}

bool savesPictures(const Case& item) {
    const Node* pictures = item.params.find("pictures");
    return pictures && pictures->toJson() == true;
}

std::vector<std::size_t> firstTwins(std::span<const Case> cases) {
    std::vector<std::size_t> firsts;
    std::map<std::string, std::size_t> known;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const std::string key = workKey(cases[i]);
        firsts.push_back(key.empty() ? i : known.try_emplace(key, i).first->second);
    }
    return firsts;
}

std::vector<double> withoutTwins(std::span<const Case> cases, std::vector<double> timesS) {
    GFXREPRO_ASSERT_EQ(cases.size(), timesS.size());
    const std::vector<std::size_t> firsts = firstTwins(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (firsts[i] != i) timesS[i] = 0.0;
    }
    return timesS;
}

std::vector<records::ImageEntry> shareFiles(const fs::path& runDir, const Case& measured,
                                            const Case& twin,
                                            const std::vector<records::ImageEntry>& images) {
    shareArtifacts(runDir, measured, twin);
    if (savesPictures(measured) && !savesPictures(twin)) return {};
    const std::string stem = "images/" + fileStem(measured);
    std::vector<records::ImageEntry> shared = images;
    for (records::ImageEntry& image : shared) {
        image.caseId = twin.id;
        image.table = twin.experiment;
        image.title = twin.title();
        for (std::string* file : {&image.png, &image.exr}) {
            if (file->empty()) continue;
            GFXREPRO_ASSERT(file->starts_with(stem));
            const std::string from = *file;
            *file = "images/" + fileStem(twin) + from.substr(stem.size());
            share(runDir / from, runDir / *file);
        }
    }
    return shared;
}

}  // namespace gfxrepro::run
