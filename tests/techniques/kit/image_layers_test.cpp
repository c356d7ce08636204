#include "techniques/kit/image_layers.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/image/srgb.h"
#include "techniques/kit/displayed_errors.h"

namespace gfxrepro::kit {
namespace {

/// From (0, 0, 5) along −z, 90 degrees, depths from 1 to 10.
View viewOfSize(glm::ivec2 sizePx) {
    const scene::Camera camera{.position = {0.0F, 0.0F, 5.0F},
                               .target = {0.0F, 0.0F, 0.0F},
                               .verticalFovRad = glm::radians(90.0F),
                               .nearM = 1.0F,
                               .farM = 10.0F};
    return viewOf(camera, sizePx);
}

TEST(ImageLayers, RowsBeginAtTheTop) {
    const std::vector<float> depthM{1.0F, 2.0F, 3.0F, 4.0F};  // the lower row first
    const technique::ImageOptions options =
        ImageLayers(viewOfSize({2, 2})).depths(depthM).options("result");
    EXPECT_EQ(options.truthOf, "result");
    const image::ImageF* depths = options.layers.find("Z");
    ASSERT_NE(depths, nullptr);
    EXPECT_EQ(depths->at(0, 0), 3.0F);
    EXPECT_EQ(depths->at(1, 0), 4.0F);
    EXPECT_EQ(depths->at(0, 1), 1.0F);
}

/// Of blocks of 2 × 2 the sample right above the middle, of 3 × 3 the middle one: never a mean.
TEST(ImageLayers, SupersampledPixelsHaveOneSample) {
    for (const int factor : {2, 3}) {
        SCOPED_TRACE(factor);
        std::vector<std::uint32_t> ids(static_cast<std::size_t>(2 * factor * factor));
        for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::uint32_t>(i);
        // Two pixels side by side.
        const technique::ImageOptions options =
            ImageLayers(viewOfSize({2 * factor, factor}), factor).ids("id", ids).options();
        const image::ImageF* id = options.layers.find("id");
        ASSERT_NE(id, nullptr);
        ASSERT_EQ(id->width(), 2);
        ASSERT_EQ(id->height(), 1);
        // Row 1 of four, columns 1 and 3; row 1 of six, columns 1 and 4.
        EXPECT_EQ(id->at(0, 0), factor == 2 ? 5.0F : 7.0F);
        EXPECT_EQ(id->at(1, 0), factor == 2 ? 7.0F : 10.0F);
        EXPECT_EQ(options.layers.channels[0].type, image::ExrPixelType::Uint);
    }
}

/// Window z of distance d between n = 1 and f = 10 is (1 − 1/d) / (1 − 1/10).
TEST(ImageLayers, DepthsOfWindowsAndPoints) {
    const View view = viewOfSize({4, 1});
    const auto windowZ = [](float d) { return (1.0F - 1.0F / d) / 0.9F; };
    const std::vector<float> window{windowZ(1.0F), windowZ(2.0F), windowZ(7.5F), 1.0F};
    const image::ExrImage fromWindow = ImageLayers(view).windowDepths(window).options().layers;
    const float expected[] = {1.0F, 2.0F, 7.5F, 0.0F};
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(fromWindow.find("Z")->at(x, 0), expected[x], 1e-5F);
    // Along the axis, not along the ray.
    const std::vector<glm::vec4> points{
        {3.0F, 1.0F, 4.0F, 1.0F}, {0.0F, 0.0F, 3.0F, 1.0F}, {9.0F, 0.0F, -2.5F, 1.0F}, {}};
    const image::ExrImage fromPoints = ImageLayers(view).pointDepths(points).options().layers;
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(fromPoints.find("Z")->at(x, 0), expected[x], 1e-5F);
}

TEST(ImageLayers, NormalsAreWhereSomethingIs) {
    const std::vector<float> depthM{0.0F, 2.0F};
    const std::vector<glm::vec3> normals(2, glm::vec3(0.0F, 0.6F, 0.8F));
    const image::ExrImage layers =
        ImageLayers(viewOfSize({2, 1})).depths(depthM).normals(normals).options().layers;
    EXPECT_EQ(layers.find("N.Z")->at(0, 0), 0.0F);
    EXPECT_EQ(layers.find("N.Y")->at(1, 0), 0.6F);
    EXPECT_EQ(layers.find("N.Z")->at(1, 0), 0.8F);
}

TEST(ImageLayers, ErrorsAreThePictureLessItsTruth) {
    const image::ImageF picture(2, 1, 3, 0.25F), truth(2, 1, 3, 1.0F);
    const image::ExrImage layers =
        ImageLayers(viewOfSize({2, 1})).errors(picture, truth, "truth_1").options().layers;
    EXPECT_EQ(layers.find("error.G")->at(1, 0), -0.75F);
    EXPECT_EQ(layers.attributes.at("about_error"), "this image less 'truth_1', linear");
    const image::ExrImage grey = ImageLayers(viewOfSize({2, 1}))
                                     .errors(image::ImageF(2, 1, 1, 3.0F), image::ImageF(2, 1, 1))
                                     .options()
                                     .layers;
    EXPECT_EQ(grey.find("error.Y")->at(0, 0), 3.0F);
}

TEST(ImageLayers, CameraIsTheView) {
    const View view = viewOfSize({2, 1});
    const technique::ImageOptions options = seenFrom(view, "image");
    ASSERT_TRUE(options.camera.has_value());
    EXPECT_EQ(options.camera->viewFromWorld, view.viewFromWorld);
    EXPECT_EQ(options.camera->clipFromView, view.clipFromView);
    EXPECT_EQ(options.camera->farM, 10.0F);
    EXPECT_EQ(options.truthOf, "image");
    EXPECT_TRUE(options.layers.channels.empty());
}

// Errors of hand-made pictures.

TEST(DisplayedErrorsTest, AreMeansOfShownDifferences) {
    image::ImageF a(2, 1, 3, 0.0F);
    image::ImageF b(2, 1, 3, 0.0F);
    b.at(0, 0, 0) = 1.0F;       // 255
    b.at(0, 0, 1) = 0.214041F;  // 127.5 … shown as 128 or 127
    b.at(1, 0, 2) = 2.0F;       // as bright as shown
    const std::vector<std::uint8_t> first{1, 0};
    EXPECT_EQ(channelErrors(a, b, &first).x, 255.0);
    EXPECT_NEAR(channelErrors(a, b, &first).y, 127.5, 0.5);
    EXPECT_EQ(channelErrors(a, b, &first).z, 0.0);
    EXPECT_EQ(channelErrors(a, b, nullptr).x, 127.5);
    EXPECT_EQ(channelErrors(a, b, nullptr).z, 127.5);
    const std::vector<std::uint8_t> none{0, 0};
    EXPECT_EQ(channelErrors(a, b, &none), glm::dvec3(0.0));
    EXPECT_EQ(shownPsnrDb(a, a), kEqualPsnrDb);
    EXPECT_NEAR(shownPsnrDb(a, image::ImageF(2, 1, 3, 1.0F)), 0.0, 1e-9);
}

TEST(DisplayedErrorsTest, PicturesAreDifferencesAsShown) {
    const image::ImageF error = errorPicture(image::ImageF(1, 1, 3, 0.0F),
                                             image::ImageF(1, 1, 3, 1.0F / 12.92F / 255.0F), 50);
    // One level, fifty times: what is shown as 50.
    EXPECT_EQ(image::toSrgb8(error).at(0, 0), 50);
}

}  // namespace
}  // namespace gfxrepro::kit
