// The method of the thesis: three stages over three directional sheets. [zju2005] Sec. 2.2.1.
#include <fmt/format.h>

#include <algorithm>

#include "techniques/kit/draws.h"
#include "techniques/voxelization/mesh_voxelizer.h"

namespace gfxrepro::voxelization {
namespace {

constexpr int kGroupSize = 64;         // texelize.comp.glsl
constexpr unsigned kMaxGroups = 4096;  // beyond it an invocation takes several fragments
constexpr int kFillGroupSize = 8;      // fill.comp.glsl: 8 × 8 columns
constexpr int kGroupEdge = 8;          // synthesis.comp.glsl: 8 × 8 texels

std::size_t indexOf(Axis axis) {
    return static_cast<std::size_t>(axis);
}

/// The sheets of the three axes; synthesis merges those of x and y into the third, the grid's own.
struct DirectionalSheets {
    gl::Texture x, y;
    VoxelGrid grid;

    explicit DirectionalSheets(const MeshRequest& request)
        : x(makeSheets(request.layout().ofAxis(Axis::X))),
          y(makeSheets(request.layout().ofAxis(Axis::Y))),
          grid{makeSheets(request.layout()), request.layout(), request.box} {}
    gl::Texture& of(Axis axis) { return axis == Axis::X ? x : axis == Axis::Y ? y : grid.sheets; }
    std::size_t sizeBytes() const {
        return x.sizeBytes() + y.sizeBytes() + grid.sheets.sizeBytes();
    }
};

/// The look-up textures of [zju2005] Sec. 2.3.2, beside the integer instructions of worksheet.glsl:
/// integers, read without filtering.
class LookupTables {
  public:
    /// Asserts that the layout is one sheet, as the thesis's.
    explicit LookupTables(const WorksheetLayout& layout)
        : xFromZ_(fromZ(layout, Axis::X)), yFromZ_(fromZ(layout, Axis::Y)) {
        GFXREPRO_ASSERT_EQ(layout.layers(), 1);
        constexpr std::uint8_t kPowers[] = {1, 2, 4, 8, 16, 32, 64, 128};
        powerOfTwo_.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, kPowers);
    }

    /// Of lookup_tables.glsl.
    gl::Resources resources() const {
        return {{"bitOfByte", bitOfByte_},
                {"powerOfTwo", powerOfTwo_},
                {"xFromZ", xFromZ_},
                {"yFromZ", yFromZ_}};
    }
    std::size_t sizeBytes() const {
        return bitOfByte_.sizeBytes() + powerOfTwo_.sizeBytes() + xFromZ_.sizeBytes() +
               yFromZ_.sizeBytes();
    }

  private:
    static gl::Texture fromZ(const WorksheetLayout& layout, Axis axis) {
        using Texel = glm::u16vec4;
        const glm::ivec3& size = layout.shape().size;
        const WorksheetLayout from = layout.ofAxis(axis);
        std::vector<glm::ivec3> slabCorners;  // by w
        for (int w = 0; w < from.shape().size.z; ++w) slabCorners.push_back(from.texel({0, 0, w}));
        std::vector<Texel> texels(layout.wordCount());
        for (int z = 0; z < size.z; z += layout.voxelsPerTexel()) {
            for (int y = 0; y < size.y; ++y) {
                Texel* row = &texels[layout.wordIndex({0, y, z})];
                for (int x = 0; x < size.x; ++x) {
                    const glm::ivec3 local = localFromVolume(axis, glm::ivec3(x, y, z));
                    const glm::ivec3& corner = slabCorners[static_cast<std::size_t>(local.z)];
                    const int shift = layout.shift(local.z);
                    row[x] = Texel(corner.x + local.x, corner.y + local.y, shift / 8, shift % 8);
                }
            }
        }
        gl::Texture table = gl::Texture::make2D(GL_RGBA16UI, layout.sheetSizePx());
        table.upload(GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, texels.data());
        return table;
    }

    gl::Texture bitOfByte_ = makeBitTable();  // (1)
    // (2) Texel s is 2^s.
    gl::Texture powerOfTwo_ = gl::Texture::make2D(GL_R8UI, {8, 1});
    // (3) The size of the sheet: for the first voxel of a texel of the z sheet where the sheet of x
    // (of y) has it: column, row, byte of the texel (0 … 3) and bit of the byte.
    gl::Texture xFromZ_, yFromZ_;
};

/// The fragments of each axis, appended in any order; see shaders/emit_voxel.glsl.
struct FragmentList {
    std::array<gl::Buffer, 3> records;
    gl::Buffer counters = gl::Buffer(3 * sizeof(std::uint32_t));
    std::array<std::uint32_t, 3> capacities{};

    /// Fragments of each axis, those beyond the capacity too; waits for the device.
    std::array<std::uint32_t, 3> counts() const {
        const auto read = counters.read<std::uint32_t>(3);
        return {read[0], read[1], read[2]};
    }
    std::size_t sizeBytes() const {
        return records[0].sizeBytes() + records[1].sizeBytes() + records[2].sizeBytes() +
               counters.sizeBytes();
    }
};

/// Stage 1: every triangle, once, becomes fragments with a voxel position. [zju2005] Sec. 2.2.1.
class Rasterization {
  public:
    /// Makes the list as long as a counting draw finds necessary. Throws UnsupportedError when a
    /// list would not fit a storage block.
    Rasterization(technique::SetupContext& context, const MeshRequest& request,
                  const DeviceMesh& mesh)
        : draw_(context.shaders, request, DrawTarget::FragmentList) {
        for (gl::Buffer& records : fragments_.records) records = gl::Buffer(sizeof(std::uint32_t));
        run(mesh);  // capacity 0: counts only
        const std::size_t recordBytes = (request.hasValues() ? 2 : 1) * sizeof(std::uint32_t);
        fragments_.capacities = fragments_.counts();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t bytes = fragments_.capacities[axis] * recordBytes;
            if (static_cast<long long>(bytes) > context.device.limits().maxStorageBlockBytes) {
                throw UnsupportedError(fmt::format(
                    "{} fragments along {} take {} bytes; the device's storage blocks hold {}",
                    fragments_.capacities[axis], "xyz"[axis], bytes,
                    context.device.limits().maxStorageBlockBytes));
            }
            fragments_.records[axis] = gl::Buffer(std::max(bytes, recordBytes));
        }
    }

    /// Draws the mesh once, in three parts (solid: once an axis).
    void run(const DeviceMesh& mesh) {
        fragments_.counters.clear();
        for (Axis axis : kAxes) {
            draw_.pass().set("fragmentCapacity", fragments_.capacities[indexOf(axis)]);
            draw_.pass().use({{"Records", fragments_.records[indexOf(axis)]},
                              gl::Resource("Counters", fragments_.counters).unordered()});
            draw_.draw(mesh, axis);
        }
    }
    const FragmentList& fragments() const { return fragments_; }
    /// Fragments of the last run. Throws Error when they were more than the list holds.
    std::size_t checkedCount() const {
        const std::array<std::uint32_t, 3> counts = fragments_.counts();
        std::size_t total = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (counts[axis] > fragments_.capacities[axis]) {
                throw Error(
                    fmt::format("{} fragments along {}, but the list holds the {} of set-up",
                                counts[axis], "xyz"[axis], fragments_.capacities[axis]));
            }
            total += counts[axis];
        }
        return total;
    }

  private:
    MeshDraw draw_;
    FragmentList fragments_;
};

/// What texelization and synthesis have in common: the layout, and how voxels are addressed.
gl::Defines stageDefines(const MeshRequest& request, Axis axis) {
    gl::Defines defines = request.layout().ofAxis(axis).defines();
    if (request.settings.addressing == Addressing::Tables) defines["TABLES"] = 1;
    return defines;
}

/// Stage 2: fragments become bits of the directional sheets. [zju2005] Sec. 2.2.1, 2.2.2.
class Texelization {
  public:
    Texelization(const gl::ShaderLibrary& shaders, const MeshRequest& request) {
        for (Axis axis : kAxes) {
            gl::Defines defines = stageDefines(request, axis);
            defines["AXIS"] = static_cast<int>(axis);
            defines["GROUP_SIZE"] = kGroupSize;
            defines["RECORD_WORDS"] = request.hasValues() ? 2 : 1;
            defines[request.hasValues() ? "ACCUMULATE_MAX" : "ACCUMULATE_OR"] = 1;
            passes_[indexOf(axis)] =
                gl::Pass(shaders, {"voxelization/texelize.comp.glsl"}, defines);
        }
    }

    /// Clears the three sheets and writes every fragment's voxel. `tables`:
    /// LookupTables::resources(), of Addressing::Tables only.
    void run(const FragmentList& fragments, DirectionalSheets& sheets,
             const gl::Resources& tables) {
        for (Axis axis : kAxes) {
            sheets.of(axis).clearToZero();
            const std::uint32_t capacity = fragments.capacities[indexOf(axis)];
            const gl::Pass& pass = passes_[indexOf(axis)];
            pass.set("fragmentCapacity", capacity);
            pass.dispatch({std::min(kit::groupsFor(capacity, kGroupSize), kMaxGroups), 1, 1},
                          gl::Resources{{"sheet", sheets.of(axis)},
                                        {"Records", fragments.records[indexOf(axis)]},
                                        {"Counters", fragments.counters}}
                              .with(tables));
        }
    }

  private:
    std::array<gl::Pass, 3> passes_;
};

/// Solid only: turns the surface's voxels in the sheets into inside flags, scan line by scan line.
/// [zju2005] Sec. 2.2.3.
class SolidFill {
  public:
    SolidFill(const gl::ShaderLibrary& shaders, const MeshRequest& request) {
        for (Axis axis : kAxes) {
            passes_[indexOf(axis)] = gl::Pass(shaders, {"voxelization/fill.comp.glsl"},
                                              request.layout().ofAxis(axis).defines());
        }
    }
    void run(DirectionalSheets& sheets) {
        openLines_.clear();
        for (Axis axis : kAxes) {
            const glm::ivec3 size = localFromVolume(axis, sheets.grid.layout.shape().size);
            passes_[indexOf(axis)].dispatch(
                {kit::groupsFor(size.x, kFillGroupSize), kit::groupsFor(size.y, kFillGroupSize), 1},
                {{"sheet", sheets.of(axis)}, {"Statistics", openLines_}});
        }
    }
    /// Of the last run; waits for the device.
    std::uint32_t ambiguousScanLines() const { return openLines_.read<std::uint32_t>(1).front(); }

  private:
    std::array<gl::Pass, 3> passes_;
    gl::Buffer openLines_ = gl::Buffer(sizeof(std::uint32_t));  // over the three axes
};

/// Stage 3: merges the sheets of x and y into the grid's: OR, or the largest value.
/// [zju2005] Sec. 2.2.1.
class Synthesis {
  public:
    Synthesis(const gl::ShaderLibrary& shaders, const MeshRequest& request) {
        gl::Defines defines = stageDefines(request, Axis::Z);
        defines["SHEET_X"] = request.layout().ofAxis(Axis::X).sheetDefine();
        defines["SHEET_Y"] = request.layout().ofAxis(Axis::Y).sheetDefine();
        defines["GROUP_EDGE"] = kGroupEdge;
        if (request.hasValues()) defines["VALUES"] = 1;
        pass_ = gl::Pass(shaders, {"voxelization/synthesis.comp.glsl"}, defines);
    }
    /// `tables` are as Texelization::run() takes them.
    void run(const DirectionalSheets& sheets, const gl::Resources& tables) {
        const WorksheetLayout& layout = sheets.grid.layout;
        const glm::ivec2 size = layout.sheetSizePx();
        pass_.dispatch(
            {kit::groupsFor(size.x, kGroupEdge), kit::groupsFor(size.y, kGroupEdge),
             layout.layers()},
            gl::Resources{{"sheetX", sheets.x}, {"sheetY", sheets.y}, {"sheet", sheets.grid.sheets}}
                .with(tables));
    }

  private:
    gl::Pass pass_;
};

class WorksheetMethod : public MeshMethod {
  public:
    WorksheetMethod(technique::SetupContext& context, const MeshRequest& request,
                    const DeviceMesh& mesh)
        : rasterization_(context, request, mesh),
          texelization_(context.shaders, request),
          synthesis_(context.shaders, request),
          sheets_(request) {
        if (request.settings.addressing == Addressing::Tables) tables_.emplace(request.layout());
        if (request.isSolid()) solidFill_.emplace(context.shaders, request);
    }

    void run(const DeviceMesh& mesh, gl::Profiler& profiler) override {
        gl::GpuScope whole(profiler, "voxelization");
        const gl::Resources tables = tables_ ? tables_->resources() : gl::Resources{};
        {
            gl::GpuScope scope(profiler, "rasterization");
            rasterization_.run(mesh);
        }
        {
            gl::GpuScope scope(profiler, "texelization");
            texelization_.run(rasterization_.fragments(), sheets_, tables);
        }
        if (solidFill_) {
            gl::GpuScope scope(profiler, "fill");
            solidFill_->run(sheets_);
        }
        gl::GpuScope scope(profiler, "synthesis");
        synthesis_.run(sheets_, tables);
    }

    const VoxelGrid* grid() const override { return &sheets_.grid; }

    void record(technique::Recorder& recorder) override {
        const std::size_t fragments = rasterization_.checkedCount();
        recorder.metric("fragments", static_cast<double>(fragments));
        if (solidFill_) recorder.metric("ambiguous_scan_lines", solidFill_->ambiguousScanLines());
    }

    std::size_t sizeBytes() const override {
        return sheets_.sizeBytes() + rasterization_.fragments().sizeBytes() +
               (tables_ ? tables_->sizeBytes() : 0);
    }

  private:
    Rasterization rasterization_;
    Texelization texelization_;
    std::optional<LookupTables> tables_;
    std::optional<SolidFill> solidFill_;
    Synthesis synthesis_;
    DirectionalSheets sheets_;
};

}  // namespace

std::unique_ptr<MeshMethod> makeWorksheetMethod(technique::SetupContext& context,
                                                const MeshRequest& request,
                                                const DeviceMesh& mesh) {
    return std::make_unique<WorksheetMethod>(context, request, mesh);
}

}  // namespace gfxrepro::voxelization
