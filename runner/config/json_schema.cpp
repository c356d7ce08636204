// The schema for editors: JSON Schema, draft 7, which YAML language servers understand.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/core/node.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

/// Axes that are parameters of a generated scene (kSceneAxisPrefix).
constexpr const char* kOfScene = "^scene[.]";
constexpr std::array<std::string_view, 4> kKinds = {"experiment", "preset", "scene", "documents"};

/// A reference swallows what stands beside it in draft 7.
Json beside(Json type) {
    if (!type.contains("$ref")) return type;
    return {{"allOf", Json::array({std::move(type)})}};
}

std::string descriptionOf(const SchemaKey& key) {
    std::string text = key.doc;
    if (!text.empty()) text += "\n";
    text += key.inWords();
    if (!key.absent.empty()) text += key.isRequired() ? "; required" : "; default: " + key.absent;
    return text;
}

Json propertyOf(const SchemaKey& key, bool isRemovable) {
    Json property = isRemovable ? orNull(key.json) : beside(key.json);
    property["description"] = descriptionOf(key);
    return property;
}

/// A section; where its keys are defined already, the definition, to which its own refer.
struct Part {
    const SchemaSection* section;
    std::string definition = {};
};

/// A map with the keys of these sections; the first says what else holds.
Json mapOfSections(const std::vector<Part>& parts) {
    Json properties = Json::object();
    Json required = Json::array();
    Json types = Json::object();  // kinds of claims may give a key of one name several
    for (const auto& [section, definition] : parts) {
        for (const SchemaKey& key : section->keys) {
            Json& known = types[key.name];
            if (std::find(known.begin(), known.end(), key.json) == known.end()) {
                known.push_back(key.json);
                const Json property =
                    definition.empty()
                        ? propertyOf(key, section->isRemovable)
                        : Json{{"$ref", fmt::format("{}/properties/{}", definition, key.name)}};
                Json& whole = properties[key.name];
                whole = whole.is_null() ? property : anyOf({whole, property});
            }
            // What is required may come from a file that is extended.
            if (key.isRequired() && !section->isRemovable) required.push_back(key.name);
        }
    }
    Json map = {{"type", "object"}, {"properties", std::move(properties)}};
    const Json& others = parts.front().section->others;
    map["additionalProperties"] = others.is_null() ? Json(false) : orNull(others);
    if (!required.empty()) map["required"] = std::move(required);
    for (const Part& part : parts) {
        if (part.section->conditions.is_object()) map.update(part.section->conditions);
    }
    return map;
}

bool isClaimType(const SchemaSection& section) {
    return section.name.starts_with("claim.");
}

/// What all claims have.
Part commonPart() {
    return {&schemaSection("claim"), "#/definitions/claim_common"};
}

/// One of the types, each with what all claims have.
Json claimType(const SchemaFile& file) {
    Json types = Json::array();
    for (const SchemaSection& section : file.sections) {
        if (!isClaimType(section)) continue;
        Json type = mapOfSections({{&section}, commonPart()});
        type["title"] = section.keys.front().name;
        types.push_back(std::move(type));
    }
    return {{"oneOf", std::move(types)}};
}

/// What a file may say that extends one which says the rest.
Json partOf(const std::vector<Part>& parts) {
    Json part = mapOfSections(parts);
    for (const char* key : {"required", "anyOf"}) part.erase(key);
    return part;
}

void addParts(const SchemaFile& file, Json& definitions) {
    std::vector<Part> claims = {commonPart()};
    for (const SchemaSection& section : file.sections) {
        if (isClaimType(section)) claims.push_back({&section});
    }
    definitions["claim_common"] = mapOfSections({{&schemaSection("claim")}});
    definitions["claim_part"] = partOf(claims);
    definitions["assumption_part"] = partOf({{&schemaSection("assumption")}});
}

/// Where nothing is extended, everything must be there.
Json wholeUnlessExtended() {
    return {{"if", {{"required", Json::array({"extends"})}}},
            {"else",
             {{"properties",
               {{"claims", mapOf(refTo("claim"))}, {"assumptions", mapOf(refTo("assumption"))}}}}}};
}

Json definitionsOf(const SchemaFile& file) {
    Json definitions = Json::object();
    for (const SchemaSection& section : file.sections) {
        if (isClaimType(section)) continue;
        definitions[section.name] =
            section.name == "claim" ? claimType(file) : mapOfSections({{&section}});
    }
    if (file.name == "experiment") addParts(file, definitions);
    return definitions;
}

/// What a parameter is swept over.
Json axisSchema(const std::string& technique, const std::string& param) {
    Json value = refTo("params_" + technique + "/properties/" + param);
    return orNull(anyOf({listOf(std::move(value), 1), refTo("axis")}));
}

Json namesType(const std::vector<std::string>& names) {
    Json exact = Json::array({nullptr});
    Json types = Json::array();
    for (const std::string& name : names) {
        if (name.ends_with('*')) {
            types.push_back({{"pattern", fmt::format("^{}", name.substr(0, name.size() - 1))}});
        } else {
            exact.push_back(name);
        }
    }
    types.push_back({{"enum", std::move(exact)}});
    return types.size() == 1 ? types[0] : Json{{"anyOf", std::move(types)}};
}

/// The metrics that all techniques have.
std::vector<std::string> commonMetrics(const SchemaNames& names) {
    std::vector<std::string> common;
    for (const MetricInfo& info : names.techniques.front().outputs.metrics) {
        const bool isCommon = std::ranges::all_of(
            names.techniques, [&](const auto& each) { return each.outputs.find(info.name); });
        if (isCommon) common.push_back(info.name);
    }
    return common;
}

/// What a layout may show of a technique: its metrics, beside those in `common`, and passes.
void defineLayout(const SchemaNames::TechniqueNames& technique,
                  const std::vector<std::string>& common, Json& definitions) {
    std::vector<std::string> metrics, passes;
    for (const MetricInfo& info : technique.outputs.metrics) {
        if (std::ranges::find(common, info.name) == common.end()) metrics.push_back(info.name);
        if (info.unit == "%") metrics.push_back(info.name + std::string(kShareOf));
    }
    for (const PassInfo& info : technique.outputs.passes) passes.push_back(info.name);
    definitions["metric_" + technique.name] = anyOf({refTo("metric"), namesType(metrics)});
    const Json metric = refTo("metric_" + technique.name);
    Json parts = {{"type", "object"},
                  {"properties", {{"metric", metric}, {"pass", namesType(passes)}}}};
    definitions["cell_" + technique.name] = parts;
    const Json labels = {{"additionalProperties",
                          {{"anyOf", Json::array({metric, refTo("cell_" + technique.name)})}}}};
    definitions["layout_" + technique.name] = {
        {"properties",
         {{"rows", labels}, {"columns", labels}, {"axes", {{"additionalProperties", labels}}}}}};
}

/// The parameters of a technique; its sweep, which has them as axes.
void defineTechnique(const SchemaNames::TechniqueNames& technique, Json& definitions) {
    Json params = Json::object();
    Json axes = Json::object();
    for (const std::string& key : keysOf("sweep")) axes[key] = anything();  // `sweep` says more
    for (const KeyInfo& info : technique.params) {
        Json param = propertyOf(info, true);
        param["default"] = parseYaml(info.absent, "default").toJson();
        params[info.name] = std::move(param);
        axes[info.name] = axisSchema(technique.name, info.name);
    }
    definitions["params_" + technique.name] = {{"type", {"object", "null"}},
                                               {"properties", std::move(params)},
                                               {"additionalProperties", false}};
    definitions["sweep_" + technique.name] = {{"type", {"object", "null"}},
                                              {"properties", std::move(axes)},
                                              {"patternProperties", {{kOfScene, anything()}}},
                                              {"additionalProperties", false}};
}

/// Whether a config is of a technique: it says so, or what it extends does, a preset that is named
/// after its technique.
Json isOfTechnique(const std::string& name) {
    std::string preset = name;
    std::ranges::replace(preset, '_', '-');
    const Json file = {{"type", "string"}, {"pattern", fmt::format("^presets/{}[.-]", preset)}};
    const Json extended = anyOf({file, {{"type", "array"}, {"contains", file}}});
    const Json says = {{"properties", {{"technique", {{"const", name}}}}},
                       {"required", Json::array({"technique"})}};
    const Json saysItself = anyOf(
        {{{"required", Json::array({"technique"})}}, {{"required", Json::array({"program"})}}});
    return anyOf({says,
                  {{"properties", {{"extends", extended}}},
                   {"required", Json::array({"extends"})},
                   {"not", saysItself}}});
}

/// `params` and `sweep` hold what the technique declares, in profiles too.
Json conditionOf(const SchemaNames::TechniqueNames& technique) {
    const Json measured = {{"params", refTo("params_" + technique.name)},
                           {"sweep", refTo("sweep_" + technique.name)}};
    Json profile = {{"type", {"object", "null"}}, {"properties", measured}};
    Json properties = measured;
    properties["layout"] = refTo("layout_" + technique.name);
    properties["profiles"] = {{"additionalProperties", std::move(profile)}};
    return {{"if", isOfTechnique(technique.name)},
            {"then", {{"properties", std::move(properties)}}}};
}

/// What holds of the names of a technique, and of which techniques there are.
void addNames(const SchemaNames& names, Json& definitions) {
    Json measured = Json::array(), techniques = Json::array();
    const std::vector<std::string> common = commonMetrics(names);
    definitions["metric"] = namesType(common);
    for (const SchemaNames::TechniqueNames& technique : names.techniques) {
        techniques.push_back(technique.name);
        if (technique.isOpen) continue;
        defineTechnique(technique, definitions);
        defineLayout(technique, common, definitions);
        measured.push_back(conditionOf(technique));
    }
    definitions["measured"] = {{"allOf", std::move(measured)}};
    Json& technique = definitions["content"]["properties"]["technique"];
    technique.erase("type");
    technique["enum"] = techniques;
    technique["enum"].push_back(kImported);
    technique["enum"].push_back(nullptr);
}

/// The keys of every config, which `file` defines ("" this one).
std::vector<Part> extendedParts(const std::string& file) {
    return {{&schemaSection("composition"), file + "#/definitions/composition"},
            {&schemaSection("content"), file + "#/definitions/content"}};
}

/// What experiments extend: a part of what they may have.
Json presetSchema() {
    const std::string file = "experiment.json";
    Json root = mapOfSections(extendedParts(file));
    root["allOf"] = Json::array({{{"$ref", file + "#/definitions/measured"}}});
    return root;
}

Json experimentSchemaOf(const SchemaNames& names) {
    std::vector<Part> parts = extendedParts("");
    parts.insert(parts.begin(), Part{&schemaSection("identity")});
    Json root = mapOfSections(parts);
    Json identities = Json::array();
    for (const std::string& key : identityKeys()) {
        identities.push_back({{"required", Json::array({key})}});
    }
    root["oneOf"] = std::move(identities);
    root.update(needsOneOf(
        {{"title", "technique"}, {"title", "program"}, {"title", "printed"}, {"extends"}}));
    root["definitions"] = definitionsOf(schema().front());
    root["allOf"] = Json::array({wholeUnlessExtended(), refTo("measured")});
    addNames(names, root["definitions"]);
    return root;
}

Json sceneOrDocuments(std::string_view kind, const SchemaNames& names) {
    for (const SchemaFile& file : schema()) {
        if (file.name != kind) continue;
        Json root = mapOfSections({{&file.sections.front()}});
        root["definitions"] = definitionsOf(file);
        if (kind == "scene" && !names.generators.empty()) {
            Json& source = root["definitions"]["generator_source"]["properties"];
            source["generator"].erase("type");
            source["generator"].update(choice(names.generators));
        }
        return root;
    }
    throw UsageError(fmt::format("schema '{}'; allowed: {}", kind, fmt::join(kKinds, ", ")));
}

/// On one line what fits there: people read it, and the differences between two versions.
std::string dumped(const Json& json, std::size_t indent) {
    constexpr std::size_t kMaxColumns = 200;
    const std::string flat = json.dump();
    if (!json.is_structured() || indent + flat.size() <= kMaxColumns) return flat;
    std::vector<std::string> lines;
    for (const auto& [key, value] : json.items()) {
        const std::string name = json.is_object() ? Json(key).dump() + ": " : "";
        lines.push_back(fmt::format("{:{}}{}{}", "", indent + 1, name, dumped(value, indent + 1)));
    }
    const std::string text = fmt::format("\n{}\n{:{}}", fmt::join(lines, ",\n"), "", indent);
    return json.is_object() ? fmt::format("{{{}}}", text) : fmt::format("[{}]", text);
}

}  // namespace

std::string jsonSchema(std::string_view kind, const SchemaNames& names) {
    Json root = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", fmt::format("gfxrepro {}", kind)}};
    root.update(kind == "experiment" ? experimentSchemaOf(names)
                : kind == "preset"   ? presetSchema()
                                     : sceneOrDocuments(kind, names));
    return dumped(root, 0) + "\n";
}

}  // namespace gfxrepro::config
