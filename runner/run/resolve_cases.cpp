// The cases of an experiment, every parameter resolved by the technique that declares it.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/run/ledger.h"
#include "runner/run/plan.h"
#include "runner/tables/cell.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

/// The parameter of techniques that save pictures only when they are asked to.
constexpr const char* kPictures = "pictures";

/// A user's own scene file is named relative to the config; a worker gets the absolute path.
Node absoluteReference(const Node& reference, const scene::Catalog& catalog) {
    if (!reference.isScalar() || catalog.entries().contains(reference.text())) return reference;
    const fs::path path = reference.text();
    if (!scene::isSceneFile(reference.text()) || path.is_absolute()) return reference;
    const fs::path folder = fs::path(reference.location().file.text()).parent_path();
    return Node::scalar(fs::absolute(folder / path).lexically_normal().string(),
                        reference.location());
}

/// Keys with a dot are checked where `printed.at` is read. A value is one that the technique takes:
/// its type and range are the parameter's.
void requireKnownAt(const config::Printed& printed, const Case& item,
                    const technique::TechniqueInfo& info, const scene::Catalog& catalog) {
    std::vector<std::string> known;
    for (const auto& [name, value] : item.params.entries()) known.push_back(name);
    for (const auto& [name, value] : printed.at) {
        if (name.find('.') != std::string::npos) continue;
        if (name == "scene") {
            const std::string text = value.isScalar() ? value.text() : "";
            if (catalog.entries().contains(scene::sceneName(text))) continue;
            throw Error(value.location(), fmt::format("printed.at: scene is {}; allowed: a "
                                                      "catalogued scene",
                                                      value.toFlowText()));
        }
        if (std::ranges::find(known, name) == known.end()) {
            throw Error(value.location(),
                        "printed.at: '" + name + "' is no parameter" + suggestion(name, known));
        }
        Node given = item.given;
        given.set(name, value, value.location());
        Params params(given, "printed.at");
        if (!item.offered.isNull()) params.offer(item.offered);
        technique::makeTechnique(info, item.program, params);
    }
}

using Of = config::MetricInfo::Of;

/// The passes that a metric may be of: errors are of pictures, the runner's times of steps.
std::vector<std::string> passesOf(const config::MetricInfo& metric,
                                  const config::Outputs& outputs) {
    if (config::isTestOfMeans(metric.name)) return outputs.tested;
    const bool isError = config::isPictureError(metric.name);
    const bool isCommon =
        std::ranges::count(technique::commonMetrics(), metric.name, &config::MetricInfo::name) > 0;
    std::vector<std::string> names;
    for (const config::PassInfo& pass : outputs.passes) {
        const bool isPicture = std::ranges::count(outputs.withTruth, pass.name) > 0;
        if (isError ? isPicture : !isPicture || !isCommon) names.push_back(pass.name);
    }
    return names;
}

/// The passes that the metric is of; of none, why there are none.
std::string allowedPasses(const config::MetricInfo& metric, const config::Outputs& outputs) {
    if (const auto passes = passesOf(metric, outputs); !passes.empty()) {
        return joined(passes, " | ");
    }
    if (config::isTestOfMeans(metric.name)) {
        return "none, as no image has a truth of several 'frames': {frame: 1000, frames: 6}";
    }
    if (config::isPictureError(metric.name)) return "none, as no image has a truth";
    return "none, as there are no passes; the time of a whole frame is wall_time_ms";
}

/// What the runner takes of a whole frame or process has no pass, and not every pass has all.
void requireOfPass(const config::MetricInfo& metric, const std::string& pass,
                   const config::Outputs& outputs, const SourceLocation& where) {
    if (metric.of == Of::Whole) {
        std::vector<std::string> ofPasses;
        for (const config::MetricInfo& info : technique::commonMetrics()) {
            if (info.of != Of::Whole) ofPasses.push_back(info.name);
        }
        throw Error(where, fmt::format("metric '{}' is not taken of a pass; those that are: {}, "
                                       "and metrics of the technique",
                                       metric.name, joined(ofPasses)));
    }
    const std::vector<std::string> passes = passesOf(metric, outputs);
    const bool isOne = std::ranges::count(outputs.passes, pass, &config::PassInfo::name) > 0;
    if (!isOne || std::ranges::count(passes, pass) > 0) return;
    throw Error(where, fmt::format("metric '{}' is not taken of '{}'; allowed: {}", metric.name,
                                   pass, allowedPasses(metric, outputs)));
}

/// What there is of passes alone has one.
void requireNoWhole(const std::string& metric, const std::string& pass,
                    const config::Outputs& outputs, const SourceLocation& where) {
    const config::MetricInfo* info = outputs.find(metric);
    if (!info || info->of != Of::Pass || !pass.empty()) return;
    throw Error(where,
                fmt::format("metric '{}' is of a pass, and the cell names none; allowed: {}{}",
                            metric, passesOf(*info, outputs).empty() ? "" : "with pass: ",
                            allowedPasses(*info, outputs)));
}

/// `equal` names no pass: there is one at most.
void requireOnePass(const std::string& metric, const config::Outputs& outputs,
                    const SourceLocation& where) {
    const config::MetricInfo* info = outputs.find(metric);
    if (!info || info->of != Of::Pass) return;
    const std::vector<std::string> passes = passesOf(*info, outputs);
    if (passes.size() == 1) return;
    throw Error(where,
                fmt::format("equal: metric '{}' is of {}; allowed: one that is recorded once",
                            metric, passes.empty() ? "no pass" : joined(passes, " and of ")));
}

/// The keys of rows or columns, a swept axis without a value.
std::vector<tables::Key> labelKeys(const std::vector<config::LayoutAxis>& axes) {
    std::vector<tables::Key> keys = {{}};
    for (const config::LayoutAxis& axis : axes) {
        std::vector<tables::Key> longer;
        for (const tables::Key& key : keys) {
            std::vector<std::string> labels;
            for (const auto& [label, selection] : axis.labels) labels.push_back(label);
            if (axis.isSweepAxis()) labels.emplace_back();
            for (const std::string& label : labels) {
                longer.push_back(key);
                longer.back().push_back(label);
            }
        }
        keys = std::move(longer);
    }
    return keys;
}

void requireCells(const config::Layout& layout, const config::Outputs& outputs) {
    if (!layout.isGiven) return;
    for (const tables::Key& row : labelKeys(layout.rows)) {
        for (const tables::Key& column : labelKeys(layout.columns)) {
            if (column.size() == 1 && layout.computed(column[0])) continue;  // of what is recorded
            const tables::CellQuery cell = tables::makeQuery(layout, row, column);
            requireNoWhole(cell.metric, cell.pass, outputs, cell.location);
            const config::MetricInfo* info = outputs.find(cell.metric);
            if (info && !cell.pass.empty()) {
                requireOfPass(*info, cell.pass, outputs, cell.location);
            }
            if (!cell.equal) continue;
            requireOnePass(cell.equal->metric, outputs, cell.location);
        }
    }
}

/// A metric of a program with the name of a swept axis: a claim could mean either.
void requireOwnNames(const config::Experiment& experiment) {
    const Node& program = config::programOf(experiment);
    const config::Outputs outputs = config::readProgram(program).outputs;
    for (const config::AxisPoint& point : config::expandSweep(experiment.sweep)) {
        for (const auto& [axis, value] : point) {
            if (!outputs.find(axis)) continue;
            throw Error(config::placeOfMetric(program, axis),
                        fmt::format("program: metric '{}' has the name of an axis that is swept; "
                                    "allowed: another",
                                    axis));
        }
    }
}

/// What is laid out is recorded: metrics and passes of the technique.
void requireOutputs(const config::Experiment& experiment,
                    std::span<const technique::TechniqueInfo> techniques) {
    if (!config::isMeasuredHere(experiment)) return;
    const config::Outputs outputs =
        technique::outputsOf(technique::findTechnique(techniques, experiment.technique, {}),
                             config::programOf(experiment));
    const std::string owner = "technique '" + experiment.technique + "'";
    const auto require = [&](const config::Selection& selection) {
        const SourceLocation& where = selection.location;
        if (selection.metric) outputs.requireMetric(*selection.metric, owner, where);
        if (selection.equal) outputs.requireMetric(selection.equal->metric, owner, where);
        if (selection.pass && !selection.pass->empty()) {
            outputs.requirePass(*selection.pass, owner, where);
            if (selection.metric) {
                requireOfPass(*outputs.find(*selection.metric), *selection.pass, outputs, where);
            }
        }
    };
    require(experiment.layout.cell);
    for (const auto* axes : {&experiment.layout.rows, &experiment.layout.columns}) {
        for (const config::LayoutAxis& axis : *axes) {
            for (const auto& [label, selection] : axis.labels) require(selection);
        }
    }
    requireCells(experiment.layout, outputs);
    if (!config::programOf(experiment).isNull()) requireOwnNames(experiment);
}

/// The value of a key of the config; its file where there is none.
SourceLocation placeOf(const GivenKey& key, const config::Experiment& experiment) {
    return key ? key->location() : SourceLocation{experiment.file.string(), 0, 0};
}

/// Whether some source of the case's scene, at hand or not, has seeds.
bool mayHaveSeeds(const Case& item, const scene::Catalog& catalog) {
    if (item.scene.isNull()) return false;
    const auto entry = catalog.entries().find(scene::sceneName(item.scene.text()));
    return entry != catalog.entries().end() &&
           std::ranges::any_of(entry->second.sources, &scene::SceneSource::isSeeded);
}

/// No key is ignored: a scene is read by some case, seeds are of one that has any. A file that is
/// extended may give what this one lacks.
void requireRead(const config::Experiment& experiment, const std::vector<Case>& cases,
                 bool needsScene, const scene::Catalog& catalog) {
    if (cases.empty()) return;
    const auto isOwn = [&](const SourceLocation& where) {
        const std::string& file = where.file.text();
        return file == experiment.file.string() || file.starts_with(config::kCommandLine);
    };
    const auto unread = std::ranges::find_if(cases, [&](const Case& item) {
        return !item.scene.isNull() && item.program.isNull() && isOwn(item.scene.location());
    });
    if (!needsScene && unread != cases.end()) {
        throw Error(unread->scene.location(),
                    fmt::format("scene '{}': technique '{}' reads none as it is set here",
                                unread->scene.text(), unread->technique));
    }
    const bool hasSeeds =
        std::ranges::any_of(cases, [&](const Case& item) { return mayHaveSeeds(item, catalog); });
    const SourceLocation seeds =
        placeOf(config::contentOf(experiment.document).sceneSeeds, experiment);
    if (experiment.measure.sceneSeeds < 2 || hasSeeds || !isOwn(seeds)) return;
    throw Error(seeds, fmt::format("'scene_seeds' is {}, and no case has a generated scene",
                                   experiment.measure.sceneSeeds));
}

/// A scene where the technique needs one, and of the kind that it takes. What a generator makes is
/// seen when it runs.
void requireScene(const Case& item, technique::SceneNeed need, const config::Experiment& experiment,
                  const scene::Catalog& catalog) {
    if (need == technique::SceneNeed::Nothing) return;
    const bool needsHeights = need == technique::SceneNeed::HeightMap;
    const char* wanted = needsHeights ? "a height map (.png, .tif, .hgt, .raw)"
                                      : "a model (.glb, .gltf, .obj, .ply)";
    if (item.scene.isNull()) {
        throw Error(placeOf(config::contentOf(experiment.document).technique, experiment),
                    fmt::format("technique '{}' needs a scene: `scene:` with a name of `gfxrepro "
                                "list scenes`, or {} beside this file",
                                item.technique, wanted));
    }
    const scene::SceneSource source = catalog.resolve(item.scene);
    if (source.generator || source.heightMap.has_value() == needsHeights) return;
    throw Error(item.scene.location(),
                fmt::format("scene '{}' is {}; technique '{}' takes {}", item.scene.text(),
                            needsHeights ? "a model" : "a height map", item.technique, wanted));
}

/// A table that nobody laid out shows what its cases look like: techniques save pictures when they
/// are asked to.
void offerPictures(const technique::TechniqueInfo& info, Case& item) {
    if (item.given.find(kPictures) || (item.offered.isMap() && item.offered.find(kPictures)))
        return;
    Params params(item.given, "technique '" + std::string(info.name) + "'");
    technique::makeTechnique(info, item.program, params);
    const bool isTaken = std::ranges::any_of(
        params.declared(), [](const auto& param) { return param.name == kPictures; });
    if (isTaken) item.offered.set(kPictures, Node::scalar("true"));
}

/// Throws Error for two cases that are alike. Those whose scenes have two names, but one content,
/// makePlan finds.
void requireDistinct(const config::Experiment& experiment, const std::vector<Case>& cases) {
    std::set<std::string> known;
    for (const Case& item : cases) {
        // All else of a case follows from these.
        const std::string key = item.axes.toJson().dump() + item.scene.toJson().dump() +
                                std::to_string(item.sceneSample.value_or(-1));
        if (known.insert(sha256(key)).second) continue;
        throw Error(experiment.file.string() + ": the sweep gives the case '" + item.title() +
                    "' twice");
    }
}

/// A title stands in every line of the journal, in tables and in pictures. Throws Error with the
/// place of the longest value of an axis.
void requireModestTitle(const config::Experiment& experiment, const Case& item) {
    constexpr std::size_t kMostBytes = 4096;
    const std::size_t size = item.title().size();
    if (size <= kMostBytes) return;
    std::size_t longest = experiment.id.size();
    std::string what = "the id";
    SourceLocation where{experiment.file.string(), 0, 0};
    for (const auto& [axis, value] : item.axes.entries()) {
        const std::size_t own = value.toFlowText().size();
        if (own <= longest) continue;
        longest = own;
        what = "a value of axis '" + axis + "'";
        where = value.location();
    }
    throw Error(where, fmt::format("{} has {} bytes, its case's title {}; at most {} are allowed",
                                   what, longest, size, kMostBytes));
}

/// Throws Error, at the place of `output.frames`, for more of them than the technique has.
void requireFrames(const technique::Technique& technique, const config::Experiment& experiment) {
    try {
        technique.requireFrames(experiment.measure.frames);
    } catch (const Error& error) {
        throw Error(placeOf(config::outputOf(experiment.document).frames, experiment),
                    error.what());
    }
}

/// What a technique needs beside a swept parameter, with how a sweep says so.
[[noreturn]] void throwWithWhen(const Error& error, const Case& item) {
    const std::string text = error.what();
    std::smatch found;
    static const std::regex kNeeds(R"('(\w+)' needs '(\w+): (\w+)'$)");
    if (!std::regex_search(text, found, kNeeds) || !item.axes.find(found[1].str())) throw;
    const std::string place = toString(error.where()) + ": ";
    throw Error(
        error.where(),
        fmt::format("{}; or `when: {{{}: {{{}: {}}}}}` in `sweep`, for the cases that have it",
                    text.substr(text.starts_with(place) ? place.size() : 0), found[1].str(),
                    found[2].str(), found[3].str()));
}

}  // namespace

void requireCaseCount(std::size_t count, const config::Experiment& experiment) {
    if (count <= kMostCases) return;
    throw Error(fmt::format("{}: the plan has {} cases; at most {} are allowed",
                            experiment.file.string(), count, kMostCases));
}

std::size_t unitCount(std::span<const Case> cases) {
    std::size_t count = 0;
    for (const Case& item : cases) {
        count += static_cast<std::size_t>(std::max(item.measure.mostRounds(), 0));
    }
    return count;
}

void requireUnitCount(std::size_t count, const SourceLocation& where) {
    if (count <= kMostUnits) return;
    throw Error(where, fmt::format("the plan has {} measurements (cases × processes); at most {} "
                                   "are allowed",
                                   count, kMostUnits));
}

namespace {

/// Gives each case of the sweep to `take`, without what takes a scene's place: there may be
/// 100,000.
void forEachCase(const config::Experiment& experiment, const scene::Catalog& catalog,
                 std::span<const technique::TechniqueInfo> techniques, std::uint64_t seed,
                 const std::function<void(Case, technique::SceneNeed)>& take) {
    if (!config::isMeasuredHere(experiment)) return;
    const technique::TechniqueInfo& info = technique::findTechnique(
        techniques, experiment.technique,
        placeOf(config::contentOf(experiment.document).technique, experiment));
    std::vector<Case> cases = config::expandCases(experiment);
    requireCaseCount(cases.size(), experiment);
    const bool drawsNumbers = !info.createFrom && info.outputs().areRandom;
    for (Case& given : cases) {
        Case item = std::move(given);
        if (drawsNumbers) item.measure.seeds = config::Measure::Seeds::Process;
        takeInstead(experiment.paramsInstead, item);
        item.program = config::programOf(experiment);
        Params params(item.given, "technique '" + std::string(info.name) + "'");
        technique::SceneNeed need{};
        try {
            if (experiment.hasDefaultLayout()) offerPictures(info, item);
            if (!item.offered.isNull()) params.offer(item.offered);
            const auto technique = technique::makeTechnique(info, item.program, params);
            need = technique->sceneNeed();
            requireFrames(*technique, experiment);
        } catch (const Error& error) {
            throwWithWhen(error, item);
        }
        params.finish();
        item.scene = absoluteReference(item.scene, catalog);
        Node resolved = params.resolved();
        for (const auto& [name, value] : item.params.entries()) {
            resolved.set(name, value, item.params.keyLocation(name));
        }
        item.params = std::move(resolved);
        requireModestTitle(experiment, item);
        item.seed = seed;
        // Of a program that takes {seed} it is a parameter.
        const Node* own = item.params.find(config::placeholder::kSeed);
        if (own && !item.program.isNull()) item.seed = static_cast<std::uint64_t>(own->asInteger());
        take(std::move(item), need);
    }
}

}  // namespace

std::vector<Case> resolveParameters(const config::Experiment& experiment,
                                    const scene::Catalog& catalog,
                                    std::span<const technique::TechniqueInfo> techniques,
                                    std::uint64_t seed) {
    std::vector<Case> cases;
    forEachCase(experiment, catalog, techniques, seed,
                [&](Case item, technique::SceneNeed) { cases.push_back(std::move(item)); });
    return cases;
}

std::vector<Case> resolveCases(const config::Experiment& experiment, const scene::Catalog& catalog,
                               std::span<const technique::TechniqueInfo> techniques,
                               std::uint64_t seed) {
    std::vector<Case> cases;
    std::map<std::string, technique::SceneNeed> asked;
    bool needsScene = false;
    forEachCase(experiment, catalog, techniques, seed, [&](const Case& item, const auto need) {
        const std::string scene = item.scene.isNull() ? "" : item.scene.text();
        needsScene |= need != technique::SceneNeed::Nothing;
        const auto [known, isNew] = asked.try_emplace(scene, need);
        if (isNew || known->second != need) requireScene(item, need, experiment, catalog);
        std::ranges::move(withScenes(item, experiment, catalog), std::back_inserter(cases));
    });
    requireCaseCount(cases.size(), experiment);
    requireUnitCount(unitCount(cases), {experiment.file.string(), 0, 0});
    requireOutputs(experiment, techniques);
    requireRead(experiment, cases, needsScene, catalog);
    requireTaken(experiment, cases);
    requireSceneNames(experiment, cases, catalog);
    requireDistinct(experiment, cases);
    return cases;
}

std::vector<Case> resolvePaperCases(const config::Experiment& experiment,
                                    const scene::Catalog& catalog,
                                    std::span<const technique::TechniqueInfo> techniques) {
    if (experiment.paperDocument.isNull()) return {};
    const config::Experiment paper =
        config::experimentFromDocument(experiment.paperDocument, experiment.file);
    std::vector<Case> cases = resolveParameters(paper, catalog, techniques, 0);
    for (const Case& item : cases) {
        requireKnownAt(paper.printed, item,
                       technique::findTechnique(techniques, paper.technique, {}), catalog);
    }
    return cases;
}

}  // namespace gfxrepro::run
