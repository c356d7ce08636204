#include "techniques/depth_sampling/sampling_experiment.h"

#include <gtest/gtest.h>

#include "techniques/depth_sampling/pixel_measures.h"
#include "tests/techniques/depth_sampling/host_images.h"

namespace gfxrepro::depth_sampling {
namespace {

glm::vec3 at(const image::ImageF& picture, int x, int y) {
    return {picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)};
}

void expectColor(const glm::vec3& actual, const glm::vec3& expected) {
    for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(actual[i], expected[i]) << "channel " << i;
}

/// 2 × 3 pixels, white but for pixel (1, 0), which is pure green of half intensity.
kit::HostDepthImage smallImage() {
    auto image = test::filledImage(test::viewFrom({0, 0, 1}, {2, 3}), 1.0F, 1);
    image.shading[1] = {0, 51, 0, 255};
    return image;
}

TEST(OccludedPicture, HasTheLegendsColoursWithRowsFromTheTop) {
    const std::vector<std::uint32_t> marks = {kSample,
                                              kSample,  // bottom
                                              kSample | kOccluded,
                                              kSample | kOccluded | kUseful,  // middle
                                              kSample | kRedundant | kUseful,
                                              0};  // top
    const image::ImageF picture = occludedPicture(smallImage(), marks);
    ASSERT_EQ(picture.width(), 2);
    ASSERT_EQ(picture.height(), 3);
    ASSERT_EQ(picture.channels(), 3);
    expectColor(at(picture, 0, 2), glm::vec3(1.0F));
    expectColor(at(picture, 1, 2), glm::vec3(0.2F * 0.7152F));  // grey, as bright
    expectColor(at(picture, 0, 1), {0.06F, 0.62F, 0.10F});
    expectColor(at(picture, 1, 1), {1.00F, 0.78F, 0.03F});
    expectColor(at(picture, 0, 0), {1.00F, 0.78F, 0.03F});
    expectColor(at(picture, 1, 0), {0.020F, 0.022F, 0.030F});
}

TEST(OccludedPicture, ShadingDarkensColoursToThreeTenths) {
    auto image = smallImage();
    image.shading[2] = {0, 0, 0, 255};
    const float greens = 0.3F + 0.7F * 0.2F * 0.7152F;
    const std::vector<std::uint32_t> marks = {
        kSample, kSample | kOccluded, kSample | kOccluded, 0, 0, 0};
    const image::ImageF picture = occludedPicture(image, marks);
    expectColor(at(picture, 1, 2), glm::vec3(0.06F, 0.62F, 0.10F) * greens);
    expectColor(at(picture, 0, 1), glm::vec3(0.06F, 0.62F, 0.10F) * 0.3F);
}

TEST(AvailabilityPicture, ShowsUnavailableSamplesRedAndOthersShaded) {
    const std::vector<std::uint32_t> marks = {
        kSample, kSample | kAvailable, kSample | kAvailable, kSample, 0, kSample};
    const image::ImageF picture = availabilityPicture(smallImage(), marks);
    expectColor(at(picture, 0, 2), {0.85F, 0.03F, 0.03F});
    expectColor(at(picture, 1, 2), {0.0F, 0.2F, 0.0F});
    expectColor(at(picture, 0, 1), glm::vec3(1.0F));
    expectColor(at(picture, 1, 1), {0.85F, 0.03F, 0.03F});
    expectColor(at(picture, 0, 0), {0.020F, 0.022F, 0.030F});
    expectColor(at(picture, 1, 0), {0.85F, 0.03F, 0.03F});
}

TEST(Pictures, RefuseMarksOfAnotherImage) {
    const std::vector<std::uint32_t> marks(5, kSample);
    EXPECT_DEATH(occludedPicture(smallImage(), marks), "marks.size\\(\\).*5 vs 6");
    EXPECT_DEATH(availabilityPicture(smallImage(), marks), "marks.size\\(\\).*5 vs 6");
}

}  // namespace
}  // namespace gfxrepro::depth_sampling
