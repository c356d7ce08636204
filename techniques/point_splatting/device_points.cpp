#include "techniques/point_splatting/device_points.h"

#include <algorithm>
#include <array>

#include "engine/core/error.h"

namespace gfxrepro::point_splatting {

namespace {

FullPoint fullPoint(const ModelFile& model, std::size_t index) {
    FullPoint point{};
    point.position = model.positions()[index];
    point.normal = model.normals()[index];
    point.tangent = tangentOf(point.normal, tangentChoice(point.normal));
    point.bitangent = glm::cross(point.normal, point.tangent);
    point.radius = model.radii()[index];
    return point;
}

gl::Buffer uncompressedPoints(const ModelFile& model, std::uint32_t first, std::uint32_t count) {
    constexpr std::uint32_t kPointsAtOnce = 1U << 18;  // in the host's memory
    gl::Buffer buffer(count * sizeof(FullPoint));
    std::vector<FullPoint> some;
    for (std::uint32_t begin = 0; begin < count; begin += kPointsAtOnce) {
        some.resize(std::min(count - begin, kPointsAtOnce));
        for (std::size_t i = 0; i < some.size(); ++i) {
            some[i] = fullPoint(model, first + begin + i);
        }
        buffer.write(std::span<const FullPoint>(some), begin * sizeof(FullPoint));
    }
    return buffer;
}

}  // namespace

DevicePoints::DevicePoints(const ModelFile& model, PointStorage storage)
    : storage_(storage),
      hasColors_(!model.colors().empty()),
      patches_(model.patches().begin(), model.patches().end()),
      levels_(model.levels().begin(), model.levels().end()),
      radii_(gl::Buffer::of(model.radiusTable())) {
    const bool isCompressed = storage == PointStorage::Compressed;
    cutIntoPieces(isCompressed ? sizeof(CompressedPoint) : sizeof(FullPoint));
    for (Piece& piece : pieces_) {
        const std::uint32_t first = piece.firstPoint, count = piece.pointCount;
        piece.points = isCompressed ? gl::Buffer::of(model.compressed().subspan(first, count))
                                    : uncompressedPoints(model, first, count);
        if (hasColors_) piece.colors = gl::Buffer::of(model.colors().subspan(first, count));
    }
}

void DevicePoints::cutIntoPieces(std::size_t pointBytes) {
    const auto limit =
        static_cast<std::size_t>(gl::getInteger64(GL_MAX_SHADER_STORAGE_BLOCK_SIZE)) / pointBytes;
    // Four vertices a point are numbered by a signed word.
    const std::size_t maxPoints = std::min(limit, std::size_t{1} << 28);
    pieceOfPatch_.reserve(patches_.size());
    for (const Patch& patch : patches_) {
        if (pieces_.empty() || pieces_.back().pointCount + patch.pointCount > maxPoints) {
            pieces_.push_back({patch.firstPoint, 0, {}, {}});
        }
        pieces_.back().pointCount += patch.pointCount;
        pieceOfPatch_.push_back(static_cast<std::uint32_t>(pieces_.size() - 1));
    }
}

gl::Defines DevicePoints::defines() const {
    gl::Defines defines;
    if (storage_ == PointStorage::Uncompressed) defines["UNCOMPRESSED"] = 1;
    if (hasColors_) defines["COLORS"] = 1;
    return defines;
}

gl::Resources DevicePoints::resources(std::uint32_t piece) const {
    return {
        {"Points", pieces_[piece].points}, {"Radii", radii_}, {"Colors", pieces_[piece].colors}};
}

std::size_t DevicePoints::sizeBytes() const {
    std::size_t size = storage_ == PointStorage::Compressed ? radii_.sizeBytes() : 0;
    for (const Piece& piece : pieces_) {
        size += piece.points.sizeBytes() + piece.colors.sizeBytes();
    }
    return size;
}

void DrawList::assign(const DevicePoints& points, std::span<const DrawnPatch> drawn,
                      std::uint32_t maxRange, std::uint32_t maxBatch) {
    records.clear();
    ranges.clear();
    batches.clear();
    constexpr std::array kModes{SplatMode::FullEwa, SplatMode::Reconstruction, SplatMode::LowPass,
                                SplatMode::Sprite};
    for (const SplatMode mode : kModes) {
        bool isNewMode = true;
        for (const DrawnPatch& which : drawn) {
            if (which.mode != mode) continue;
            const Patch& patch = points.patches()[which.patch];
            GFXREPRO_ASSERT(which.level < patch.levelCount);
            const Level& level = points.levels()[patch.firstLevel + which.level];
            const std::uint32_t piece = points.pieceOf(which.patch);
            const std::uint32_t first = points.indexInPiece(piece, patch.firstPoint);
            const auto record = static_cast<std::uint32_t>(records.size());
            records.push_back({glm::vec4(patch.bounds.min, level.radiusScale),
                               glm::vec4(patch.bounds.size(), 0.0F)});
            for (std::uint32_t begin = 0; begin < level.count; begin += maxRange) {
                if (isNewMode || batches.back().piece != piece ||
                    batches.back().pointCount >= maxBatch) {
                    batches.push_back(
                        {mode, piece, static_cast<std::uint32_t>(ranges.size()), 0, 0});
                    isNewMode = false;
                }
                const std::uint32_t count = std::min(level.count - begin, maxRange);
                ranges.push_back({first + begin, count, record});
                ++batches.back().rangeCount;
                batches.back().pointCount += count;
            }
        }
    }
}

void setView(const gl::Program& program, const PatchView& view) {
    const glm::mat4& clip = view.clipFromView;
    const glm::vec2 size(view.sizePx);
    const glm::vec2 ndcPerSlope(clip[0][0], clip[1][1]);
    const glm::vec2 ndcOffset(-clip[2][0], -clip[2][1]);  // clip w is −z
    glm::mat4 eyeFromView(1.0F);
    eyeFromView[2][2] = -1.0F;
    program.setIfActive("eyeFromModel", eyeFromView * view.viewFromWorld);
    program.setIfActive("ndcPerSlope", ndcPerSlope);
    program.setIfActive("ndcOffset", ndcOffset);
    program.setIfActive("depthFromInverseZ", glm::vec2(clip[3][2], -clip[2][2]));
    program.setIfActive("nearM", view.nearM);
    program.setIfActive("focalPx", view.focalPx);
    program.setIfActive("sizePx", size);
    // As wide a border as is common for splats of this kind: 0.3 of half the window.
    program.setIfActive("slopeLimit", 1.3F * (1.0F + glm::abs(ndcOffset)) / ndcPerSlope);
    program.setIfActive("slopePerPx", 2.0F / (size * ndcPerSlope));
    program.setIfActive("slopeAtZero", (-1.0F - ndcOffset) / ndcPerSlope);
}

}  // namespace gfxrepro::point_splatting
