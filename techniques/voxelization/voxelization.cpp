#include "techniques/voxelization/voxelization.h"

#include <fmt/format.h>

#include <algorithm>

#include "techniques/kit/requirements.h"
#include "techniques/voxelization/binvox.h"
#include "techniques/voxelization/implicit.h"
#include "techniques/voxelization/outputs.h"
#include "techniques/voxelization/parametric.h"
#include "techniques/voxelization/phantom.h"
#include "techniques/voxelization/reference.h"

namespace gfxrepro::voxelization {
namespace {

std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<Voxelization>(params);
}

/// Formulas are read with the parameters; a mesh comes at set-up, with the scene.
std::unique_ptr<GridSource> makeFormulaSource(const VoxelizationParams& read, Params& params) {
    switch (read.input) {
        case InputKind::Implicit:
            return std::make_unique<ImplicitSource>(params, read.voxelizer.grid, read.box);
        case InputKind::Parametric:
            return std::make_unique<ParametricSource>(params, read.voxelizer.grid, read.box);
        case InputKind::Mesh:
            break;
    }
    return nullptr;
}

/// Voxels that are full in either grid of one layout.
DenseGrid together(const DenseGrid& a, const DenseGrid& b) {
    std::vector<std::uint32_t> words(a.words().begin(), a.words().end());
    for (std::size_t i = 0; i < words.size(); ++i) words[i] |= b.words()[i];
    return {a.layout(), std::move(words)};
}

}  // namespace

Voxelization::Voxelization(Params& params)
    : params_(params),
      source_(makeFormulaSource(params_, params)),
      combination_(params_.combination),
      drawing_(params_.drawing) {
    params.finish();
}

void Voxelization::setup(technique::SetupContext& context) {
    const WorksheetLayout& layout = params_.voxelizer.grid.layout;
    checkFitsDevice(layout, context.device.limits());
    if (params_.input == InputKind::Mesh) {
        setupMesh(context);
        return;
    }
    source_->setup(context);
    box_ = source_->grid()->box;
    if (params_.drawing.isOn()) drawing_.setup(context, layout, box_, box_, false);
}

void Voxelization::requireScene(const scene::Scene& scene) const {
    if (params_.input == InputKind::Mesh) requireVoxelizable(scene);
}

void Voxelization::setupMesh(technique::SetupContext& context) {
    const MeshVoxelizerSettings& settings = params_.voxelizer;
    const WorksheetLayout& layout = settings.grid.layout;
    input_.emplace(*context.scene, settings.grid.value);
    scene::Box bounds = input_->mesh().bounds();
    if (params_.combination.needsSecond()) {
        bounds.add(combination_.loadSecond(context, settings.grid.value, bounds));
    }
    const bool isInHead = params_.drawing.draw.mode == DrawMode::Mixed;
    box_ = params_.box ? *params_.box
           : isInHead  ? headBoxAround(bounds)
                       : cubicBox(bounds, layout.resolution(), params_.paddingVoxels);
    source_ = std::make_unique<MeshVoxelizer>(settings, input_->mesh(), box_);
    source_->setup(context);
    if (params_.combination.needsSecond()) combination_.setup(context, settings, box_);
    if (params_.drawing.isOn()) {
        const bool showsBoth =
            params_.combination.findsCollision && !params_.combination.csg.has_value();
        const scene::Box shown = isInHead ? headBounds(box_) : params_.box ? *params_.box : bounds;
        drawing_.setup(context, layout, box_, shown, showsBoth);
    }
}

const VoxelGrid* Voxelization::grid() const {
    return combination_.result() ? combination_.result() : source_->grid();
}

void Voxelization::render(technique::FrameContext& context) {
    source_->render(context.profiler);
    if (params_.combination.needsSecond()) {
        combination_.render(context.profiler, *source_->grid());
    }
    if (!grid()) return;
    if (params_.readsBack) {
        gl::CpuScope scope(context.profiler, "read_back");
        readSheets(grid()->sheets);
    }
    if (params_.drawing.isPass()) draw(context.profiler);
}

void Voxelization::draw(gl::Profiler& profiler) {
    const bool showsBoth = params_.combination.findsCollision && !combination_.result();
    drawing_.render(profiler, *grid(), showsBoth ? &combination_.second() : nullptr);
}

void Voxelization::record(technique::Recorder& recorder) {
    const auto count = [&](const char* name, std::size_t value, const char* unit) {
        recorder.metric(name, static_cast<double>(value), unit);
    };
    if (input_) {
        count("triangles", input_->mesh().triangles.size(), "triangle");
        count("vertices", input_->mesh().positions.size(), "vertex");
    }
    source_->record(recorder);
    combination_.record(recorder);
    if (!grid()) return;
    recordGrid(recorder, grid()->read());
    if (!params_.drawing.isOn()) return;
    if (params_.drawing.isBeside) {
        gl::Profiler unread(false);
        draw(unread);
    }
    drawing_.record(recorder);
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
        if (params_.voxelizer.fillRule == FillRule::SurfaceVoxels) {
            count("stray_voxels", grid,
                  together(expected, reference::conservative(mesh, resolution)));
        }
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
    "real-time voxelization of triangle meshes with worksheets (zju2005, chapter 2)", &create,
    &outputs};

}  // namespace gfxrepro::voxelization
