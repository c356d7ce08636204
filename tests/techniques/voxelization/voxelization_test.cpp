// The technique as a whole: parameters, metrics, files.
#include "techniques/voxelization/voxelization.h"

#include <fmt/format.h>

#include "tests/techniques/technique_fixture.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

struct VoxelizationTest : VoxelizerTest {
    std::map<std::string, double> run(const std::string& yaml, const scene::Scene& scene) {
        Params params = test::paramsOf(kVoxelization, yaml);
        const auto technique = kVoxelization.create(params);
        technique::SetupContext context = setupContext();
        context.scene = &scene;
        technique::setUp(*technique, context);
        technique::FrameContext frame{0, 1, profiler()};
        technique->render(frame);
        passes_ = profiler().collect();
        test::MetricRecorder recorder;
        technique->record(recorder);
        technique->recordOnce(recorder);
        return recorder.metrics;
    }
    bool hasPass(const std::string& name, gl::PassTime::Clock clock) const {
        for (const gl::PassTime& pass : passes_) {
            if (pass.pass == name && pass.clock == clock) return true;
        }
        return false;
    }

    std::vector<gl::PassTime> passes_;
    const scene::Scene sphere_ = scene::sceneOf(shapes::sphere(glm::vec3(0.0F), 1.0F, 3));
};

TEST(VoxelizationParamsTest, RefusesWhatMeansNothing) {
    test::expectRefused(
        kVoxelization,
        {
            {"{}", ""},
            {"resolution: 100", ""},
            {"{resolution: 2048, method: worksheet}",
             "14: resolution: 2048 is not allowed with 'method: worksheet'; allowed: at most 1024"},
            {"{resolution: 2048, draw: opaque}",
             "14: resolution: 2048 is not allowed with a picture; allowed: at most 1024"},
            {"resolution: 2048", ""},
            {"{resolution: 4, padding: 2}",
             "14: resolution: 4 is not allowed with 'padding: 2'; allowed: at least 5"},
            {"{resolution: 5, padding: 2}", ""},
            {"{resolution: 1, box_min: [0, 0, 0], box_max: [1, 1, 1]}", ""},
            {"{grid: box, draw: mixed, voxel_bits: 8}", "8: 'draw: mixed' needs 'grid: cube'"},
            {"voxel_bits: 4", "13: voxel_bits: 4 is not allowed; allowed: 1, 8, 16, 32"},
            {"value: normal",
             "8: a voxel of 1 bit says occupancy only; allowed with 'value: normal': voxel_bits 8, "
             "16 or 32"},
            {"{fill: solid, rule: conservative}",
             "21: 'fill: solid' decides by crossings of scan lines; leave 'rule' out or give "
             "'thin'"},
            {"{fill: solid, rule: thin}", ""},
            {"fill_rule: surface_voxels", "12: 'fill_rule' needs 'fill: solid'"},
            {"{fill: solid, fill_rule: surface_voxels, rule: thin}",
             "48: 'fill_rule: surface_voxels' flips at rasterized voxels; leave 'rule' out or give "
             "'rasterized'"},
            {"{fill: solid, fill_rule: surface_voxels}", ""},
            {"{fill: solid, method: worksheet}",
             "23: 'fill_rule: crossings' needs 'method: direct'"},
            {"{fill: solid, fill_rule: surface_voxels, method: direct}",
             "50: 'fill_rule: surface_voxels' needs 'method: worksheet'"},
            {"{fill: solid, voxel_bits: 8, value: normal}",
             "37: 'fill: solid' needs 'value: occupancy'"},
            {"{method: slices, rule: thin}",
             "24: 'rule: thin' and 'rule: conservative' need 'method: direct'"},
            {"{method: worksheet, rule: conservative}",
             "27: 'rule: thin' and 'rule: conservative' need 'method: direct'"},
            {"{method: worksheet, rule: rasterized}", ""},
            {"{method: slices, addressing: tables}", "30: 'addressing' needs 'method: worksheet'"},
            {"{method: worksheet, addressing: tables, voxel_bits: 32}",
             "33: 'addressing: tables' needs a grid of one worksheet; 256³ voxels of 32 bits take "
             "4"},
            {"{method: worksheet, addressing: tables}", ""},
            {"box_min: [0, 0, 0]", "10: box_min and box_max must be given together"},
            {"{box_min: [0, 0, 0], box_max: [1, 2, 1]}",
             "31: the box must be cubic and not be empty; it is 1 × 2 × 1; allowed with 'grid: "
             "box': any other"},
            {"{box_min: [0, 0, 0], box_max: [1, 2, 1], grid: box}", ""},
            {"{box_min: [0, 0, 0], box_max: [1, 2, 0], grid: box}",
             "31: the box must not be empty; it is 1 × 2 × 0"},
            {"{box_min: [0, 0, 0], box_max: [1, 1, 1]}", ""},
        });
}

// Before there is a device.
TEST_F(VoxelizationTest, TheEyeIsOutsideOfTheGrid) {
    const auto refused = [&](const std::string& yaml) {
        return errorText([&] {
            Params params = test::paramsOf(kVoxelization, "{resolution: 32, " + yaml + "}");
            kVoxelization.create(params)->requireScene(sphere_);
        });
    };
    const std::string within = "view '0 0 0 > 1 0 0': the eye lies within the grid, from ";
    EXPECT_THAT(refused("draw: opaque, view: 0 0 0 > 1 0 0"), StartsWith(within + "-1.0"));
    // A corner of the padded cube, a voxel beside the sphere's own box.
    EXPECT_THAT(refused("padding: 8, view: -1.5 -1.5 -1.5 > 1 0 0"),
                HasSubstr("the eye lies within the grid, from -2 -2 -2 to 2 2 2"));
    EXPECT_EQ(refused("padding: 0, view: -1.5 -1.5 -1.5 > 1 0 0"), "no error");
    EXPECT_EQ(refused("box_min: [1, 1, 1], box_max: [2, 2, 2], view: 0 0 0 > 1 0 0"), "no error");
    EXPECT_EQ(
        refused("input: implicit, formula: x, view: 0 0 0 > 1 0 0"),
        "case.yaml:1:53: " + within + "-2.5 -2.5 -2.5 to 2.5 2.5 2.5; allowed: one outside of it");
    EXPECT_THAT(refused("input: implicit, formula: x, box_min: [-1, -1, -1], box_max: [1, 1, 1], "
                        "view: 0 0 0 > 1 0 0"),
                HasSubstr(within + "-1 -1 -1 to 1 1 1;"));
}

TEST_F(VoxelizationTest, NeedsTrianglesThatReachSomewhere) {
    const std::string allowed =
        "; allowed to voxelize: triangles that reach from one point to another";
    EXPECT_EQ(errorText([&] { run("{}", scene::Scene{.name = "void"}); }),
              "scene 'void' has no triangles" + allowed);
    scene::Scene cloud{.name = "cloud.ply"};
    cloud.points.positions = {{0, 0, 0}, {1, 2, 3}};
    cloud.origin.description = "/scans/cloud.ply";
    EXPECT_EQ(errorText([&] { run("{}", cloud); }),
              "scene 'cloud.ply' (/scans/cloud.ply) has no triangles, but 2 points" + allowed);
    const scene::Mesh mesh{.positions = {{1, 2, 3}, {1, 2, 3}}, .triangles = {{0, 1, 0}}};
    scene::Scene point = scene::sceneOf(mesh);
    point.name = "point.obj";
    EXPECT_EQ(errorText([&] { run("{}", point); }),
              "scene 'point.obj' has all its 2 vertices at one point" + allowed);
    point.meshes[0].positions[1].x = 2.0F;  // a line
    EXPECT_GT(run("{resolution: 32, rule: conservative}", point).at("voxels"), 0.0);
}

TEST_F(VoxelizationTest, RecordsTheGrid) {
    const auto metrics =
        run("{resolution: 64, voxel_bits: 8, method: worksheet, compare: true}", sphere_);
    EXPECT_EQ(metrics.at("triangles"), 1280.0);
    EXPECT_EQ(metrics.at("vertices"), 642.0);
    EXPECT_EQ(metrics.at("voxel_bits"), 8.0);
    EXPECT_EQ(metrics.at("grid_voxels"), 64.0 * 64 * 64);
    EXPECT_EQ(metrics.at("worksheet_bytes"), 64.0 * 64 * 64);
    EXPECT_GT(metrics.at("missed_thin_voxels"), 0.0);
    EXPECT_GT(metrics.at("memory_bytes"), 3.0 * 64 * 64 * 64);
    EXPECT_GT(metrics.at("fragments"), 0.0);
    for (const char* stage : {"rasterization", "texelization", "synthesis", "voxelization"}) {
        EXPECT_TRUE(hasPass(stage, gl::PassTime::Clock::Gpu)) << stage;
    }
    const auto direct = run("{resolution: 64, voxel_bits: 8, compare: true}", sphere_);
    EXPECT_EQ(direct.at("missed_thin_voxels"), 0.0);
    EXPECT_GT(direct.at("missed_conservative_voxels"), 0.0);
    EXPECT_EQ(direct.at("added_conservative_voxels"), 0.0);
    EXPECT_LT(direct.at("memory_bytes"), 2.0 * 64 * 64 * 64);  // one grid
    EXPECT_FALSE(direct.contains("fragments"));
    EXPECT_TRUE(hasPass("voxelization", gl::PassTime::Clock::Gpu));
    EXPECT_FALSE(hasPass("synthesis", gl::PassTime::Clock::Gpu));
}

// The same voxels, as many of them as the model needs: with whole numbers they lie in both grids
// alike.
TEST_F(VoxelizationTest, ABoxHoldsTheVoxelsOfTheCube) {
    const scene::Scene flat =
        scene::sceneOf(shapes::cube(glm::vec3(1, 2, 3), glm::vec3(31, 8, 17)));
    for (const char* how : {"rule: thin", "rule: conservative", "fill: solid", "method: worksheet",
                            "method: worksheet, fill: solid, fill_rule: surface_voxels"}) {
        const auto cube = run(fmt::format("{{resolution: 32, {}}}", how), flat);
        const auto box = run(fmt::format("{{resolution: 32, grid: box, {}}}", how), flat);
        EXPECT_EQ(box.at("voxels"), cube.at("voxels")) << how;
        EXPECT_EQ(cube.at("grid_voxels"), 32.0 * 32 * 32);
        EXPECT_EQ(box.at("grid_voxels"), 32.0 * 8 * 16) << how;
        EXPECT_LT(box.at("memory_bytes"), cube.at("memory_bytes")) << how;
    }
    const auto torus =
        run("{input: parametric, resolution: 100, grid: box, samples: [900, 500]}", {});
    EXPECT_EQ(torus.at("grid_voxels"), 100.0 * 100 * 30);
    const auto given =
        run("{input: implicit, formula: z - 0.5, resolution: 40, grid: box, box_min: [0, 0, 0], "
            "box_max: [4, 2.05, 1]}",
            {});
    EXPECT_EQ(given.at("grid_voxels"), 40.0 * 21 * 10);
    EXPECT_EQ(given.at("voxels"), 40.0 * 21 * 2);  // on the face between two layers
}

TEST_F(VoxelizationTest, TimesPreprocessAndReadBackEachFrame) {
    run("{resolution: 32, split: every_frame, read_back: true}", sphere_);
    EXPECT_TRUE(hasPass("preprocess", gl::PassTime::Clock::Cpu));
    EXPECT_TRUE(hasPass("read_back", gl::PassTime::Clock::Cpu));
    const auto metrics = run("{resolution: 32, method: depth_only}", sphere_);
    EXPECT_TRUE(hasPass("draw_depth", gl::PassTime::Clock::Gpu));
    EXPECT_FALSE(metrics.contains("voxels"));
}

// A model of one's own has no pinholes unless it asks for the thesis's rule.
TEST_F(VoxelizationTest, IsThinUnlessAskedOtherwise) {
    const auto metrics = run("{resolution: 64, compare: true}", sphere_);
    EXPECT_EQ(metrics.at("missed_thin_voxels"), 0.0);
    EXPECT_EQ(metrics.at("digest"), run("{resolution: 64, rule: thin}", sphere_).at("digest"));
    EXPECT_GT(
        run("{resolution: 64, compare: true, rule: rasterized}", sphere_).at("missed_thin_voxels"),
        0.0);
}

TEST_F(VoxelizationTest, CountsStrayVoxels) {
    const scene::Scene plate =
        scene::sceneOf(shapes::cube(glm::vec3(4, 4, 10.2F), glm::vec3(14, 14, 10.4F)));
    const auto metrics =
        run("{resolution: 32, fill: solid, fill_rule: surface_voxels, compare: true, box_min: [0, "
            "0, 0], box_max: [32, 32, 32]}",
            plate);
    EXPECT_EQ(metrics.at("voxels"), 2200.0);
    EXPECT_EQ(metrics.at("added_solid_voxels"), 2200.0);
    EXPECT_EQ(metrics.at("stray_voxels"), 2100.0);  // without the plate's own voxels
}

TEST_F(VoxelizationTest, DigestTellsGridsApart) {
    const auto first = run("{resolution: 32}", sphere_);
    EXPECT_EQ(run("{resolution: 32}", sphere_).at("digest"), first.at("digest"));
    EXPECT_EQ(run("{resolution: 32, method: direct}", sphere_).at("digest"), first.at("digest"));
    const double rasterized = run("{resolution: 32, method: worksheet}", sphere_).at("digest");
    for (const char* same : {"method: worksheet, addressing: tables",
                             "method: direct, rule: rasterized", "method: slices"}) {
        EXPECT_EQ(run(fmt::format("{{resolution: 32, {}}}", same), sphere_).at("digest"),
                  rasterized);
    }
    EXPECT_NE(run("{resolution: 32, fill: solid}", sphere_).at("digest"), first.at("digest"));
}

}  // namespace
}  // namespace gfxrepro::voxelization
