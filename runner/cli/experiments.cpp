#include "runner/cli/experiments.h"

#include <fnmatch.h>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/cli/console.h"
#include "runner/config/experiment.h"
#include "runner/outcome/results.h"
#include "runner/run/case_filter.h"
#include "runner/run/scheduler.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kSeed = 1;

std::string paperOf(const fs::path& file) {
    return file.parent_path().filename().string();
}

/// Papers by name; in each tables first, then sections, then figures, by number (2.6 before 2.10).
bool comesBefore(const fs::path& a, const fs::path& b) {
    const auto rank = [](const fs::path& file) {
        const std::string stem = file.stem().string();
        return stem.starts_with("table-") ? 0 : stem.starts_with("section-") ? 1 : 2;
    };
    if (paperOf(a) != paperOf(b)) return paperOf(a) < paperOf(b);
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return ::strverscmp(a.stem().c_str(), b.stem().c_str()) < 0;
}

/// "table-2.1.yaml" is table 2.1; "section-2.5.3.yaml" is 2.5.3.
bool isTable(const fs::path& file, std::string_view table) {
    const std::string stem = file.stem().string();
    const std::size_t dash = stem.find('-');
    return stem == table || (dash != std::string::npos && stem.substr(dash + 1) == table);
}

/// Whether a pattern is meant, and of "zju2005/table-2.1" or "zju2005/2.1".
bool matches(const fs::path& file, const std::string& pattern) {
    if (pattern.find_first_of("*?[") == std::string::npos) return false;
    const std::string stem = file.stem().string();
    const std::string number = stem.substr(stem.find('-') + 1);
    return std::ranges::any_of(std::array{stem, number}, [&](const std::string& name) {
        return ::fnmatch(pattern.c_str(), (paperOf(file) + "/" + name).c_str(), 0) == 0;
    });
}

bool isConfig(const fs::path& file) {
    return file.extension() == ".yaml";
}

}  // namespace

std::vector<fs::path> runFolders() {
    std::vector<fs::path> folders;
    std::error_code isAbsent;
    for (const fs::directory_entry& folder : fs::directory_iterator("runs", isAbsent)) {
        if (fs::is_regular_file(folder.path() / "plan.json")) folders.push_back(folder.path());
    }
    std::ranges::sort(folders);
    return folders;
}

bool isYamlFile(const fs::path& name) {
    return name.extension() == ".yaml" || name.extension() == ".yml";
}

std::vector<fs::path> paperConfigs() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& folder : entriesIn(dataFolder("configs"))) {
        if (!outcome::isPaperFolder(folder.path())) continue;
        for (const fs::directory_entry& file : entriesIn(folder.path())) {
            if (isConfig(file.path())) files.push_back(fs::absolute(file.path()));
        }
    }
    std::ranges::sort(files, comesBefore);
    return files;
}

std::vector<std::string> paperNames() {
    std::vector<std::string> names;
    for (const fs::path& file : paperConfigs()) {
        const std::string stem = file.stem().string();
        if (names.empty() || !names.back().starts_with(paperOf(file) + "/")) {
            names.push_back(paperOf(file));
        }
        names.push_back(paperOf(file) + "/" + stem.substr(stem.find('-') + 1));
    }
    return names;
}

std::vector<std::string> paperFileNames() {
    std::vector<std::string> names;
    for (const fs::path& file : paperConfigs()) {
        names.push_back(paperOf(file) + "/" + file.stem().string());
    }
    return names;
}

std::vector<std::string> findPaperConfigs(const std::vector<std::string>& names) {
    const std::vector<fs::path> all = paperConfigs();
    std::vector<std::string> known = paperNames();
    std::ranges::copy(paperFileNames(), std::back_inserter(known));
    std::vector<std::string> found;
    for (const std::string& name : names) {
        if (isYamlFile(name)) {  // a config of the user's own
            found.push_back(name);
            continue;
        }
        const std::size_t slash = name.find('/');
        const std::string paper = name.substr(0, slash);
        const std::size_t before = found.size();
        for (const fs::path& file : all) {
            const bool isMeant =
                slash == std::string::npos || isTable(file, name.substr(slash + 1));
            const bool isOfPaper = paperOf(file) == paper;
            if ((isOfPaper && isMeant) || matches(file, name)) found.push_back(file.string());
        }
        if (found.size() == before) {
            throw UsageError("unknown paper or table '" + name + "'" + suggestion(name, known) +
                             "; 'gfxrepro list tables' shows all");
        }
    }
    if (names.empty()) {
        for (const fs::path& file : all) found.push_back(file.string());
    }
    return found;
}

std::vector<config::Experiment> loadExperiments(const run::Request& request,
                                                const std::string& profile) {
    config::ExperimentOptions options;
    options.profile = profile;
    for (const std::string& set : request.sets) options.sets.push_back(config::parseOverride(set));
    for (const std::string& sweep : request.sweeps) {
        options.sweeps.push_back(config::parseOverride(sweep));
    }
    const fs::path configs = dataFolder("configs");
    std::vector<config::Experiment> experiments;
    for (const std::string& file : request.configs) {
        experiments.push_back(config::loadExperiment(file, options, configs));
    }
    return experiments;
}

run::Request requestOf(const Chosen& selection, const std::vector<std::string>& files) {
    run::Request request{{}, selection.sets, selection.sweeps, selection.only, selection.device};
    for (const std::string& file : files) {
        request.configs.push_back(fs::absolute(file).lexically_normal());
    }
    return request;
}

void tellDevice(const gl::DeviceInfo& device) {
    tell("device {}: {} ({}), OpenGL {}{}{}\n", device.index, device.renderer,
         device.isSoftware ? "software" : "gpu", device.version,
         device.uuid.empty() ? "" : ", UUID " + device.uuid,
         device.timer.bits > 0 ? "" : "; it has no clock for GPU times");
}

void tellDevice(const std::string& asked) {
    try {
        run::PhaseClock phases;
        tellDevice(run::probeDevice({asked, assetsFolder(""), 1, {}}, phases));
    } catch (const NoDeviceError&) {
        // What is measured will say why, if it needs one.
    }
}

std::string deviceClassFor(const Chosen& selection) {
    if (selection.device == "software" || selection.device == "gpu") return selection.device;
    try {
        run::PhaseClock phases;
        const gl::DeviceInfo device =
            run::probeDevice({selection.device, assetsFolder(selection.assets), 1, {}}, phases);
        return device.isSoftware ? "software" : "gpu";
    } catch (const NoDeviceError&) {
        return "software";
    }
}

std::string deviceFor(const Context& context, const std::string& asked,
                      const std::vector<config::Experiment>& experiments) {
    const auto isOpened = [&](const config::Experiment& experiment) {
        return config::isMeasuredHere(experiment) &&
               technique::needsDevice(
                   technique::findTechnique(
                       context.techniques, experiment.technique,
                       config::contentOf(experiment.document).technique->location()),
                   config::programOf(experiment));
    };
    const bool measures = std::ranges::any_of(experiments, config::isMeasuredHere);
    return asked == "auto" && measures && std::ranges::none_of(experiments, isOpened) ? "none"
                                                                                      : asked;
}

run::Plan planFor(const Context& context, const run::Request& request, const std::string& profile,
                  const std::string& assets, const std::string& deviceClass) {
    const std::vector<config::Experiment> experiments = loadExperiments(request, profile);
    const bool needsNone = deviceFor(context, request.device, experiments) == "none";
    const scene::Catalog catalog = openCatalog(context, assets);
    run::Plan plan = run::makePlan(experiments, catalog, context.techniques, profile,
                                   needsNone ? "software" : deviceClass, kSeed);
    plan.request = request;
    std::set<std::string> told;
    for (const config::Experiment& experiment : plan.experiments) {
        const auto isOwn = [&](const config::Case& item) {
            return item.experiment == experiment.id;
        };
        const auto first = std::ranges::find_if(plan.cases, isOwn);
        const auto end = std::find_if_not(first, plan.cases.end(), isOwn);
        requireSound(context, catalog, experiment, std::span(first, end), told);
    }
    run::keepOnly(plan, request.only);
    requireFiles(plan.cases);
    run::requirePlanBytes(plan, run::planBytes(plan));
    return plan;
}

void warnOfChangedConfigs(const run::Plan& plan, const std::string& consequence) {
    run::Request request = plan.request;
    request.configs.clear();  // a shard has not all of them
    for (const config::Experiment& experiment : plan.experiments) {
        request.configs.push_back(experiment.file);
    }
    std::vector<config::Experiment> now;
    std::string problem;
    try {
        now = loadExperiments(request, plan.profile);
    } catch (const std::exception& error) {
        problem = error.what();
    }
    for (std::size_t i = 0; i < plan.experiments.size() && problem.empty(); ++i) {
        const config::Experiment& planned = plan.experiments[i];
        if (i < now.size() && now[i].document.toJson() == planned.document.toJson()) continue;
        problem = planned.file.string() + " changed";
    }
    if (!problem.empty()) tell("warning: {}; {}\n", problem, consequence);
}

std::string runSlug(const run::Plan& plan) {
    if (plan.experiments.empty()) return "empty";
    if (plan.experiments.size() == 1) return plan.experiments.front().slug();
    const std::string& id = plan.experiments.front().id;
    return id.substr(0, id.find('/'));
}

scene::Catalog openCatalog(const Context& context, const std::string& assets) {
    return {dataFolder("configs") / "scenes", assetsFolder(assets), context.generators};
}

void Columns::fit(const std::vector<std::string>& row) {
    widths_.resize(std::max(widths_.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
        widths_[i] = std::max(widths_[i], printable(row[i]).size());
    }
}

std::string Columns::line(const std::vector<std::string>& row) const {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const std::string text = printable(row[i]);
        line += text;
        if (i + 1 < row.size()) line.append(widths_[i] - text.size() + 2, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

std::string alignedColumns(const std::vector<std::vector<std::string>>& rows) {
    Columns columns;
    for (const auto& row : rows) columns.fit(row);
    std::string text;
    for (const auto& row : rows) text += columns.line(row);
    return text;
}

std::string sceneState(const scene::Catalog& catalog, const std::string& name) {
    const scene::SceneEntry& entry = catalog.entries().at(name);
    for (const scene::SceneSource& source : entry.sources) {
        const bool isThere =
            source.file.empty() || std::filesystem::exists(catalog.assetsFolder() / source.file);
        if (isThere) return std::string(scene::kindName(source.kind));
    }
    return "missing";
}

}  // namespace gfxrepro::cli
