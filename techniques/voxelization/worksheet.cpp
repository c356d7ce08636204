#include "techniques/voxelization/worksheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "engine/core/error.h"

namespace gfxrepro::voxelization {
namespace {

int dividedUp(int a, int b) {
    return (a + b - 1) / b;
}

}  // namespace

WorksheetLayout::WorksheetLayout(const GridShape& shape, int voxelBits)
    : shape_(shape), voxelBits_(voxelBits) {
    GFXREPRO_ASSERT(glm::all(glm::greaterThan(shape.size, glm::ivec3(0))));
    GFXREPRO_ASSERT(voxelBits == 1 || voxelBits == 8 || voxelBits == 16 || voxelBits == 32);
    // A patch that is larger than the thesis's sheet has one of its own.
    const glm::ivec2 most = glm::max(kMaxSheetSizePx / glm::ivec2(shape.size), glm::ivec2(1));
    const int sheets = dividedUp(slabCount(), most.x * most.y);
    const int patches = dividedUp(slabCount(), sheets);
    // As square as powers of two make it, the wider side along x, unless less is wasted otherwise.
    int widest = 1;
    while (widest * widest < patches) widest *= 2;
    widest = std::clamp(widest, dividedUp(patches, most.y), most.x);
    int fewest = std::numeric_limits<int>::max();
    for (int across = widest; across > 0; --across) {
        const int down = std::min(dividedUp(patches, across), most.y);
        const int layers = dividedUp(slabCount(), across * down);
        if (layers > 1 && sheets == 1) break;
        if (across * down * layers >= fewest) continue;
        fewest = across * down * layers;
        patchesX_ = across;
        patchesY_ = down;
    }
}

std::size_t WorksheetLayout::wordCount() const {
    const glm::ivec2 size = sheetSizePx();
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
           static_cast<std::size_t>(layers());
}

// [zju2005] Sec. 2.2.2: pz by C gives the patch, (px, py) the texel in it, pz modulo C the bits.
glm::ivec3 WorksheetLayout::texel(const glm::ivec3& local) const {
    const int slab = local.z / voxelsPerTexel();
    const int patch = slab % patchesPerSheet();
    return {patch % patchesX_ * shape_.size.x + local.x,
            patch / patchesX_ * shape_.size.y + local.y, slab / patchesPerSheet()};
}

std::size_t WorksheetLayout::wordIndex(const glm::ivec3& local) const {
    const glm::ivec3 at = texel(local);
    const glm::ivec2 size = sheetSizePx();
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) +
            static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(at.x);
}

WorksheetLayout WorksheetLayout::ofAxis(Axis axis) const {
    return {GridShape(localFromVolume(axis, shape_.size)), voxelBits_};
}

std::string WorksheetLayout::sheetDefine() const {
    return fmt::format("ivec4({}, {}, {}, {})", shape_.size.x, shape_.size.y, patchesX_,
                       patchesPerSheet());
}

gl::Defines WorksheetLayout::defines() const {
    const glm::ivec3& size = shape_.size;
    return {{"SIZE", fmt::format("ivec3({}, {}, {})", size.x, size.y, size.z)},
            {"SHEET", sheetDefine()},
            {"VOXEL_BITS", voxelBits_},
            {"VOXELS_PER_TEXEL", voxelsPerTexel()},
            {"LANE_MASK", laneMask()}};
}

DenseGrid::DenseGrid(const WorksheetLayout& layout) : layout_(layout), words_(layout.wordCount()) {}

DenseGrid::DenseGrid(const WorksheetLayout& layout, std::vector<std::uint32_t> words)
    : layout_(layout), words_(std::move(words)) {
    GFXREPRO_ASSERT_EQ(words_.size(), layout_.wordCount());
}

std::uint32_t DenseGrid::value(const glm::ivec3& voxel) const {
    return (words_[layout_.wordIndex(voxel)] >> layout_.shift(voxel.z)) & layout_.laneMask();
}

void DenseGrid::set(const glm::ivec3& voxel, std::uint32_t value) {
    GFXREPRO_ASSERT((value & ~layout_.laneMask()) == 0);
    std::uint32_t& word = words_[layout_.wordIndex(voxel)];
    const int shift = layout_.shift(voxel.z);
    word = (word & ~(layout_.laneMask() << shift)) | (value << shift);
}

std::size_t DenseGrid::countFull() const {
    std::size_t count = 0;
    for (std::uint32_t word : words_) {
        if (layout_.voxelBits() == 1) {
            count += static_cast<std::size_t>(std::popcount(word));
            continue;
        }
        for (int lane = 0; lane < layout_.voxelsPerTexel(); ++lane) {
            if ((word >> (lane * layout_.voxelBits())) & layout_.laneMask()) ++count;
        }
    }
    return count;
}

gl::Texture makeSheets(const WorksheetLayout& layout) {
    gl::Texture sheets = gl::Texture::make2DArray(GL_R32UI, layout.sheetSizePx(), layout.layers());
    sheets.clearToZero();
    return sheets;
}

gl::Texture makeBitTable() {
    std::vector<std::uint8_t> bits;
    for (unsigned bit = 0; bit < 8; ++bit) {
        for (unsigned byte = 0; byte < 256; ++byte) bits.push_back((byte >> bit) & 1U);
    }
    gl::Texture table = gl::Texture::make2D(GL_R8UI, {256, 8});
    table.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, bits.data());
    return table;
}

DenseGrid VoxelGrid::read() const {
    return DenseGrid(layout, readSheets(sheets));
}

std::vector<std::uint32_t> readSheets(const gl::Texture& sheets) {
    return sheets.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
}

float voxelSizeOf(const scene::Box& box, const GridShape& shape) {
    return box.size()[shape.longestAxis()] / static_cast<float>(shape.longest());
}

scene::Box gridBox(const scene::Box& bounds, const GridShape& shape, int paddingVoxels) {
    const glm::vec3 size = bounds.size();
    const float longest = std::max({size.x, size.y, size.z});
    const auto n = static_cast<float>(shape.longest());
    const float half = 0.5F * longest * n / static_cast<float>(shape.longest() - 2 * paddingVoxels);
    const glm::vec3 halves = half * (glm::vec3(shape.size) / n);
    return {bounds.centre() - halves, bounds.centre() + halves};
}

void GridSettings::fitTo(const scene::Box& bounds, int paddingVoxels) {
    if (extent == Extent::Cube) return;
    const int n = layout.shape().longest();
    const glm::dvec3 size(bounds.size());
    const double voxelSize = std::max({size.x, size.y, size.z}) / (n - 2 * paddingVoxels);
    // A thousandth of a voxel: what decimal fractions lose as floats.
    const glm::ivec3 voxels(glm::ceil(size / voxelSize - 1e-3));
    layout = WorksheetLayout(GridShape(glm::max(voxels, glm::ivec3(1)) + 2 * paddingVoxels),
                             layout.voxelBits());
}

void checkFitsDevice(const WorksheetLayout& layout, const gl::DeviceLimits& limits) {
    const glm::ivec2 size = layout.sheetSizePx();
    if (std::max(size.x, size.y) > limits.maxTextureSizePx ||
        layout.layers() > limits.maxArrayLayers) {
        throw UnsupportedError(fmt::format(
            "{} voxels of {} bits take {} worksheets of {} × {} texels; the device holds {} of "
            "{} × {}",
            layout.shape().text(), layout.voxelBits(), layout.layers(), size.x, size.y,
            limits.maxArrayLayers, limits.maxTextureSizePx, limits.maxTextureSizePx));
    }
    // What Mesa's software rasterizer holds, and a third of what three axes would take elsewhere.
    constexpr std::size_t kMaxSheetsBytes = std::size_t{1} << 30;
    if (layout.sizeBytes() > kMaxSheetsBytes) {
        throw UnsupportedError(fmt::format(
            "{} voxels of {} bits take {} bytes an axis; allowed: {}", layout.shape().text(),
            layout.voxelBits(), layout.sizeBytes(), kMaxSheetsBytes));
    }
}

}  // namespace gfxrepro::voxelization
