#include "runner/outcome/import_run.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "engine/core/checks.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "runner/config/experiment.h"
#include "runner/config/external_program.h"
#include "runner/outcome/export.h"
#include "runner/run/ledger.h"
#include "runner/run/manifest.h"
#include "runner/run/plan_json.h"

namespace gfxrepro::outcome {

namespace fs = std::filesystem;
using config::Experiment;

namespace {

constexpr const char* kOutputWidth = "output.width";
constexpr const char* kOutputHeight = "output.height";

/// "time ms (2).csv" → "time-ms--2-": a name that a config may have.
std::string nameFrom(const fs::path& file) {
    std::string name = file.stem().string().substr(0, 60);
    for (char& c : name) {
        const bool isAllowed = std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
        if (!isAllowed) c = '-';
    }
    return name.empty() ? "imported" : name;
}

/// One table of everything, for who gives no config.
Experiment plainExperiment(const fs::path& file) {
    const Node document =
        Node::map({{"sweep_of", Node::scalar(nameFrom(file), {}, true)},
                   {"title", Node::scalar("Numbers of " + file.filename().string(), {}, true)},
                   {"technique", Node::scalar(config::kImported)}});
    return config::experimentFromDocument(document, fs::absolute(file));
}

/// One node for one number, however it is spelt: 1, 1.0 and 1e0 are one case.
Node valueOf(const std::string& text, const SourceLocation& where) {
    const Node node = Node::scalar(text, where);
    const auto number = node.tryInteger() ? std::nullopt : node.tryDouble();
    return number ? Node::number(*number, where) : node;
}

int outputSize(const ImportedCase& given, const std::string& column, int absent) {
    const std::string text = given.cell(column);
    if (text.empty()) return absent;
    return static_cast<int>(numberIn(Node::scalar(text, given.where), config::kOutputSizesPx,
                                     fmt::format("column '{}'", column)));
}

/// Cases have an output beside their parameters; a parameter of that name would be lost.
void requireKnownOutput(const std::string& name, const ImportedCase& given) {
    if (name != "output" && !name.starts_with("output.")) return;
    throw Error(given.where, fmt::format("column '{}'; allowed of that: {}, {}", name, kOutputWidth,
                                         kOutputHeight));
}

/// The name of the parameter in that column; empty where it holds something else of the case.
std::string paramOf(const std::string& column) {
    if (column.starts_with(kParamPrefix)) return column.substr(kParamPrefix.size());
    constexpr std::string_view kOthers[] = {"experiment", "technique", "scene", kOutputWidth,
                                            kOutputHeight};
    return std::ranges::find(kOthers, column) != std::end(kOthers) ? "" : column;
}

config::Case caseFrom(const ImportedCase& given, const Experiment& experiment) {
    config::Case item;
    item.experiment = experiment.id;
    item.technique = experiment.technique;
    const std::string technique = given.cell("technique");
    if (!config::isMeasuredHere(experiment) && !technique.empty()) item.technique = technique;
    Node params = Node::map({});
    for (const auto& [column, text] : given.cells) {
        const std::string name = paramOf(column);
        if (name.empty()) continue;
        requireKnownOutput(name, given);
        const Node value = valueOf(text, given.where);
        if (name.starts_with(config::kSceneAxisPrefix)) {
            params.set(name, value);
        } else {
            params.setPath(name, value);
        }
    }
    item.params = std::move(params);
    item.given = item.params;
    item.axes = Node::map({});
    if (const std::string scene = given.cell("scene"); !scene.empty()) {
        item.scene = Node::scalar(scene, {}, true);
    }
    item.outputWidthPx = outputSize(given, kOutputWidth, experiment.outputWidthPx);
    item.outputHeightPx = outputSize(given, kOutputHeight, experiment.outputHeightPx);
    item.measure = experiment.measure;
    item.measure.processes = 1;
    using Seeds = config::Measure::Seeds;
    item.measure.seeds = given.hasSeeds ? Seeds::Process : Seeds::None;
    return item;
}

bool isSeedSwept(const Experiment& experiment) {
    const auto isSeed = [](const config::LayoutAxis& axis) { return axis.name == "seed"; };
    const config::Layout& layout = experiment.layout;
    return (experiment.sweep.isMap() && experiment.sweep.find("seed")) ||
           std::ranges::any_of(layout.rows, isSeed) || std::ranges::any_of(layout.columns, isSeed);
}

bool isSeedLeftOut(const Experiment& experiment) {
    const Node* when = config::whenOf(experiment.sweep);
    return when && when->isMap() && when->find("seed");
}

/// The value of an axis; null where the case has none.
Node axisOf(const config::Case& item, const std::string& axis) {
    if (axis == "scene") return item.standsFor.isNull() ? item.scene : item.standsFor;
    if (axis == kOutputWidth) return Node::number(item.outputWidthPx);
    if (axis == kOutputHeight) return Node::number(item.outputHeightPx);
    const Node* value = &item.params;
    if (const Node* whole = value->find(axis)) return *whole;
    for (const std::string& step : split(axis, '.')) {
        value = value->isMap() ? value->find(step) : nullptr;
        if (!value) return {};
    }
    return *value;
}

/// What is swept: of a config its axes, and what differs beside between the cases.
std::vector<std::string> axesOf(const Experiment& experiment,
                                const std::vector<std::string>& columns,
                                const std::vector<config::Case*>& cases) {
    std::vector<std::string> axes;
    const auto add = [&](const std::string& axis) {
        if (std::ranges::find(axes, axis) == axes.end()) axes.push_back(axis);
    };
    for (const config::AxisPoint& point : config::expandSweep(experiment.sweep)) {
        for (const auto& [axis, value] : point) add(axis);
    }
    const bool isLaidOut = !axes.empty() || !experiment.hasDefaultLayout();
    if (isLaidOut && config::isMeasuredHere(experiment)) return axes;
    std::vector<std::string> names = {"scene", kOutputWidth, kOutputHeight};
    for (const std::string& column : columns) {
        if (const std::string name = paramOf(column); !name.empty()) names.push_back(name);
    }
    for (const std::string& name : names) {
        const bool varies = std::ranges::any_of(cases, [&](const config::Case* item) {
            return !axisOf(*item, name).sameContent(axisOf(*cases.front(), name));
        });
        if (varies) add(name);
    }
    return axes;
}

const Experiment& experimentOf(const ImportedCase& given,
                               const std::vector<Experiment>& experiments) {
    const std::string id = given.cell("experiment");
    if (id.empty() && experiments.size() == 1) return experiments.front();
    const auto found = std::ranges::find(experiments, id, &Experiment::id);
    if (found != experiments.end()) return *found;
    std::vector<std::string> known;
    for (const Experiment& experiment : experiments) known.push_back(experiment.id);
    throw Error(given.where,
                fmt::format("column 'experiment': '{}'; allowed, as of the configs given: {}", id,
                            joined(known)));
}

std::string laneName(config::Measure::Lane lane) {
    return lane == config::Measure::Lane::Timing ? "timing" : "quality";
}

/// Claims know a time by its name: one of another name would be judged as what never varies. Those
/// of a config know an axis by its name, too.
void requireNames(const ImportedNumbers& numbers, const run::Plan& plan, const fs::path& file) {
    const bool isPlain = plan.request.configs.empty();
    // Of experiments whose metrics no technique declares.
    std::map<std::string, std::set<std::string>> axes;
    for (const Experiment& experiment : plan.experiments) {
        if (config::isMeasuredHere(experiment)) continue;
        std::set<std::string>& own = axes[experiment.id];
        if (!isPlain) own = {"scene", "seed", "frame"};
    }
    for (const config::Case& item : plan.cases) {
        const auto own = axes.find(item.experiment);
        if (isPlain || own == axes.end()) continue;
        for (const auto& [axis, value] : item.axes.entries()) own->second.insert(axis);
    }
    for (const ImportedRow& row : numbers.rows) {
        const records::Record& record = row.record;
        const auto own = axes.find(plan.cases[row.caseIndex].experiment);
        if (own == axes.end()) continue;
        std::string why = config::whyNoTimeName(record.metric, record.unit);
        if (own->second.contains(record.metric)) {
            why =
                fmt::format("metric '{}' has the name of an axis; allowed: another", record.metric);
        }
        if (!why.empty()) throw Error({file.string(), row.line, 0}, why);
    }
}

/// How often each case was measured, and in which lane, as its rows say.
void takeMeasures(const ImportedNumbers& numbers, std::vector<config::Case>& cases) {
    for (const ImportedRow& row : numbers.rows) {
        config::Measure& measure = cases[row.caseIndex].measure;
        measure.processes = std::max(measure.processes, row.record.process + 1);
        measure.lane = row.record.lane == laneName(config::Measure::Lane::Timing)
                           ? config::Measure::Lane::Timing
                           : config::Measure::Lane::Quality;
    }
}

/// Whether `when` of its sweep leaves the case without a seed.
bool isLeftWithoutSeed(const config::Case& item, const Node& when) {
    config::AxisPoint point = item.axes.entries();
    if (!item.axes.find("seed")) point.emplace_back("seed", Node::scalar("0"));
    config::applyWhen(when, point);
    return std::ranges::none_of(point, [](const auto& axis) { return axis.key() == "seed"; });
}

/// Where `when` leaves cases without a seed, these have none, and of a metric with seeds all others
/// have one: a case without it would count as what never varies.
void requireSeeds(const ImportedNumbers& numbers, const run::Plan& plan, const fs::path& file) {
    std::map<std::string, int> seeded;  // by metric its first line with a seed
    std::vector<std::optional<bool>> isLeftOut(plan.cases.size());
    const auto hasSeed = [&](const ImportedRow& row) {
        return plan.cases[row.caseIndex].axes.find("seed") != nullptr;
    };
    for (const ImportedRow& row : numbers.rows) {
        if (hasSeed(row)) seeded.try_emplace(row.record.metric, row.line);
    }
    for (const ImportedRow& row : numbers.rows) {
        const config::Case& item = plan.cases[row.caseIndex];
        const auto experiment =
            std::ranges::find(plan.experiments, item.experiment, &Experiment::id);
        if (!isSeedLeftOut(*experiment)) continue;
        std::optional<bool>& isOut = isLeftOut[row.caseIndex];
        if (!isOut) isOut = isLeftWithoutSeed(item, *config::whenOf(experiment->sweep));
        const auto refuse = [&](const std::string& what) {
            throw Error({file.string(), row.line, 0}, "column 'seed': " + what);
        };
        if (*isOut && hasSeed(row)) {
            refuse(
                fmt::format("'{}'; allowed: nothing, as 'when' of the sweep leaves this case "
                            "without one",
                            item.axes.find("seed")->text()));
        }
        const auto other = seeded.find(row.record.metric);
        if (*isOut || hasSeed(row) || other == seeded.end()) continue;
        refuse(
            fmt::format("is empty, and '{}' has one in line {}; allowed: nothing only where "
                        "'when' of the sweep leaves a case without one",
                        other->first, other->second));
    }
}

void takeAxes(const ImportedNumbers& numbers, run::Plan& plan) {
    for (const Experiment& experiment : plan.experiments) {
        std::vector<config::Case*> own;
        for (config::Case& item : plan.cases) {
            if (item.experiment == experiment.id) own.push_back(&item);
        }
        for (const std::string& axis : axesOf(experiment, numbers.columns, own)) {
            for (config::Case* item : own) {
                if (const Node value = axisOf(*item, axis); !value.isNull()) {
                    item->axes.set(axis, value);
                }
            }
        }
    }
}

/// The first parameter in which they differ.
std::string differenceOf(const config::Case& a, const config::Case& b) {
    for (const config::Case* one : {&a, &b}) {
        for (const auto& [name, value] : one->params.entries()) {
            const Node* other = (one == &a ? b : a).params.find(name);
            if (!other || !other->sameContent(value)) return name;
        }
    }
    return "scene";
}

/// What is measured here, too, has a case at each point of its sweep: one of two would go into the
/// other's cells.
void requireOnePerPoint(const ImportedNumbers& numbers, const run::Plan& plan) {
    std::map<std::string, std::size_t> first;
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        const config::Case& item = plan.cases[i];
        const auto experiment =
            std::ranges::find(plan.experiments, item.experiment, &Experiment::id);
        if (!config::isMeasuredHere(*experiment)) continue;
        const std::string point =
            fmt::format("{} {} {} {}", item.experiment, item.axes.toJson().dump(),
                        item.recordedScene(), item.sceneSample.value_or(-1));
        const auto [other, isNew] = first.try_emplace(point, i);
        if (isNew) continue;
        throw Error(
            numbers.cases[i].where,
            fmt::format("differs from line {} by '{}', which the sweep of {} does not have; "
                        "allowed: one case at each point of it; what repeats a case has "
                        "its number in the column 'process'",
                        numbers.cases[other->second].where.line,
                        differenceOf(plan.cases[other->second], item), item.experiment));
    }
}

/// Ids, as a plan that is read must have them.
void identify(const ImportedNumbers& numbers, run::Plan& plan) {
    std::map<std::string, int> lines;
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        config::Case& item = plan.cases[i];
        if (!item.scene.isNull())
            plan.sceneKeys[item.scene.text()] = "imported " + item.scene.text();
        item.id = run::caseId(item, run::toJson(item), plan);
        const SourceLocation& where = numbers.cases[i].where;
        const auto [known, isNew] = lines.try_emplace(item.id, where.line);
        if (!isNew) {
            throw Error(
                where, fmt::format("the same case as in line {}: {}", known->second, item.title()));
        }
    }
    std::vector<run::Json> documents;
    for (const Experiment& experiment : plan.experiments) {
        documents.push_back(experiment.document.toJson());
    }
    plan.hash = run::planHash(plan, documents);
}

run::Json manifestOf(const run::Plan& plan, const ImportRequest& request, const std::string& sha256,
                     std::size_t rowCount) {
    const std::string file = request.files.file.filename().string();
    run::Json manifest = {
        {"schema", 1},
        {"commit", run::programCommit()},
        {"build", run::programBuild()},
        {"build_id", plan.buildId},
        {"plan", plan.hash},
        {"profile", plan.profile},
        {"started", run::utcTime()},
        {"cpu", "not known: imported"},
        {"cores", 0},
        {"device_class", plan.deviceClass},
        {"gl", {{"vendor", ""}, {"renderer", request.machine}, {"version", ""}}},
        {"scenes", run::Json::object()},
        {"invocations", run::Json::array()},
        {"imported",
         {{"file", file}, {"sha256", sha256}, {"rows", rowCount}, {"machine", request.machine}}}};
    run::beginInvocation(manifest, request.commandLine);
    run::addNote(manifest,
                 fmt::format("imported: these numbers were measured elsewhere, on {}, and not "
                             "by this program; they are those of {} (SHA-256 {})",
                             request.machine, file, sha256.substr(0, 12)));
    return manifest;
}

}  // namespace

run::StoredRun importRun(const ImportRequest& request, const scene::Catalog& catalog,
                         std::span<const technique::TechniqueInfo> techniques) {
    ImportFiles files = request.files;
    files.isSeedSwept = std::ranges::any_of(request.experiments, isSeedSwept);
    files.isSeedLeftOut = std::ranges::any_of(request.experiments, isSeedLeftOut);
    const ImportedNumbers numbers = readImport(files);
    run::StoredRun run;
    run::Plan& plan = run.plan;
    plan.profile = request.profile;
    plan.deviceClass = request.isOfGpu ? "gpu" : "software";
    const std::string fileHash = sha256OfFile(request.files.file);
    plan.buildId = "imported-" + sha256(fileHash);
    plan.experiments = request.experiments;
    for (const Experiment& experiment : plan.experiments) {
        plan.request.configs.push_back(experiment.file.string());
    }
    if (plan.experiments.empty()) plan.experiments = {plainExperiment(request.files.file)};
    const bool isPlain = request.experiments.empty();
    run::requireCaseCount(numbers.cases.size(), plan.experiments.front());
    for (const ImportedCase& given : numbers.cases) {
        plan.cases.push_back(caseFrom(
            given, isPlain ? plan.experiments.front() : experimentOf(given, plan.experiments)));
    }
    takeMeasures(numbers, plan.cases);
    takeAxes(numbers, plan);
    requireSeeds(numbers, plan, request.files.file);
    requireNames(numbers, plan, request.files.file);
    for (Experiment& experiment : plan.experiments) {
        experiment.paperCases = run::resolvePaperCases(experiment, catalog, techniques);
        if (config::isMeasuredHere(experiment) && experiment.hasDefaultLayout()) {
            experiment.outputs =
                technique::outputsOf(technique::findTechnique(techniques, experiment.technique, {}),
                                     config::programOf(experiment));
        }
        std::vector<config::Case> own;
        std::ranges::copy_if(plan.cases, std::back_inserter(own), [&](const config::Case& item) {
            return item.experiment == experiment.id;
        });
        run::bindAssumptions(experiment, own, catalog, techniques);
    }
    identify(numbers, plan);
    requireOnePerPoint(numbers, plan);
    for (const ImportedRow& row : numbers.rows) {
        const config::Case& item = plan.cases[row.caseIndex];
        records::Record record = row.record;
        record.caseId = item.id;
        record.table = item.experiment;
        record.technique = item.technique;
        record.method = item.method();
        record.scene = item.recordedScene();
        run.records.push_back(std::move(record));
    }
    run.manifest = manifestOf(plan, request, fileHash, run.records.size());
    return run;
}

void writeImported(const run::RunDirectory& directory, const run::StoredRun& run) {
    run.plan.writeFile(directory.planFile());
    records::writeRecords(directory.recordsFile(), run.records);
    directory.note(
        run::Json{{"event", "imported"}, {"message", run::notesOf(run.manifest).front()}});
    run::Json manifest = run.manifest;
    run::sealRecords(manifest, directory.path());
    writeFileAtomic(directory.manifestFile(), manifest.dump(2) + '\n');
}

void requireNotImported(const run::Json& manifest, const std::string& runDir,
                        const std::string& purpose) {
    if (!manifest.contains("imported")) return;
    throw Error(fmt::format("{}: was imported; there is nothing to {}", runDir, purpose));
}

}  // namespace gfxrepro::outcome
