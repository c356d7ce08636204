#include "runner/run/scene_cache.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/output_files.h"
#include "engine/core/text.h"
#include "runner/run/child_process.h"
#include "runner/run/process_memory.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

std::size_t sizeBytesOf(const scene::Scene& scene) {
    std::size_t sizeBytes = 0;
    for (const scene::Mesh& mesh : scene.meshes) sizeBytes += mesh.sizeBytes();
    for (const image::Image8& texture : scene.textures) sizeBytes += texture.values().size();
    const scene::PointCloud& points = scene.points;
    sizeBytes += (points.positions.size() + points.normals.size() + points.colors.size()) *
                     sizeof(glm::vec3) +
                 points.radii.size() * sizeof(float);
    if (scene.heights) sizeBytes += scene.heights->heightsM.size() * sizeof(float);
    return sizeBytes;
}

/// A scene's members one after another, as this program has them in memory: written, or read. A
/// struct is taken apart into all its members, so that one more does not compile.
class SceneBytes {
  public:
    static std::string of(scene::Scene& scene) {
        SceneBytes bytes;
        bytes.take(scene);
        return std::move(bytes.written_);
    }
    static scene::Scene read(std::string_view bytes) {
        SceneBytes kept;
        kept.unread_ = bytes;
        kept.isRead_ = true;
        scene::Scene scene;
        kept.take(scene);
        GFXREPRO_ASSERT(kept.unread_.empty());
        return scene;
    }

  private:
    void takeBytes(void* data, std::size_t sizeBytes) {
        if (!isRead_) {
            written_.append(static_cast<const char*>(data), sizeBytes);
            return;
        }
        GFXREPRO_ASSERT(sizeBytes <= unread_.size());
        if (sizeBytes > 0) std::memcpy(data, unread_.data(), sizeBytes);
        unread_.remove_prefix(sizeBytes);
    }
    template <class... Values>
    void all(Values&... values) {
        (take(values), ...);
    }
    template <class Value>
    void take(Value& value) {
        static_assert(std::is_trivially_copyable_v<Value>);
        takeBytes(&value, sizeof value);
    }
    template <class Values>
    void takeSize(Values& values) {
        std::size_t size = values.size();
        take(size);
        values.resize(size);
    }
    void take(std::string& text) {
        takeSize(text);
        takeBytes(text.data(), text.size());
    }
    template <class Value>
    void take(std::vector<Value>& values) {
        takeSize(values);
        if constexpr (std::is_trivially_copyable_v<Value>) {
            takeBytes(values.data(), values.size() * sizeof(Value));
        } else {
            for (Value& value : values) take(value);
        }
    }
    void take(scene::Scene& scene) {
        auto& [name, origin, meshes, materials, textures, samplings, instances, points, heights,
               cameras, paths, lights, motions, warnings, offset, filesBeside] = scene;
        GFXREPRO_ASSERT(!heights);  // they have files of their own
        GFXREPRO_ASSERT(filesBeside.empty());
        auto& [kind, description, sha256] = origin;
        auto& [positions, normals, radii, colors] = points;
        all(name, kind, description, sha256, meshes, materials, textures, samplings, instances,
            positions, normals, radii, colors, cameras, paths, lights, motions, warnings, offset);
    }
    void take(scene::Mesh& mesh) {
        auto& [name, positions, normals, texcoords, colors, triangles, material] = mesh;
        all(name, positions, normals, texcoords, colors, triangles, material);
    }
    void take(scene::Material& material) {
        auto& [name, color, metallic, roughness, emissive, colorTexture, roughnessTexture,
               normalTexture, normalScale, emissiveTexture, cutoff, isDoubleSided, isUnlit,
               transmission, refraction] = material;
        all(name, color, metallic, roughness, emissive, colorTexture, roughnessTexture,
            normalTexture, normalScale, emissiveTexture, cutoff, isDoubleSided, isUnlit,
            transmission, refraction);
    }
    void take(scene::Camera& camera) {
        auto& [name, position, target, up, verticalFovRad, nearM, farM] = camera;
        all(name, position, target, up, verticalFovRad, nearM, farM);
    }
    void take(scene::CameraPath& path) {
        auto& [name, keys] = path;
        all(name, keys);
    }
    void take(image::Image8& image) {
        glm::ivec3 size(image.width(), image.height(), image.channels());
        take(size);
        if (isRead_) image = image::Image8(size.x, size.y, size.z);
        takeBytes(image.values().data(), image.values().size());
    }

    std::string written_;
    std::string_view unread_;
    bool isRead_ = false;
};

/// Smaller scenes are made as fast as they are read.
constexpr std::size_t kLeastKeptBytes = std::size_t{1} << 20;

/// Where a generated scene is kept, by all that it is made of; empty for one of a file.
fs::path keptPath(const scene::Catalog& catalog, const std::string& reference) {
    const Node node = Node::scalar(reference);
    if (catalog.resolve(node).generator == nullptr) return {};
    static const std::string program = sha256OfFile("/proc/self/exe");
    const std::string key = program + ' ' + catalog.contentKey(node) + ' ' + reference;
    return cacheFolder() / "scenes" / (sha256(key) + ".scene");
}

/// A kept file is the digest of what follows, and that.
constexpr std::size_t kDigestSize = 64;

/// Nothing where none is kept, or not whole.
std::optional<scene::Scene> keptScene(const fs::path& path) {
    std::error_code failure;
    if (path.empty() || !fs::is_regular_file(path, failure)) return std::nullopt;
    try {
        const MappedFile file(path);
        const std::string_view text = file.text();
        if (text.size() < kDigestSize) return std::nullopt;
        const std::string_view bytes = text.substr(kDigestSize);
        if (sha256(bytes) != text.substr(0, kDigestSize)) return std::nullopt;
        // Which was in use last, for makeRoom().
        fs::last_write_time(path, fs::file_time_type::clock::now(), failure);
        return SceneBytes::read(bytes);
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Removes the files that were used longest ago until the rest take no more than that.
void makeRoom(const fs::path& folder, std::uintmax_t mostBytes) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        files.emplace_back(entry.last_write_time(), entry.path());
        bytes += entry.file_size();
    }
    std::sort(files.begin(), files.end());
    for (const auto& [time, path] : files) {
        if (bytes <= mostBytes) return;
        bytes -= fs::file_size(path);
        fs::remove(path);
    }
}

/// Where it cannot be kept, that costs the next process its time, no more.
void keepScene(const fs::path& path, scene::Scene& scene, std::uintmax_t mostBytes) {
    try {
        const std::string bytes = SceneBytes::of(scene);
        AtomicFile file(path);
        file.write(sha256(bytes));
        file.write(bytes);
        file.commit();
        makeRoom(path.parent_path(), mostBytes);
    } catch (const Error&) {
    } catch (const fs::filesystem_error&) {  // another process made room, too
    }
}

}  // namespace

void SceneCache::beginCase(const std::string& keep) {
    for (Entry& entry : entries_) entry.isOfThisCase = entry.reference == keep;
    trim();
}

const SceneCache::Entry& SceneCache::get(const std::string& reference) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& e) { return e.reference == reference; });
    if (found != entries_.end()) {
        entries_.splice(entries_.begin(), entries_, found);
        entries_.front().isOfThisCase = true;
        return entries_.front();
    }
    const auto begin = std::chrono::steady_clock::now();
    Entry entry;
    entry.reference = reference;
    const fs::path kept = keptPath(catalog_, reference);
    std::optional<scene::Scene> known = keptScene(kept);
    const bool isKept = known.has_value();
    entry.scene = isKept ? std::move(*known) : catalog_.load(Node::scalar(reference));
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    entry.loadTimeMs = time.count();
    entry.sizeBytes = sizeBytesOf(entry.scene);
    entry.peakResidentBytes = peakResidentBytes();
    if (!kept.empty() && !isKept && entry.sizeBytes >= kLeastKeptBytes && !entry.scene.heights) {
        keepScene(kept, entry.scene, mostKeptBytes_);
        // The bytes on their way to the file are not the case's; a later scene comes after a peak
        // that is.
        if (std::ranges::none_of(entries_, &Entry::isOfThisCase)) resetPeakResident();
    }
    entries_.push_front(std::move(entry));
    trim();
    return entries_.front();
}

std::size_t SceneCache::otherBytes() const {
    std::size_t sizeBytes = 0;
    for (const Entry& entry : entries_) {
        if (!entry.isOfThisCase) sizeBytes += entry.sizeBytes;
    }
    return sizeBytes;
}

void SceneCache::trim() {
    std::size_t total = 0;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        total += entry->sizeBytes;
        const bool goes = !entry->isOfThisCase && total > budgetBytes_;
        if (goes) total -= entry->sizeBytes;
        entry = goes ? entries_.erase(entry) : std::next(entry);
    }
}

namespace {

constexpr std::chrono::seconds kVersionLimit{20};

/// The first line that says something.
std::string firstLine(const std::string& output) {
    constexpr std::size_t kLongest = 200;
    for (const std::string& line : split(output, '\n')) {
        const std::string_view text = trimmed(line);
        if (!text.empty()) return std::string(text.substr(0, kLongest));
    }
    return "";
}

}  // namespace

std::vector<ProgramUse> ProgramCache::require(const Case& item, const Node& params) {
    const config::ExternalProgram program = config::readProgram(item.program);
    const std::vector<config::ProgramFile> files =
        config::filesOf(program, program.valuesOf(params));
    const std::string key = config::programKey(files, digests_);
    if (const config::ProgramFile* absent = config::absentOf(files)) {
        throw UnsupportedError("the program '" + absent->name + "' is not on this machine");
    }
    if (!item.programKey.empty() && key != item.programKey) {
        throw Error("the program '" + files.front().name +
                    "', or a file that it reads, changed since the run was planned");
    }
    std::vector<ProgramUse> uses;
    for (const config::ProgramFile& file : files) {
        uses.push_back({file.name, digests_.of(file.path), ""});
    }
    if (program.version.empty()) return uses;
    // Of the file that is asked; of the program where another one is.
    const auto asked =
        std::ranges::find(files, program.version.front(), &config::ProgramFile::name);
    const std::size_t at =
        asked == files.end() ? 0 : static_cast<std::size_t>(asked - files.begin());
    uses[at].version = versionOf(program, uses[at].sha256);
    return uses;
}

std::string ProgramCache::versionOf(const config::ExternalProgram& program,
                                    const std::string& sha256) {
    std::vector<std::string> command;
    for (const std::string& argument : program.version) {
        command.push_back(config::filled(argument, {{config::placeholder::kHere, program.here}}));
    }
    const auto [known, isNew] = versions_.try_emplace(sha256 + ' ' + joined(command, " "));
    if (!isNew) return known->second;
    const std::string path = config::findExecutable(command.front(), program.here).string();
    if (path.empty()) {
        throw UnsupportedError("the program '" + command.front() +
                               "', which says the version, is not on this machine");
    }
    command.front() = path;
    known->second = firstLine(runToEnd(command, kVersionLimit).output);
    return known->second;
}

}  // namespace gfxrepro::run
