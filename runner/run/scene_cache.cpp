#include "runner/run/scene_cache.h"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
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
                 points.radii.size() * sizeof(float) + points.surface.sizeBytes();
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
        auto& [positions, normals, radii, colors, surface, whole] = points;
        all(name, kind, description, sha256, meshes, materials, textures, samplings, instances,
            positions, normals, radii, colors, surface, whole, cameras, paths, lights, motions,
            warnings, offset);
    }
    void take(scene::Mesh& mesh) {
        auto& [name, positions, normals, texcoords, colors, triangles, material, isFlat] = mesh;
        all(name, positions, normals, texcoords, colors, triangles, material, isFlat);
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

/// What the linker made of all that this program is (its build id); the file's digest where the
/// linker made none.
std::string programDigest() {
    std::string id;
    const auto takeNotes = [](dl_phdr_info* program, std::size_t, void* to) {
        for (int i = 0; i < program->dlpi_phnum; ++i) {
            const ElfW(Phdr)& part = program->dlpi_phdr[i];
            if (part.p_type != PT_NOTE) continue;
            std::string_view rest(reinterpret_cast<const char*>(program->dlpi_addr + part.p_vaddr),
                                  part.p_memsz);
            const auto aligned = [&](std::size_t size) {
                return (size + part.p_align - 1) / part.p_align * part.p_align;
            };
            for (ElfW(Nhdr) note; rest.size() >= sizeof note;) {
                std::memcpy(&note, rest.data(), sizeof note);
                const std::size_t begin = sizeof note + aligned(note.n_namesz);
                const std::size_t end = begin + aligned(note.n_descsz);
                if (end > rest.size()) break;
                if (note.n_type == NT_GNU_BUILD_ID) {
                    *static_cast<std::string*>(to) = rest.substr(begin, note.n_descsz);
                }
                rest.remove_prefix(end);
            }
        }
        return 1;  // the first is the program itself, the others are libraries
    };
    ::dl_iterate_phdr(takeNotes, &id);
    return id.empty() ? sha256OfFile("/proc/self/exe") : id;
}

/// Where a generated or refined scene is kept, by all that it is made of; empty for others.
fs::path keptPath(const scene::Catalog& catalog, const std::string& reference) {
    const Node node = Node::scalar(reference);
    const scene::SceneSource source = catalog.resolve(node);
    if (source.generator == nullptr && !source.refineTo) return {};
    static const std::string program = programDigest();
    const std::string key = program + ' ' + catalog.contentKey(node) + ' ' + reference;
    return cacheFolder() / "scenes" / (sha256(key) + ".scene");
}

/// Differs where a bit of the bytes does, or their number: what a disk lost is told, in a tenth of
/// SHA-256's time.
std::uint64_t checksumOf(std::string_view bytes) {
    std::uint64_t sum = bytes.size();
    const auto add = [&](const char* from, std::size_t size) {
        std::uint64_t word = 0;
        std::memcpy(&word, from, size);
        sum = std::rotl((sum ^ word) * 0x9E3779B97F4A7C15U, 29);
    };
    const std::size_t whole = bytes.size() / sizeof sum * sizeof sum;
    for (std::size_t i = 0; i < whole; i += sizeof sum) add(bytes.data() + i, sizeof sum);
    add(bytes.data() + whole, bytes.size() - whole);
    return sum;
}

/// Nothing where none is kept, or not whole. A kept file is the checksum of what follows, and that.
std::optional<scene::Scene> keptScene(const fs::path& path) {
    std::error_code failure;
    if (path.empty() || !fs::is_regular_file(path, failure)) return std::nullopt;
    try {
        const MappedFile file(path);
        const std::string_view text = file.text();
        std::uint64_t sum = 0;
        if (text.size() < sizeof sum) return std::nullopt;
        std::memcpy(&sum, text.data(), sizeof sum);
        const std::string_view bytes = text.substr(sizeof sum);
        if (checksumOf(bytes) != sum) return std::nullopt;
        // Which was in use last, for removeOldest().
        fs::last_write_time(path, fs::file_time_type::clock::now(), failure);
        return SceneBytes::read(bytes);
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Where it cannot be kept, that costs the next process its time, no more.
void keepScene(const fs::path& path, scene::Scene& scene, std::uintmax_t mostBytes) {
    try {
        const std::string bytes = SceneBytes::of(scene);
        const std::uint64_t sum = checksumOf(bytes);
        AtomicFile file(path);
        file.write({reinterpret_cast<const char*>(&sum), sizeof sum});
        file.write(bytes);
        file.commitUnflushed();
        removeOldest(path.parent_path(), ".scene", path, mostBytes);
    } catch (const Error&) {
    } catch (const fs::filesystem_error&) {  // another process made room, too
    }
}

}  // namespace

void SceneCache::beginCase(const std::string& keep) {
    for (CachedScene& entry : entries_) entry.isOfThisCase = entry.reference == keep;
    trim();
}

const SceneCache::CachedScene& SceneCache::get(const std::string& reference) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const CachedScene& e) { return e.reference == reference; });
    if (found != entries_.end()) {
        entries_.splice(entries_.begin(), entries_, found);
        entries_.front().isOfThisCase = true;
        return entries_.front();
    }
    const auto begin = std::chrono::steady_clock::now();
    CachedScene entry;
    entry.reference = reference;
    const fs::path kept = keptPath(catalog_, reference);
    std::optional<scene::Scene> known = keptScene(kept);
    const bool isKept = known.has_value();
    entry.scene = isKept ? std::move(*known) : catalog_.load(Node::scalar(reference));
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    entry.loadTimeMs = time.count();
    entry.sizeBytes = sizeBytesOf(entry.scene);
    entry.peakResidentBytes = peakResidentBytes();
    const bool mayBeKept = !entry.scene.heights && entry.scene.filesBeside.empty();
    if (!kept.empty() && !isKept && entry.sizeBytes >= kLeastKeptBytes && mayBeKept) {
        keepScene(kept, entry.scene, mostKeptBytes_);
        // The bytes on their way to the file are not the case's; a later scene comes after a peak
        // that is.
        if (std::ranges::none_of(entries_, &CachedScene::isOfThisCase)) resetPeakResident();
    }
    entries_.push_front(std::move(entry));
    trim();
    return entries_.front();
}

std::size_t SceneCache::otherBytes() const {
    std::size_t sizeBytes = 0;
    for (const CachedScene& entry : entries_) {
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
    const std::string key = gfxrepro::sha256(sha256 + ' ' + joined(command, " "));
    const fs::path file = folder_ / ("version-" + key.substr(0, 16));
    if (fs::is_regular_file(file)) return readFile(file);
    const std::string path = config::findExecutable(command.front(), program.here).string();
    if (path.empty()) {
        throw UnsupportedError("the program '" + command.front() +
                               "', which says the version, is not on this machine");
    }
    command.front() = path;
    const std::string version = firstLine(runToEnd(command, kVersionLimit).output);
    makeFolder(folder_);
    writeFileAtomic(file, version);
    return version;
}

}  // namespace gfxrepro::run
