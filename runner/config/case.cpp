#include "runner/config/case.h"

#include <algorithm>

#include "engine/core/checks.h"
#include "engine/core/params.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/experiment.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

const Node& sceneAt(const AxisPoint& point, const Experiment& experiment) {
    const auto swept = std::ranges::find(point, "scene", &Node::Entry::key);
    return swept == point.end() ? experiment.scene : swept->value;
}

namespace {

/// `params` with those of the scene laid over.
Node paramsOf(const Node& scene, const Experiment& experiment) {
    Node params = experiment.params;
    const Node* own =
        scene.isScalar() ? experiment.paramsByScene.find(scene::sceneName(scene.text())) : nullptr;
    if (!own) return params;
    for (const auto& [name, value] : own->entries()) {
        params.set(name, value, own->keyLocation(name));
    }
    return params;
}

}  // namespace

int outputSize(const Node& value, std::string_view axis) {
    return static_cast<int>(numberIn(value, kOutputSizesPx, axis));
}

std::vector<Case> expandCases(const Experiment& experiment) {
    std::vector<Case> cases;
    if (experiment.technique.empty()) return cases;
    for (AxisPoint& point : expandSweep(experiment.sweep)) {
        Case item;
        item.experiment = experiment.id;
        item.technique = experiment.technique;
        item.measure = experiment.measure;
        item.scene = sceneAt(point, experiment);
        item.given = paramsOf(item.scene, experiment);
        item.params = Node::map({});
        for (const auto& [name, value] : experiment.sceneParams.entries()) {
            item.params.set(std::string(kSceneAxisPrefix) + name, value,
                            experiment.sceneParams.keyLocation(name));
        }
        item.outputWidthPx = experiment.outputWidthPx;
        item.outputHeightPx = experiment.outputHeightPx;
        for (const auto& [axis, value] : point) {
            if (axis == "scene") continue;
            if (axis.starts_with(kSceneAxisPrefix)) {
                item.params.set(axis, value, value.location());
            } else if (axis == "output.width") {
                item.outputWidthPx = outputSize(value, axis);
            } else if (axis == "output.height") {
                item.outputHeightPx = outputSize(value, axis);
            } else {
                item.given.set(axis, value);
            }
        }
        item.axes = Node::map(std::move(point));
        cases.push_back(std::move(item));
    }
    return cases;
}

std::string Case::title() const {
    std::string title = experiment;
    if (!axes.isMap()) return title;
    for (const auto& [name, value] : axes.entries()) {
        title += ' ' + name + '=' + (value.isScalar() ? value.text() : value.toFlowText());
    }
    // A file with its units is no other scene.
    const bool isOther = !standsFor.isNull() && !scene::isSceneFile(scene.text());
    if (isOther) title += " (" + scene.text() + ")";
    return title;
}

std::string Case::slug() const {
    std::string slug = experiment;
    std::replace(slug.begin(), slug.end(), '/', '-');
    return slug;
}

std::string Case::method() const {
    const Node* method = params.find("method");
    return method ? method->text() : "";
}

std::string Case::recordedScene() const {
    const Node* swept = axes.find("scene");
    const Node& shown = swept && standsFor.isNull() ? *swept : scene;
    return shown.isNull() ? "" : shown.text();
}

Node Case::recordedParams() const {
    Node recorded = params;
    recorded.set("output", Node::map({{"width", Node::number(outputWidthPx)},
                                      {"height", Node::number(outputHeightPx)}}));
    if (!standsFor.isNull()) recorded.set(kStandsFor, standsFor);
    if (sceneSample) recorded.set(kSceneSample, Node::number(*sceneSample));
    return recorded;
}

Node Case::sceneParams() const {
    Node own = Node::map({});
    for (const auto& [name, value] : params.entries()) {
        if (!name.starts_with(kSceneAxisPrefix)) continue;
        own.set(name.substr(kSceneAxisPrefix.size()), value, params.keyLocation(name));
    }
    return own;
}

bool Measure::mayContinue() const {
    return relativeError > 0.0 && lane == Lane::Timing && processes >= kFewestRounds &&
           processes < kMostRounds;
}

bool Measure::mayFollow(int rounds, double roundS) const {
    constexpr double kMore = 1.25;
    return roundS * (rounds + 1) <= timeBudgetS ||
           (rounds < processes && roundS * processes <= kMore * timeBudgetS);
}

int Measure::certainRounds() const {
    return lane == Lane::Timing && isWithinBudget ? 1 : processes;
}

std::pair<int, int> readOutput(Params& params) {
    const auto side = [&](const char* name, const char* doc) {
        return params.getInt(name, kDefaultOutputPx,
                             {doc, "pixels", kOutputSizesPx.least, kOutputSizesPx.most});
    };
    const int width = side("width", "width of the image");
    const int height = side("height", "height of the image");
    params.finish();
    return {width, height};
}

Measure readMeasure(Params& params, Measure measure) {
    constexpr Choice<Measure::Lane> kLanes[] = {
        {Measure::Lane::Quality, "quality", "may run beside others"},
        {Measure::Lane::Timing, "timing", "runs alone"}};
    constexpr double kMax = 1'000'000;
    constexpr Choice<Measure::Seeds> kSeeds[] = {
        {Measure::Seeds::Case, "case", "the same in all processes of a case"},
        {Measure::Seeds::Process, "process", "others in each, so that errors have an interval"}};
    measure.lane = params.getEnum("lane", measure.lane, kLanes, {"how cases run"});
    measure.relativeError = params.getDouble(
        kRelativeError, measure.relativeError,
        {"rounds go on until half of each 95 % interval ÷ time is no more, and then "
         "to 14, 16 or 19, or to 20; with 6 to 19 processes in the timing lane; 0: they do not",
         "", 0, 1});
    // Who asks how well a time is known wants times.
    if (measure.relativeError > 0.0 && !params.isGiven("lane")) {
        measure.lane = Measure::Lane::Timing;
    }
    // Times are wanted with an interval, in about a minute.
    if (measure.lane == Measure::Lane::Timing) {
        measure.warmup = 1;
        measure.processes = kFewestRounds;
        measure.isWithinBudget = !params.isGiven("processes");
    }
    measure.warmup = params.getInt("warmup", measure.warmup,
                                   {"iterations before the first measured one", "", 0, kMax});
    measure.repeats = params.getInt("repeats", measure.repeats,
                                    {"measured iterations in one process", "", 1, kMax});
    measure.processes = params.getInt(
        "processes", measure.processes,
        {"rounds: in each every case is run, in a process of its own; of times six, or "
         "as many as fit into the budget, where it is not given",
         "", 1, kMax});
    measure.timeBudgetS = params.getDouble(
        kTimeBudget, measure.timeBudgetS,
        {"of all rounds of the file but those that 'processes' asks for: none is begun to end "
         "later, but where a quarter more gives six",
         "seconds", 0, 1e9});
    measure.frames = params.getInt(
        "frames", measure.frames,
        {"frames of a path; each is repeated", "", kFrameCounts.least, kFrameCounts.most});
    const bool isByProcess = measure.seeds == Measure::Seeds::Process;
    const Measure::Seeds seeds = params.getEnum(
        "seeds", isByProcess ? Measure::Seeds::Process : Measure::Seeds::Case, kSeeds,
        {"random numbers of a technique that draws some, or of a program with {seed}; of the "
         "latter as 'program.seeds' says"});
    if (measure.seeds != Measure::Seeds::None || params.isGiven("seeds")) measure.seeds = seeds;
    measure.sceneSeeds =
        params.getInt("scene_seeds", measure.sceneSeeds,
                      {"seeds of a generated scene, from the catalogue's on: a case each", "", 1,
                       kMostSceneSample + 1});
    if (measure.sceneSeeds > 1 && measure.lane == Measure::Lane::Timing) {
        throw Error(params.locationOf("scene_seeds"),
                    "'scene_seeds' needs the quality lane: a time varies by the process");
    }
    measure.timeLimitS =
        params.getDouble("time_limit_s", measure.timeLimitS,
                         {"of the whole case, scene loading included", "seconds", 1e-3, 1e9});
    params.finish();
    return measure;
}

namespace {

/// What a reader declares.
SchemaSection declared(const std::string& name, const Params& params) {
    SchemaSection section{name, name + ".", ""};
    for (const ParamInfo& info : params.declared()) {
        std::string type = info.range.empty() ? info.type : info.range;
        if (!info.unit.empty()) type += " " + info.unit;
        section.keys.push_back({info.name, type, info.defaultValue, info.doc, jsonTypeOf(info)});
    }
    return section;
}

}  // namespace

SchemaSection outputKeys() {
    Params params(Node(), "output");
    readOutput(params);
    return declared("output", params);
}

SchemaSection measureKeys() {
    Params params(Node(), "measure");
    readMeasure(params);
    return declared("measure", params);
}

}  // namespace gfxrepro::config
