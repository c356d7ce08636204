// Reflections through clusters against mirrored scenes and rays whose hits are known.
#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "engine/core/random.h"
#include "tests/techniques/clustered_reflections/tracer_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::clustered_reflections {
namespace {

using reflections::ReflectiveScene;
using rooms::Surface;
namespace shapes = voxelization::shapes;

struct ClusteredTracerTest : TracerTest {
    /// A room whose wall at −z is a mirror.
    static scene::Scene mirrorRoom() {
        scene::Scene scene = furnishedRoomBefore();
        rooms::add(scene, mirrorWall(), glm::vec3(0.9F), Surface::Mirror);
        return scene;
    }
    static scene::Mesh mirrorWall() {
        return rooms::rectangle({0.0F, 0.0F, -2.0F}, {2.0F, 0.0F, 0.0F}, {0.0F, 1.5F, 0.0F});
    }
    static scene::Scene sphereRoom(float radius = 0.7F) {
        scene::Scene scene = rooms::room();
        rooms::add(scene, shapes::sphere(glm::vec3(0.1F, -0.2F, -0.3F), radius, 5), glm::vec3(0.9F),
                   Surface::Mirror);
        return scene;
    }
    static scene::Camera frontCamera() {
        return reflections::camera({0.4F, 0.2F, 1.8F}, {0.0F, -0.3F, -1.0F});
    }
    /// Several reflectors of all kinds, touching each other.
    static scene::Scene fullRoom() {
        scene::Scene scene = mirrorRoom();
        rooms::add(scene, shapes::sphere({0.3F, -0.6F, -0.9F}, 0.4F, 4), glm::vec3(0.8F),
                   Surface::Mirror);
        rooms::add(scene, rooms::bowl({-0.6F, -0.2F, -0.1F}, 0.4F), glm::vec3(0.7F, 0.2F, 0.1F),
                   Surface::Mirror);
        rooms::add(scene, shapes::cube({-0.9F, -1.5F, 0.6F}, {-0.6F, -1.1F, 0.9F}), glm::vec3(0.8F),
                   Surface::Mirror);
        return scene;
    }
    /// The truth of a planar mirror in the wall at −z: what lies behind it, drawn as if it were
    /// there.
    static reflections::HostGBuffer seenBehind(const scene::Scene& scene, int sizePx = 128) {
        const ReflectiveScene mirrored(rooms::mirroredInZ(scene, -2.0F));
        reflections::GBuffer truth(kit::viewOf(frontCamera(), glm::ivec2(sizePx)));
        reflections::GBufferRenderer(shaders(), mirrored)
            .render(reflections::GpuObjects(mirrored), truth);
        return readGBuffer(truth);
    }
    static scene::Scene furnishedRoomBefore() {
        scene::Scene scene = rooms::room(false);
        rooms::addFurniture(scene);
        return scene;
    }
    /// A colour that nothing has but the reflector in question.
    static bool isMagenta(const glm::vec3& c, float least) {
        return c.y < 0.02F && c.x > least && c.z > least;
    }
    static constexpr OwnReflector kOwnReflectors[] = {OwnReflector::ConcaveDiffuse,
                                                      OwnReflector::WholeScene};
    static constexpr ImageDrawing kDrawings[] = {ImageDrawing::OneByOne, ImageDrawing::Visible};
};

TEST_F(ClusteredTracerTest, APlanarMirrorShowsTheMirroredScene) {
    const ReflectiveScene scene(mirrorRoom());
    constexpr int kSizePx = 160;
    const reflections::HostGBuffer expected = seenBehind(furnishedRoomBefore(), kSizePx);
    for (const ImageDrawing drawing : kDrawings) {
        const Traced traced =
            trace(scene, frontCamera(), {.camera = {.depthImageScale = 2.0F}, .drawing = drawing},
                  kSizePx);
        EXPECT_GT(traced.reflectiveCount(), 3000);
        EXPECT_EQ(traced.cameras.size(), 1U);
        EXPECT_GE(psnrDb(traced, [&](std::size_t i) { return expected.diffuse[i]; }), 40.0);
        // As it is shown, with the resolution of Sec. 4.4 and the mean of 2 × 2 samples a pixel.
        const Traced plain = trace(scene, frontCamera(), {.drawing = drawing}, kSizePx);
        EXPECT_GE(shownPsnrDb(plain, expected.diffuse), 38.0);
        // C8: no occlusion error, nothing takes the environment map.
        EXPECT_EQ(std::count(traced.environment.begin(), traced.environment.end(), 1), 0);
        int silhouettes = 0;
        traced.forEachReflective([&](glm::ivec2 pixel, std::size_t i) {
            const float seen =
                glm::distance(expected.positionWorld(pixel), expected.view.eyeWorld) -
                glm::distance(traced.gbuffer.positionWorld(pixel), expected.view.eyeWorld);
            // Silhouettes in a texel of the depth image may belong to either side.
            if (std::abs(traced.distanceM[i] - seen) > 0.02F) ++silhouettes;
        });
        EXPECT_LT(silhouettes, traced.reflectiveCount() / 50);
    }
}

// Rays meet triangles, not texels: a bar is as wide in images a quarter as fine, where a texel in
// the middle of which it is not seen shows what lies behind it.
TEST_F(ClusteredTracerTest, OutlinesAreSharperThanImagesOfTriangles) {
    scene::Scene source = rooms::room(false);
    for (const float x : {-0.9F, -0.2F, 0.5F}) {
        rooms::add(source, shapes::cube({x, -1.4F, 0.5F}, {x + 0.4F, 1.4F, 0.55F}),
                   {1.0F, 0.0F, 1.0F});
    }
    constexpr int kSizePx = 160;
    const reflections::HostGBuffer expected = seenBehind(source, kSizePx);
    rooms::add(source, mirrorWall(), glm::vec3(0.9F), Surface::Mirror);
    const Traced traced =
        trace(ReflectiveScene(source), frontCamera(),
              {.camera = {.depthImageScale = 0.25F}, .drawing = ImageDrawing::Visible}, kSizePx);
    int bars = 0, wrong = 0;
    traced.forEachReflective([&](glm::ivec2, std::size_t i) {
        const bool isBar = isMagenta(expected.diffuse[i], 0.05F);
        bars += isBar;
        wrong += isBar != isMagenta(traced.radiance[i], 0.05F);
    });
    EXPECT_GT(bars, 500);
    EXPECT_LT(wrong, bars / 15);
}

// A hundredth of the light: steps of linear colours in 10 bits are three levels there.
TEST_F(ClusteredTracerTest, APlanarMirrorShowsDarkColours) {
    scene::Scene dark = rooms::room(false);
    for (scene::Material& material : dark.materials) {
        material.baseColor = glm::vec4(0.01F * glm::vec3(material.baseColor), 1.0F);
    }
    const reflections::HostGBuffer expected = seenBehind(dark);
    rooms::add(dark, mirrorWall(), glm::vec3(0.9F), Surface::Mirror);
    const ReflectiveScene scene(dark);
    for (const ImageDrawing drawing : kDrawings) {
        const Traced traced = trace(scene, frontCamera(), {.drawing = drawing});
        double sum = 0.0;
        const int count = traced.forEachReflective([&](glm::ivec2, std::size_t i) {
            for (int c = 0; c < 3; ++c) {
                sum += 255.0 * std::abs(image::srgbOf(traced.radiance[i][c]) -
                                        image::srgbOf(expected.diffuse[i][c]));
            }
        });
        EXPECT_LE(sum / (3.0 * count), 0.2);
    }
}

/// The wall at +z and the floor have tiles with grain in them, a texel wide: much finer than
/// samples are apart.
void addPattern(scene::Scene& scene) {
    Random random(5);
    scene.textures = {reflections::imageOf([&](int x, int y) {
        const std::uint32_t tile = (x / 64 + y / 64) % 2 == 0 ? 120 : 60;
        return glm::u8vec3{tile + random.index(136), tile + random.index(136),
                           tile + random.index(136)};
    })};
    for (scene::Mesh mesh :
         {rooms::rectangle({0.0F, 0.0F, 1.99F}, {-2.0F, 0.0F, 0.0F}, {0.0F, 1.5F, 0.0F}),
          rooms::rectangle({0.0F, -1.49F, 0.0F}, {2.0F, 0.0F, 0.0F}, {0.0F, 0.0F, -2.0F})}) {
        mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
        rooms::add(scene, mesh, glm::vec3(1.0F));
        scene.materials.back().baseColorTexture = 0;
    }
}

TEST_F(ClusteredTracerTest, APlanarMirrorIsShownAsRaysShowItAtThePrintedSize) {
    constexpr int kSizePx = 1024;  // samples, 2 × 2 of which make a pixel
    const ReflectiveScene scene(mirrorRoom());
    const reflections::HostGBuffer expected = seenBehind(furnishedRoomBefore(), kSizePx);
    for (const ImageDrawing drawing : {ImageDrawing::OneByOne, ImageDrawing::Visible}) {
        const Traced traced = trace(scene, frontCamera(), {.drawing = drawing}, kSizePx);
        EXPECT_GE(shownPsnrDb(traced, expected.diffuse), 45.0);
    }
}

TEST_F(ClusteredTracerTest, APlanarMirrorShowsTexturesAsTheyAreSeen) {
    scene::Scene source = rooms::room(false);
    addPattern(source);
    const reflections::HostGBuffer expected = seenBehind(source);
    rooms::add(source, mirrorWall(), glm::vec3(0.9F), Surface::Mirror);

    const auto shownPsnr = [&](reflections::TextureFilter filter, ImageDrawing drawing) {
        const ReflectiveScene scene(source, {}, filter);
        return shownPsnrDb(trace(scene, frontCamera(), {.drawing = drawing}), expected.diffuse);
    };
    for (const ImageDrawing drawing : kDrawings) {
        const double filtered = shownPsnr(reflections::TextureFilter::Footprint, drawing);
        // Bilinear fetches soften images of colours where tiles meet; a device's own choice of
        // levels costs up to 2 dB.
        EXPECT_GE(filtered, drawing == ImageDrawing::Visible ? 45.0 : 41.0);
        const double finest = shownPsnr(reflections::TextureFilter::FinestLevel, drawing);
        EXPECT_LT(finest, 35.0);
    }
}

TEST_F(ClusteredTracerTest, ASphereShowsTheRoomThatItsRaysMeet) {
    const ReflectiveScene scene(sphereRoom());
    for (const ImageDrawing drawing : kDrawings) {
        const Traced traced = trace(scene, frontCamera(), {.drawing = drawing}, 256);
        EXPECT_GT(traced.cameras.size(), 20U);
        int wrong = 0, wrongDistance = 0, environment = 0;
        const int count = traced.forEachReflective([&](glm::ivec2 pixel, std::size_t i) {
            if (traced.environment[i] != 0) {
                ++environment;
                return;
            }
            const glm::vec3 from = traced.gbuffer.positionWorld(pixel);
            const reflections::WallHit hit =
                reflections::wallHit(rooms::kWalls, from, traced.gbuffer.mirrorDirection(pixel));
            const glm::vec3 expected =
                reflections::shadeDiffuse(scene.lights(), glm::vec3(hit.position), hit.normal,
                                          reflections::kWallColours[hit.side], glm::vec3(0.0F));
            wrong += reflections::largestDifference(traced.radiance[i], expected) > 0.02F;
            wrongDistance += std::abs(traced.distanceM[i] - hit.distanceM) > 0.05 * hit.distanceM;
        });
        // Edges between walls are as sharp as the clusters' images, some dozen texels wide; rays
        // that graze the sphere leave their image at its side.
        EXPECT_LT(wrong, count * 6 / 100);
        EXPECT_LT(wrongDistance, count / 100);
        EXPECT_LT(environment, count * 6 / 100);
    }
}

TEST_F(ClusteredTracerTest, TheHierarchicalMarchGivesTheLinearReflections) {
    const ReflectiveScene scene(fullRoom());
    for (const ImageDrawing drawing : kDrawings) {
        const Traced linear = trace(scene, frontCamera(), {.drawing = drawing});
        const Traced hierarchical =
            trace(scene, frontCamera(), {.drawing = drawing, .march = March::Hierarchical});
        linear.forEachReflective([&](glm::ivec2, std::size_t i) {
            EXPECT_EQ(linear.radiance[i], hierarchical.radiance[i]) << i;
            EXPECT_EQ(linear.distanceM[i], hierarchical.distanceM[i]) << i;
        });
    }
}

TEST_F(ClusteredTracerTest, ImagesThatDoNotFitInTheAtlasAreScaledDown) {
    const ReflectiveScene scene(fullRoom());
    const Traced plain = trace(scene, frontCamera(), {.drawing = ImageDrawing::Visible});
    const Traced scaled =
        trace(scene, frontCamera(),
              {.camera = {.depthImageScale = 16.0F}, .drawing = ImageDrawing::Visible});
    EXPECT_GT(scaled.drawn.texels, plain.drawn.texels);
    EXPECT_LT(scaled.drawn.texels, 200 * plain.drawn.texels);  // of 16 * 16 times
    EXPECT_TRUE(scaled.isFinite());
    EXPECT_GE(psnrDb(scaled, [&](std::size_t i) { return plain.radiance[i]; }), 20.0);
}

TEST_F(ClusteredTracerTest, NothingIsReflectedWithoutReflectorsInView) {
    const ReflectiveScene scene(fullRoom());
    for (const ImageDrawing drawing : kDrawings) {
        const Traced traced =
            trace(scene, reflections::camera({0.0F, 0.0F, 1.5F}, {0.0F, 0.0F, 5.0F}),
                  {.drawing = drawing});
        EXPECT_EQ(traced.reflectiveCount(), 0);
        EXPECT_TRUE(traced.cameras.empty());
    }
}

TEST_F(ClusteredTracerTest, DegenerateClustersAreFinite) {
    const struct {
        const char* name;
        scene::Scene scene;
        scene::Camera camera;
        int sizePx;
    } cases[] = {
        {"a ball of about a pixel", sphereRoom(0.02F),
         reflections::camera({0.1F, -0.2F, 1.9F}, {0.1F, -0.2F, -0.3F}), 33},
        {"a mirror seen edge-on", mirrorRoom(),
         reflections::camera({0.0F, 0.0F, -1.999F}, {1.9F, 0.1F, -1.9995F}), 64},
        {"an eye in the mirror", mirrorRoom(),
         reflections::camera({0.0F, 0.0F, -2.0F}, {1.0F, 0.1F, -1.9F}), 64},
        {"an eye inside of a ball", sphereRoom(),
         reflections::camera({0.1F, -0.2F, -0.3F}, {0.0F, 0.0F, -1.0F}), 64},
        {"one pixel", sphereRoom(), frontCamera(), 1},
    };
    for (const auto& one : cases) {
        const ReflectiveScene scene(one.scene);
        for (const ImageDrawing drawing : kDrawings) {
            for (const March march : {March::Linear, March::Hierarchical}) {
                const Traced traced = trace(
                    scene, one.camera,
                    {.drawing = drawing, .march = march, .ownReflector = OwnReflector::WholeScene},
                    one.sizePx);
                EXPECT_TRUE(traced.isFinite()) << one.name;
            }
        }
    }
}

TEST_F(ClusteredTracerTest, ABowlSeesItselfEitherWay) {
    constexpr glm::vec3 kCentre(0.0F, -0.4F, 0.0F);
    constexpr float kRadius = 0.8F;
    scene::Scene bowlRoom = rooms::room();
    // The bowl's own colour is in nothing else.
    rooms::add(bowlRoom, rooms::bowl(kCentre, kRadius), {1.0F, 0.0F, 1.0F}, Surface::Mirror);
    const ReflectiveScene scene(bowlRoom);
    const scene::Camera camera = reflections::camera({0.3F, 1.2F, 1.2F}, {0.0F, -0.6F, 0.0F});
    for (const ImageDrawing drawing : kDrawings) {
        for (const OwnReflector ownReflector : kOwnReflectors) {
            const Traced traced =
                trace(scene, camera, {.drawing = drawing, .ownReflector = ownReflector});
            int marched = 0, own = 0, wrong = 0;
            traced.forEachReflective([&](glm::ivec2 pixel, std::size_t i) {
                if (traced.environment[i] != 0) return;
                const glm::vec3 from = traced.gbuffer.positionWorld(pixel) - kCentre;
                const glm::vec3 direction = traced.gbuffer.mirrorDirection(pixel);
                // Where the ray meets the sphere again: on the bowl or above its rim.
                const glm::vec3 again = from - 2.0F * glm::dot(from, direction) * direction;
                const bool isOwn = again.y < -kRadius * std::cos(0.45F * glm::pi<float>());
                ++marched;
                own += isOwn;
                wrong += isOwn != isMagenta(traced.radiance[i], 0.2F);
            });
            EXPECT_GT(own, marched / 5);
            EXPECT_LT(own, marched * 4 / 5);
            EXPECT_LT(wrong, marched / 10);
        }
    }
}

TEST_F(ClusteredTracerTest, InAndOutsideOfATubeShareNoClusterAsPartsOfIt) {
    // Where its inside is seen, far away, normals point as those of its outside do that is near.
    scene::Mesh tube;
    const auto addWall = [&](float radius, float side) {
        constexpr unsigned kAround = 64;
        const auto first = static_cast<unsigned>(tube.positions.size());
        for (unsigned i = 0; i <= kAround; ++i) {
            const float angle = glm::two_pi<float>() * static_cast<float>(i) / kAround;
            const glm::vec3 outwards(std::cos(angle), 0.0F, std::sin(angle));
            for (const float y : {-0.9F, -0.3F}) {
                tube.positions.push_back(radius * outwards + glm::vec3(0.0F, y, 0.0F));
                tube.normals.push_back(side * outwards);
            }
        }
        for (unsigned a = first; a < first + 2 * kAround; a += 2) {
            tube.triangles.emplace_back(a, a + 1, a + 3);
            tube.triangles.emplace_back(a, a + 3, a + 2);
        }
    };
    addWall(0.8F, 1.0F);
    addWall(0.76F, -1.0F);
    scene::Scene tubeRoom = rooms::room();
    rooms::add(tubeRoom, tube, glm::vec3(1.0F), Surface::Mirror);
    const scene::Camera camera = reflections::camera({0.0F, 0.3F, 1.8F}, {0.0F, -0.6F, 0.0F});
    // Of the samples, those whose cluster is taken to bend to the other side.
    const auto wrongShare = [&](bool splitsParts) {
        const ReflectiveScene scene(tubeRoom, {.splitsParts = splitsParts});
        const Traced traced = trace(scene, camera, {});
        int inside = 0, wrong = 0;
        const int all = traced.forEachReflective([&](glm::ivec2 pixel, std::size_t i) {
            const ClusterCamera& cluster = traced.cameras[traced.clusterOfSample[i] - 1U];
            const glm::vec3 position = traced.gbuffer.positionWorld(pixel);
            const bool isInside = glm::length(glm::vec2(position.x, position.z)) < 0.78F;
            inside += isInside;
            wrong += isInside != ((cluster.flags & kShowsOwn) != 0);
        });
        EXPECT_GT(inside, all / 5);
        EXPECT_LT(inside, all * 4 / 5);
        return static_cast<double>(wrong) / all;
    };
    EXPECT_LT(wrongShare(true), 0.02);  // a cluster of a sample or a facet bends to no side
    EXPECT_GT(wrongShare(false), 0.05);
}

TEST_F(ClusteredTracerTest, PartsOfOneObjectThatDoNotTouchReflectEachOther) {
    scene::Scene potRoom = rooms::room();
    // Their colour is in nothing else; they are convex, and show nothing of themselves.
    rooms::add(potRoom, rooms::potAndKnob(), {1.0F, 0.0F, 1.0F}, Surface::Mirror);
    const ReflectiveScene scene(potRoom, {.splitsParts = true});
    const scene::Camera camera = reflections::camera({0.4F, 0.6F, 1.4F}, {0.0F, -0.1F, 0.0F});
    const auto meets = [](const rooms::Ball& ball, const glm::vec3& from, const glm::vec3& to) {
        const float along = glm::dot(ball.centre - from, to);
        return along > 0.0F && glm::distance(from + along * to, ball.centre) < ball.radius;
    };
    for (const ImageDrawing drawing : kDrawings) {
        const Traced traced = trace(scene, camera, {.drawing = drawing});
        double reflecting = 0.0, right = 0.0;  // the other one
        traced.forEachReflective([&](glm::ivec2 pixel, std::size_t i) {
            const glm::vec3 from = traced.gbuffer.positionWorld(pixel);
            const bool isOnKnob = glm::distance(from, rooms::kKnob.centre) < 0.25F;
            const bool isOther = meets(isOnKnob ? rooms::kPot : rooms::kKnob, from,
                                       traced.gbuffer.mirrorDirection(pixel));
            reflecting += isOther;
            right += isOther && isMagenta(traced.radiance[i], 0.1F);
        });
        EXPECT_GT(reflecting, 150.0);
        EXPECT_GT(right, 0.6 * reflecting);  // its outline is a large part of so small a thing
    }
}

TEST_F(ClusteredTracerTest, ABallHidesWhatItsRaysMeetWhereItsBackIsDrawn) {
    scene::Scene ballRoom = rooms::room();
    // The ball's own colour is in nothing else, and none of its rays meets it.
    rooms::add(ballRoom, shapes::sphere({0.0F, -0.4F, 0.0F}, 0.5F, 5), {1.0F, 0.0F, 1.0F},
               Surface::Mirror);
    const ReflectiveScene scene(ballRoom);
    const scene::Camera camera = reflections::camera({0.3F, 0.2F, 1.4F}, {0.0F, -0.4F, 0.0F});
    for (const ImageDrawing drawing : kDrawings) {
        const auto seenShare = [&](bool showsOwnBack) {
            const Traced traced = trace(scene, camera,
                                        {.drawing = drawing,
                                         .ownReflector = OwnReflector::WholeScene,
                                         .showsOwnBack = showsOwnBack});
            double seen = 0.0;
            const int marched = traced.forEachReflective([&](glm::ivec2, std::size_t i) {
                seen += isMagenta(traced.radiance[i], 0.2F) ? 1.0 : 0.0;
            });
            return seen / marched;
        };
        EXPECT_LT(seenShare(false), 0.06) << "at the edge";
        EXPECT_GT(seenShare(true), 0.1);
    }
}

TEST_F(ClusteredTracerTest, GlossyReflectionsFadeToTheDiffuseColour) {
    ReflectiveScene scene(sphereRoom());
    scene.setGlossiness(0.9F);  // the far plane is at 1e-4 diagonals: no room
    for (const ImageDrawing drawing : kDrawings) {
        const Traced rough = trace(scene, frontCamera(), {.drawing = drawing}, 64);
        rough.forEachReflective([&](glm::ivec2, std::size_t i) {
            EXPECT_LT(glm::distance(rough.radiance[i], rough.gbuffer.diffuse[i]), 2e-3F) << i;
        });
    }
}

TEST_F(ClusteredTracerTest, PassesAreNamedAsTable14) {
    const ReflectiveScene scene(sphereRoom());
    for (const ImageDrawing drawing : kDrawings) {
        std::vector<std::string> names;
        for (const gl::PassTime& pass : trace(scene, frontCamera(), {.drawing = drawing}).passes) {
            names.push_back(pass.pass);
        }
        EXPECT_EQ(names, (std::vector<std::string>{"first_pass_and_clustering", "cluster_cameras",
                                                   "depth_images", "intersection"}));
    }
}

TEST_F(ClusteredTracerTest, TheHostWaitsForCamerasOneByOneAndElseForNothing) {
    const ReflectiveScene scene(fullRoom());
    for (const ImageDrawing drawing : kDrawings) {
        // How many clusters there are, their cameras, their samples.
        const Traced traced = trace(scene, frontCamera(), {.drawing = drawing});
        EXPECT_EQ(std::ranges::count(traced.calls, reflections::GlCall::Wait),
                  drawing == ImageDrawing::OneByOne ? 3 : 0);
    }
}

TEST_F(ClusteredTracerTest, OneByOneClustersShareBarriersAndSetUp) {
    const ReflectiveScene scene(fullRoom());
    const auto traced = [&](float gain) {
        return trace(scene, frontCamera(), {.bins = {.gain = gain}});
    };
    const Traced few = traced(1e-6F), many = traced(1.0F);
    const auto more = static_cast<std::ptrdiff_t>(many.cameras.size() - few.cameras.size());
    EXPECT_GT(more, 10);
    const auto count = [](const Traced& frame, reflections::GlCall call) {
        return std::ranges::count(frame.calls, call);
    };
    EXPECT_EQ(count(many, reflections::GlCall::Barrier), count(few, reflections::GlCall::Barrier));
    EXPECT_GT(count(few, reflections::GlCall::SetView), 0);
    // What a frame shares is told once; an image is told its own camera, which is no other's.
    EXPECT_LE(count(many, reflections::GlCall::SetView) - count(few, reflections::GlCall::SetView),
              more);
}

TEST_F(ClusteredTracerTest, AFrameChangesNoTextureParameter) {
    const ReflectiveScene scene(fullRoom());
    for (const ImageDrawing drawing : kDrawings) {
        const Traced traced =
            trace(scene, frontCamera(), {.drawing = drawing, .march = March::Hierarchical});
        EXPECT_EQ(std::ranges::count(traced.calls, reflections::GlCall::Parameter), 0);
    }
}

// [xie2017] Sec. 4.7.1: 512² output, 2 × 2 samples a pixel.
TEST_F(ClusteredTracerTest, AFrameHoldsNoMoreThanPrinted) {
    const ReflectiveScene scene(fullRoom());
    for (const March march : {March::Linear, March::Hierarchical}) {
        const Traced traced = trace(scene, frontCamera(), {.march = march}, 1024);
        EXPECT_LE(traced.sizeBytes, 87'000'000U);
    }
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
