#include "runner/scene/catalog.h"

#include <fmt/format.h>

#include <algorithm>

#include "runner/config/schema.h"
#include "runner/core/hash.h"
#include "runner/core/text.h"
#include "runner/image/png_io.h"
#include "runner/scene/generators.h"
#include "runner/scene/generators_terrain.h"
#include "runner/scene/load.h"
#include "runner/scene/point_sampling.h"
#include "runner/scene/refine.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;
using config::Node;

namespace {

void requireKeys(const Node& map, const std::string& what, std::string_view section) {
    if (!map.isMap()) {
        throw Error(map.location(), what + " is " + map.kindName() + ", but must be a map");
    }
    const std::vector<std::string> names = config::keysOf(section);
    for (const auto& [key, value] : map.entries()) {
        if (std::find(names.begin(), names.end(), key) != names.end()) continue;
        throw Error(map.keyLocation(key), what + ": unknown key '" + key + "'" +
                                              suggestion(key, names) +
                                              " (allowed: " + joined(names) + ")");
    }
}

const Node& required(const Node& map, const std::string& what, std::string_view key) {
    const Node* value = map.find(key);
    if (!value) throw Error(map.location(), what + ": '" + std::string(key) + "' is missing");
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
    const Node& file = required(node, "source", "file");
    source.file = file.text();
    if (source.file.empty() || fs::path(source.file).is_absolute()) {
        throw Error(file.location(),
                    "file is '" + source.file + "', but must be a path within the assets folder");
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
    const Node& file = required(node, "source", "height_map");
    source.file = file.text();
    if (source.file.empty() || fs::path(source.file).is_absolute()) {
        throw Error(file.location(),
                    fmt::format("height_map is '{}', but must be a path within the assets folder",
                                source.file));
    }
    HeightMapSource map;
    map.units.spacingM = readPositive(required(node, "source", "spacing_m"), "spacing_m");
    if (const Node* scale = node.find("height_scale_m")) {
        map.units.heightScaleM = readPositive(*scale, "height_scale_m");
    }
    if (const Node* noData = node.find("no_data")) {
        map.units.noData = static_cast<float>(noData->asDouble());
    }
    if (const auto samples = readCount(node, "resample_to", "samples")) {
        if (*samples > kMaxHeightMapSide) {
            throw Error(
                node.find("resample_to")->location(),
                fmt::format("resample_to is {}; allowed: 1 to {}", *samples, kMaxHeightMapSide));
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

SceneSource readGeneratorSource(const Node& node, bool isGenerated) {
    requireKeys(node, "source", "generator_source");
    SceneSource source;
    const Node& generator = required(node, "source", "generator");
    source.generator = findGenerator(generator.text(), generator.location()).name;
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

SceneSource readSource(const Node& node, bool isGenerated) {
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
                                     : readGeneratorSource(node, isGenerated);
    source.where = node.location();
    return source;
}

SceneEntry readEntry(const fs::path& path, const std::string& expectedName) {
    const Node root = config::parseYamlFile(path);
    requireKeys(root, "scene entry", "scene");
    SceneEntry entry;
    entry.path = path;
    const Node& name = required(root, "scene entry", "scene");
    entry.name = name.text();
    if (entry.name != expectedName) {
        throw Error(name.location(), "scene is '" + entry.name +
                                         "', but the file's place names it '" + expectedName + "'");
    }
    entry.doc = required(root, "scene entry", "doc").text();
    if (const Node* canonical = root.find("canonical")) entry.canonical = canonical->text();
    if (const Node* licence = root.find("licence")) entry.licence = licence->text();
    const Node* generated = root.find("generated");
    const bool isGenerated = generated && generated->asBool();
    const Node& sources = required(root, "scene entry", "sources");
    for (const Node& source : sources.items()) {
        entry.sources.push_back(readSource(source, isGenerated));
    }
    if (entry.sources.empty()) {
        throw Error(sources.location(), "sources is empty; an entry needs at least one");
    }
    return entry;
}

/// "file, refined to N triangles" or "generator g, seed n: {params}".
std::string descriptionOf(const SceneSource& source) {
    std::string text = source.file;
    if (!source.generator.empty()) {
        text = "generator " + source.generator + ", seed " + std::to_string(source.seed) +
               (source.params.isNull() ? "" : ": " + source.params.toFlowText());
    }
    if (source.heightMap && source.heightMap->resampleTo) {
        text += fmt::format(", resampled to {} samples a side with up to {} m of noise, seed {}",
                            *source.heightMap->resampleTo, source.heightMap->detailM, source.seed);
    }
    if (source.refineTo) text += ", refined to " + std::to_string(*source.refineTo) + " triangles";
    if (source.points) text += ", sampled to " + std::to_string(*source.points) + " points";
    return text;
}

/// What was up +z stands up +y.
void turnUp(Scene& scene) {
    const auto turned = [](const glm::vec3& v) { return glm::vec3(v.x, v.z, -v.y); };
    const glm::mat4 turn(glm::vec4(turned({1, 0, 0}), 0), glm::vec4(turned({0, 1, 0}), 0),
                         glm::vec4(turned({0, 0, 1}), 0), glm::vec4(0, 0, 0, 1));
    for (Instance& instance : scene.instances) {
        instance.worldFromMesh = turn * instance.worldFromMesh;
    }
    for (glm::vec3& position : scene.points.positions) position = turned(position);
    for (glm::vec3& normal : scene.points.normals) normal = turned(normal);
}

/// All instances as one mesh of the wanted count; materials and cameras stay.
void refine(Scene& scene, const SceneSource& source) {
    try {
        Mesh mesh = refinedTo(flattened(scene), *source.refineTo);
        scene.meshes.clear();
        scene.meshes.push_back(std::move(mesh));
        scene.instances = {Instance{}};
    } catch (const Error& error) {
        throw Error(source.where, source.file + ": " + error.what());
    }
}

/// The wanted number of complete points instead of meshes.
void turnIntoPoints(Scene& scene, const SceneSource& source) {
    const auto count = static_cast<std::size_t>(*source.points);
    try {
        scene.points = scene.points.positions.empty() ? sampledPoints(scene, count)
                                                      : thinnedPoints(scene.points, count);
        completePoints(scene.points);
    } catch (const Error& error) {
        throw Error(source.where, descriptionOf(source) + ": " + error.what());
    }
    scene.meshes.clear();
    scene.instances.clear();
}

/// RGB, whatever the PNG has.
image::Image8 rgbOf(const image::Image8& image) {
    image::Image8 rgb(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < 3; ++c) {
                rgb.at(x, y, c) = image.at(x, y, image.channels() < 3 ? 0 : c);
            }
        }
    }
    return rgb;
}

Scene loadTerrain(const fs::path& assetsFolder, const SceneSource& source) {
    const HeightMapSource& how = *source.heightMap;
    Scene scene;
    scene.heights = loadHeightMap(assetsFolder / source.file, how.units);
    if (how.resampleTo) {
        scene.heights = resampled(*scene.heights, *how.resampleTo, how.detailM, source.seed);
    }
    if (!how.colourMap.empty()) {
        scene.textures.push_back(rgbOf(image::readPng8(assetsFolder / how.colourMap)));
        Material ground;
        ground.baseColorTexture = 0;
        scene.materials.push_back(ground);
    }
    addTerrainCameras(scene);
    return scene;
}

std::string heightMapKey(const fs::path& assetsFolder, const SceneSource& source) {
    const HeightMapSource& how = *source.heightMap;
    const std::string colours =
        how.colourMap.empty() ? "" : " colours " + sha256OfFile(assetsFolder / how.colourMap);
    return colours + fmt::format(" heights {} {} {} {} {} {}", how.units.spacingM,
                                 how.units.heightScaleM, how.units.noData.value_or(0.0F),
                                 how.resampleTo.value_or(0), how.detailM, source.seed);
}

bool isUserFile(const std::string& reference) {
    return fs::path(reference).has_extension();
}

}  // namespace

Catalog::Catalog(const fs::path& scenesFolder, fs::path assetsFolder)
    : assetsFolder_(std::move(assetsFolder)) {
    std::vector<fs::path> files;
    for (const auto& file : fs::recursive_directory_iterator(scenesFolder)) {
        if (file.is_regular_file() && file.path().extension() == ".yaml") {
            files.push_back(file.path());
        }
    }
    std::sort(files.begin(), files.end());  // so that the first error does not depend on the disk
    for (const fs::path& file : files) {
        const std::string name =
            file.lexically_relative(scenesFolder).replace_extension().generic_string();
        entries_.emplace(name, readEntry(file, name));
    }
}

const SceneEntry& Catalog::entryNamed(const Node& reference) const {
    const auto found = entries_.find(reference.text());
    if (found != entries_.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [name, entry] : entries_) names.push_back(name);
    throw Error(reference.location(), "unknown scene '" + reference.text() + "'" +
                                          suggestion(reference.text(), names) +
                                          " (`gfxrepro list scenes` prints all)");
}

SceneSource Catalog::resolve(const Node& reference) const {
    const std::string& name = reference.text();
    if (isUserFile(name)) {
        SceneSource source;
        source.file = fs::absolute(fs::path(reference.location().file).parent_path() / name)
                          .lexically_normal();
        source.where = reference.location();
        if (fs::is_regular_file(source.file)) return source;
        throw Error(reference.location(),
                    "scene file '" + name + "' is not there; looked at " + source.file);
    }
    const SceneEntry& entry = entryNamed(reference);
    std::string tried;
    for (const SceneSource& source : entry.sources) {
        if (!source.generator.empty()) return source;
        const fs::path path = assetsFolder_ / source.file;
        if (fs::is_regular_file(path)) return source;
        tried += "\n  " + path.string();
    }
    throw Error(reference.location(),
                "scene '" + name + "' is not at hand; looked at:" + tried + "\nget it with " +
                    "scripts/fetch-assets" +
                    (entry.canonical.empty() ? "" : " or from " + entry.canonical));
}

std::string Catalog::contentKey(const Node& reference) const {
    const SceneSource source = resolve(reference);
    const std::string points =
        source.points ? " sampled to " + std::to_string(*source.points) : std::string();
    if (!source.generator.empty()) {
        return sha256("generator " + std::to_string(kGeneratorVersion) + ' ' + source.generator +
                      ' ' + std::to_string(source.seed) + ' ' + source.params.toFlowText() +
                      points);
    }
    const fs::path path = assetsFolder_ / source.file;
    FileDigest& digest = digests_[path];
    const auto sizeBytes = fs::file_size(path);
    const auto time = fs::last_write_time(path);
    if (digest.sha256.empty() || digest.sizeBytes != sizeBytes || digest.time != time) {
        digest = {sizeBytes, time, sha256OfFile(path)};
    }
    return sha256("file " + digest.sha256 + ' ' +
                  (source.refineTo ? std::to_string(*source.refineTo) : "as it is") +
                  (source.isZUp ? " z up" : "") + points +
                  (source.heightMap ? heightMapKey(assetsFolder_, source) : ""));
}

Scene Catalog::load(const Node& reference) const {
    const SceneSource source = resolve(reference);
    Scene scene;
    std::string sha256;
    if (source.heightMap) {
        scene = loadTerrain(assetsFolder_, source);
        sha256 = sha256OfFile(assetsFolder_ / source.file);
    } else if (source.generator.empty()) {
        scene = loadScene(assetsFolder_ / source.file);
        sha256 = scene.origin.sha256;
        if (source.isZUp) turnUp(scene);
        if (source.refineTo) refine(scene, source);
    } else {
        config::Params params(source.params, "generator '" + source.generator + "'");
        scene = findGenerator(source.generator, source.where).generate(params, source.seed);
    }
    if (source.points) turnIntoPoints(scene, source);
    scene.name = reference.text();
    scene.origin = {source.kind, descriptionOf(source), sha256};
    return scene;
}

}  // namespace gfxrepro::scene
