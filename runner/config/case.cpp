#include "runner/config/case.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "engine/core/checks.h"
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
    constexpr double kMore = 1.5;
    return roundS * (rounds + 1) <= timeBudgetS ||
           (rounds < processes && roundS * processes <= kMore * timeBudgetS);
}

int Measure::certainRounds() const {
    return lane == Lane::Timing && isWithinBudget ? 1 : processes;
}

namespace {

using namespace types;

struct OutputKeys {
    GivenKey width, height;
};
const KeyTable<OutputKeys>& outputTable() {
    const auto side = [](const char* name, const char* doc) {
        return numberKey(name, kOutputSizesPx, std::to_string(kDefaultOutputPx), doc, "pixels");
    };
    static const KeyTable<OutputKeys> table{
        {"output", "output.", ""},
        {{&OutputKeys::width, side("width", "width of the image")},
         {&OutputKeys::height, side("height", "height of the image")}}};
    return table;
}

constexpr double kMost = 1'000'000;

/// The number, where it is given.
void take(const GivenKey& key, auto& value) {
    if (key) value = static_cast<std::remove_reference_t<decltype(value)>>(key.number("measure"));
}

}  // namespace

std::pair<int, int> readOutput(const Node& map) {
    const OutputKeys given = outputTable().readKnown(map, "output");
    const auto side = [](const GivenKey& key) {
        return key ? static_cast<int>(key.number("output")) : kDefaultOutputPx;
    };
    return {side(given.width), side(given.height)};
}

const KeyTable<MeasureKeys>& measureTable() {
    using M = MeasureKeys;
    const auto key = [](const char* name, const NumberRange& range, double value, const char* doc,
                        const char* unit = "") {
        return numberKey(name, range, Node::number(value).text(), doc, unit);
    };
    constexpr NumberRange kAny{.least = 0, .most = kMost, .isWhole = true};
    constexpr NumberRange kSome{.least = 1, .most = kMost, .isWhole = true};
    constexpr Measure kUsual{};
    static const KeyTable<M> table{
        {"measure", "measure.", ""},
        {{&M::lane, choiceKey("lane", std::array{"quality", "timing"}, "quality",
                              "how cases run (quality: may run beside others; timing: runs "
                              "alone)")},
         {&M::relativeError,
          key(kRelativeError, {.least = 0, .most = 1}, kUsual.relativeError,
              "rounds go on until half of each 95 % interval ÷ time is no more, and then to 14, 16 "
              "or 19, or to 20; with 6 to 19 processes in the timing lane; 0: they do not")},
         {&M::warmup,
          key("warmup", kAny, kUsual.warmup, "iterations before the first measured one")},
         {&M::repeats, key("repeats", kSome, kUsual.repeats, "measured iterations in one process")},
         {&M::processes,
          key("processes", kSome, kUsual.processes,
              "rounds: in each every case is run, in a process of its own; of times six, or as "
              "many as fit into the budget, where it is not given")},
         {&M::timeBudgetS,
          key(kTimeBudget, {.least = 0, .most = 1e9}, kUsual.timeBudgetS,
              "of all rounds of the file but those that 'processes' asks for: none is begun to end "
              "later, but where half more gives six",
              "seconds")},
         {&M::frames,
          key("frames", kFrameCounts, kUsual.frames, "frames of a path; each is repeated")},
         {&M::seeds,
          choiceKey("seeds", std::array{"case", "process"}, "case",
                    "random numbers of a technique that draws some, or of a program with {seed}; "
                    "of the latter as 'program.seeds' says (case: the same in all processes of a "
                    "case; process: others in each, so that errors have an interval)")},
         {&M::sceneSeeds,
          key("scene_seeds", {.least = 1, .most = kMostSceneSample + 1, .isWhole = true},
              kUsual.sceneSeeds,
              "seeds of a generated scene, from the catalogue's on: a case each, without times")},
         {&M::timeLimitS, key("time_limit_s", {.least = 1e-3, .most = 1e9}, kUsual.timeLimitS,
                              "of the whole case, scene loading included", "seconds")}}};
    return table;
}

MeasureKeys measureOf(const Node& document) {
    static const Node kNone;
    const GivenKey measure = contentOf(document).measure;
    return measureTable().find(measure ? *measure : kNone);
}

Measure readMeasure(const Node& map, Measure measure) {
    const MeasureKeys given = measureTable().readKnown(map, "measure");
    take(given.relativeError, measure.relativeError);
    // Who asks how well a time is known wants times.
    if (measure.relativeError > 0.0) measure.lane = Measure::Lane::Timing;
    if (given.lane) measure.lane = Measure::Lane(given.lane.choice("measure"));
    // Times are wanted with an interval, in about a minute.
    if (measure.lane == Measure::Lane::Timing) {
        measure.warmup = 1;
        measure.processes = kFewestRounds;
        measure.isWithinBudget = !given.processes;
    }
    take(given.warmup, measure.warmup);
    take(given.repeats, measure.repeats);
    take(given.processes, measure.processes);
    take(given.timeBudgetS, measure.timeBudgetS);
    take(given.frames, measure.frames);
    if (given.seeds) {
        const bool isByCase = given.seeds.choice("measure") == 0;
        measure.seeds = isByCase ? Measure::Seeds::Case : Measure::Seeds::Process;
    }
    take(given.sceneSeeds, measure.sceneSeeds);
    if (measure.sceneSeeds > 1 && measure.lane == Measure::Lane::Timing) {
        throw Error(given.sceneSeeds->location(),
                    "'scene_seeds' takes no times; allowed: 1, or with lane: quality");
    }
    take(given.timeLimitS, measure.timeLimitS);
    return measure;
}

SchemaSection outputKeys() {
    return outputTable().section();
}

SchemaSection measureKeys() {
    return measureTable().section();
}

}  // namespace gfxrepro::config
