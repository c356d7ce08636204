// Proxy planes against a ray march on the CPU through the same grid.
#include "techniques/voxelization/volume_renderer.h"

#include <cmath>

#include "engine/core/random.h"
#include "techniques/voxelization/phantom.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"
#include "tests/techniques/voxelization/voxelizer_fixture.h"

namespace gfxrepro::voxelization {
namespace {

constexpr glm::ivec2 kSizePx{96, 64};
const scene::Box kBox{glm::vec3(-2.0F, 1.0F, 3.0F), glm::vec3(2.0F, 5.0F, 7.0F)};

std::vector<std::uint32_t> hitsOf(const VolumeRenderer& renderer) {
    return renderer.hits().read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
}

/// A ray in voxels.
struct Ray {
    glm::dvec3 origin, direction;
};

Ray rayThrough(const scene::Camera& camera, const DenseGrid& grid, int x, int y) {
    const glm::dvec3 backwards = glm::normalize(glm::dvec3(camera.position - camera.target));
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(camera.up), backwards));
    const glm::dvec3 up = glm::cross(backwards, right);
    const double halfHeight = std::tan(0.5 * static_cast<double>(camera.verticalFovRad));
    const double aspect = static_cast<double>(kSizePx.x) / kSizePx.y;
    const double u = (2.0 * (x + 0.5) / kSizePx.x - 1.0) * halfHeight * aspect;
    const double v = (2.0 * (y + 0.5) / kSizePx.y - 1.0) * halfHeight;
    const double scale = grid.shape().longest() / static_cast<double>(kBox.size().x);
    return {glm::dvec3(camera.position - kBox.min) * scale, -backwards + u * right + v * up};
}

/// Calls visit(voxel, axis of the face entered, length in the voxel) along the ray until it returns
/// false. Amanatides and Woo 1987, in double precision.
template <class Visit>
void march(const Ray& ray, const GridShape& shape, Visit&& visit) {
    double enter = 0.0;
    double leave = 1e30;
    int face = 0;
    for (int axis = 0; axis < 3; ++axis) {
        double a = -ray.origin[axis] / ray.direction[axis];
        double b = (shape.size[axis] - ray.origin[axis]) / ray.direction[axis];
        if (a > b) std::swap(a, b);
        if (a > enter) {
            enter = a;
            face = axis;
        }
        leave = std::min(leave, b);
    }
    if (enter >= leave) return;
    const glm::dvec3 start = ray.origin + (enter + 1e-9) * ray.direction;
    glm::ivec3 voxel(glm::floor(start));
    double t = enter;
    while (t < leave) {
        double next = 1e30;
        int nextAxis = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double border = voxel[axis] + (ray.direction[axis] > 0 ? 1 : 0);
            const double crossing = (border - ray.origin[axis]) / ray.direction[axis];
            if (crossing < next) {
                next = crossing;
                nextAxis = axis;
            }
        }
        if (!visit(voxel, face, (next - t) * glm::length(ray.direction))) return;
        t = next;
        face = nextAxis;
        voxel[nextAxis] += ray.direction[nextAxis] > 0 ? 1 : -1;
        if (!shape.has(voxel)) return;
    }
}

std::uint32_t firstHit(const DenseGrid& grid, const Ray& ray) {
    std::uint32_t hit = 0;
    march(ray, grid.shape(), [&](const glm::ivec3& voxel, int face, double) {
        if (!grid.isFull(voxel)) return true;
        const glm::uvec3 v(voxel);
        hit = v.x | v.y << 10 | v.z << 20 | static_cast<std::uint32_t>(face + 1) << 30;
        return false;
    });
    return hit;
}

// Of which kBox holds the first.
const GridShape kDrawnShapes[] = {32, GridShape({32, 6, 20}), GridShape({9, 32, 7})};
scene::Box drawnBoxOf(const GridShape& shape) {
    return {kBox.min, kBox.min + glm::vec3(shape.size) / 8.0F};
}

/// A 6-separating shell of a sphere or ellipsoid, one voxel thick, and a few loose voxels.
DenseGrid shell(const WorksheetLayout& layout) {
    DenseGrid grid(layout);
    const glm::vec3 half = 0.5F * glm::vec3(layout.shape().size);
    const auto isInside = [&](const glm::ivec3& v) {
        return glm::length((glm::vec3(v) + 0.5F - half) / half) < 0.9F;
    };
    forEachVoxel(layout.shape(), [&](const glm::ivec3& v) {
        bool isBorder = false;
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 step(0);
            step[axis] = 1;
            isBorder = isBorder || !isInside(v + step) || !isInside(v - step);
        }
        if (isInside(v) && isBorder) grid.set(v, 1);
    });
    Random random(3);
    const glm::uvec3 size(layout.shape().size);
    for (int i = 0; i < layout.shape().longest(); ++i) {
        grid.set(glm::ivec3{random.index(size.x), random.index(size.y), random.index(size.z)}, 1);
    }
    return grid;
}

struct View {
    const char* name;
    double azimuthDeg, elevationDeg;
};
constexpr View kViews[] = {{"Front", 10, 5},     {"Back", 190, -10}, {"Right", 80, 10},
                           {"Left", -85, -10},   {"Above", 30, 80},  {"Below", 30, -75},
                           {"Diagonal", 45, 35}, {"Straight", 0, 0}, {"Top", 0, 90}};

class VolumeRendering : public GlTest, public testing::WithParamInterface<View> {};
INSTANTIATE_TEST_SUITE_P(Views, VolumeRendering, testing::ValuesIn(kViews),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(VolumeRendering, OpaqueShowsTheVoxelsThatARayMeetsFirst) {
    for (const GridShape& shape : kDrawnShapes) {
        const int voxelBits = shape.size.y < 32 ? 8 : shape.size.x < 32 ? 32 : 1;
        const WorksheetLayout layout(shape, voxelBits);
        const DenseGrid grid = shell(layout);
        const scene::Box box = drawnBoxOf(shape);
        const scene::Camera camera =
            orbitCamera(box, GetParam().azimuthDeg, GetParam().elevationDeg, 1.5F);
        VolumeRenderer renderer(shaders(), layout, box, camera, kSizePx, {});
        renderer.draw(uploaded(grid), nullptr, nullptr);
        const std::vector<std::uint32_t> hits = hitsOf(renderer);
        int different = 0;
        int full = 0;
        for (const auto [y, x] : test::grid(kSizePx.y, kSizePx.x)) {
            const std::uint32_t expected = firstHit(grid, rayThrough(camera, grid, x, y));
            if (expected != 0) ++full;
            if (hits[static_cast<std::size_t>(y * kSizePx.x + x)] != expected) ++different;
        }
        EXPECT_GT(full, kSizePx.x * kSizePx.y / 20) << shape.text();
        // Rays along an edge between voxels, where single and double precision part.
        EXPECT_LE(different, kSizePx.x * kSizePx.y / 1000) << shape.text();
    }
}

/// A view of one's own: beside, over a corner, past the grid's middle, and along a plane's edge.
TEST_F(GlTest, OpaqueShowsWhatAnEyeOutsideTheGridMeetsFirst) {
    const WorksheetLayout layout(32, 8);
    const DenseGrid grid = shell(layout);
    for (const char* view : {"-6 3 5 > 0 3 5", "3 6 8 > 0 3 5", "2.5 5.5 1 > 2 3 12",
                             "-2.1 4.9 2.9 > 2 1 7", "0 6 5 > 0 3 5"}) {
        const scene::Camera camera = cameraOf(view, {}, kBox, kBox, 1.5F);
        VolumeRenderer renderer(shaders(), layout, kBox, camera, kSizePx, {});
        renderer.draw(uploaded(grid), nullptr, nullptr);
        const std::vector<std::uint32_t> hits = hitsOf(renderer);
        int different = 0, full = 0;
        for (const auto [y, x] : test::grid(kSizePx.y, kSizePx.x)) {
            const std::uint32_t expected = firstHit(grid, rayThrough(camera, grid, x, y));
            if (expected != 0) ++full;
            if (hits[static_cast<std::size_t>(y * kSizePx.x + x)] != expected) ++different;
        }
        EXPECT_GT(full, kSizePx.x * kSizePx.y / 20) << view;
        EXPECT_LE(different, kSizePx.x * kSizePx.y / 1000) << view;
    }
}

TEST_P(VolumeRendering, TransparencyIsTheLengthOfTheRayInFullVoxels) {
    constexpr float kOpacity = 0.2F;
    const WorksheetLayout layout(32, 8);
    const DenseGrid grid = shell(layout);
    const scene::Camera camera =
        orbitCamera(kBox, GetParam().azimuthDeg, GetParam().elevationDeg, 1.5F);
    const DrawSettings settings{.mode = DrawMode::Transparent, .opacity = kOpacity};
    VolumeRenderer renderer(shaders(), layout, kBox, camera, kSizePx, settings);
    renderer.draw(uploaded(grid), nullptr, nullptr);
    const image::ImageF image = renderer.readImage();
    int wrong = 0;
    for (int y = 0; y < kSizePx.y; ++y) {
        for (int x = 0; x < kSizePx.x; ++x) {
            double length = 0;
            march(rayThrough(camera, grid, x, y), 32,
                  [&](const glm::ivec3& voxel, int, double way) {
                      if (grid.isFull(voxel)) length += way;
                      return true;
                  });
            const double background = std::pow(1.0 - static_cast<double>(kOpacity), length);
            const auto green = static_cast<double>(image.at(x, kSizePx.y - 1 - y, 1));
            // The white background's share is known; lit voxels are between the ambient share and
            // the brightest highlight of 0.56.
            const double lowest = background + (1 - background) * 0.22 * 0.56;
            const double highest = background + (1 - background) * (0.56 + 0.06);
            if (green < lowest - 0.01 || green > highest + 0.01) ++wrong;
        }
    }
    EXPECT_LE(wrong, kSizePx.x * kSizePx.y / 1000);
}

// [zju2005] Sec. 2.3.2 (1). To the bit.
TEST_F(GlTest, LookUpsDrawTheSamePicture) {
    const scene::Camera camera = orbitCamera(kBox, 45, 35, 1.5F);
    for (const int voxelBits : {1, 8, 32}) {
        const WorksheetLayout layout(32, voxelBits);
        const gl::Texture sheets = uploaded(shell(layout));
        for (const DrawMode mode : {DrawMode::Opaque, DrawMode::Transparent}) {
            DrawSettings settings{.mode = mode, .opacity = 0.5F};
            const auto drawn = [&] {
                VolumeRenderer renderer(shaders(), layout, kBox, camera, kSizePx, settings);
                renderer.draw(sheets, nullptr, nullptr);
                return renderer.readImage();
            };
            const image::ImageF byInstructions = drawn();
            settings.looksUpBits = true;
            EXPECT_TRUE(drawn() == byInstructions) << voxelBits << " bits";
            EXPECT_LT(byInstructions.at(kSizePx.x / 2, kSizePx.y / 2, 1),
                      0.9F);  // not the background
        }
    }
}

TEST_F(GlTest, CutVoxelsAreNotDrawn) {
    const WorksheetLayout layout(32, 1);
    DenseGrid grid(layout);
    forEachVoxel(32, [&](const glm::ivec3& voxel) { grid.set(voxel, 1); });
    const DrawSettings settings{.cut = scene::Box{glm::vec3(0.0F, 0.0F, 0.5F), glm::vec3(1.0F)}};
    const scene::Camera camera = orbitCamera(kBox, 10, 5, 1.5F);
    VolumeRenderer renderer(shaders(), layout, kBox, camera, kSizePx, settings);
    renderer.draw(uploaded(grid), nullptr, nullptr);
    const std::uint32_t centre =
        hitsOf(renderer)[static_cast<std::size_t>(kSizePx.y / 2 * kSizePx.x + kSizePx.x / 2)];
    EXPECT_EQ(centre >> 20 & 1023U, 15U);  // the first layer behind the cut
    EXPECT_EQ(centre >> 30, 3U);           // entered across z
}

TEST_F(GlTest, CommonVoxelsOfTwoModelsAreRed) {
    const WorksheetLayout layout(32, 8);
    DenseGrid first(layout);
    DenseGrid second(layout);
    for (const auto [y, x] : test::grid(32, 32)) {
        if (x < 20) first.set({x, y, 16}, 1);
        if (x >= 12) second.set({x, y, 16}, 1);
    }
    // Blended, too, they are opaque.
    for (const DrawMode mode : {DrawMode::Opaque, DrawMode::Transparent}) {
        const DrawSettings settings{.mode = mode, .hasSecond = true};
        const scene::Camera camera = orbitCamera(kBox, 0, 0, 1.5F);
        VolumeRenderer renderer(shaders(), layout, kBox, camera, kSizePx, settings);
        const gl::Texture secondSheets = uploaded(second);
        renderer.draw(uploaded(first), &secondSheets, nullptr);
        const image::ImageF image = renderer.readImage();
        const auto isRed = [&](int x) {
            return image.at(x, 32, 0) > 5 * image.at(x, 32, 1) && image.at(x, 32, 0) > 0.3F;
        };
        EXPECT_TRUE(isRed(48));
        EXPECT_FALSE(isRed(28));
        EXPECT_FALSE(isRed(68));
        EXPECT_GT(image.at(28, 32, 0), image.at(28, 32, 2));  // beige
        EXPECT_LT(image.at(68, 32, 0), image.at(68, 32, 2));  // blue
    }
}

TEST(OrbitCamera, HoldsTheWholeBox) {
    for (double azimuth = -180; azimuth < 180; azimuth += 37) {
        for (double elevation = -90; elevation <= 90; elevation += 22.5) {
            const scene::Camera camera = orbitCamera(kBox, azimuth, elevation, 1.5F);
            const PlaneView view = planeViewOf(camera, kBox, 32, kSizePx);
            for (int corner = 0; corner < 8; ++corner) {
                const glm::vec4 clip =
                    view.clipFromVoxel *
                    glm::vec4(32 * (corner & 1), 32 * (corner >> 1 & 1), 32 * (corner >> 2), 1);
                const glm::vec3 ndc = glm::vec3(clip) / clip.w;
                EXPECT_LT(std::abs(ndc.x), 1.0F);
                EXPECT_LT(std::abs(ndc.y), 1.0F);
                EXPECT_LT(std::abs(ndc.z), 1.0F);
            }
        }
    }
}

TEST(CameraOfVoxels, IsAsAllTechniquesTakeIt) {
    scene::Scene scene;
    scene.cameras.resize(1);
    scene.cameras[0].name = "door";
    scene.cameras[0].position = {0.0F, 3.0F, 20.0F};
    scene.cameras[0].target = {0.0F, 3.0F, 5.0F};
    const auto from = [&](const std::string& view) {
        return cameraOf(view, scene, kBox, kBox, 1.5F).position;
    };
    const auto expectNear = [](const glm::vec3& a, const glm::vec3& b) {
        EXPECT_LT(glm::distance(a, b), 1e-4F);
    };
    expectNear(from(""), orbitCamera(kBox, 30, 17, 1.5F).position);
    expectNear(from("200 -40"), orbitCamera(kBox, 200, -40, 1.5F).position);
    expectNear(from("0 90"), orbitCamera(kBox, 0, 90, 1.5F).position);
    expectNear(from("door"), scene.cameras[0].position);
    expectNear(from("9 8 7 > 0 3 5"), {9.0F, 8.0F, 7.0F});
    EXPECT_EQ(errorText([&] { from("0 3 5 > 1 3 5"); }),
              "view '0 3 5 > 1 3 5': the eye lies within the grid, from -2 1 3 to 2 5 7; allowed: "
              "one outside of it");
    EXPECT_THAT(
        errorText([&] { from("window"); }),
        StartsWith("the scene has no path or camera 'window'; paths: none; cameras: 'door'"));
}

// As large as it fits, the eye outside of a grid that is longer than it needs; what is flat is seen
// from higher, unless asked otherwise.
TEST(CameraOfVoxels, FramesWhatIsThin) {
    const auto sees = [](const scene::Box& framed, const scene::Box& grid, const char* view) {
        const scene::Camera camera = cameraOf(view, {}, framed, grid, 1.5F);
        const PlaneView planes = planeViewOf(camera, grid, 32, kSizePx);  // asserts what is outside
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 at = (framed.corner(corner) - grid.min) / voxelSizeOf(grid, 32);
            const glm::vec4 clip = planes.clipFromVoxel * glm::vec4(at, 1.0F);
            EXPECT_LT(std::abs(clip.x), clip.w) << view;
            EXPECT_LT(std::abs(clip.y), clip.w) << view;
            EXPECT_LT(std::abs(clip.z), clip.w) << view;
        }
        return camera.position;
    };
    const scene::Box stick{{1.99F, 2.99F, 1.0F}, {2.01F, 3.01F, 5.0F}};
    const scene::Box cube{{-0.25F, 0.75F, 0.75F}, {4.25F, 5.25F, 5.25F}};
    EXPECT_GT(sees(stick, cube, "0 0").z, cube.max.z);
    EXPECT_GT(sees(stick, cube, "90 0").x, cube.max.x);
    const auto elevation = [](const glm::vec3& eye, const glm::vec3& centre) {
        return glm::degrees(std::asin(glm::normalize(eye - centre).y));
    };
    const scene::Box flat{{0.0F, 2.9F, 1.0F}, {4.0F, 3.1F, 5.0F}};
    EXPECT_NEAR(elevation(sees(flat, cube, ""), flat.centre()), 45.0F, 1e-3F);
    EXPECT_NEAR(elevation(sees(flat, cube, "30 17"), flat.centre()), 17.0F, 1e-3F);
    EXPECT_NEAR(elevation(sees(cube, cube, ""), cube.centre()), 17.0F, 1e-3F);
}

TEST(PhantomTest, TheHeadFillsItsBounds) {
    constexpr int n = 64;
    const std::vector<float> densities = headDensities(n, 1);
    scene::Box found;
    for (int i = 0; i < n * n * n; ++i) {
        if (densities[static_cast<std::size_t>(i)] < 0.05F) continue;
        found.add((glm::vec3(i % n, i / n % n, i / n / n) + 0.5F) / float{n});
    }
    const scene::Box bounds = headBounds({glm::vec3(0.0F), glm::vec3(1.0F)});
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(found.min[axis], bounds.min[axis], 0.025F) << axis;
        EXPECT_NEAR(found.max[axis], bounds.max[axis], 0.025F) << axis;
    }
}

TEST(HeadPhantom, HasSkinBoneAndBrainInThatOrder) {
    const std::vector<float> densities = headDensities(64, 1);
    const auto at = [&](int x, int y, int z) {
        return densities[static_cast<std::size_t>((z * 64 + y) * 64 + x)];
    };
    EXPECT_LT(at(1, 62, 1), 0.05F);             // air
    EXPECT_NEAR(at(40, 40, 30), 0.55F, 0.03F);  // brain
    float densest = 0.0F;                       // the skull, from the crown down
    for (int y = 63; y > 40; --y) densest = std::max(densest, at(32, y, 30));
    EXPECT_GT(densest, 0.7F);
    EXPECT_EQ(densities, headDensities(64, 1));
    EXPECT_NE(densities, headDensities(64, 2));
}

TEST(HeadPhantom, BoxHoldsTheBrainInTheSkull) {
    const scene::Box brain{glm::vec3(1, 2, 3), glm::vec3(2, 3, 4.5F)};
    const scene::Box head = headBoxAround(brain);
    EXPECT_FLOAT_EQ(head.size().x, head.size().y);
    const std::vector<float> densities = headDensities(64, 1);
    // The brain's widest points lie inside the bone.
    for (int axis = 0; axis < 3; ++axis) {
        for (float side : {-0.5F, 0.5F}) {
            glm::vec3 p = brain.centre();
            p[axis] += side * brain.size()[axis];
            const glm::ivec3 v((p - head.min) / head.size() * 64.0F);
            const float density = densities[static_cast<std::size_t>((v.z * 64 + v.y) * 64 + v.x)];
            EXPECT_GT(density, 0.40F);
            EXPECT_LT(density, 0.65F);
        }
    }
}

}  // namespace
}  // namespace gfxrepro::voxelization
