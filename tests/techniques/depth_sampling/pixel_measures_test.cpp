// Measures on the device against double loops on the CPU, and against answers known beforehand.
#include <algorithm>

#include "engine/core/files.h"
#include "engine/raycast/ray_tracer.h"
#include "scenes/shared/mesh_builder.h"
#include "techniques/depth_sampling/pixel_measures.h"
#include "techniques/depth_sampling/visibility.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/grid.h"
#include "tests/techniques/depth_sampling/host_images.h"
#include "tests/techniques/kit/write_depth_image.h"

namespace gfxrepro::depth_sampling {
namespace {

using kit::DepthFormat;
using kit::DepthImage;
using kit::HostDepthImage;
using kit::View;
using test::HostImages;

struct PixelMeasuresTest : test::GlTest {
    /// Copies of host images on the device.
    struct OnDevice {
        std::vector<DepthImage> images;
        std::vector<const DepthImage*> pointers;
        std::span<const DepthImage* const> span() const { return pointers; }
    };
    static OnDevice onDevice(HostImages hosts) {
        OnDevice all;
        for (const HostDepthImage& host : hosts) {
            all.images.emplace_back(host.view, DepthFormat::Float32);
            kit::writeDepthImage(host, all.images.back());
        }
        for (const DepthImage& image : all.images) all.pointers.push_back(&image);
        return all;
    }
    static OnDevice onDevice(const HostDepthImage& host) { return onDevice({&host, 1}); }

    static std::vector<std::uint32_t> read(const gl::Texture& marks) {
        return marks.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
    }
    /// Of the samples of `image`, those redundant with one of `others`, on the device.
    std::uint64_t redundantCount(const HostDepthImage& image, HostImages others) {
        const OnDevice one = onDevice(image);
        const OnDevice rest = onDevice(others);
        gl::Texture marks = measures.makeMarks(one.images[0]);
        measures.mark(one.images[0], marks, rest.span(), true, kSample, kRedundant);
        return measures.count(marks, kRedundant);
    }

    gl::ShaderLibrary programShaders{dataFolder("shaders")};
    PixelMeasures measures{programShaders};
};

/// A random scene, three views of different sizes, the images of all methods and output frames.
struct Experiment {
    std::vector<test::Triangle> triangles;
    std::vector<HostDepthImage> conventional, nonRedundant, outputs;

    explicit Experiment(unsigned seed) : triangles(test::randomTriangles(40, seed)) {
        const View views[] = {
            test::viewFrom({-1.2F, -0.7F, 3.0F}, {61, 53}),
            test::viewFrom({1.2F, -0.7F, 3.0F}, {49, 64}),
            // Within the scene: much of the others' samples is behind this eye.
            test::viewFrom({0.0F, 0.2F, 0.3F}, {37, 90}, {0.1F, 0.0F, -2.0F}),
        };
        for (const View& view : views) {
            conventional.push_back(test::castImage(view, triangles));
            nonRedundant.push_back(test::castImage(view, triangles, nonRedundant));
        }
        for (int i = 0; i < 5; ++i) {
            const float t = static_cast<float>(i) / 4.0F;
            outputs.push_back(test::castImage(
                test::viewFrom({2.4F * t - 1.2F, 0.6F * t - 0.5F, 3.0F}, {55 + i, 50}), triangles));
        }
    }
};

/// Expected marks of one image, with samples whose answer depends on rounding set apart.
struct Expected {
    const HostDepthImage& image;
    std::vector<std::uint32_t> marks, borderline;

    explicit Expected(const HostDepthImage& of)
        : image(of), marks(of.triangleId.size(), 0), borderline(of.triangleId.size(), 0) {
        for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = of.triangleId[i] != 0 ? 1 : 0;
    }
    void mark(HostImages others, bool isRedundant, std::uint32_t among, std::uint32_t bit) {
        for (const auto [y, x] : test::grid(image.view.sizePx.y, image.view.sizePx.x)) {
            const std::size_t i = image.indexOf({x, y});
            if ((marks[i] & 1) == 0) continue;
            // What hangs on an undecided mark is undecided, too.
            if (test::isBorderlineWithAny(image, {x, y}, others) || (borderline[i] & among) != 0) {
                borderline[i] |= bit;
            }
            if ((marks[i] & among) == among &&
                test::isRedundantWithAny(image, {x, y}, others) == isRedundant) {
                marks[i] |= bit;
            }
        }
    }
};

/// Marks equal sample by sample, but for the few that are borderline; then counts are those of the
/// device's marks.
void expectEqualMarks(const Expected& expected, const std::vector<std::uint32_t>& actual) {
    ASSERT_EQ(actual.size(), expected.marks.size());
    std::size_t different = 0;
    std::size_t undecided = 0;
    std::size_t samples = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        if (((actual[i] ^ expected.marks[i]) & ~expected.borderline[i]) != 0) ++different;
        if (expected.borderline[i] != 0) ++undecided;
        if (actual[i] != 0) ++samples;
    }
    EXPECT_EQ(different, 0U) << "of " << samples << " samples";
    // A sample lands within 1e-3 px of a border with probability 0.004 for each image.
    EXPECT_LE(undecided, samples / 20 + 2) << "of " << samples << " samples";
}

std::uint64_t countOf(const std::vector<std::uint32_t>& marks, std::uint32_t bits) {
    return static_cast<std::uint64_t>(std::count_if(
        marks.begin(), marks.end(), [&](std::uint32_t mark) { return (mark & bits) == bits; }));
}

TEST_F(PixelMeasuresTest, ConventionalImagesHoldTheRedundantSamplesThatDoubleLoopsFind) {
    for (unsigned seed : {1U, 2U, 3U}) {
        const Experiment e(seed);
        const OnDevice device = onDevice(e.conventional);
        for (std::size_t i = 0; i < 3; ++i) {
            Expected expected(e.conventional[i]);
            expected.mark(HostImages(e.conventional).first(i), true, kSample, kRedundant);
            gl::Texture marks = measures.makeMarks(device.images[i]);
            EXPECT_EQ(read(marks), Expected(e.conventional[i]).marks);
            measures.mark(device.images[i], marks, device.span().first(i), true, kSample,
                          kRedundant);
            expectEqualMarks(expected, read(marks));
            EXPECT_EQ(measures.count(marks, kRedundant), countOf(read(marks), kRedundant));
            EXPECT_EQ(measures.count(marks, kSample), countOf(read(marks), kSample));
            EXPECT_EQ(measures.count(marks, kRedundant) > 0, i > 0);
        }
    }
}

TEST_F(PixelMeasuresTest, NonRedundantImagesHoldTheOccludedAndUsefulSamplesThatDoubleLoopsFind) {
    std::uint64_t occluded = 0;
    std::uint64_t useful = 0;
    for (unsigned seed : {1U, 2U, 3U}) {
        const Experiment e(seed);
        const OnDevice conventional = onDevice(e.conventional);
        const OnDevice nonRedundant = onDevice(e.nonRedundant);
        const OnDevice outputs = onDevice(e.outputs);
        for (std::size_t i = 0; i < 3; ++i) {
            Expected expected(e.nonRedundant[i]);
            expected.mark(HostImages(e.nonRedundant).first(i), true, kSample, kRedundant);
            expected.mark(e.conventional, false, kSample, kOccluded);

            const DepthImage& image = nonRedundant.images[i];
            gl::Texture marks = measures.makeMarks(image);
            measures.mark(image, marks, nonRedundant.span().first(i), true, kSample, kRedundant);
            measures.mark(image, marks, conventional.span(), false, kSample, kOccluded);
            for (std::size_t frame = 0; frame < e.outputs.size(); ++frame) {
                expected.mark({&e.outputs[frame], 1}, true, kOccluded, kUseful);
                measures.mark(image, marks, outputs.span().subspan(frame, 1), true, kOccluded,
                              kUseful);
            }
            const std::vector<std::uint32_t> actual = read(marks);
            expectEqualMarks(expected, actual);
            for (const Mark bit : {kRedundant, kOccluded, kUseful}) {
                EXPECT_EQ(measures.count(marks, bit), countOf(actual, bit)) << bit;
            }
            EXPECT_EQ(measures.count(marks, kOccluded | kUseful), countOf(actual, kUseful));
            occluded += countOf(expected.marks, kOccluded);
            useful += countOf(expected.marks, kUseful);
        }
    }
    // The scenes do have what is compared.
    EXPECT_GT(useful, 100U);
    EXPECT_GT(occluded, useful + 100);
}

TEST_F(PixelMeasuresTest, AvailabilityIsThatOfDoubleLoops) {
    for (unsigned seed : {1U, 2U, 3U}) {
        const Experiment e(seed);
        const OnDevice references = onDevice(e.nonRedundant);
        const OnDevice outputs = onDevice(e.outputs);
        double mean = 0.0, least = 1.0, expectedMean = 0.0, expectedLeast = 1.0;
        for (std::size_t frame = 0; frame < e.outputs.size(); ++frame) {
            Expected expected(e.outputs[frame]);
            expected.mark(e.nonRedundant, true, kSample, kAvailable);
            const std::uint64_t samples = countOf(expected.marks, kSample);
            const std::uint64_t sure = countOf(expected.marks, kAvailable);
            const std::uint64_t undecided = countOf(expected.borderline, kAvailable);

            measures.beginAvailability(outputs.images[frame], references.span());
            const FrameCounts found = measures.finishAvailability();
            EXPECT_EQ(found.samples, samples);
            EXPECT_NEAR(static_cast<double>(found.available), static_cast<double>(sure),
                        static_cast<double>(undecided));
            // The marks are of the same test: no tolerance.
            gl::Texture marks = measures.makeMarks(outputs.images[frame]);
            measures.mark(outputs.images[frame], marks, references.span(), true, kSample,
                          kAvailable);
            expectEqualMarks(expected, read(marks));
            EXPECT_EQ(found.available, measures.count(marks, kAvailable));

            const auto share = [&](std::uint64_t n) {
                return static_cast<double>(n) / static_cast<double>(samples);
            };
            mean += share(found.available) / 5.0;
            least = std::min(least, share(found.available));
            expectedMean += share(sure) / 5.0;
            expectedLeast = std::min(expectedLeast, share(sure));
        }
        EXPECT_NEAR(mean, expectedMean, 0.01);
        EXPECT_NEAR(least, expectedLeast, 0.01);
        EXPECT_LT(least, mean);
        EXPECT_GT(least, 0.3);
    }
}

TEST_F(PixelMeasuresTest, AnImageIsRedundantWithItself) {
    const Experiment e(4);
    for (const HostDepthImage& image : e.conventional) {
        EXPECT_EQ(redundantCount(image, {&image, 1}), countOf(Expected(image).marks, kSample));
    }
}

TEST_F(PixelMeasuresTest, SamplesBehindTheEyeAreNotRedundant) {
    // Back to back: projected through the eye, the samples would land inside.
    const auto image = test::filledImage(test::viewFrom({0, 0, 1}, {8, 8}), 2.0F, 1);
    const auto away = test::filledImage(test::viewFrom({0, 0, 1}, {8, 8}, {0, 0, 5}), 2.0F, 1);
    const auto towards = test::filledImage(test::viewFrom({0, 0, 2}, {8, 8}), 2.0F, 1);
    EXPECT_EQ(redundantCount(image, {&away, 1}), 0U);
    EXPECT_EQ(redundantCount(image, {&towards, 1}), 64U);
}

TEST_F(PixelMeasuresTest, SamplesOutsideOfTheOtherImageAreNotRedundant) {
    const scene::Camera camera{.position = {0, 0, 1}};
    const auto image = test::filledImage(kit::viewOf(camera, {20, 10}), 2.0F, 1);
    struct Shift {
        glm::vec2 offsetPx;
        std::uint64_t inside;
    };
    for (const Shift& shift : {Shift{{3, 0}, 17 * 10},
                               {{-3, 0}, 17 * 10},
                               {{0, 2}, 20 * 8},
                               {{0, -2}, 20 * 8},
                               {{1, -1}, 19 * 9},
                               {{20, 0}, 0}}) {
        const auto other =
            test::filledImage(kit::viewOf(camera, {20, 10}, shift.offsetPx), 2.0F, 1);
        EXPECT_EQ(redundantCount(image, {&other, 1}), shift.inside)
            << shift.offsetPx.x << ", " << shift.offsetPx.y;
    }
}

TEST_F(PixelMeasuresTest, ImagesMayDifferInSize) {
    const auto image = test::filledImage(test::viewFrom({0, 0, 1}, {12, 9}), 2.0F, 7);
    // Three times finer: the centre of pixel p lands at the centre of pixel 3p + 1.
    auto fine = test::emptyImage(test::viewFrom({0, 0, 1}, {36, 27}));
    auto others = test::filledImage(fine.view, 2.0F, 7);
    for (const auto [y, x] : test::grid(9, 12)) {
        fine.triangleId[fine.indexOf({3 * x + 1, 3 * y + 1})] = 7;
        others.triangleId[fine.indexOf({3 * x + 1, 3 * y + 1})] = 8;
    }
    EXPECT_EQ(redundantCount(image, {&fine, 1}), 12U * 9U);
    EXPECT_EQ(redundantCount(image, {&others, 1}), 0U);
}

TEST_F(PixelMeasuresTest, EmptyImagesAndEmptyLists) {
    const View view = test::viewFrom({0, 0, 1}, {19, 70});
    const OnDevice full = onDevice(test::filledImage(view, 2.0F, 1));
    const OnDevice empty = onDevice(test::emptyImage(view));

    gl::Texture none = measures.makeMarks(empty.images[0]);
    measures.mark(empty.images[0], none, full.span(), false, 0, kOccluded);
    measures.mark(empty.images[0], none, empty.span(), true, 0, kRedundant);
    EXPECT_EQ(read(none), std::vector<std::uint32_t>(19 * 70, 0));
    measures.beginAvailability(empty.images[0], empty.span());
    EXPECT_EQ(measures.finishAvailability(), (FrameCounts{0, 0}));
    measures.beginAvailability(full.images[0], empty.span());
    EXPECT_EQ(measures.finishAvailability(), (FrameCounts{19 * 70, 0}));
    measures.beginAvailability(full.images[0], {});
    EXPECT_EQ(measures.finishAvailability(), (FrameCounts{19 * 70, 0}));

    gl::Texture marks = measures.makeMarks(full.images[0]);
    measures.mark(full.images[0], marks, {}, true, kSample, kRedundant);
    EXPECT_EQ(measures.count(marks, kRedundant), 0U);
    measures.mark(full.images[0], marks, {}, false, kSample, kOccluded);
    EXPECT_EQ(measures.count(marks, kOccluded), 19U * 70U);
    EXPECT_EQ(measures.count(marks, 0), 19U * 70U);
}

TEST_F(PixelMeasuresTest, EveryOneOfSixteenImagesIsTestedAndSeventeenAreRefused) {
    const View view = test::viewFrom({0, 0, 1}, {16, 4});
    const auto image = test::filledImage(view, 2.0F, 1);
    // Image i holds column i only.
    std::vector<HostDepthImage> columns;
    for (int i = 0; i < 16; ++i) {
        columns.push_back(test::emptyImage(view));
        for (int y = 0; y < 4; ++y) columns.back().triangleId[columns.back().indexOf({i, y})] = 1;
    }
    for (std::size_t count = 0; count <= 16; ++count) {
        EXPECT_EQ(redundantCount(image, HostImages(columns).first(count)), 4 * count);
    }
    columns.push_back(image);
    const OnDevice one = onDevice(image);
    const OnDevice all = onDevice(columns);
    gl::Texture marks = measures.makeMarks(one.images[0]);
    // Nothing waits for the device in here: the forked process has none of the driver's threads.
    EXPECT_DEATH(measures.mark(one.images[0], marks, all.span(), true, kSample, kRedundant),
                 "imageCount <= kMaxImages");
    EXPECT_DEATH(measures.beginAvailability(one.images[0], all.span()), "imageCount <= kMaxImages");
}

TEST_F(PixelMeasuresTest, MarksStayAndConditionsOnMarksHold) {
    const View view = test::viewFrom({0, 0, 1}, {16, 4});
    const OnDevice full = onDevice(test::filledImage(view, 2.0F, 1));
    auto leftHalf = test::filledImage(view, 2.0F, 1);
    for (int y = 0; y < 4; ++y) {
        for (int x = 8; x < 16; ++x) leftHalf.triangleId[leftHalf.indexOf({x, y})] = 0;
    }
    const OnDevice left = onDevice(leftHalf);
    gl::Texture marks = measures.makeMarks(full.images[0]);
    measures.mark(full.images[0], marks, left.span(), false, kSample, kOccluded);
    EXPECT_EQ(measures.count(marks, kOccluded), 32U);
    // The left half would be needed as well, but is not occluded.
    measures.mark(full.images[0], marks, full.span(), true, kOccluded, kUseful);
    EXPECT_EQ(measures.count(marks, kUseful), 32U);
    EXPECT_EQ(measures.count(marks, kUseful | kOccluded), 32U);
    EXPECT_EQ(read(marks)[0], std::uint32_t{kSample});
    EXPECT_EQ(read(marks)[15], std::uint32_t{kSample | kOccluded | kUseful});
    // Again, with nothing that needs them: all that were marked stay so.
    const std::vector<std::uint32_t> before = read(marks);
    measures.mark(full.images[0], marks, {}, true, kOccluded, kUseful);
    EXPECT_EQ(read(marks), before);
    // Among two bits.
    measures.mark(full.images[0], marks, full.span(), true, kOccluded | kRedundant, kAvailable);
    EXPECT_EQ(measures.count(marks, kAvailable), 0U);
}

TEST_F(PixelMeasuresTest, MarksOfAnotherSizeAreRefused) {
    const OnDevice small = onDevice(test::emptyImage(test::viewFrom({0, 0, 1}, {4, 4})));
    const OnDevice large = onDevice(test::emptyImage(test::viewFrom({0, 0, 1}, {4, 5})));
    gl::Texture marks = measures.makeMarks(small.images[0]);
    EXPECT_DEATH(measures.mark(large.images[0], marks, {}, true, 0, kRedundant),
                 "marks.size\\(\\) == glm::ivec3");
}

scene::Camera cameraFrom(const glm::vec3& position, const glm::vec3& target = glm::vec3(0.0F)) {
    return scene::Camera{.position = position, .target = target, .nearM = 0.5F, .farM = 30.0F};
}

/// A wall across the view along −z, and a block behind it that shows from the right only.
scene::Scene wallAndHiddenBlock() {
    scene::MeshBuilder builder;
    builder.addBox({0.0F, 0.0F, 0.0F}, {1.5F, 1.5F, 0.05F});
    builder.addBox({0.5F, 0.0F, -2.0F}, {0.4F, 0.4F, 0.4F});
    return scene::sceneOf(builder.take("wall and block", -1));
}

struct NextViewTest : test::GlTest {
    kit::DepthImage conventional(const scene::Camera& camera) {
        auto image = renderer.makeImage(kit::viewOf(camera, {48, 48}));
        renderer.render(scene, image);
        return image;
    }

    gl::ShaderLibrary programShaders{dataFolder("shaders")};
    kit::DepthImageRenderer renderer{programShaders, kit::TriangleIds::PrimitiveId,
                                     kit::DepthFormat::Float32};
    kit::DrawableScene scene{wallAndHiddenBlock()};

    const scene::Camera front = cameraFrom({0, 0, 8});
    const scene::Camera frontAbove = cameraFrom({0, 0.5F, 8});
    const scene::Camera right = cameraFrom({8, 0, -1}, {0, 0, -1});
    const scene::Camera away = cameraFrom({0, 0, 8}, {0, 0, 20});
    // Most of what they show is the block.
    const std::vector<scene::Camera> outputs = {cameraFrom({7, 0.5F, -1.5F}, {0, 0, -1}),
                                                cameraFrom({7, -0.5F, -2.0F}, {0, 0, -1})};
};

TEST_F(NextViewTest, IsTheOnlyOneThatSeesTheHiddenBlock) {
    NextView nextView(programShaders, renderer, scene, {away, front, frontAbove, right}, outputs,
                      {48, 48});
    const kit::DepthImage first = conventional(front);
    const kit::DepthImage* const soFar[] = {&first};
    const NextView::Choice choice = nextView.next(soFar);
    EXPECT_EQ(choice.candidate, 3U);
    EXPECT_EQ(choice.camera.position, right.position);
    EXPECT_GT(choice.gainedSamples, 100U);
    // With that image at hand, no candidate gains more than rims that its resolution missed.
    const kit::DepthImage second = conventional(right);
    const kit::DepthImage* const both[] = {&first, &second};
    EXPECT_LT(nextView.next(both).gainedSamples, choice.gainedSamples / 10);
}

TEST_F(NextViewTest, CountsWhatOutputFramesNeedAndNoImageHas) {
    // The front shows the wall, which the output frame needs, but the image so far has it already.
    NextView nextView(programShaders, renderer, scene, {front}, {front}, {48, 48});
    const NextView::Choice before = nextView.next({});
    const kit::HostDepthImage frame = readDepthImage(conventional(front));
    const auto samples = static_cast<std::uint64_t>(
        std::count_if(frame.triangleId.begin(), frame.triangleId.end(),
                      [](std::uint32_t triangleId) { return triangleId != 0; }));
    EXPECT_GT(samples, 100U);
    EXPECT_EQ(before.gainedSamples, samples);
    const kit::DepthImage first = conventional(front);
    const kit::DepthImage* const soFar[] = {&first};
    EXPECT_EQ(nextView.next(soFar).gainedSamples, 0U);
}

TEST_F(NextViewTest, TiesGoToTheFirstCandidate) {
    NextView equal(programShaders, renderer, scene, {away, right, right}, outputs, {48, 48});
    EXPECT_EQ(equal.next({}).candidate, 1U);
    NextView useless(programShaders, renderer, scene, {away, away}, outputs, {48, 48});
    EXPECT_EQ(useless.next({}).candidate, 0U);
    EXPECT_EQ(useless.next({}).gainedSamples, 0U);
}

// [xie2017] Fig. 10: where a sample s₁ of I₁ lands on I₀, and by which definition it is redundant.

constexpr float kEyeZ = 8.0F;
constexpr float kOccluderZ = 1.0F;
enum TriangleId : std::uint32_t { T0 = 1, T1 = 2, T2 = 3 };

struct Figure10Test : test::GlTest {
    /// The point of height z that lands on I₀ at these pixel coordinates.
    static glm::vec3 landingAt(glm::vec2 px, float z) {
        const float halfWidthPx = 4.0F;
        const float widthAtEyeDistance = std::tan(glm::radians(22.5F)) / halfWidthPx;
        return {(px - halfWidthPx) * widthAtEyeDistance * (kEyeZ - z), z};
    }

    /// T₀ left and T₁ right of x = 4.3 px, T₂ before T₁ from x = 6.7 px on.
    static std::vector<test::Triangle> triangles() {
        const auto blue = [](glm::vec2 px) { return landingAt(px, 0.0F); };
        const auto red = [](glm::vec2 px) { return landingAt(px, kOccluderZ); };
        return {{blue({4.3F, -20.0F}), blue({4.3F, 28.0F}), blue({-60.0F, 4.0F})},
                {blue({4.3F, 28.0F}), blue({4.3F, -20.0F}), blue({60.0F, 4.0F})},
                {red({6.7F, 8.0F}), red({6.7F, 0.0F}), red({9.0F, 4.0F})}};
    }
    static scene::Scene scene() {
        scene::Scene scene;
        scene.materials.resize(1);
        scene.meshes.resize(1);
        for (const test::Triangle& corners : triangles()) {
            scene::Mesh& mesh = scene.meshes[0];
            const auto first = static_cast<unsigned>(mesh.positions.size());
            mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
        scene.instances = {{0}};
        return scene;
    }

    /// I₁ has one pixel, whose centre shows what lands on I₀ at `px`: a point of `triangle`, seen
    /// from the left, so that nothing hides it.
    static HostDepthImage imageOf(TriangleId triangle, glm::vec2 px) {
        const glm::vec3 point = landingAt(px, triangle == T2 ? kOccluderZ : 0.0F);
        HostDepthImage image =
            test::castImage(test::viewFrom({-6.0F, 0.0F, 4.0F}, {1, 1}, point), triangles());
        EXPECT_EQ(image.triangleId[0], triangle);
        EXPECT_LT(glm::distance(image.pointWorld({0, 0}), point), 1e-4F);
        return image;
    }

    bool isPixelRedundant(const HostDepthImage& s1) {
        DepthImage here(s1.view, kit::DepthFormat::Float32);
        DepthImage there(i0.view, kit::DepthFormat::Float32);
        kit::writeDepthImage(s1, here);
        kit::writeDepthImage(i0, there);
        gl::Texture marks = measures.makeMarks(here);
        const DepthImage* const earlier[] = {&there};
        measures.mark(here, marks, earlier, true, kSample, kRedundant);
        return measures.count(marks, kRedundant) == 1;
    }
    bool isVisibilityRedundant(const HostDepthImage& s1) const {
        return sequence.holds(0, {s1.pointWorld({0, 0}), s1.triangleId[0]});
    }

    gl::ShaderLibrary programShaders{dataFolder("shaders")};
    PixelMeasures measures{programShaders};
    HostDepthImage i0 = test::castImage(test::viewFrom({0.0F, 0.0F, kEyeZ}, {8, 8}), triangles());
    raycast::RayTracer tracer{scene()};
    VisibilitySequence sequence{tracer, {i0.view}, false};
};

TEST_F(Figure10Test, AOnThePixelsCentreIsTheSameSample) {
    const HostDepthImage s1 = imageOf(T0, {2.5F, 2.5F});
    EXPECT_LT(glm::distance(i0.pointWorld({2, 2}), s1.pointWorld({0, 0})), 1e-4F);
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_TRUE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, BBesideTheCentreOnTheSameTriangleIsRedundantByBoth) {
    const HostDepthImage s1 = imageOf(T0, {2.8F, 2.3F});
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_TRUE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, CInAPixelOfTheNextTriangleIsVisibleOnly) {
    const HostDepthImage s1 = imageOf(T0, {4.1F, 2.3F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({4, 2})], T1);
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_FALSE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, DBehindTheOccluderInAPixelOfItsOwnTriangleIsPixelRedundantOnly) {
    const HostDepthImage s1 = imageOf(T1, {6.85F, 4.5F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({6, 4})], T1);
    EXPECT_FALSE(isVisibilityRedundant(s1));
    EXPECT_TRUE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, EBehindTheOccluderInItsPixelIsRedundantByNeither) {
    const HostDepthImage s1 = imageOf(T1, {7.5F, 4.5F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({7, 4})], T2);
    EXPECT_FALSE(isVisibilityRedundant(s1));
    EXPECT_FALSE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, FOnTheOccluderInAPixelOfWhatItHidesIsVisibleOnly) {
    const HostDepthImage s1 = imageOf(T2, {6.8F, 4.5F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({6, 4})], T1);
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_FALSE(isPixelRedundant(s1));
}

}  // namespace
}  // namespace gfxrepro::depth_sampling
