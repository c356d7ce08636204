#include "engine/scene/catalog_entry.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/text.h"
#include "engine/scene/catalog_schema.h"
#include "engine/scene/load.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

namespace {

void requireKeys(const Node& map, const std::string& what, std::string_view section) {
    if (!map.isMap()) {
        throw Error(map.location(), what + " is " + map.kindName() + ", but must be a map");
    }
    static const SchemaFile schema = sceneSchema();
    const std::vector<std::string> names = schema.find(section)->keyNames();
    for (const auto& [key, value] : map.entries()) {
        if (std::find(names.begin(), names.end(), key) != names.end()) continue;
        throw Error(map.keyLocation(key), what + ": unknown key '" + key + "'" +
                                              suggestion(key, names) +
                                              " (allowed: " + joined(names) + ")");
    }
}

// Literals, not strings: a reference from a call with a temporary is one that GCC 14 takes for
// dangling.
const Node& requiredMember(const Node& map, const char* what, const char* key) {
    const Node* value = map.find(key);
    if (!value) throw Error(map.location(), std::string(what) + ": '" + key + "' is missing");
    return *value;
}

std::optional<long long> readCount(const Node& source, const std::string& key,
                                   const std::string& of) {
    const Node* node = source.find(key);
    if (!node) return std::nullopt;
    const long long count = node->asInteger();
    if (count < 1) {
        throw Error(node->location(),
                    key + " is " + node->text() + "; allowed: a number of " + of + ", at least 1");
    }
    return count;
}

SceneSource readFileSource(const Node& node) {
    requireKeys(node, "source", "file_source");
    SceneSource source;
    const Node& file = requiredMember(node, "source", "file");
    source.file = file.text();
    if (source.file.empty() || fs::path(source.file).is_absolute()) {
        throw Error(file.location(),
                    "file is '" + source.file + "', but must be a path within the assets folder");
    }
    try {
        requireKnownExtension(source.file);
    } catch (const Error& error) {
        throw Error(file.location(), std::string("file ") + error.what());
    }
    source.refineTo = readCount(node, "refine_to", "triangles");
    source.points = readCount(node, "points", "points");
    if (const Node* up = node.find("up")) {
        if (up->text() != "y" && up->text() != "z") {
            throw Error(up->location(), "up is '" + up->text() + "'; allowed: y | z");
        }
        source.isZUp = up->text() == "z";
    }
    if (source.refineTo || source.points) source.kind = Origin::Kind::StandIn;
    return source;
}

float readPositive(const Node& node, const std::string& key) {
    const double value = node.asDouble();
    if (value > 0.0 && value <= 1e6) return static_cast<float>(value);
    throw Error(node.location(),
                fmt::format("{} is {}; allowed: above 0, at most 1e6", key, node.text()));
}

SceneSource readHeightMapSource(const Node& node) {
    requireKeys(node, "source", "height_map_source");
    SceneSource source;
    const Node& file = requiredMember(node, "source", "height_map");
    source.file = file.text();
    if (source.file.empty() || fs::path(source.file).is_absolute()) {
        throw Error(file.location(),
                    fmt::format("height_map is '{}', but must be a path within the assets folder",
                                source.file));
    }
    HeightMapSource map;
    map.units.spacingM = readPositive(requiredMember(node, "source", "spacing_m"), "spacing_m");
    if (const Node* scale = node.find("height_scale_m")) {
        map.units.heightScaleM = readPositive(*scale, "height_scale_m");
    }
    if (const Node* noData = node.find("no_data")) {
        map.units.noData = static_cast<float>(noData->asDouble());
    }
    if (const auto samples = readCount(node, "resample_to", "samples")) {
        if (*samples > kMaxHeightFileSide) {
            throw Error(
                node.find("resample_to")->location(),
                fmt::format("resample_to is {}; allowed: 1 to {}", *samples, kMaxHeightFileSide));
        }
        map.resampleTo = static_cast<int>(*samples);
        source.kind = Origin::Kind::StandIn;
    }
    if (const Node* detail = node.find("detail_m")) {
        if (!map.resampleTo) {
            throw Error(detail->location(), "detail_m needs resample_to, whose gaps it fills");
        }
        map.detailM = readPositive(*detail, "detail_m");
    }
    if (const Node* seed = node.find("seed")) {
        source.seed = static_cast<std::uint64_t>(seed->asInteger());
    }
    if (const Node* colours = node.find("colour_map")) {
        map.colourMap = colours->text();
        if (map.colourMap.empty() || fs::path(map.colourMap).is_absolute()) {
            throw Error(colours->location(),
                        fmt::format("colour_map is '{}', but must be a path within the assets "
                                    "folder",
                                    map.colourMap));
        }
    }
    source.heightMap = map;
    return source;
}

SceneSource readGeneratorSource(const Node& node, bool isGenerated,
                                std::span<const GeneratorInfo> generators) {
    requireKeys(node, "source", "generator_source");
    SceneSource source;
    const Node& generator = requiredMember(node, "source", "generator");
    source.generator = &findGenerator(generators, generator.text(), generator.location());
    if (const Node* params = node.find("params")) source.params = *params;
    if (const Node* seed = node.find("seed")) {
        const long long value = seed->asInteger();
        if (value < 0) {
            throw Error(seed->location(), "seed is " + seed->text() + "; allowed: at least 0");
        }
        source.seed = static_cast<std::uint64_t>(value);
    }
    source.points = readCount(node, "points", "points");
    source.kind = isGenerated ? Origin::Kind::Generated : Origin::Kind::StandIn;
    return source;
}

SceneSource readSource(const Node& node, bool isGenerated,
                       std::span<const GeneratorInfo> generators) {
    if (!node.isMap()) {
        throw Error(node.location(), "source is " + node.kindName() + ", but must be a map");
    }
    if (node.find("file") && node.find("generator")) {
        throw Error(node.location(), "source: 'file' and 'generator' exclude each other");
    }
    const bool isFile = node.find("generator") == nullptr;
    if (isFile && isGenerated) {
        throw Error(node.location(), "source: a file cannot be the source of a generated scene");
    }
    const bool isHeightMap = isFile && node.find("height_map") != nullptr;
    SceneSource source = isHeightMap ? readHeightMapSource(node)
                         : isFile    ? readFileSource(node)
                                     : readGeneratorSource(node, isGenerated, generators);
    source.where = node.location();
    return source;
}

}  // namespace

SceneEntry readEntry(const fs::path& path, const std::string& expectedName,
                     std::span<const GeneratorInfo> generators) {
    const Node root = parseYamlFile(path);
    requireKeys(root, "scene entry", "scene");
    SceneEntry entry;
    entry.path = path;
    const Node& name = requiredMember(root, "scene entry", "scene");
    entry.name = name.text();
    if (entry.name != expectedName) {
        throw Error(name.location(), "scene is '" + entry.name +
                                         "', but the file's place names it '" + expectedName + "'");
    }
    entry.doc = requiredMember(root, "scene entry", "doc").text();
    if (const Node* canonical = root.find("canonical")) entry.canonical = canonical->text();
    if (const Node* licence = root.find("licence")) entry.licence = licence->text();
    const Node* generated = root.find("generated");
    const bool isGenerated = generated && generated->asBool();
    const Node& sources = requiredMember(root, "scene entry", "sources");
    for (const Node& source : sources.items()) {
        entry.sources.push_back(readSource(source, isGenerated, generators));
    }
    if (entry.sources.empty()) {
        throw Error(sources.location(), "sources is empty; an entry needs at least one");
    }
    return entry;
}

}  // namespace gfxrepro::scene
