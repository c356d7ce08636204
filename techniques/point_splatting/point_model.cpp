#include "techniques/point_splatting/point_model.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/image/srgb.h"
#include "engine/scene/point_sampling.h"
#include "techniques/kit/kept_file.h"

namespace gfxrepro::point_splatting {
namespace {

using Indices = std::span<std::uint32_t>;

/// The least axis-aligned cone around the mean of normals: its half angle; π where they cancel.
struct NormalCone {
    glm::vec3 mean{0.0F, 1.0F, 0.0F};
    float halfAngleRad = glm::pi<float>();
};
NormalCone coneOf(const scene::PointCloud& points, Indices indices) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t i : indices) sum += glm::dvec3(points.normals[i]);
    const double length = glm::length(sum);
    NormalCone cone;
    if (length < 1e-6 * static_cast<double>(indices.size())) return cone;
    cone.mean = glm::vec3(sum / length);
    float least = 1.0F;
    for (const std::uint32_t i : indices) {
        least = std::min(least, glm::dot(cone.mean, points.normals[i]));
    }
    cone.halfAngleRad = std::acos(std::clamp(least, -1.0F, 1.0F));
    return cone;
}

struct Spread {
    glm::dvec3 mean{0.0};
    scene::Eigensystem axes;
};
Spread spreadOf(const scene::PointCloud& points, Indices indices) {
    scene::Covariance covariance;
    for (const std::uint32_t i : indices) covariance.add(points.positions[i]);
    return {covariance.mean(), scene::eigensystem(covariance.matrix())};
}

/// Puts the points before the plane through the mean, across the principal axis, first; returns how
/// many they are. Halves where the plane does not divide.
std::size_t split(const scene::PointCloud& points, Indices indices, const Spread& spread) {
    const glm::dvec3 axis = spread.axes.vectors[2];
    const auto middle = std::partition(indices.begin(), indices.end(), [&](std::uint32_t i) {
        return glm::dot(glm::dvec3(points.positions[i]) - spread.mean, axis) < 0.0;
    });
    const auto before = static_cast<std::size_t>(middle - indices.begin());
    return before == 0 || before == indices.size() ? indices.size() / 2 : before;
}

/// Ranges of `indices` that are patches, in order.
using Ranges = std::vector<Indices>;

Ranges cutIntoPatches(const scene::PointCloud& points, Indices indices,
                      const TreeSettings& settings) {
    const std::size_t count = indices.size();
    if (count <= settings.minPatchPoints ||
        (count <= settings.maxPatchPoints &&
         coneOf(points, indices).halfAngleRad <= settings.patchConeRad)) {
        return {indices};
    }
    const std::size_t before = split(points, indices, spreadOf(points, indices));
    Ranges first, second;
    const auto cutFirst = [&] { first = cutIntoPatches(points, indices.first(before), settings); };
    const auto cutSecond = [&] {
        second = cutIntoPatches(points, indices.subspan(before), settings);
    };
    constexpr std::size_t kWorthATask = 1U << 14;
    if (count > kWorthATask) {
        tbb::parallel_invoke(cutFirst, cutSecond);
    } else {
        cutFirst();
        cutSecond();
    }
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

/// A patch's points in breadth-first order, and its levels.
class LinearTree {
  public:
    LinearTree(const scene::PointCloud& points, Indices indices)
        : points_(points), order_(indices.size()), levels_(1) {
        std::vector<Indices> nodes{indices};
        std::size_t placed = 0;
        while (!nodes.empty()) {
            const bool isLast = levels_.size() == kMaxLevels;
            std::vector<Indices> next;
            for (Indices node : nodes) {
                if (isLast) {
                    for (const std::uint32_t i : node) order_[placed++] = i;
                } else {
                    order_[placed++] = takeNode(node, next);
                }
            }
            finishLevel(placed);
            nodes = std::move(next);
            if (!nodes.empty()) levels_.emplace_back();
        }
        // All points stand for themselves.
        levels_.back().radiusScale = 1.0F;
        for (Level& level : levels_) setRadii(level);
    }
    const std::vector<std::uint32_t>& order() const { return order_; }
    const std::vector<Level>& levels() const { return levels_; }

  private:
    /// The node's own point, the nearest to the mean; the others become its children.
    std::uint32_t takeNode(Indices node, std::vector<Indices>& children) {
        if (node.size() == 1) {
            coverage_.push_back(1.0F);
            return node[0];
        }
        const Spread spread = spreadOf(points_, node);
        const auto distance2 = [&](std::uint32_t i) {
            const glm::dvec3 away = glm::dvec3(points_.positions[i]) - spread.mean;
            return glm::dot(away, away);
        };
        const auto nearest =
            std::min_element(node.begin(), node.end(), [&](std::uint32_t a, std::uint32_t b) {
                return std::pair(distance2(a), a) < std::pair(distance2(b), b);
            });
        std::swap(node[0], *nearest);
        const std::uint32_t own = node[0];
        float reach = 0.0F;
        for (const std::uint32_t i : node) {
            reach = std::max(reach, glm::distance(points_.positions[i], points_.positions[own]));
        }
        coverage_.push_back(std::max(reach / points_.radii[own], 1.0F));
        const Indices rest = node.subspan(1);
        const std::size_t before = split(points_, rest, spread);
        if (before > 0) children.push_back(rest.first(before));
        if (before < rest.size()) children.push_back(rest.subspan(before));
        return own;
    }

    /// The scale that covers what nine of ten nodes stand for: the tenth would blur all others, and
    /// the discs of coarser nodes lie over it.
    void finishLevel(std::size_t placed) {
        Level& level = levels_.back();
        level.count = static_cast<std::uint32_t>(placed);
        if (coverage_.empty()) return;
        const auto rank = static_cast<std::ptrdiff_t>(coverage_.size() - 1) * 9 / 10;
        std::nth_element(coverage_.begin(), coverage_.begin() + rank, coverage_.end());
        level.radiusScale = coverage_[static_cast<std::size_t>(rank)];
        coverage_.clear();
    }

    void setRadii(Level& level) const {
        level.minRadius = std::numeric_limits<float>::max();
        double sum = 0.0;
        for (std::uint32_t k = 0; k < level.count; ++k) {
            const float radius = points_.radii[order_[k]] * level.radiusScale;
            level.minRadius = std::min(level.minRadius, radius);
            level.maxRadius = std::max(level.maxRadius, radius);
            sum += static_cast<double>(radius);
        }
        level.meanRadius = static_cast<float>(sum / static_cast<double>(level.count));
    }

    const scene::PointCloud& points_;
    std::vector<std::uint32_t> order_;
    std::vector<Level> levels_;
    std::vector<float> coverage_;  // of the level's nodes: reach in own radii
};

Patch patchOf(const scene::PointCloud& points, Indices indices) {
    Patch patch;
    patch.pointCount = static_cast<std::uint32_t>(indices.size());
    for (const std::uint32_t i : indices) patch.bounds.add(points.positions[i]);
    const NormalCone cone = coneOf(points, indices);
    patch.meanNormal = cone.mean;
    patch.coneRad = cone.halfAngleRad;
    const glm::dvec3 values = spreadOf(points, indices).axes.values;
    const double sum = values[0] + values[1] + values[2];
    patch.curvature = sum > 0.0 ? static_cast<float>(std::max(values[0], 0.0) / sum) : 0.0F;
    return patch;
}

}  // namespace

PointModel buildModel(const scene::PointCloud& points, const TreeSettings& settings) {
    const std::size_t count = points.positions.size();
    if (count == 0) throw Error("a point model of no points");
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0U);
    const Ranges ranges = cutIntoPatches(points, indices, settings);

    PointModel model;
    model.patches.resize(ranges.size());
    std::vector<std::vector<Level>> levels(ranges.size());
    std::vector<std::uint32_t> order(count);
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t p) {
        const Indices range = ranges[p];
        Patch& patch = model.patches[p];
        patch = patchOf(points, range);
        patch.firstPoint = static_cast<std::uint32_t>(range.data() - indices.data());
        const LinearTree tree(points, range);
        std::copy(tree.order().begin(), tree.order().end(), order.begin() + patch.firstPoint);
        levels[p] = tree.levels();
    });
    for (std::size_t p = 0; p < ranges.size(); ++p) {
        Patch& patch = model.patches[p];
        patch.firstLevel = static_cast<std::uint32_t>(model.levels.size());
        patch.levelCount = static_cast<std::uint32_t>(levels[p].size());
        model.levels.insert(model.levels.end(), levels[p].begin(), levels[p].end());
    }
    model.positions.resize(count);
    model.normals.resize(count);
    model.radii.resize(count);
    model.colors.resize(points.colors.empty() ? 0 : count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
        const std::uint32_t from = order[k];
        model.positions[k] = points.positions[from];
        model.normals[k] = points.normals[from];
        model.radii[k] = points.radii[from];
        if (!model.colors.empty()) model.colors[k] = points.colors[from];
    });
    return model;
}

namespace {

constexpr std::uint32_t kVersion = 2;
constexpr const char* kMagic = "gfxpoint";
constexpr std::size_t kAlignment = 64;

enum Section { kPatches, kLevelList, kCompressed, kPositions, kNormals, kRadii, kColors, kTable };
constexpr std::size_t kSections = 8;

struct Header {
    kit::FileStamp stamp;
    std::uint64_t sizeBytes;  // of the whole file: a cut-off one is known by it
    struct {
        std::uint64_t offsetBytes, sizeBytes;
    } sections[kSections];
};

std::size_t aligned(std::size_t offset) {
    return (offset + kAlignment - 1) / kAlignment * kAlignment;
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
    const auto byteOf = [](float linear) {
        return std::lround(255.0F * image::srgbOf(std::clamp(linear, 0.0F, 1.0F)));
    };
    for (const glm::vec3& c : model.colors) {
        colors.emplace_back(byteOf(c.x), byteOf(c.y), byteOf(c.z), 255);
    }
    const std::array<std::span<const std::byte>, kSections> sections{
        bytesOf(model.patches), bytesOf(model.levels), bytesOf(points), bytesOf(model.positions),
        bytesOf(model.normals), bytesOf(model.radii),  bytesOf(colors), bytesOf(table)};

    Header header{};
    header.stamp = {kMagic, kVersion, key};
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

    static std::unique_ptr<Content> built(const scene::PointCloud& points,
                                          const TreeSettings& settings, const std::string& key) {
        auto content = std::make_unique<Content>();
        content->memory = serialized(buildModel(points, settings), key);
        content->header = *headerOf(content->bytes(), key);
        return content;
    }
    /// The mapped file where it is what the key says.
    static std::unique_ptr<Content> mapped(const std::filesystem::path& path,
                                           const std::string& key) {
        if (!std::filesystem::is_regular_file(path)) return nullptr;
        auto content = std::make_unique<Content>();
        content->file = std::make_unique<MappedFile>(path);
        const std::optional<Header> header = headerOf(content->bytes(), key);
        if (!header) return nullptr;
        content->header = *header;
        return content->isConsistent() ? std::move(content) : nullptr;
    }

    std::span<const std::byte> bytes() const {
        return file ? file->bytes() : std::as_bytes(std::span<const char>(memory));
    }
    template <class T>
    std::span<const T> section(Section which) const {
        const auto& place = header.sections[which];
        return {reinterpret_cast<const T*>(bytes().data() + place.offsetBytes),
                static_cast<std::size_t>(place.sizeBytes) / sizeof(T)};
    }

    /// Whether what sections say of each other is true: counts in a file may lie.
    bool isConsistent() const {
        const std::size_t points = section<glm::vec3>(kPositions).size();
        const auto holds = [&](std::size_t count) { return count == points; };
        const auto records = section<CompressedPoint>(kCompressed);
        const std::size_t colors = section<glm::u8vec4>(kColors).size();
        const std::size_t radii = section<float>(kTable).size();
        if (points == 0 || !holds(records.size()) || !holds(section<glm::vec3>(kNormals).size()) ||
            !holds(section<float>(kRadii).size()) || (colors > 0 && !holds(colors)) || radii == 0 ||
            radii > 256) {
            return false;
        }
        const auto hasRadius = [&](const CompressedPoint& p) { return p.surface >> 24 < radii; };
        if (radii < 256 && !std::ranges::all_of(records, hasRadius)) return false;
        const auto levels = section<Level>(kLevelList);
        std::uint64_t next = 0;  // patches lie one behind the other
        for (const Patch& patch : section<Patch>(kPatches)) {
            if (patch.firstPoint != next || patch.levelCount == 0 ||
                patch.levelCount > levels.size() ||
                patch.firstLevel > levels.size() - patch.levelCount) {
                return false;
            }
            for (const Level& level : levels.subspan(patch.firstLevel, patch.levelCount)) {
                if (level.count > patch.pointCount) return false;
            }
            next += patch.pointCount;
        }
        return holds(static_cast<std::size_t>(next));
    }
};

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
    return ModelFile(Content::built(points, settings, key), true);
}

ModelFile ModelFile::openOrBuild(const std::filesystem::path& folder,
                                 const scene::PointCloud& points, const TreeSettings& settings) {
    const std::string key = keyOf(points, settings);
    const std::filesystem::path path = folder / (key + ".points");
    const auto find = [&]() -> std::optional<ModelFile> {
        auto content = Content::mapped(path, key);
        if (!content) return std::nullopt;
        return ModelFile(std::move(content), false);
    };
    const auto make = [&] {
        auto content = Content::built(points, settings, key);
        if (kit::keepFile(path, content->memory)) {
            if (auto kept = Content::mapped(path, key)) content = std::move(kept);
        }
        return ModelFile(std::move(content), true);
    };
    return kit::foundOrMade<ModelFile>(path, find, make);
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

}  // namespace gfxrepro::point_splatting
