#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/core/node.h"
#include "engine/image/png_io.h"
#include "runner/run/manifest.h"
#include "runner/run/measure.h"
#include "runner/run/recorder.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::run {
namespace {

Case someCase() {
    Case item;
    item.id = "0123456789ab";
    item.experiment = "xie2017/8";
    item.technique = "clustered_reflections";
    item.scene = parseYaml("office", "test");
    item.params = parseYaml("{method: clustered, supersampling: 2}", "test");
    item.axes = parseYaml("{frames: 3}", "test");
    item.outputWidthPx = 64;
    item.outputHeightPx = 32;
    item.measure.frames = 1;
    return item;
}

/// A row vector times the matrix, as OpenEXR and Imath have it.
glm::vec4 times(const glm::vec4& v, const std::array<float, 16>& m) {
    glm::vec4 result(0.0F);
    for (const auto [column, row] : test::grid(4, 4)) {
        result[column] += v[row] * m[static_cast<std::size_t>(4 * row + column)];
    }
    return result;
}

void expectNear(const glm::vec3& a, const glm::vec3& b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5) << i;
}

TEST(ImageAttributes, SayWhatMadeAnImage) {
    image::ExrImage exr;
    describeImage(exr, someCase(), 4, "gfxrepro run x.yaml --profile quick", {});
    const std::map<std::string, std::string> expected{
        {"case", "0123456789ab"},
        {"command", "gfxrepro run x.yaml --profile quick"},
        {"commit", programCommit()},
        {"frame", "4"},
        {"method", "clustered"},
        {"params",
         R"({"method":"clustered","supersampling":2,"output":{"width":64,"height":32},"scene":"office"})"},
        {"table", "xie2017/8"},
        {"technique", "clustered_reflections"},
        {"title", "xie2017/8 frames=3"}};
    EXPECT_EQ(exr.attributes, expected);
    EXPECT_TRUE(exr.matrices.empty());
}

/// From (1, 2, 3) along +x, 90 degrees high, twice as wide: corners and distances are known without
/// any matrix.
TEST(ImageAttributes, CameraIsAsOpenExrDefinesIt) {
    const glm::vec3 eye(1.0F, 2.0F, 3.0F);
    const technique::ImageOptions options{
        .camera = technique::ImageCamera{
            glm::lookAt(eye, eye + glm::vec3(5.0F, 0.0F, 0.0F), glm::vec3(0, 1, 0)),
            glm::perspective(glm::radians(90.0F), 2.0F, 0.5F, 100.0F), 0.5F, 100.0F}};
    image::ExrImage exr;
    describeImage(exr, someCase(), 0, "", options);
    EXPECT_THAT(exr.attributes.at("camera"), HasSubstr(R"("eye":[1.0,2.0,3.0])"));
    EXPECT_THAT(exr.attributes.at("camera"), HasSubstr(R"("forward":[1.0,)"));
    EXPECT_THAT(exr.attributes.at("camera"), HasSubstr(R"("near_m":0.5,"far_m":100.0)"));

    // Seen along +x with y up, right is +z: left-handed with z forward.
    const std::array<float, 16>& camera = exr.matrices.at("worldToCamera");
    expectNear(times({1.0F, 2.0F, 3.0F, 1.0F}, camera), {0.0F, 0.0F, 0.0F});
    expectNear(times({5.0F, 3.0F, 5.0F, 1.0F}, camera), {2.0F, 1.0F, 4.0F});
    // Four metres away the image reaches 4 m up and down, 8 m to the left and right.
    const auto ndc = [&](const glm::vec3& point) {
        const glm::vec4 p = times({point, 1.0F}, exr.matrices.at("worldToNDC"));
        return glm::vec3(p.x / p.w, p.y / p.w, 0.0F);
    };
    expectNear(ndc({5.0F, 2.0F, 3.0F}), {0.5F, 0.5F, 0.0F});
    expectNear(ndc({5.0F, 6.0F, -5.0F}), {0.0F, 0.0F, 0.0F});  // upper left
    expectNear(ndc({5.0F, -2.0F, 11.0F}), {1.0F, 1.0F, 0.0F});
}

config::Outputs withTruthOf(const char* picture) {
    const auto errors = config::pictureErrors();
    return {{errors.begin(), errors.end()}, {{picture, ""}}, false, {picture}};
}

/// A case whose picture `result` has a truth.
struct Recorded : FolderTest {
    std::map<std::string, double> errors() const {
        std::map<std::string, double> errors;
        for (const Sample& sample : result.samples) errors[sample.metric] = sample.value;
        return errors;
    }

    const Case item = someCase();
    CaseResult result;
    RunRecorder recorder{folder.path(), "gfxrepro run x.yaml", item, withTruthOf("result"), result};
};

TEST_F(Recorded, ErrorsAreThoseOfKnownPictures) {
    recorder.setIteration(0, 0);
    image::ImageF picture(16, 16, 3, 0.75F);
    picture.at(0, 0, 1) = 1.0F;
    recorder.image("result", picture, {});
    recorder.image("truth", image::ImageF(16, 16, 3, 0.5F), {.truthOf = "result"});
    recorder.image("other", image::ImageF(16, 16, 3, 0.1F), {.truthOf = "result"});
    recorder.compareWithTruths();
    std::map<std::string, double> first = errors();
    EXPECT_EQ(first.size(), config::pictureErrors().size());
    const double mse = (767.0 * 0.0625 + 0.25) / 768.0;
    EXPECT_NEAR(first["mse"], mse, 1e-12) << "against the first truth";
    EXPECT_NEAR(first["rmse"], std::sqrt(mse), 1e-12);
    EXPECT_NEAR(first["rel_mse"], mse / 0.26, 1e-9);
    EXPECT_NEAR(first["psnr_db"], -10.0 * std::log10(mse), 1e-9);
    EXPECT_LT(first["ssim"], 1.0);
    EXPECT_GT(first["flip"], 0.0);
    EXPECT_DOUBLE_EQ(first["error_p95"], 0.25) << "one pixel of 256 is worse";
    EXPECT_DOUBLE_EQ(first["error_p99"], 0.25);
    EXPECT_EQ(result.samples[0].pass, "result");
    // Of the next frame its own.
    recorder.setIteration(1, 0);
    recorder.image("result", image::ImageF(4, 4, 3, 0.5F), {});
    recorder.compareWithTruths();
    EXPECT_EQ(errors(), first);
}

TEST_F(Recorded, APngIsComparedAsItIsStored) {
    recorder.setIteration(0, 0);
    const image::ImageF stored(16, 16, 3, 0.4F), storedTruth(16, 16, 3, 0.2F);
    recorder.image("result", image::ImageF(16, 16, 3, 0.1329F), {.stored = &stored});
    recorder.image("truth", image::ImageF(16, 16, 3, 0.0331F),
                   {.truthOf = "result", .stored = &storedTruth});
    recorder.compareWithTruths();
    EXPECT_NEAR(errors().at("rmse"), 0.2, 1e-6);
}

TEST_F(Recorded, WhatCannotBeComparedIsAnError) {
    recorder.image("result", image::ImageF(16, 16, 3), {});
    recorder.image("truth", image::ImageF(32, 16, 3), {.truthOf = "result"});
    EXPECT_EQ(errorText([&] { recorder.compareWithTruths(); }),
              "image 'result' and its truth: the images differ in shape: 32x16 with 3 channels and "
              "16x16 with 3 channels");
    EXPECT_EQ(
        errorText([&] { recorder.image("truth", image::ImageF(4, 4, 3), {.truthOf = "other"}); }),
        "image 'truth' is the truth of 'other', of which technique 'clustered_reflections' does "
        "not declare that it has one");
}

TEST_F(Recorded, KeepsLayersTruthsAndAttributes) {
    recorder.setIteration(0, 0);
    technique::ImageOptions options;
    options.layers.add(image::ImageF(4, 2, 1, 7.0F), {"id"}, image::ExrPixelType::Uint);
    options.layers.attributes["about_id"] = "reflector";
    recorder.image("result", image::ImageF(4, 2, 3, 0.5F), options);
    recorder.image("truth", image::ImageF(4, 2, 3, 0.25F), {.truthOf = "result"});
    recorder.compareWithTruths();
    ASSERT_EQ(result.images.size(), 2U);
    EXPECT_EQ(result.images[0].truthOf, "");
    EXPECT_EQ(result.images[1].truthOf, "result");
    const image::ExrImage exr = image::readExr(folder.path() / result.images[0].exr);
    ASSERT_NE(exr.find("id"), nullptr);
    EXPECT_EQ(exr.find("id")->at(3, 1), 7.0F);
    EXPECT_EQ(exr.colour().at(3, 1, 2), 0.5F);
    EXPECT_EQ(exr.attributes.at("about_id"), "reflector");
    EXPECT_EQ(exr.attributes.at("command"), "gfxrepro run x.yaml");
    // As the runner gets it from the worker.
    EXPECT_EQ(caseResultFromJson(toJson(result)).images, result.images);
}

/// Grey at half cover: PNG has what is covered.
TEST_F(Recorded, GreyMayHaveAlpha) {
    image::ImageF grey(2, 1, 2, 0.5F);
    grey.at(0, 0, 0) = 0.25F;
    recorder.image("grey", grey, {});
    EXPECT_EQ(image::readExr(folder.path() / result.images.at(0).exr).colour(), grey);
    const image::Image8 png = image::readPng8(folder.path() / result.images[0].png);
    ASSERT_EQ(png.channels(), 2);
    EXPECT_EQ(png.at(0, 0, 0), 188);
    EXPECT_EQ(png.at(0, 0, 1), 128);
    EXPECT_EQ(errorText([&] { recorder.image("five", image::ImageF(1, 1, 5), {}); }),
              "image 'five' has 5 channels; 1 to 4 are allowed");
}

TEST_F(Recorded, TruthsNeedTheirImage) {
    recorder.setIteration(0, 0);
    recorder.image("result", image::ImageF(1, 1, 1), {});
    recorder.compareWithTruths();
    recorder.setIteration(1, 0);
    recorder.image("truth", image::ImageF(1, 1, 1), {.truthOf = "result"});
    EXPECT_EQ(errorText([&] { recorder.compareWithTruths(); }),
              "image 'truth' is the truth of 'result', which is not among the frame's images");
}

TEST(RunRecorder, TakesWhatIsDeclaredAlone) {
    const TemporaryFolder folder;
    CaseResult result;
    Case item = someCase();
    item.technique = "dots";
    const config::Outputs outputs{{{"voxels", "voxel", "full ones"}, {"useful_pct", "%", "useful"}},
                                  {{"draw", "the picture"}, {"image_*", "an image"}}};
    RunRecorder recorder(folder.path(), "", item, outputs, result);
    recorder.metric("voxels", 7, "draw", "voxel");
    recorder.metric("voxels", 8, "image_12");
    recorder.share("useful_pct", 1, 4, "sample", "");
    const auto refused = [&](const char* metric, const char* unit, const char* pass) {
        return errorText([&] { recorder.metric(metric, 1, pass, unit); });
    };
    EXPECT_EQ(refused("voxel", "voxel", ""),
              "technique 'dots' has no metric 'voxel'; did you mean 'voxels'?");
    EXPECT_EQ(refused("voxels", "byte", ""),
              "metric 'voxels' is recorded in 'byte', but declared in 'voxel'");
    EXPECT_EQ(refused("voxels", "voxel", "drew"),
              "technique 'dots' has no pass 'drew'; did you mean 'draw'?");
    EXPECT_EQ(refused("voxels", "voxel", "image_"),
              "technique 'dots' has no pass 'image_'; did you mean 'image_*'?");
    EXPECT_EQ(refused("voxels_of", "voxel", ""),
              "technique 'dots' has no metric 'voxels_of'; did you mean 'voxels'?");
    std::string units;
    for (const auto& sample : result.samples) units += sample.metric + " " + sample.unit + "; ";
    EXPECT_EQ(units, "voxels voxel; voxels voxel; useful_pct %; useful_pct_of sample; ");
}

config::Measure timing(int repeats, int frames) {
    return config::Measure{
        .lane = config::Measure::Lane::Timing, .repeats = repeats, .frames = frames};
}

TEST(Pacing, OnASoftwareDeviceAndInTheQualityLaneAsTheConfigSays) {
    config::Measure quality = timing(5, 1);
    quality.lane = config::Measure::Lane::Quality;
    for (const Pacing& pacing : {Pacing::of(timing(5, 1), false), Pacing::of(quality, true)}) {
        EXPECT_EQ(pacing.warmUpS, 0.0);
        EXPECT_EQ(pacing.warmUpAtMostS, 0.0);
        EXPECT_EQ(pacing.busyS, 0.0);
        EXPECT_EQ(pacing.repeatsS, 0.0);
        EXPECT_EQ(pacing.repeatsAtMost, 5);
        EXPECT_EQ(pacing.inFlight(1.0), 1);
    }
}

TEST(Pacing, OnHardwareByTimeWhichTheFramesShare) {
    EXPECT_EQ(Pacing::of(timing(1, 1), true).repeatsS, 0.2);
    EXPECT_EQ(Pacing::of(timing(1, 500), true).repeatsS, 0.0004);
    EXPECT_EQ(Pacing::of(timing(1, 1), true).repeatsAtMost, 10);
    EXPECT_EQ(Pacing::of(timing(200, 1), true).repeatsAtMost, 200);
    EXPECT_GE(Pacing::of(timing(1, 1), true).warmUpS, 0.2);
}

TEST(Pacing, SettledAreThreeTimesWithinTwoPercent) {
    EXPECT_FALSE(Pacing::areSettled({}));
    EXPECT_FALSE(Pacing::areSettled({1.0, 1.0}));
    EXPECT_TRUE(Pacing::areSettled({9.0, 1.0, 1.0, 1.019}));
    EXPECT_FALSE(Pacing::areSettled({1.0, 1.0, 1.0, 1.03}));
    EXPECT_FALSE(Pacing::areSettled({1.03, 1.0, 1.0}));
}

TEST(Pacing, FramesInFlightTakeFiftyMillisecondsTogether) {
    const Pacing pacing = Pacing::of(timing(1, 1), true);
    EXPECT_EQ(pacing.inFlight(0.0), 8);
    EXPECT_EQ(pacing.inFlight(1.0), 8);
    EXPECT_EQ(pacing.inFlight(20.0), 3);
    EXPECT_EQ(pacing.inFlight(50.0), 1);
    EXPECT_EQ(pacing.inFlight(900.0), 1);
}

image::ImageF ramp(float shift = 0.0F) {
    image::ImageF image(32, 16, 3);
    for (const auto [y, x] : test::grid(16, 32)) {
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(x) / 31.0F + shift;
    }
    return image;
}

RepeatWork work(std::uint64_t primitives, std::uint64_t fragments, float shift = 0.0F) {
    return {gl::Work{primitives, fragments, 7}, ImageDigest::of(ramp(shift))};
}

TEST(ImageDigest, TellsBlankPicturesAndCellMeans) {
    EXPECT_TRUE(ImageDigest::of(image::ImageF(5, 3, 4, 0.25F)).isBlank);
    const ImageDigest digest = ImageDigest::of(ramp());
    EXPECT_FALSE(digest.isBlank);
    EXPECT_EQ(digest.range, 1.0F);
    EXPECT_NEAR(digest.means[0], 1.5F / 31.0F, 1e-6F);  // columns 0 to 3
    EXPECT_NEAR(digest.means[7], 29.5F / 31.0F, 1e-6F);
    EXPECT_EQ(digest.hash, ImageDigest::of(ramp()).hash);
    EXPECT_NE(digest.hash, ImageDigest::of(ramp(1e-6F)).hash);
}

TEST(ImageDigest, SmallPicturesHaveEmptyCells) {
    image::ImageF image(2, 1, 1);
    image.at(1, 0, 0) = 3.0F;
    const ImageDigest digest = ImageDigest::of(image);
    EXPECT_EQ(digest.means[0], 0.0F);
    EXPECT_EQ(digest.means[4], 3.0F);
    EXPECT_EQ(digest.means[63], 0.0F);
}

TEST(EqualWork, TheSameIsFine) {
    EXPECT_EQ(whyUnequal({}), "");
    EXPECT_EQ(whyUnequal({work(5, 1000)}), "");
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1000)}), "");
    // Orders of sums and of early depth tests.
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1009, 0.005F)}), "");
    // A device that does not count, a technique without a picture.
    EXPECT_EQ(whyUnequal({{}, {}}), "");
}

TEST(EqualWork, APointOfMillionsMayDependOnTheOrder) {
    EXPECT_EQ(whyUnequal({work(2'480'376, 100), work(2'480'377, 100)}), "");
    EXPECT_EQ(whyUnequal({work(2'480'376, 100), work(2'480'476, 100)}),
              "repeat 1 has 2480476 primitives, repeat 0 has 2480376");
}

TEST(EqualWork, AWorkGroupOfAMillionInvocationsMayDependOnTheOrder) {
    RepeatWork first = work(5, 1000), other = first;
    first.counts->invocations = 1'233'024;
    other.counts->invocations = 1'233'088;
    EXPECT_EQ(whyUnequal({first, other}), "");
    other.counts->invocations = 1'233'152;
    EXPECT_EQ(whyUnequal({first, other}),
              "repeat 1 has 1233152 compute invocations, repeat 0 has 1233024");
}

TEST(EqualWork, DifferencesAreNamedWithTheirNumbers) {
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1000), work(6, 1000)}),
              "repeat 2 has 6 primitives, repeat 0 has 5");
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1011)}),
              "repeat 1 has 1011 fragments, repeat 0 has 1000");
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1000, 0.02F)}),
              "repeat 1 drew a different picture than repeat 0");
    RepeatWork idle = work(5, 1000);
    idle.counts->invocations = 0;
    EXPECT_EQ(whyUnequal({work(5, 1000), idle}),
              "repeat 1 has 0 compute invocations, repeat 0 has 7");
    RepeatWork blank = work(5, 1000);
    blank.image = ImageDigest::of(image::ImageF(8, 8, 3));
    EXPECT_EQ(whyUnequal({blank}), "the picture of repeat 0 is blank: all its pixels are the same");
}

}  // namespace
}  // namespace gfxrepro::run
