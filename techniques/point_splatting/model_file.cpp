#include "techniques/point_splatting/model_file.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "techniques/kit/kept_file.h"

namespace gfxrepro::point_splatting {

namespace {

constexpr std::uint32_t kVersion = 1;
constexpr const char* kMagic = "gfxpoint";
constexpr std::size_t kAlignment = 64;

enum Section { kPatches, kLevelList, kCompressed, kPositions, kNormals, kRadii, kColors, kTable };
constexpr std::size_t kSections = 8;

struct Header {
    kit::FileStamp stamp;
    scene::Box bounds;
    std::uint64_t sizeBytes;  // of the whole file: a cut-off one is known by it
    struct {
        std::uint64_t offsetBytes, sizeBytes;
    } sections[kSections];
};

std::size_t aligned(std::size_t offset) {
    return (offset + kAlignment - 1) / kAlignment * kAlignment;
}

std::uint8_t srgbOf(float linear) {
    const float c = std::clamp(linear, 0.0F, 1.0F);
    const float encoded = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255.0F * encoded));
}

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span<const T>(values));
}

std::string serialized(const PointModel& model, const std::string& key) {
    const std::vector<float> table = clusteredRadii(model.radii);
    std::vector<CompressedPoint> points(model.positions.size());
    tbb::parallel_for(std::size_t{0}, model.patches.size(), [&](std::size_t p) {
        const Patch& patch = model.patches[p];
        for (std::size_t i = patch.firstPoint; i < patch.firstPoint + patch.pointCount; ++i) {
            points[i] = compressed(model.positions[i], model.normals[i], model.radii[i],
                                   patch.bounds, table);
        }
    });
    std::vector<glm::u8vec4> colors;
    colors.reserve(model.colors.size());
    for (const glm::vec3& c : model.colors) {
        colors.emplace_back(srgbOf(c.x), srgbOf(c.y), srgbOf(c.z), 255);
    }
    const std::array<std::span<const std::byte>, kSections> sections{
        bytesOf(model.patches), bytesOf(model.levels), bytesOf(points), bytesOf(model.positions),
        bytesOf(model.normals), bytesOf(model.radii),  bytesOf(colors), bytesOf(table)};

    Header header{};
    header.stamp = {kMagic, kVersion, key};
    header.bounds = model.bounds;
    std::size_t offset = aligned(sizeof header);
    for (std::size_t s = 0; s < kSections; ++s) {
        header.sections[s] = {offset, sections[s].size()};
        offset = aligned(offset + sections[s].size());
    }
    header.sizeBytes = offset;
    std::string file(offset, '\0');
    std::memcpy(file.data(), &header, sizeof header);
    for (std::size_t s = 0; s < kSections; ++s) {
        if (sections[s].empty()) continue;
        std::memcpy(file.data() + header.sections[s].offsetBytes, sections[s].data(),
                    sections[s].size());
    }
    return file;
}

/// Nothing when the bytes are not a whole file of this version and key.
std::optional<Header> headerOf(std::span<const std::byte> bytes, const std::string& key) {
    Header header;
    if (bytes.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.stamp != kit::FileStamp(kMagic, kVersion, key) || header.sizeBytes != bytes.size()) {
        return std::nullopt;
    }
    for (const auto& section : header.sections) {
        if (section.offsetBytes % kAlignment != 0 || section.sizeBytes > bytes.size() ||
            section.offsetBytes > bytes.size() - section.sizeBytes) {
            return std::nullopt;
        }
    }
    return header;
}

}  // namespace

struct ModelFile::Content {
    std::unique_ptr<MappedFile> file;
    std::string memory;  // where there is no file
    Header header{};

    std::span<const std::byte> bytes() const {
        return file ? file->bytes() : std::as_bytes(std::span<const char>(memory));
    }
    template <class T>
    std::span<const T> section(Section which) const {
        const auto& place = header.sections[which];
        return {reinterpret_cast<const T*>(bytes().data() + place.offsetBytes),
                static_cast<std::size_t>(place.sizeBytes) / sizeof(T)};
    }
};

namespace {

/// Whether what sections say of each other is true: counts in a file may lie.
template <class Content>
bool isConsistent(const Content& content) {
    const std::size_t points = content.template section<glm::vec3>(kPositions).size();
    const auto holds = [&](std::size_t count) { return count == points; };
    const std::size_t colors = content.template section<glm::u8vec4>(kColors).size();
    const std::size_t radii = content.template section<float>(kTable).size();
    if (points == 0 || !holds(content.template section<CompressedPoint>(kCompressed).size()) ||
        !holds(content.template section<glm::vec3>(kNormals).size()) ||
        !holds(content.template section<float>(kRadii).size()) || (colors > 0 && !holds(colors)) ||
        radii == 0 || radii > 256) {
        return false;
    }
    const auto records = content.template section<CompressedPoint>(kCompressed);
    if (radii < 256 && !std::all_of(records.begin(), records.end(), [&](const CompressedPoint& p) {
            return p.surface >> 24 < radii;
        })) {
        return false;
    }
    const auto levels = content.template section<Level>(kLevelList);
    std::uint64_t next = 0;  // patches lie one behind the other
    for (const Patch& patch : content.template section<Patch>(kPatches)) {
        if (patch.firstPoint != next || patch.levelCount == 0 || patch.levelCount > levels.size() ||
            patch.firstLevel > levels.size() - patch.levelCount) {
            return false;
        }
        const auto own = levels.subspan(patch.firstLevel, patch.levelCount);
        if (std::any_of(own.begin(), own.end(),
                        [&](const Level& level) { return level.count > patch.pointCount; })) {
            return false;
        }
        next += patch.pointCount;
    }
    return holds(static_cast<std::size_t>(next));
}

template <class Content>
std::unique_ptr<Content> built(const scene::PointCloud& points, const TreeSettings& settings,
                               const std::string& key) {
    auto content = std::make_unique<Content>();
    content->memory = serialized(buildModel(points, settings), key);
    content->header = *headerOf(content->bytes(), key);
    return content;
}

/// The mapped file where it is what the key says.
template <class Content>
std::unique_ptr<Content> mapped(const std::filesystem::path& path, const std::string& key) {
    if (!std::filesystem::is_regular_file(path)) return nullptr;
    auto content = std::make_unique<Content>();
    content->file = std::make_unique<MappedFile>(path);
    const std::optional<Header> header = headerOf(content->bytes(), key);
    if (!header) return nullptr;
    content->header = *header;
    return isConsistent(*content) ? std::move(content) : nullptr;
}

}  // namespace

ModelFile::ModelFile(std::unique_ptr<Content> content, bool wasBuilt)
    : content_(std::move(content)), wasBuilt_(wasBuilt) {}
ModelFile::~ModelFile() = default;
ModelFile::ModelFile(ModelFile&&) noexcept = default;
ModelFile& ModelFile::operator=(ModelFile&&) noexcept = default;

std::string ModelFile::keyOf(const scene::PointCloud& points, const TreeSettings& settings) {
    std::string parts = "points " + std::to_string(kVersion);
    parts += ' ' + sha256(bytesOf(points.positions)) + ' ' + sha256(bytesOf(points.normals));
    parts += ' ' + sha256(bytesOf(points.radii)) + ' ' + sha256(bytesOf(points.colors));
    parts += ' ' + std::to_string(settings.maxPatchPoints);
    parts += ' ' + std::to_string(settings.minPatchPoints);
    parts += ' ' + std::to_string(settings.patchConeRad);
    return sha256(parts);
}

ModelFile ModelFile::build(const scene::PointCloud& points, const TreeSettings& settings) {
    const std::string key = sha256("");  // nothing looks for it
    return ModelFile(built<Content>(points, settings, key), true);
}

ModelFile ModelFile::openOrBuild(const std::filesystem::path& folder,
                                 const scene::PointCloud& points, const TreeSettings& settings) {
    const std::string key = keyOf(points, settings);
    const std::filesystem::path path = folder / (key + ".points");
    if (auto content = mapped<Content>(path, key)) return ModelFile(std::move(content), false);

    auto content = built<Content>(points, settings, key);
    if (kit::keepFile(path, content->memory)) {
        if (auto kept = mapped<Content>(path, key)) content = std::move(kept);
    }
    return ModelFile(std::move(content), true);
}

std::span<const Patch> ModelFile::patches() const {
    return content_->section<Patch>(kPatches);
}
std::span<const Level> ModelFile::levels() const {
    return content_->section<Level>(kLevelList);
}
std::span<const CompressedPoint> ModelFile::compressed() const {
    return content_->section<CompressedPoint>(kCompressed);
}
std::span<const glm::vec3> ModelFile::positions() const {
    return content_->section<glm::vec3>(kPositions);
}
std::span<const glm::vec3> ModelFile::normals() const {
    return content_->section<glm::vec3>(kNormals);
}
std::span<const float> ModelFile::radii() const {
    return content_->section<float>(kRadii);
}
std::span<const glm::u8vec4> ModelFile::colors() const {
    return content_->section<glm::u8vec4>(kColors);
}
std::span<const float> ModelFile::radiusTable() const {
    return content_->section<float>(kTable);
}
const scene::Box& ModelFile::bounds() const {
    return content_->header.bounds;
}

}  // namespace gfxrepro::point_splatting
