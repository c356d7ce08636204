// Voxelizes a mesh on the device and hands back the grid and the metrics.
#pragma once

#include <map>
#include <string>

#include "techniques/voxelization/mesh_input.h"
#include "techniques/voxelization/mesh_voxelizer.h"
#include "techniques/voxelization/reference.h"
#include "tests/support/support.h"
#include "tests/techniques/voxelization/gl_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::voxelization {

/// Keeps what a technique records.
class MetricRecorder final : public technique::Recorder {
  public:
    explicit MetricRecorder(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}
    void metric(std::string_view metric, double value, std::string_view,
                std::string_view) override {
        metrics[std::string(metric)] = value;
    }
    void image(std::string_view name, const image::ImageF& image,
               const technique::ImageOptions&) override {
        images.emplace(name, image);
    }
    std::filesystem::path artifact(std::string_view fileName) override {
        return folder_ / fileName;
    }

    std::map<std::string, double> metrics;
    std::map<std::string, image::ImageF> images;

  private:
    std::filesystem::path folder_;
};

struct Voxelized {
    DenseGrid grid;
    std::map<std::string, double> metrics;
};

class VoxelizerTest : public GlTest {
  protected:
    static MeshVoxelizerSettings settings(int resolution, Rule rule, int voxelBits = 1) {
        MeshVoxelizerSettings result;
        result.grid.layout = WorksheetLayout(resolution, voxelBits);
        result.rule = rule;
        return result;
    }
    static MeshVoxelizerSettings solid(int resolution, int voxelBits = 1) {
        MeshVoxelizerSettings result = settings(resolution, Rule::Rasterized, voxelBits);
        result.grid.fill = Fill::Solid;
        return result;
    }

    Voxelized voxelize(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings,
                       const scene::Box& box) {
        MeshVoxelizer voxelizer(settings, mesh, box);
        technique::SetupContext context = setupContext();
        voxelizer.setup(context);
        voxelizer.render(profiler());
        MetricRecorder recorder;
        voxelizer.record(recorder);
        profiler().collect();
        return {voxelizer.grid()->read(), recorder.metrics};
    }
    Voxelized voxelize(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings) {
        return voxelize(mesh, settings, boxOf(mesh, settings));
    }
    static scene::Box boxOf(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings) {
        return cubicBox(mesh.bounds(), settings.grid.layout.resolution(), 1);
    }
    static LatticeMesh lattice(const scene::Mesh& mesh, const MeshVoxelizerSettings& settings) {
        return snapped(mesh, boxOf(mesh, settings), settings.grid.layout.resolution());
    }
};

/// The voxels that are full in `grid`, 1 bit each.
inline DenseGrid occupancyOf(const DenseGrid& grid) {
    const int n = grid.resolution();
    DenseGrid bits(WorksheetLayout(n, 1));
    for (int z = 0; z < n; ++z) {
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                if (grid.isFull({x, y, z})) bits.set({x, y, z}, 1);
            }
        }
    }
    return bits;
}

}  // namespace gfxrepro::voxelization
