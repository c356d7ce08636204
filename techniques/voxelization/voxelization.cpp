#include "techniques/voxelization/voxelization.h"

#include <fmt/format.h>

#include <algorithm>

#include "techniques/voxelization/binvox.h"
#include "techniques/voxelization/reference.h"

namespace gfxrepro::voxelization {
namespace {

std::unique_ptr<technique::Technique> create(config::Params& params) {
    return std::make_unique<Voxelization>(params);
}

}  // namespace

Voxelization::Voxelization(config::Params& params) : params_(params) {
    params.finish();
}

void Voxelization::setup(technique::SetupContext& context) {
    const MeshVoxelizerSettings& settings = params_.voxelizer;
    const WorksheetLayout& layout = settings.grid.layout;
    checkFitsDevice(layout, context.device.limits());
    if (!context.scene)
        throw Error("technique 'voxelization' needs a scene; the config names none");
    input_.emplace(*context.scene, settings.grid.value);
    box_ = params_.box
               ? *params_.box
               : cubicBox(input_->mesh().bounds(), layout.resolution(), params_.paddingVoxels);
    source_ = std::make_unique<MeshVoxelizer>(settings, input_->mesh(), box_);
    source_->setup(context);
}

void Voxelization::render(technique::FrameContext& context) {
    source_->render(context.profiler);
    if (!params_.readsBack || !source_->grid()) return;
    gl::CpuScope scope(context.profiler, "read_back");
    readSheets(source_->grid()->sheets);
}

void Voxelization::record(technique::Recorder& recorder) {
    const auto count = [&](const char* name, std::size_t value, const char* unit) {
        recorder.metric(name, static_cast<double>(value), unit);
    };
    count("triangles", input_->mesh().triangles.size(), "triangle");
    count("vertices", input_->mesh().positions.size(), "vertex");
    source_->record(recorder);
    if (const VoxelGrid* grid = source_->grid()) recordGrid(recorder, grid->read());
}

void Voxelization::recordGrid(technique::Recorder& recorder, const DenseGrid& grid) const {
    const WorksheetLayout& layout = grid.layout();
    recorder.metric("voxels", static_cast<double>(grid.countFull()), "voxel");
    recorder.metric("voxel_bits", layout.voxelBits(), "bit");
    recorder.metric("worksheet_bytes", static_cast<double>(layout.sizeBytes()), "byte");
    recorder.metric("digest", digestOf(grid.words()), "1");
    if (params_.comparesWithReference) recordMisses(recorder, grid);
    if (params_.exportsBinvox) writeBinvox(recorder.artifact("grid.binvox"), grid, box_);
    if (params_.showsSlices) recorder.image("slices", middleSlices(grid));
}

void Voxelization::recordMisses(technique::Recorder& recorder, const DenseGrid& grid) const {
    const int resolution = grid.resolution();
    const LatticeMesh mesh = snapped(input_->mesh(), box_, resolution);
    const auto count = [&](const char* name, const DenseGrid& a, const DenseGrid& b) {
        recorder.metric(name, static_cast<double>(reference::countMissing(a, b)), "voxel");
    };
    if (params_.voxelizer.grid.fill == Fill::Solid) {
        const DenseGrid expected = reference::solid(mesh, resolution).grid;
        count("missed_solid_voxels", expected, grid);
        count("added_solid_voxels", grid, expected);
        return;
    }
    count("missed_thin_voxels", reference::thin(mesh, resolution), grid);
    const DenseGrid conservative = reference::conservative(mesh, resolution);
    count("missed_conservative_voxels", conservative, grid);
    count("added_conservative_voxels", grid, conservative);
}

void checkFitsDevice(const WorksheetLayout& layout, const gl::DeviceLimits& limits) {
    const glm::ivec2 size = layout.sheetSizePx();
    if (std::max(size.x, size.y) > limits.maxTextureSizePx ||
        layout.layers() > limits.maxArrayLayers) {
        throw UnsupportedError(fmt::format(
            "{}³ voxels of {} bits take {} worksheets of {} × {} texels; the device holds {} of "
            "{} × {}",
            layout.resolution(), layout.voxelBits(), layout.layers(), size.x, size.y,
            limits.maxArrayLayers, limits.maxTextureSizePx, limits.maxTextureSizePx));
    }
    // What Mesa's software rasterizer holds, and a third of what three axes would take elsewhere.
    constexpr std::size_t kMaxSheetsBytes = std::size_t{1} << 30;
    if (layout.sizeBytes() > kMaxSheetsBytes) {
        throw UnsupportedError(fmt::format(
            "{}³ voxels of {} bits take {} bytes an axis; allowed: {}", layout.resolution(),
            layout.voxelBits(), layout.sizeBytes(), kMaxSheetsBytes));
    }
}

double digestOf(std::span<const std::uint32_t> words) {
    // FNV-1a over words, folded to 48 bits: exact as a double.
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (std::uint32_t word : words) hash = (hash ^ word) * 0x100000001B3ULL;
    return static_cast<double>((hash ^ (hash >> 48)) & 0xFFFFFFFFFFFFULL);
}

image::ImageF middleSlices(const DenseGrid& grid) {
    const int n = grid.resolution();
    image::ImageF image(3 * n, n, 1);
    for (int b = 0; b < n; ++b) {
        for (int a = 0; a < n; ++a) {
            image.at(a, n - 1 - b) = grid.isFull({a, b, n / 2}) ? 1.0F : 0.0F;
            image.at(n + a, n - 1 - b) = grid.isFull({a, n / 2, b}) ? 1.0F : 0.0F;
            image.at(2 * n + a, n - 1 - b) = grid.isFull({n / 2, b, a}) ? 1.0F : 0.0F;
        }
    }
    return image;
}

const technique::TechniqueInfo kVoxelization = {
    "voxelization",
    "real-time voxelization of triangle meshes with worksheets (zju2005, chapter 2)", &create};

}  // namespace gfxrepro::voxelization
