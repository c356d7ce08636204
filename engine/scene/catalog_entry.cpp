#include "engine/scene/catalog_entry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/scene/height_map.h"
#include "engine/scene/height_rows.h"
#include "engine/scene/load.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

namespace {

using namespace types;

constexpr std::array<std::string_view, 2> kUps = {"y", "z"};
constexpr NumberRange kCounts{.least = 1, .isWhole = true};
constexpr NumberRange kSamplesPerSide{.least = 1, .most = kMaxHeightFileSide, .isWhole = true};
constexpr NumberRange kSeeds{.least = 0, .isWhole = true};
constexpr NumberRange kMetres{.least = 1e-9, .most = 1e6};

SchemaKey pointsKey() {
    return numberKey("points", kCounts, "none",
                     "points of the surface, or of the cloud, instead of it");
}

SchemaKey upKey() {
    return choiceKey("up", kUps, "y", "the file's own up");
}

/// How the values of a height map become metres.
struct UnitKeys {
    GivenKey spacingM, heightScaleM, noData;
};
SchemaKey spacingKey() {
    return numberKey("spacing_m", kMetres, "the file's, or 1", "distance of samples, both ways");
}
SchemaKey heightScaleKey() {
    return numberKey("height_scale_m", kMetres, Node::number(HeightMapUnits().heightScaleM).text(),
                     "a step of the file's values");
}

/// Of a file of one's own.
struct OwnFileKeys : UnitKeys {
    GivenKey up;
};
const KeyTable<OwnFileKeys>& ownFileTable() {
    using O = OwnFileKeys;
    static const KeyTable<O> table{{"own_file", "scene_params.", ""},
                                   {{&O::up, upKey()},
                                    {&O::spacingM, spacingKey()},
                                    {&O::heightScaleM, heightScaleKey()},
                                    {&O::noData, noDataKey()}}};
    return table;
}

/// Throws Error for a number that is no distance.
void readMetres(const GivenKey& key, auto& valueM) {
    if (key) valueM = static_cast<float>(key.number());
}

void readUnits(const UnitKeys& given, HeightMapUnits& units) {
    readMetres(given.spacingM, units.spacingM);
    readMetres(given.heightScaleM, units.heightScaleM);
    if (given.noData) units.noData = static_cast<float>(given.noData.number());
}

void readUp(const GivenKey& up, SceneSource& source) {
    if (up) source.isZUp = kUps[up.choice()] == "z";
}

std::optional<long long> readWhole(const GivenKey& key) {
    if (!key) return std::nullopt;
    (void)key.number();
    return key->asInteger();
}

void readSeed(const GivenKey& key, SceneSource& source) {
    if (const auto seed = readWhole(key)) {
        source.seed = static_cast<std::uint64_t>(*seed);
    }
}

Json assetPath() {
    return {{"type", "string"}, {"minLength", 1}, {"pattern", "^[^/]"}};
}

std::string assetPathOf(const GivenKey& key) {
    const std::string& file = key->text();
    if (!file.empty() && !fs::path(file).is_absolute()) return file;
    throw Error(
        key->location(),
        fmt::format("{} is '{}', but must be a path within the assets folder", key.name(), file));
}

struct FileKeys {
    GivenKey file, points, refineTo, up;
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
         {&F::up, upKey()}}};
    return table;
}

SceneSource readFileSource(const Node& node) {
    const FileKeys given = fileTable().read(node, "source");
    SceneSource source;
    source.file = assetPathOf(given.file);
    try {
        requireKnownExtension(source.file);
    } catch (const Error& error) {
        throw Error(given.file->location(), given.file.name() + " " + error.what());
    }
    source.refineTo = readWhole(given.refineTo);
    source.points = readWhole(given.points);
    readUp(given.up, source);
    if (source.refineTo || source.points) source.kind = Origin::Kind::StandIn;
    return source;
}

struct HeightMapKeys : UnitKeys {
    GivenKey heightMap, resampleTo, detailM, seed, colourMap;
};
const KeyTable<HeightMapKeys>& heightMapTable() {
    using H = HeightMapKeys;
    constexpr const char *kResampleTo = "resample_to", *kDetailM = "detail_m";
    static const KeyTable<H> table{
        {"height_map_source",
         "sources[].",
         "A terrain.",
         false,
         nullptr,
         {{"dependencies", {{kDetailM, Json::array({kResampleTo})}}}}},
        {{&H::heightMap, "height_map", "path", "required", "below the assets folder", assetPath()},
         {&H::spacingM, spacingKey()},
         {&H::heightScaleM, heightScaleKey()},
         {&H::noData, noDataKey()},
         {&H::resampleTo, numberKey(kResampleTo, kSamplesPerSide, "none",
                                    "samples per side: a stand-in for a finer survey")},
         {&H::detailM,
          numberKey(kDetailM, kMetres, "none", std::string("noise in the gaps of ") + kResampleTo)},
         {&H::seed, numberKey("seed", kSeeds, std::to_string(SceneSource().seed), "of the noise")},
         {&H::colourMap, "colour_map", "path", "none", "PNG of the ground, north on top",
          assetPath()}}};
    return table;
}

SceneSource readHeightMapSource(const Node& node) {
    const HeightMapKeys given = heightMapTable().read(node, "source");
    SceneSource source;
    source.file = assetPathOf(given.heightMap);
    HeightMapSource map;
    readUnits(given, map.units);
    if (const auto samples = readWhole(given.resampleTo)) {
        map.resampleTo = static_cast<int>(*samples);
        source.kind = Origin::Kind::StandIn;
    }
    if (given.detailM) {
        if (!map.resampleTo) {
            throw Error(given.detailM->location(),
                        fmt::format("{} needs {}, whose gaps it fills", given.detailM.name(),
                                    given.resampleTo.name()));
        }
        readMetres(given.detailM, map.detailM);
    }
    readSeed(given.seed, source);
    if (given.colourMap) map.colourMap = assetPathOf(given.colourMap);
    source.heightMap = map;
    return source;
}

struct GeneratorKeys {
    GivenKey generator, params, seed, points;
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
    const GeneratorKeys given = generatorTable().read(node, "source");
    SceneSource source;
    source.generator =
        &findGenerator(generators, given.generator->text(), given.generator->location());
    if (given.params) source.params = *given.params;
    readSeed(given.seed, source);
    source.points = readWhole(given.points);
    source.kind = isGenerated ? Origin::Kind::Generated : Origin::Kind::StandIn;
    return source;
}

SceneSource readSource(const Node& node, bool isGenerated,
                       std::span<const GeneratorInfo> generators) {
    if (!node.isMap()) throwNotAllowed(node, "source", "a map");
    const GivenKey file = fileTable().find(node).file;
    const GivenKey generator = generatorTable().find(node).generator;
    const bool isFile = !generator;
    if (file && generator) {
        throw Error(node.location(), fmt::format("source: '{}' and '{}' exclude each other",
                                                 file.name(), generator.name()));
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
    GivenKey scene, doc, canonical, licence, generated, sources;
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
         {&E::generated, flagKey("generated", "there never was a real one")},
         {&E::sources, "sources", "[source]", "required", "the first that is at hand is taken",
          listOf(source, 1)}}};
    return table;
}

}  // namespace

std::span<const std::string> ownFileParams(bool isHeightMap) {
    const std::span<const std::string> names = ownFileTable().names();
    return isHeightMap ? names.subspan(1) : names.first(1);
}

void takeFileParams(const std::string& name, const Node& params, SceneSource& source) {
    const bool isHeightMap = source.heightMap.has_value();
    const auto names = ownFileParams(isHeightMap);
    for (const auto& [key, value] : params.entries()) {
        if (std::ranges::find(names, key) != names.end()) continue;
        throw Error(params.keyLocation(key),
                    fmt::format("{} '{}' has no parameter '{}'{}; allowed: {}",
                                isHeightMap ? "height map" : "model", name, key,
                                suggestion(key, names), joined(names)));
    }
    const OwnFileKeys given = ownFileTable().find(params);
    readUp(given.up, source);
    if (isHeightMap) readUnits(given, source.heightMap->units);
}

SceneEntry readEntry(const fs::path& path, const std::string& expectedName,
                     std::span<const GeneratorInfo> generators) {
    const Node root = parseYamlFile(path);
    const EntryKeys given = entryTable().read(root, "scene entry");
    SceneEntry entry;
    entry.path = path;
    entry.name = given.scene->text();
    if (entry.name != expectedName) {
        throw Error(given.scene->location(), given.scene.name() + " is '" + entry.name +
                                                 "', but the file's place names it '" +
                                                 expectedName + "'");
    }
    entry.doc = given.doc->text();
    if (given.canonical) entry.canonical = given.canonical->text();
    if (given.licence) entry.licence = given.licence->text();
    const bool isGenerated = given.generated && given.generated.flag();
    for (const Node& source : given.sources->items()) {
        entry.sources.push_back(readSource(source, isGenerated, generators));
    }
    if (entry.sources.empty()) {
        throw Error(given.sources->location(),
                    given.sources.name() + " is empty; an entry needs at least one");
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
