#include "runner/config/case.h"

#include <fmt/format.h>

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
    return lane == Lane::Timing && !isWithinBudget && timeBudgetS > 0.0 &&
           processes >= kFewestRounds && processes < kMostRounds;
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

const KeyTable<OutputKeys>& outputTable() {
    const auto side = [](const char* name, const char* doc) {
        return numberKey(name, kOutputSizesPx, std::to_string(kDefaultOutputPx), doc, "pixels");
    };
    static const KeyTable<OutputKeys> table{
        {"output", "output.", ""},
        {{&OutputKeys::width, side("width", "width of the image")},
         {&OutputKeys::height, side("height", "height of the image")},
         {&OutputKeys::frames,
          numberKey("frames", kFrameCounts, "1", "frames of a path; each is measured")}}};
    return table;
}

constexpr double kMost = 1'000'000;

/// The number, where it is given.
void take(const GivenKey& key, auto& value) {
    if (key) value = static_cast<std::remove_reference_t<decltype(value)>>(key.number("measure"));
}

}  // namespace

std::tuple<int, int, int> readOutput(const Node& map) {
    const OutputKeys given = outputTable().readKnown(map, "output");
    const auto number = [](const GivenKey& key, int absent) {
        return key ? static_cast<int>(key.number("output")) : absent;
    };
    return {number(given.width, kDefaultOutputPx), number(given.height, kDefaultOutputPx),
            number(given.frames, 1)};
}

const KeyTable<MeasureKeys>& measureTable() {
    using M = MeasureKeys;
    const auto key = [](const char* name, const NumberRange& range, double value, const char* doc,
                        const char* unit = "") {
        return numberKey(name, range, Node::number(value).text(), doc, unit);
    };
    constexpr NumberRange kSome{.least = 1, .most = kMost, .isWhole = true};
    constexpr Measure kUsual{};
    static const KeyTable<M> table{
        {"measure", "measure.", ""},
        {{&M::lane, choiceKey("lane", std::array{"quality", "timing"}, "quality",
                              "how cases run (quality: side by side; timing: each alone, and "
                              "each frame is drawn once before it is timed)")},
         {&M::repeats,
          key("repeats", kSome, kUsual.repeats, "how often a process measures each frame")},
         {&M::processes,
          key("processes", kSome, kUsual.processes,
              "rounds, in each of which every case has a process of its own; where it is not "
              "given, of times six, or as many as fit into the budget")},
         {&M::timeBudgetS,
          numberKey(kTimeBudget, {.least = 0, .most = 1e9}, "60 without 'processes', else 0",
                    fmt::format("for all rounds of the file that are timed, and half more where "
                                "that gives six; beside {} to {} 'processes', which are all "
                                "measured, for further ones until each time is known to {:g} %, "
                                "{} in all at most",
                                kFewestRounds, kMostRounds - 1, 100.0 * kKnownTo, kMostRounds),
                    "seconds")},
         {&M::timeLimitS, key("time_limit_s", {.least = 1e-3, .most = 1e9}, kUsual.timeLimitS,
                              "for a case, the loading of its scene included", "seconds")}}};
    return table;
}

MeasureKeys measureOf(const Node& document) {
    static const Node kNone;
    const GivenKey measure = contentOf(document).measure;
    return measureTable().find(measure ? *measure : kNone);
}

OutputKeys outputOf(const Node& document) {
    static const Node kNone;
    const GivenKey output = contentOf(document).output;
    return outputTable().find(output ? *output : kNone);
}

Measure readMeasure(const Node& map, Measure measure) {
    const MeasureKeys given = measureTable().readKnown(map, "measure");
    if (given.lane) measure.lane = Measure::Lane(given.lane.choice("measure"));
    // Times are wanted with an interval, in about a minute.
    if (measure.lane == Measure::Lane::Timing) {
        measure.processes = kFewestRounds;
        measure.isWithinBudget = !given.processes;
        if (measure.isWithinBudget) measure.timeBudgetS = kUsualTimeBudgetS;
    }
    take(given.repeats, measure.repeats);
    take(given.processes, measure.processes);
    take(given.timeBudgetS, measure.timeBudgetS);
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
