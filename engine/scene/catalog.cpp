#include "engine/scene/catalog.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/checks.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/near_file.h"
#include "engine/core/text.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "engine/scene/catalog_entry.h"
#include "engine/scene/height_rows.h"
#include "engine/scene/load.h"
#include "engine/scene/model_files.h"
#include "engine/scene/point_sampling.h"
#include "engine/scene/refine.h"
#include "engine/scene/scene_reference.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

namespace {

/// Goes up when resampled() makes other heights.
constexpr int kResamplingVersion = 1;
/// Goes up when loadHeightMap() makes other heights.
constexpr int kReadingVersion = 3;

/// "the file s.obj", "generator grass".
std::string kindOf(const SceneSource& source) {
    return source.generator ? "generator " + std::string(source.generator->name)
                            : "the file " + source.file;
}

/// "file, refined to N triangles" or "generator g, seed n: {params}".
std::string descriptionOf(const SceneSource& source) {
    std::string text = source.file;
    if (source.generator) {
        text = kindOf(source) + ", seed " + std::to_string(source.seed) +
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
    const auto turn = [](auto&... vectors) {
        ((vectors = {vectors.x, vectors.z, -vectors.y}), ...);
    };
    const glm::mat4 turned(glm::vec4(1, 0, 0, 0), glm::vec4(0, 0, -1, 0), glm::vec4(0, 1, 0, 0),
                           glm::vec4(0, 0, 0, 1));
    for (Instance& instance : scene.instances) {
        instance.worldFromMesh = turned * instance.worldFromMesh;
    }
    for (glm::vec3& position : scene.points.positions) turn(position);
    for (glm::vec3& normal : scene.points.normals) turn(normal);
    const auto turnCamera = [&](Camera& c) { turn(c.position, c.target, c.up); };
    for (Camera& camera : scene.cameras) turnCamera(camera);
    for (CameraPath& path : scene.paths) {
        for (Camera& key : path.keys) turnCamera(key);
    }
    for (PointLight& light : scene.lights) turn(light.position);
    for (Motion& motion : scene.motions) turn(motion.pivot, motion.axis, motion.swing);
    turn(scene.offset);
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
    const std::size_t all = scene.points.positions.size();
    if (all > 0 && count > all) {
        throw Error(
            source.where,
            fmt::format("{} points wanted of {}, a cloud of {}; allowed: no more than it has",
                        count, source.file, all));
    }
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

/// Throws Error for a large file that no loader would take, before anybody reads it through.
void requireWhatIsRead(const fs::path& file) {
    if (!isHeightMapFile(file)) return requireReadAtOnce(file);
    const std::uintmax_t bytes = fs::file_size(file);
    if (bytes < kMostBytesAtOnce) return;
    const auto size = openHeightRows(file, false)->sizeSamples;
    // Floats, and as much again for the coarser levels that surveyors' programs put beside them.
    const auto mostBytes = 2 * sizeof(float) * static_cast<std::uintmax_t>(size.x) *
                           static_cast<std::uintmax_t>(size.y);
    if (bytes <= mostBytes) return;
    throw Error(fmt::format("{}: has {} bytes; a height map of {} x {} samples has at most {}",
                            file.string(), bytes, size.x, size.y, mostBytes));
}

std::string sha256AtOnce(const fs::path& file) {
    requireReadAtOnce(file);
    return sha256OfFile(file);
}

std::string heightMapKey(const fs::path& assetsFolder, const SceneSource& source) {
    const HeightMapSource& how = *source.heightMap;
    const std::string colours =
        how.colourMap.empty() ? "" : " colours " + sha256AtOnce(assetsFolder / how.colourMap);
    // A raw file's, which says how its bytes are read.
    const fs::path sidecar = (assetsFolder / source.file).string() + ".yaml";
    const std::string reading =
        (fs::is_regular_file(sidecar) ? " sidecar " + sha256AtOnce(sidecar) : "") +
        (how.units.noData == 0.0F ? " no data 0" : "");
    return colours + reading +
           fmt::format(" heights {} {} {} {} {} {}",
                       how.units.spacingM ? fmt::format("{}", *how.units.spacingM) : "as it says",
                       how.units.heightScaleM, how.units.noData.value_or(0.0F),
                       how.resampleTo.value_or(0), how.detailM, source.seed);
}

Scene loadTerrain(const fs::path& assetsFolder, const SceneSource& source) {
    const HeightMapSource& how = *source.heightMap;
    Scene scene;
    const fs::path path = assetsFolder / source.file;
    requireWhatIsRead(path);
    const std::string content =
        fmt::format("of file {}{}", sha256OfFile(path), heightMapKey(assetsFolder, source));
    const fs::path folder = cacheFolder() / "heights";
    if (how.resampleTo) {
        scene.heights = resampledInFile(
            loadHeightMap(path, how.units), *how.resampleTo, how.detailM, source.seed, folder,
            sha256(fmt::format("resampled {} {}", kResamplingVersion, content)));
    } else {
        scene.heights = loadHeightMapInFile(
            path, how.units, folder, sha256(fmt::format("read {} {}", kReadingVersion, content)));
    }
    if (!how.colourMap.empty()) {
        const fs::path map = assetsFolder / how.colourMap;
        scene.textures.push_back(
            image::rgbOf(image::decodePng8(MappedFile(map).bytes(), map.string())));
        Material ground;
        ground.baseColorTexture = 0;
        scene.materials.push_back(ground);
    }
    addTerrainCameras(scene);
    return scene;
}

void takeSeed(const std::string& name, const std::string& seed, const SourceLocation& where,
              SceneSource& source) {
    const auto number = parseInteger(seed);
    if (!number || *number < 0) {
        throw Error(
            where,
            fmt::format("the seed of scene '{}' is '{}'; allowed: a whole number, at least 0", name,
                        seed));
    }
    if (!source.isSeeded()) {
        throw Error(where,
                    fmt::format("scene '{}' has no seed: it is {}{}", name,
                                source.file.empty() ? "the only one of " : "", kindOf(source)));
    }
    source.seed = static_cast<std::uint64_t>(*number);
}

}  // namespace

Catalog::Catalog(const fs::path& scenesFolder, fs::path assetsFolder,
                 std::span<const GeneratorInfo> generators)
    : assetsFolder_(std::move(assetsFolder)) {
    std::vector<fs::path> files;
    for (const auto& file : entriesBelow(scenesFolder)) {
        if (file.is_regular_file() && file.path().extension() == ".yaml") {
            files.push_back(file.path());
        }
    }
    std::sort(files.begin(), files.end());  // so that the first error does not depend on the disk
    for (const fs::path& file : files) {
        const std::string name =
            file.lexically_relative(scenesFolder).replace_extension().generic_string();
        entries_.emplace(name, readEntry(file, name, generators));
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

bool SceneSource::isSeeded() const {
    if (generator) return generator->isSeeded;
    return heightMap && heightMap->detailM > 0.0F;
}

std::string_view kindName(Origin::Kind kind) {
    switch (kind) {
        case Origin::Kind::Real:
            return "real";
        case Origin::Kind::StandIn:
            return "stand-in";
        case Origin::Kind::Generated:
            break;
    }
    return "generated";
}

void takeParams(const std::string& name, const Node& params, SceneSource& source) {
    if (isSceneFile(name)) {
        takeFileParams(name, params, source);
        return;
    }
    if (!source.generator) {
        const std::string& first = params.entries().front().key();
        throw Error(
            params.keyLocation(first),
            fmt::format("scene '{}' is not generated, so it has no parameter '{}': it is {}", name,
                        first, kindOf(source)));
    }
    source.params = merged(source.params, params);
    declaredParams(*source.generator, source.params);
}

SceneSource Catalog::resolve(const Node& reference) const {
    const SceneReference parts = SceneReference::from(reference);
    const SourceLocation& where = reference.location();
    SceneSource source = sourceOf(Node::scalar(parts.name, where));
    if (parts.seed) takeSeed(parts.name, *parts.seed, where, source);
    if (!parts.params.entries().empty()) takeParams(parts.name, parts.params, source);
    return source;
}

SceneSource Catalog::sourceOf(const Node& reference) const {
    const std::string& name = reference.text();
    if (isSceneFile(name)) {
        SceneSource source;
        source.file = fs::absolute(fs::path(reference.location().file.text()).parent_path() / name)
                          .lexically_normal();
        source.where = reference.location();
        if (isHeightMapFile(source.file)) source.heightMap = HeightMapSource{};
        try {
            if (!source.heightMap) requireKnownExtension(name);
        } catch (const Error& error) {
            throw Error(reference.location(), std::string("scene file ") + error.what());
        }
        if (fs::is_regular_file(source.file)) return source;
        throw Error(reference.location(), "scene file '" + name + "' is not there; looked at " +
                                              source.file + suggestedFile(source.file));
    }
    const SceneEntry& entry = entryNamed(reference);
    std::string tried;
    for (const SceneSource& source : entry.sources) {
        if (source.generator) return source;
        const fs::path path = assetsFolder_ / source.file;
        if (fs::is_regular_file(path)) return source;
        tried += "\n  " + path.string();
    }
    throw Error(reference.location(),
                "scene '" + name + "' not found; searched:" + tried + "\nget it with " +
                    "scripts/fetch-assets" +
                    (entry.canonical.empty() ? "" : " or from " + entry.canonical));
}

const Catalog::FileDigest& Catalog::digestOf(const fs::path& path) const {
    FileDigest& digest = digests_[path];
    const auto sizeBytes = fs::file_size(path);
    const auto time = fs::last_write_time(path);
    if (digest.sha256.empty() || digest.sizeBytes != sizeBytes || digest.time != time) {
        requireWhatIsRead(path);  // or throws, before all is read
        std::vector<fs::path> beside = filesBeside(path);
        digest = {sizeBytes, time, sha256OfFile(path), std::move(beside)};
    }
    return digest;
}

std::string Catalog::contentKey(const Node& reference) const {
    const SceneSource source = resolve(reference);
    const std::string points =
        source.points ? " sampled to " + std::to_string(*source.points) : std::string();
    if (source.generator) {
        return sha256("generator " + std::to_string(kGeneratorVersion) + ' ' +
                      std::string(source.generator->name) + ' ' + std::to_string(source.seed) +
                      ' ' + source.params.toFlowText() + points);
    }
    const FileDigest& digest = digestOf(assetsFolder_ / source.file);
    std::string content = digest.sha256;
    for (const fs::path& file : digest.beside) content += digestOf(file).sha256;
    return sha256("file " + content + ' ' +
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
        const bool isOwn = isSceneFile(SceneReference::from(reference).name);
        for (const std::string& warning :
             {isOwn ? steepnessWarning(*scene.heights) : std::string(),
              scene.heights->spacingWarning, scene.heights->unitWarning}) {
            if (!warning.empty()) scene.warnings.push_back(warning);
        }
    } else if (!source.generator) {
        scene = loadScene(assetsFolder_ / source.file);
        sha256 = scene.origin.sha256;
        if (source.isZUp) turnUp(scene);
        if (source.refineTo) refine(scene, source);
    } else {
        Params params(source.params, "generator '" + std::string(source.generator->name) + "'");
        scene = source.generator->generate(params, source.seed);
    }
    if (source.points) turnIntoPoints(scene, source);
    scene.name = reference.text();
    scene.origin = {source.kind, descriptionOf(source), sha256};
    return scene;
}

const std::vector<std::string>& Catalog::viewNames(const Node& reference) const {
    const bool isFile = isSceneFile(SceneReference::from(reference).name);
    const std::string key =
        reference.text() + '\n' + (isFile ? reference.location().file.text() : "");
    const auto known = viewNames_.find(key);
    if (known != viewNames_.end()) return known->second;
    const Scene scene = load(reference);
    std::vector<std::string> names;
    for (const CameraPath& path : scene.paths) names.push_back(path.name);
    for (const Camera& camera : scene.cameras) names.push_back(camera.name);
    return viewNames_.emplace(key, std::move(names)).first->second;
}

}  // namespace gfxrepro::scene
