#include "engine/scene/catalog_entry.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/scene/height_map.h"
#include "engine/scene/load.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

namespace {

using namespace types;

constexpr NumberRange kCounts{.least = 1, .isWhole = true};
constexpr NumberRange kSamplesPerSide{.least = 1, .most = kMaxHeightFileSide, .isWhole = true};
constexpr NumberRange kSeeds{.least = 0, .isWhole = true};
constexpr NumberRange kMetres{.least = 1e-9, .most = 1e6};

/// What the map has at the keys of the table, each required one among them; `what` begins messages.
template <class Given>
Given readTable(const KeyTable<Given>& table, const Node& map, const std::string& what) {
    if (!map.isMap()) {
        throw Error(map.location(), what + " is " + map.kindName() + ", but must be a map");
    }
    const std::vector<std::string>& names = table.names();
    for (const auto& [key, value] : map.entries()) {
        if (std::ranges::find(names, key) != names.end()) continue;
        throw Error(map.keyLocation(key), what + ": unknown key '" + key + "'" +
                                              suggestion(key, names) +
                                              " (allowed: " + joined(names) + ")");
    }
    const Given given = table.find(map);
    table.require(given, map.location(), what + ": ", " is missing");
    return given;
}

SchemaKey pointsKey() {
    return numberKey("points", kCounts, "none",
                     "points of the surface, or of the cloud, instead of it");
}

std::optional<long long> readWhole(const Node* node, const std::string& key,
                                   const NumberRange& range) {
    if (!node) return std::nullopt;
    (void)numberIn(*node, range, key);
    return node->asInteger();
}

void readSeed(const Node* node, SceneSource& source) {
    if (const auto seed = readWhole(node, "seed", kSeeds)) {
        source.seed = static_cast<std::uint64_t>(*seed);
    }
}

Json assetPath() {
    return {{"type", "string"}, {"minLength", 1}, {"pattern", "^[^/]"}};
}

std::string assetPathOf(const Node& node, const char* key) {
    const std::string& file = node.text();
    if (!file.empty() && !fs::path(file).is_absolute()) return file;
    throw Error(node.location(),
                fmt::format("{} is '{}', but must be a path within the assets folder", key, file));
}

struct FileKeys {
    const Node *file, *points, *refineTo, *up;
};
const KeyTable<FileKeys>& fileTable() {
    using F = FileKeys;
    static const KeyTable<F> table{
        {"file_source", "sources[].", "A file is the real model, unless it is refined or sampled.",
         false},
        {{&F::file, "file", "path", "required", "below the assets folder", assetPath()},
         {&F::points, pointsKey()},
         {&F::refineTo, numberKey("refine_to", kCounts, "none",
                                  "longest edges halved up to this many triangles")},
         {&F::up, choiceKey("up", kUps, "y", "the file's own up")}}};
    return table;
}

SceneSource readFileSource(const Node& node) {
    const FileKeys given = readTable(fileTable(), node, "source");
    SceneSource source;
    source.file = assetPathOf(*given.file, "file");
    try {
        requireKnownExtension(source.file);
    } catch (const Error& error) {
        throw Error(given.file->location(), std::string("file ") + error.what());
    }
    source.refineTo = readWhole(given.refineTo, "refine_to", kCounts);
    source.points = readWhole(given.points, "points", kCounts);
    if (given.up) source.isZUp = kUps[choiceOf(*given.up, kUps, "up")] == "z";
    if (source.refineTo || source.points) source.kind = Origin::Kind::StandIn;
    return source;
}

struct HeightMapKeys {
    const Node *heightMap, *spacingM, *heightScaleM, *noData, *resampleTo, *detailM, *seed,
        *colourMap;
};
const KeyTable<HeightMapKeys>& heightMapTable() {
    using H = HeightMapKeys;
    static const KeyTable<H> table{
        {"height_map_source",
         "sources[].",
         "A terrain.",
         false,
         nullptr,
         {{"dependencies", {{"detail_m", Json::array({"resample_to"})}}}}},
        {{&H::heightMap, "height_map", "path", "required", "below the assets folder", assetPath()},
         {&H::spacingM, numberKey("spacing_m", kMetres, "required", "distance of samples")},
         {&H::heightScaleM,
          numberKey("height_scale_m", kMetres, Node::number(HeightMapUnits().heightScaleM).text(),
                    "a step of the file's values")},
         {&H::noData, numberKey("no_data", {}, "none", "the value of samples that are missing")},
         {&H::resampleTo, numberKey("resample_to", kSamplesPerSide, "none",
                                    "samples per side: a stand-in for a finer survey")},
         {&H::detailM, numberKey("detail_m", kMetres, "none", "noise in the gaps of resample_to")},
         {&H::seed, numberKey("seed", kSeeds, std::to_string(SceneSource().seed), "of the noise")},
         {&H::colourMap, "colour_map", "path", "none", "PNG of the ground, north on top",
          assetPath()}}};
    return table;
}

SceneSource readHeightMapSource(const Node& node) {
    const HeightMapKeys given = readTable(heightMapTable(), node, "source");
    SceneSource source;
    source.file = assetPathOf(*given.heightMap, "height_map");
    HeightMapSource map;
    map.units.spacingM = readMetres(*given.spacingM, "spacing_m");
    if (given.heightScaleM) {
        map.units.heightScaleM = readMetres(*given.heightScaleM, "height_scale_m");
    }
    if (given.noData) {
        map.units.noData = static_cast<float>(numberIn(*given.noData, {}, "no_data"));
    }
    if (const auto samples = readWhole(given.resampleTo, "resample_to", kSamplesPerSide)) {
        map.resampleTo = static_cast<int>(*samples);
        source.kind = Origin::Kind::StandIn;
    }
    if (given.detailM) {
        if (!map.resampleTo) {
            throw Error(given.detailM->location(),
                        "detail_m needs resample_to, whose gaps it fills");
        }
        map.detailM = readMetres(*given.detailM, "detail_m");
    }
    readSeed(given.seed, source);
    if (given.colourMap) map.colourMap = assetPathOf(*given.colourMap, "colour_map");
    source.heightMap = map;
    return source;
}

struct GeneratorKeys {
    const Node *generator, *params, *seed, *points;
};
const KeyTable<GeneratorKeys>& generatorTable() {
    using G = GeneratorKeys;
    static const KeyTable<G> table{
        {"generator_source", "sources[].",
         "A generated scene or, where a real one exists, its stand-in.", false},
        {{&G::generator, "generator", "name", "required", "`gfxrepro list generators`", text()},
         {&G::params, "params", "{name: value}", "{}", "`gfxrepro describe GENERATOR`",
          mapOf(anything())},
         {&G::seed,
          numberKey("seed", kSeeds, std::to_string(SceneSource().seed), "of its random numbers")},
         {&G::points, pointsKey()}}};
    return table;
}

SceneSource readGeneratorSource(const Node& node, bool isGenerated,
                                std::span<const GeneratorInfo> generators) {
    const GeneratorKeys given = readTable(generatorTable(), node, "source");
    SceneSource source;
    source.generator =
        &findGenerator(generators, given.generator->text(), given.generator->location());
    if (given.params) source.params = *given.params;
    readSeed(given.seed, source);
    source.points = readWhole(given.points, "points", kCounts);
    source.kind = isGenerated ? Origin::Kind::Generated : Origin::Kind::StandIn;
    return source;
}

SceneSource readSource(const Node& node, bool isGenerated,
                       std::span<const GeneratorInfo> generators) {
    if (!node.isMap()) {
        throw Error(node.location(), "source is " + node.kindName() + ", but must be a map");
    }
    const bool isFile = generatorTable().find(node).generator == nullptr;
    if (!isFile && fileTable().find(node).file) {
        throw Error(node.location(), "source: 'file' and 'generator' exclude each other");
    }
    if (isFile && isGenerated) {
        throw Error(node.location(), "source: a file cannot be the source of a generated scene");
    }
    const bool isHeightMap = isFile && heightMapTable().find(node).heightMap;
    SceneSource source = isHeightMap ? readHeightMapSource(node)
                         : isFile    ? readFileSource(node)
                                     : readGeneratorSource(node, isGenerated, generators);
    source.where = node.location();
    return source;
}

struct EntryKeys {
    const Node *scene, *doc, *canonical, *licence, *generated, *sources;
};
const KeyTable<EntryKeys>& entryTable() {
    using E = EntryKeys;
    static const Json source = {
        {"oneOf", Json::array({refTo("file_source"), refTo("height_map_source"),
                               refTo("generator_source")})}};
    static const KeyTable<E> table{
        {"scene", "", "", false},
        {{&E::scene, "scene", "FOLDER/NAME", "required", "equals the file's place", text()},
         {&E::doc, "doc", "line", "required", "for `gfxrepro list scenes`", text()},
         {&E::canonical, "canonical", "address", "none", "where one gets the real thing", text()},
         {&E::licence, "licence", "line", "none", "the terms of the real thing", text()},
         {&E::generated, "generated", "true | false", "false", "there never was a real one",
          boolean()},
         {&E::sources, "sources", "[source]", "required", "the first that is at hand is taken",
          listOf(source, 1)}}};
    return table;
}

}  // namespace

float readMetres(const Node& node, const std::string& key) {
    return static_cast<float>(numberIn(node, kMetres, key));
}

SceneEntry readEntry(const fs::path& path, const std::string& expectedName,
                     std::span<const GeneratorInfo> generators) {
    const Node root = parseYamlFile(path);
    const EntryKeys given = readTable(entryTable(), root, "scene entry");
    SceneEntry entry;
    entry.path = path;
    entry.name = given.scene->text();
    if (entry.name != expectedName) {
        throw Error(
            given.scene->location(),
            "scene is '" + entry.name + "', but the file's place names it '" + expectedName + "'");
    }
    entry.doc = given.doc->text();
    if (given.canonical) entry.canonical = given.canonical->text();
    if (given.licence) entry.licence = given.licence->text();
    const bool isGenerated = given.generated && flagOf(*given.generated, "generated");
    for (const Node& source : given.sources->items()) {
        entry.sources.push_back(readSource(source, isGenerated, generators));
    }
    if (entry.sources.empty()) {
        throw Error(given.sources->location(), "sources is empty; an entry needs at least one");
    }
    return entry;
}

SchemaFile sceneSchema() {
    return {"scene",
            "A scene of the catalogue, in `scenes/`",
            {entryTable().section(), fileTable().section(), heightMapTable().section(),
             generatorTable().section()}};
}

}  // namespace gfxrepro::scene
