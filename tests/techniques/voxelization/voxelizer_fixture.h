// Grids on the device and off it, and meshes voxelized into them, with the metrics.
#pragma once

#include <muParser.h>

#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/mesh_voxelizer.h"
#include "techniques/voxelization/reference.h"
#include "tests/gl/suite_device.h"
#include "tests/support/support.h"
#include "tests/techniques/technique_recorder.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::voxelization {

/// Empty voxels that a path over faces of empty voxels joins to the grid's boundary.
inline DenseGrid outsideOf(const DenseGrid& surface) {
    const GridShape& shape = surface.shape();
    DenseGrid result(WorksheetLayout(shape, 1));
    std::vector<glm::ivec3> open;
    const auto reach = [&](const glm::ivec3& voxel) {
        if (!shape.has(voxel) || surface.isFull(voxel) || result.isFull(voxel)) return;
        result.set(voxel, 1);
        open.push_back(voxel);
    };
    forEachVoxel(shape, [&](const glm::ivec3& voxel) {
        const glm::ivec3 opposite = shape.size - 1 - voxel;
        for (int axis = 0; axis < 3; ++axis) {
            if (voxel[axis] == 0 || opposite[axis] == 0) reach(voxel);
        }
    });
    while (!open.empty()) {
        const glm::ivec3 voxel = open.back();
        open.pop_back();
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                glm::ivec3 next = voxel;
                next[axis] += step;
                reach(next);
            }
        }
    }
    return result;
}

/// The voxels that are full in `grid`, 1 bit each.
inline DenseGrid occupancyOf(const DenseGrid& grid) {
    DenseGrid bits(WorksheetLayout(grid.shape(), 1));
    forEachVoxel(grid.shape(), [&](const glm::ivec3& voxel) {
        if (grid.isFull(voxel)) bits.set(voxel, 1);
    });
    return bits;
}

inline gl::Texture uploaded(const DenseGrid& grid) {
    gl::Texture sheets = makeSheets(grid.layout());
    sheets.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, grid.words().data());
    return sheets;
}

/// A formula in x, y and z on the host, by muParser.
class HostFormula {
  public:
    explicit HostFormula(const std::string& formula) {
        parser_.DefineConst("pi", std::numbers::pi);
        for (int i = 0; i < 3; ++i) parser_.DefineVar(std::string(1, "xyz"[i]), &at_[i]);
        parser_.SetExpr(formula);
    }
    HostFormula(const HostFormula&) = delete;
    double operator()(const glm::dvec3& at) {
        at_ = at;
        return parser_.Eval();
    }

  private:
    glm::dvec3 at_{0.0};
    mu::Parser parser_;
};

/// The shaders of the technique with one of the test's own beside them.
class ShaderFolder {
  public:
    explicit ShaderFolder(const std::string& text) {
        fs::copy(dataFolder("shaders") / "voxelization", folder_.path() / "voxelization");
        folder_.write("test.comp.glsl", text);
    }
    gl::Pass pass(const gl::Defines& defines,
                  const std::map<std::string, std::string>& snippets = {}) const {
        return gl::Pass(gl::ShaderLibrary(folder_.path()), {"test.comp.glsl"}, defines, snippets);
    }

  private:
    TemporaryFolder folder_;
};

/// A device and the shaders.
class GlTest : public test::SuiteDeviceTest {
  protected:
    /// For sources that need no scene.
    technique::SetupContext setupContext() {
        return {device(), shaders(), scenes_, nullptr, {64, 64}, 1, profiler_};
    }
    gl::Profiler& profiler() { return profiler_; }

  private:
    test::NoScenes scenes_;
    gl::Profiler profiler_{true};
};

struct Voxelized {
    DenseGrid grid;
    std::map<std::string, double> metrics;
};

struct VoxelizerTest : GlTest {
    static MeshVoxelizerSettings settings(const GridShape& shape, Rule rule, int voxelBits = 1) {
        MeshVoxelizerSettings result;
        result.grid.layout = WorksheetLayout(shape, voxelBits);
        result.method = rule == Rule::Rasterized ? Method::Worksheet : Method::Direct;
        result.rule = rule;
        return result;
    }
    static MeshVoxelizerSettings solid(const GridShape& shape, int voxelBits = 1) {
        MeshVoxelizerSettings result = settings(shape, Rule::Thin, voxelBits);
        result.grid.fill = Fill::Solid;
        return result;
    }

    Voxelized voxelize(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings,
                       const scene::Box& box) {
        MeshVoxelizer voxelizer(settings, mesh, box);
        technique::SetupContext context = setupContext();
        voxelizer.setup(context);
        voxelizer.render(profiler());
        test::MetricRecorder recorder;
        voxelizer.record(recorder);
        profiler().collect();
        return {voxelizer.grid()->read(), recorder.metrics};
    }
    Voxelized voxelize(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings) {
        return voxelize(mesh, settings, boxOf(mesh, settings));
    }
    static scene::Box boxOf(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings) {
        return gridBox(mesh.bounds(), settings.grid.layout.shape(), 1);
    }
    static LatticeMesh lattice(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings) {
        return snapped(mesh, boxOf(mesh, settings), settings.grid.layout.shape());
    }
};

}  // namespace gfxrepro::voxelization
