#include "runner/tables/printed_parameters.h"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/records/csv.h"
#include "runner/tables/cell_builder.h"
#include "runner/tables/labels.h"

namespace gfxrepro::tables {

namespace {

using Json = nlohmann::ordered_json;

/// What techniques call the parameter that saves pictures and changes no number.
constexpr const char* kPictures = "pictures";

/// At what a case was measured: name and value as text, in an order that reads well.
using Settings = std::vector<std::pair<std::string, std::string>>;

std::string settingText(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return records::shortestText(value.get<double>());
    if (!value.is_array()) return value.dump();
    std::vector<std::string> items;
    for (const Json& item : value) items.push_back(settingText(item));
    return fmt::format("[{}]", joined(items));
}

/// Under which name settings have what `printed.at` names.
std::string settingNameOf(const std::string& name) {
    if (name == "measure.frames") return "frames";
    return name.starts_with("output.") ? "output" : name;
}

/// Lays what `printed.at` says over a case.
void layPrintedOver(const config::Printed& printed, std::string& scene, Json& params,
                    Json& frames) {
    for (const auto& [name, value] : printed.at) {
        if (name == "scene") {
            scene = value.text();
        } else if (name == "measure.frames") {
            frames = value.toJson();
        } else if (name == "output.width" || name == "output.height") {
            params["output"][name.substr(name.find('.') + 1)] = value.toJson();
        } else {
            params[name] = value.toJson();
        }
    }
}

/// What records say of a case beside its parameters.
bool isNoParameter(const std::string& name) {
    return name == "output" || name == kPictures || name == config::kStandsFor ||
           name == config::kSceneSample;
}

/// A parameter that is null or empty is one that a case has not got: the tables of a run that was
/// exported, which tells these apart no more, and imported again say the same.
bool isNothing(const Json& value) {
    const bool isEmptyText = value.is_string() && value.get<std::string>().empty();
    return isEmptyText || (!value.is_string() && value.empty());
}

/// Of a generated scene at another seed ("outdoor/city@3") the name in the table: another sample of
/// it, not another parameter. Its generator's parameters are among the case's.
std::string sceneNameOf(const CaseRecords& item, const Json& params) {
    const auto named = params.find(config::kStandsFor);
    if (named == params.end()) return item.scene;
    const std::string name = settingText(*named);
    return scene::sceneName(item.scene) == name ? name : item.scene;
}

Settings settingsOf(const CaseRecords& item, int frameCount, const config::Printed& printed) {
    Json params = item.params.toJson();
    std::string scene = sceneNameOf(item, params);
    Json frames = frameCount;
    layPrintedOver(printed, scene, params, frames);
    Settings settings;
    if (!scene.empty()) settings.emplace_back("scene", scene);
    if (const auto output = params.find("output"); output != params.end()) {
        settings.emplace_back("output", fmt::format("{}×{}", settingText((*output)["width"]),
                                                    settingText((*output)["height"])));
    }
    for (const auto& [name, value] : params.items()) {
        if (isNoParameter(name) || isNothing(value)) continue;
        settings.emplace_back(name, settingText(value));
    }
    settings.emplace_back("frames", settingText(frames));
    return settings;
}

/// Each once, in the order of the cases.
template <class T>
void addOnce(T value, std::vector<T>& values) {
    if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
}

std::vector<Settings> settingsOf(const std::vector<const CaseRecords*>& cases, int frameCount,
                                 const config::Printed& printed) {
    std::vector<Settings> settings;
    for (const CaseRecords* item : cases) addOnce(settingsOf(*item, frameCount, printed), settings);
    return settings;
}

/// The values of a parameter in several cases.
std::vector<std::string> valuesOf(const std::string& name, const std::vector<Settings>& cases) {
    std::vector<std::string> values;
    for (const Settings& settings : cases) {
        for (const auto& [known, value] : settings) {
            if (known == name) addOnce(value, values);
        }
    }
    return values;
}

template <class T>
bool isSameSet(std::vector<T> a, std::vector<T> b) {
    std::ranges::sort(a);
    std::ranges::sort(b);
    return a == b;
}

/// Whatever the order of their parameters.
bool areSameCases(std::vector<Settings> a, std::vector<Settings> b) {
    for (auto* cases : {&a, &b}) {
        for (Settings& settings : *cases) std::ranges::sort(settings);
    }
    return isSameSet(std::move(a), std::move(b));
}

/// `isOpen` tells of a parameter whether the document leaves it open.
std::vector<Departure> departuresOf(const std::vector<Settings>& measured,
                                    const std::vector<Settings>& printed,
                                    const std::function<bool(const std::string&)>& isOpen) {
    std::vector<std::string> names;
    for (const auto* cases : {&printed, &measured}) {
        for (const Settings& settings : *cases) {
            for (const auto& [name, value] : settings) addOnce(name, names);
        }
    }
    std::vector<Departure> departures;
    for (const std::string& name : names) {
        Departure departure{name, valuesOf(name, measured), valuesOf(name, printed), isOpen(name)};
        if (!isSameSet(departure.measured, departure.printed)) {
            departures.push_back(std::move(departure));
        }
    }
    if (departures.empty()) {
        departures.push_back({"cases",
                              {std::to_string(measured.size())},
                              {std::to_string(printed.size())},
                              std::ranges::any_of(names, isOpen)});
    }
    return departures;
}

/// Whether a layout has such a row or column at all; values of swept axes may still be others.
bool hasKey(const std::vector<config::LayoutAxis>& axes,
            const std::vector<config::LayoutAxis>& asked, const Key& key) {
    if (axes.size() != asked.size()) return false;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].name != asked[i].name || axes[i].isSweepAxis() != asked[i].isSweepAxis()) {
            return false;
        }
        if (axes[i].isSweepAxis()) continue;
        const auto isLabel = [&](const auto& label) { return label.first == key[i]; };
        if (std::ranges::none_of(axes[i].labels, isLabel)) return false;
    }
    return true;
}

bool hasRun(const CaseRecords& item) {
    return std::ranges::any_of(item.processes,
                               [](const auto& process) { return !process.second.failure; });
}

}  // namespace

PrintedParameters::PrintedParameters(const config::Experiment& experiment) {
    if (experiment.paperCases.empty()) return;
    config::Experiment paper =
        config::experimentFromDocument(experiment.paperDocument, experiment.file);
    cases_ = gatherCases(paper, experiment.paperCases, {});
    layout_ = std::move(paper.layout);
    printed_ = std::move(paper.printed);
    for (const config::Assumption& assumption : paper.assumptions) {
        open_.insert(settingNameOf(assumption.name));
    }
    for (const auto& [name, value] : printed_.at) {
        open_.erase(settingNameOf(name));
        given_.insert(settingNameOf(name));
    }
    if (printed_.rows.empty()) return;
    for (const char* name : {"scene", "output", "measure.frames"})
        given_.insert(settingNameOf(name));
    for (const config::Case& item : config::expandCases(paper)) {
        for (const auto& [name, value] : item.given.entries()) given_.insert(settingNameOf(name));
        for (const auto& [name, value] : item.params.entries()) given_.insert(name);
    }
}

void PrintedParameters::compare(const config::Layout& layout, const Key& row, const Key& column,
                                const LayoutCases& cases, Cell& cell) const {
    if (!isKnown() || cell.values.empty()) return;
    if (!hasKey(layout_.rows, layout.rows, row) || !hasKey(layout_.columns, layout.columns, column))
        return;
    std::vector<const CaseRecords*> run = casesAt(whereOf(layout, row, column), cases);
    std::erase_if(run, [](const CaseRecords* item) { return !hasRun(*item); });
    const std::vector<Settings> measured = settingsOf(run, cases.frameCount, {});
    const std::vector<Settings> printed =
        settingsOf(casesAt(whereOf(layout_, row, column), cases_), cases_.frameCount, printed_);
    if (printed.empty()) return;
    cell.isAtPrintedParameters = areSameCases(measured, printed);
    if (!cell.isAtPrintedParameters) {
        cell.departures = departuresOf(measured, printed, [&](const std::string& name) {
            return open_.contains(name) || !given_.contains(name);
        });
    }
    for (const Settings& settings : printed) {
        for (const auto& [name, value] : settings) {
            const bool isSaid = std::ranges::find(cell.departures, name, &Departure::parameter) !=
                                cell.departures.end();
            if (name == "scene" || isSaid || !open_.contains(name)) continue;
            addOnce(name, cell.openParameters);
        }
    }
}

}  // namespace gfxrepro::tables
