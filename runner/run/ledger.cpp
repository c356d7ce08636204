#include "runner/run/ledger.h"

#include <fmt/format.h>
#include <algorithm>
#include <limits>
#include <set>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/tables/case_records.h"

namespace gfxrepro::run {

void takeInstead(const Node& instead, Case& item) {
    for (const auto& [name, value] : instead.entries()) {
        if (item.axes.find(name)) {
            throw Error(instead.keyLocation(name),
                        fmt::format("'{}': '{}' is swept here", config::kParamsInstead, name));
        }
        Node& map = item.given.find(name) ? item.given : item.offered;
        map.set(name, value, instead.keyLocation(name));
    }
}

std::vector<Case> withScenes(const Case& item, const config::Experiment& experiment,
                             const scene::Catalog& catalog) {
    if (item.scene.isNull()) return {item};
    Case first = item;
    if (const Node* other = experiment.sceneInstead.find(item.scene.text())) first.scene = *other;
    scene::SceneSource source = catalog.resolve(first.scene);
    const Node params = item.sceneParams();
    if (!params.entries().empty()) {
        scene::takeParams(scene::sceneName(first.scene.text()), params, source);
        first.scene = scene::withSceneParams(first.scene, params);
    }
    const int count = source.isSeeded() ? experiment.measure.sceneSeeds : 1;
    std::vector<Case> cases;
    for (int i = 0; i < count; ++i) {
        Case& taken = cases.emplace_back(first);
        if (count > 1) taken.sceneSample = i;
        if (i > 0)
            taken.scene = scene::withSeed(first.scene, source.seed + static_cast<std::uint64_t>(i));
        if (taken.scene.text() != item.scene.text()) taken.standsFor = item.scene;
    }
    return cases;
}

void requireTaken(const config::Experiment& experiment, const std::vector<Case>& cases) {
    for (const auto& [name, other] : experiment.sceneInstead.entries()) {
        const auto isTaken = [&name = name](const Case& item) {
            return !item.standsFor.isNull() && item.standsFor.text() == name;
        };
        if (std::ranges::any_of(cases, isTaken)) continue;
        throw Error(experiment.sceneInstead.keyLocation(name),
                    fmt::format("'{}': no case of {} has the scene '{}'", config::kSceneInstead,
                                experiment.id, name));
    }
}

void requireSceneNames(const config::Experiment& experiment, const std::vector<Case>& cases,
                       const scene::Catalog& catalog) {
    std::set<std::string> known, scenes;
    for (const auto& [name, entry] : catalog.entries()) scenes.insert(name);
    for (const Case& item : cases) {
        for (const auto& [name, value] : item.params.entries()) known.insert(name);
        const Node& scene = item.standsFor.isNull() ? item.scene : item.standsFor;
        if (!scene.isNull()) scenes.insert(scene::sceneName(scene.text()));
    }
    const auto require = [](const std::set<std::string>& names, const std::string& name,
                            const SourceLocation& where, const std::string& what) {
        if (names.contains(name)) return;
        const std::vector<std::string> all(names.begin(), names.end());
        throw Error(where, fmt::format("{}: {} '{}'{}", config::kParamsByScene, what, name,
                                       suggestion(name, all)));
    };
    for (const auto& [scene, params] : experiment.paramsByScene.entries()) {
        require(scenes, scene, experiment.paramsByScene.keyLocation(scene), "unknown scene");
        for (const auto& [name, value] : params.entries()) {
            require(known, name, params.keyLocation(name), "unknown parameter");
        }
    }
}

namespace {

using config::Assumption;

constexpr std::size_t kMostShown = 12;
/// What techniques call the camera or path of the scene that a case is seen along; some have views
/// of their own beside.
constexpr const char* kView = "view";

std::vector<KeyInfo> declaredBy(const config::Experiment& experiment,
                                std::span<const technique::TechniqueInfo> techniques) {
    Params none(Node::map({}), "technique '" + experiment.technique + "'");
    technique::makeTechnique(technique::findTechnique(techniques, experiment.technique, {}),
                             config::programOf(experiment), none);
    return none.declared();
}

const KeyInfo* findInfo(const std::vector<KeyInfo>& declared, const std::string& name) {
    const auto found = std::ranges::find(declared, name, &KeyInfo::name);
    return found == declared.end() ? nullptr : &*found;
}

bool isOfCases(const std::string& name) {
    return name == config::kOutputAssumption || name == config::kSceneAssumption ||
           name == config::kSceneSeedAssumption || name == config::kFramesAssumption;
}

std::string valueIn(const Case& item, const std::string& name, const scene::Catalog& catalog) {
    if (name == config::kOutputAssumption) {
        return item.outputWidthPx == item.outputHeightPx
                   ? std::to_string(item.outputWidthPx)
                   : fmt::format("{} × {}", item.outputWidthPx, item.outputHeightPx);
    }
    if (name == config::kSceneAssumption) return item.scene.isNull() ? "" : item.scene.text();
    if (name == config::kSceneSeedAssumption) {
        if (item.scene.isNull()) return "";
        const scene::SceneSource source = catalog.resolve(item.scene);
        return source.isSeeded() ? std::to_string(source.seed) : "";
    }
    if (name == config::kFramesAssumption) return std::to_string(item.measure.frames);
    const Node* value = item.params.find(name);
    return value ? tables::canonicalText(*value) : "";
}

/// Each value once, in the order of the cases.
std::string valuesOf(const std::string& name, const std::vector<Case>& cases,
                     const scene::Catalog& catalog) {
    std::vector<std::string> values;
    for (const Case& item : cases) {
        std::string value = valueIn(item, name, catalog);
        const bool isKnown = std::ranges::find(values, value) != values.end();
        if (!value.empty() && !isKnown) values.push_back(std::move(value));
    }
    if (values.empty()) return "none";
    if (values.size() > kMostShown) {
        return fmt::format("{}, …, {} ({} values)", values.front(), values.back(), values.size());
    }
    return joined(values);
}

std::string unitOf(const std::string& name, const KeyInfo* info) {
    if (name == config::kOutputAssumption) return "pixels";
    if (name == config::kFramesAssumption) return "frames";
    return info && info->unit != "1" ? info->unit : "";
}

bool isNumber(const Node& node) {
    return node.isScalar() && parseDouble(node.text()).has_value();
}

/// Numbers are what parameters take: a number whose name is nearly a parameter's is that one
/// misspelt, and a range of numbers is of one.
void requireFreeText(const Assumption& assumption, const config::Experiment& experiment,
                     const std::vector<KeyInfo>& declared) {
    std::vector<std::string> names = {config::kOutputAssumption, config::kSceneAssumption,
                                      config::kSceneSeedAssumption, config::kFramesAssumption};
    for (const KeyInfo& info : declared) names.push_back(info.name);
    const std::string near = suggestion(assumption.name, names);
    const auto refuse = [&](const SourceLocation& where, const std::string& what) {
        throw Error(where, fmt::format("assumption '{}' {}: it is no parameter of technique '{}'{}",
                                       assumption.name, what, experiment.technique, near));
    };
    if (assumption.value.isNull()) refuse(assumption.location, "needs 'value'");
    const Node& range = assumption.range;
    const bool isOfNumbers =
        isNumber(range) || (range.isSequence() && std::ranges::any_of(range.items(), isNumber));
    if (isOfNumbers) refuse(range.location(), "has a range of numbers");
    // A list is what is tried in its place, and only parameters are.
    if (!range.isNull() && (!range.isScalar() || range.text().find('\n') != std::string::npos)) {
        refuse(range.location(), "has a range that is no line of text");
    }
    if (isNumber(assumption.value) && !near.empty()) {
        refuse(assumption.value.location(), "is a number");
    }
}

[[noreturn]] void refuseRange(const Assumption& assumption, const Node& value,
                              const std::string& allowed) {
    throw Error(value.location(),
                fmt::format("assumption '{}': range is {}; allowed: {}", assumption.name,
                            value.isNull() ? "empty" : value.toFlowText(), allowed));
}

const Node::Sequence& listOf(const Assumption& assumption) {
    if (!assumption.range.isSequence() || assumption.range.items().empty()) {
        refuseRange(assumption, assumption.range, "a list of values, or [first, last]");
    }
    return assumption.range.items();
}

void requireWhole(const Assumption& assumption, const NumberRange& range) {
    const Node::Sequence& values = listOf(assumption);
    if (values.size() > 1 && std::ranges::all_of(values, [&](const Node& value) {
            return value.toFlowText() == values[0].toFlowText();
        })) {
        refuseRange(assumption, assumption.range, "one of more than one value");
    }
    for (const Node& value : values) {
        (void)numberIn(value, range, fmt::format("assumption '{}': range", assumption.name));
    }
}

void requireCatalogued(const Assumption& assumption, const Node& name,
                       const scene::Catalog& catalog) {
    const std::string text = name.isScalar() ? name.text() : "";
    std::vector<std::string> known;
    for (const auto& [entry, source] : catalog.entries()) known.push_back(entry);
    if (catalog.entries().contains(scene::sceneName(text))) return;
    refuseRange(assumption, name, "catalogued scenes" + suggestion(text, known));
}

/// Whether some source of the scene, at hand or not, is a height map. What a generator makes is
/// seen when it runs.
bool hasHeights(const scene::SceneEntry& entry) {
    return std::ranges::any_of(entry.sources, [](const scene::SceneSource& source) {
        return source.heightMap.has_value();
    });
}

/// Catalogued, each once, with a seed and parameters that its generator takes, and of the kind of
/// `scene`, whose place it takes.
void requireAlternatives(const Assumption& assumption, const Node& others, const std::string& scene,
                         const scene::Catalog& catalog) {
    if (!others.isSequence() || others.items().empty()) {
        refuseRange(assumption, others, "a list of scenes");
    }
    const auto own = catalog.entries().find(scene::sceneName(scene));
    std::vector<std::string> seen;
    for (const Node& other : others.items()) {
        requireCatalogued(assumption, other, catalog);
        if (std::ranges::find(seen, other.text()) != seen.end()) {
            refuseRange(assumption, other, "each scene once");
        }
        seen.push_back(other.text());
        const std::string name = scene::sceneName(other.text());
        if (name != other.text()) catalog.resolve(other);
        if (own == catalog.entries().end()) continue;
        const bool needsHeights = hasHeights(own->second);
        if (hasHeights(catalog.entries().at(name)) == needsHeights) continue;
        refuseRange(
            assumption, other,
            fmt::format("{} in the place of {}", needsHeights ? "height maps" : "models", scene));
    }
    if (seen == std::vector<std::string>{scene}) {
        refuseRange(assumption, others, "another scene than " + scene);
    }
}

void requireScenes(const config::Experiment& experiment, const Assumption& assumption,
                   const scene::Catalog& catalog) {
    const Node& range = assumption.range;
    if (range.isMap()) {
        for (const auto& [scene, others] : range.entries()) {
            const Node name = Node::scalar(scene, range.keyLocation(scene));
            requireCatalogued(assumption, name, catalog);
            requireAlternatives(assumption, others, scene, catalog);
        }
        return;
    }
    std::vector<std::string> names;
    for (const Case& item : config::expandCases(experiment)) {
        const std::string name = item.scene.isNull() ? "" : item.scene.text();
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    for (const Node& other : listOf(assumption)) requireCatalogued(assumption, other, catalog);
    if (names.size() > 1) {
        refuseRange(assumption, range,
                    fmt::format("{{NAME: [names]}}, as {} has {} scenes: {}", experiment.id,
                                names.size(), joined(names)));
    }
    requireAlternatives(assumption, range, names.empty() ? "" : names.front(), catalog);
}

/// Views are what the scenes of the cases have, whatever their seed.
void requireViews(const Assumption& assumption, const std::vector<Case>& cases,
                  const scene::Catalog& catalog) {
    std::vector<std::string> loaded;
    for (const Case& item : cases) {
        if (item.scene.isNull()) continue;
        const std::string name = scene::sceneName(item.scene.text());
        if (std::ranges::find(loaded, name) != loaded.end()) continue;
        loaded.push_back(name);
        const std::vector<std::string>& views = catalog.viewNames(item.scene);
        for (const Node& value : listOf(assumption)) {
            const std::string text = value.isScalar() ? value.text() : "";
            if (std::ranges::find(views, text) != views.end()) continue;
            refuseRange(assumption, value,
                        fmt::format("paths and cameras of {}, {}", item.scene.text(),
                                    views.empty() ? "which has none" : joined(views, " | ")));
        }
    }
}

/// Makes every case with the value; the technique refuses what it cannot take.
void requireReadable(const config::Experiment& experiment, const Assumption& assumption,
                     const technique::TechniqueInfo& info) {
    const std::vector<Case> cases = config::expandCases(experiment);
    for (const Node& value : listOf(assumption)) {
        for (Case item : cases) {
            item.axes = Node::map({});  // of a swept one, too
            takeInstead(Node::map({{assumption.name, value}}), item);
            Params params(item.given, "technique '" + std::string(info.name) + "'");
            if (!item.offered.isNull()) params.offer(item.offered);
            technique::makeTechnique(info, config::programOf(experiment), params);
        }
    }
}

/// A range of numbers holds what is measured: else it says nothing of how the outcome depends on
/// it. What is swept says so itself.
void requireMeasuredWithin(const Assumption& assumption, const std::vector<Case>& cases) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Node& value : listOf(assumption)) {
        const auto number = value.isScalar() ? parseDouble(value.text()) : std::nullopt;
        if (!number) return;
        low = std::min(low, *number);
        high = std::max(high, *number);
    }
    if (low == high) refuseRange(assumption, assumption.range, "one of more than one value");
    const bool isOfFrames = assumption.name == config::kFramesAssumption;
    for (const Case& item : cases) {
        const Node* param = item.params.find(assumption.name);
        const bool isParam = param && param->isScalar() && !item.axes.find(assumption.name);
        if (!isOfFrames && !isParam) continue;
        const std::string text = isOfFrames ? std::to_string(item.measure.frames) : param->text();
        const auto number = parseDouble(text);
        if (!number || (*number >= low && *number <= high)) continue;
        refuseRange(assumption, assumption.range,
                    fmt::format("one that holds what is measured, {}", text));
    }
}

}  // namespace

void bindAssumptions(config::Experiment& experiment, const std::vector<Case>& cases,
                     const scene::Catalog& catalog,
                     std::span<const technique::TechniqueInfo> techniques) {
    if (!config::isMeasuredHere(experiment)) return;
    const std::vector<KeyInfo> declared = declaredBy(experiment, techniques);
    for (Assumption& assumption : experiment.assumptions) {
        const KeyInfo* info = findInfo(declared, assumption.name);
        if (!info && !isOfCases(assumption.name)) {
            requireFreeText(assumption, experiment, declared);
            continue;
        }
        const auto refuse = [&](const SourceLocation& where, const char* key) {
            throw Error(where, fmt::format("assumption '{}': '{}' is filled in from the cases; "
                                           "allowed: range, why",
                                           assumption.name, key));
        };
        if (!assumption.value.isNull()) refuse(assumption.value.location(), "value");
        if (!assumption.unit.empty()) refuse(assumption.location, "unit");
        assumption.isBound = true;
        assumption.value = Node::scalar(valuesOf(assumption.name, cases, catalog));
        assumption.unit = unitOf(assumption.name, info);
    }
}

void requireRanges(const config::Experiment& experiment, const std::vector<Case>& cases,
                   const scene::Catalog& catalog,
                   std::span<const technique::TechniqueInfo> techniques) {
    constexpr NumberRange kSeeds{.least = 0, .most = 1'000'000'000, .isWhole = true};
    if (!config::isMeasuredHere(experiment)) return;
    const std::vector<KeyInfo> declared = declaredBy(experiment, techniques);
    for (const Assumption& assumption : experiment.assumptions) {
        if (!assumption.isBound || assumption.range.isNull()) continue;
        if (assumption.name == config::kOutputAssumption) {
            requireWhole(assumption, config::kOutputSizesPx);
        } else if (assumption.name == config::kSceneSeedAssumption) {
            requireWhole(assumption, kSeeds);
        } else if (assumption.name == config::kFramesAssumption) {
            requireWhole(assumption, config::kFrameCounts);
            requireMeasuredWithin(assumption, cases);
        } else if (assumption.name == config::kSceneAssumption) {
            requireScenes(experiment, assumption, catalog);
        } else {
            requireReadable(experiment, assumption,
                            technique::findTechnique(techniques, experiment.technique, {}));
            requireMeasuredWithin(assumption, cases);
            const KeyInfo* info = findInfo(declared, assumption.name);
            // A technique whose default is a view by name has views of its own.
            if (assumption.name == kView && info && info->type == "text" &&
                (info->absent.empty() || info->absent == "\"\"")) {
                requireViews(assumption, cases, catalog);
            }
        }
    }
}

std::vector<std::pair<std::string, Node>> alternativesOf(const Assumption& assumption,
                                                         const std::vector<std::string>& scenes) {
    std::vector<std::pair<std::string, Node>> alternatives;
    for (const std::string& name : scenes) {
        const Node* others =
            assumption.range.isMap() ? assumption.range.find(name) : &assumption.range;
        if (!others || !others->isSequence()) continue;
        for (const Node& other : others->items()) {
            if (other.text() != name) alternatives.emplace_back(name, other);
        }
    }
    return alternatives;
}

std::vector<std::string> sceneNames(const std::vector<Case>& cases) {
    std::vector<std::string> names;
    for (const Case& item : cases) {
        const Node& scene = item.standsFor.isNull() ? item.scene : item.standsFor;
        if (scene.isNull()) continue;
        if (std::ranges::find(names, scene.text()) == names.end()) names.push_back(scene.text());
    }
    return names;
}

}  // namespace gfxrepro::run
