#include "engine/image/resample.h"

#include <cmath>

#include <limits>
#include <string>

#include "engine/image/contact_sheet.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::image {
namespace {

/// Each pixel holds 10·y + x.
ImageF numbered(int width, int height) {
    ImageF image(width, height, 1);
    for (const auto [y, x] : test::grid(height, width))
        image.at(x, y) = static_cast<float>(10 * y + x);
    return image;
}

TEST(Cropped, TakesThePartAndMagnifies) {
    const ImageF part = cropped(numbered(6, 5), {2, 1, 3, 2}, 2);
    ASSERT_EQ(part.width(), 6);
    ASSERT_EQ(part.height(), 4);
    EXPECT_EQ(part.at(0, 0), 12.0F);
    EXPECT_EQ(part.at(1, 1), 12.0F);
    EXPECT_EQ(part.at(2, 1), 13.0F);
    EXPECT_EQ(part.at(5, 3), 24.0F);
    EXPECT_EQ(cropped(numbered(6, 5), {0, 0, 6, 5}), numbered(6, 5));
}

TEST(Cropped, RefusesWhatIsNoPart) {
    const ImageF image = numbered(6, 5);
    const int most = std::numeric_limits<int>::max();
    for (const Rectangle part : {Rectangle{-1, 0, 2, 2},
                                 {0, 4, 1, 2},
                                 {0, 0, 0, 1},
                                 {0, 0, 1, -1},
                                 {most, 0, 1, 1},
                                 {1, 1, most, 1}}) {
        EXPECT_THAT(errorText([&] { cropped(image, part); }),
                    HasSubstr("are no part of an image of 6x5"));
    }
    EXPECT_EQ(errorText([&] {
                  cropped(image, {0, 0, 4, 2}, 8193);
              }),
              "4x2 pixels from (0, 0) cannot be magnified 8193 times; 1 to 8192 times are allowed");
}

/// A single white pixel gives each pixel its own weight: the product of two normalized Gaussians.
TEST(GaussianAveraged, WeighsByDistanceToTheBlocksMiddle) {
    ImageF image(12, 8, 2);
    image.at(5, 2, 1) = 1.0F;
    const ImageF half = gaussianAveraged(image, 2, 1.5);
    ASSERT_EQ(half.width(), 6);
    ASSERT_EQ(half.height(), 4);
    const auto weight = [](double middle, int pixel, int size) {
        const auto at = [&](int i) {
            const double away = (i + 0.5 - middle) / 1.5;
            return std::abs(away) <= 3.0 ? std::exp(-0.5 * away * away) : 0.0;
        };
        double sum = 0.0;
        for (int i = 0; i < size; ++i) sum += at(i);
        return at(pixel) / sum;
    };
    for (const auto [y, x] : test::grid(4, 6)) {
        EXPECT_NEAR(half.at(x, y, 1), weight(2 * x + 1, 5, 12) * weight(2 * y + 1, 2, 8), 1e-6);
        EXPECT_EQ(half.at(x, y, 0), 0.0F);
    }
    // What is the same everywhere stays, at the border, too.
    const ImageF grey = gaussianAveraged(ImageF(8, 8, 1, 0.25F), 4, 4.0);
    for (const float value : grey.values()) EXPECT_NEAR(value, 0.25F, 1e-6F);
}

/// Light is averaged, not sRGB values: black and white make 188, not 128.
TEST(ResizedTo, AveragesLight) {
    Image8 image(4, 2, 1);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 4; x += 2) image.at(x, y) = 255;
    }
    const Image8 half = resizedTo(image, 2);
    ASSERT_EQ(half.height(), 1);
    EXPECT_EQ(half.at(0, 0), 188);
    EXPECT_EQ(half.at(1, 0), 188);
}

/// Three pixels on two: each takes two thirds of its own and a third of the middle one.
TEST(ResizedTo, SharesPixelsAndMagnifies) {
    Image8 image(3, 3, 1);
    for (int y = 0; y < 3; ++y) image.at(0, y) = 255;
    const Image8 two = resizedTo(image, 2);
    EXPECT_EQ(two.at(0, 0), toSrgb8(ImageF(1, 1, 1, 2.0F / 3.0F)).at(0, 0));
    EXPECT_EQ(two.at(1, 1), 0);
    const Image8 large = resizedTo(image, 9);
    EXPECT_EQ(large.at(2, 8), 255);
    EXPECT_EQ(large.at(3, 8), 0);
    EXPECT_EQ(resizedTo(Image8(100, 1, 3, 7), 3).height(), 1);
    EXPECT_EQ(errorText([] { resizedTo(Image8(1, 32768, 1), 2); }),
              "an image of 1x32768 would have 2x65536 pixels; 32768 a side are allowed");
}

TEST(Text, LettersAreDrawnFromTheUpperLeftAndCutAtTheEdges) {
    Image8 image(14, 9, 3, 0);
    drawText(image, 1, 1, "Lé", 200);
    std::string seen;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) seen += image.at(x, y, 1) == 200 ? '#' : '.';
        seen += '\n';
    }
    EXPECT_EQ(seen,
              "..............\n"
              ".#......###...\n"
              ".#.....#...#.#\n"
              ".#.........#..\n"
              ".#........#...\n"
              ".#.......#....\n"
              ".#............\n"
              ".#####...#....\n"
              "..............\n");
}

TEST(ContactSheet, LaysAlphaOverTheGroundAndRefuses) {
    Image8 clear(4, 4, 4, 255);
    for (const auto [y, x] : test::grid(4, 4)) clear.at(x, y, 3) = 0;
    const Image8 images[] = {clear, Image8(4, 2, 2, 255)};
    SheetLayout layout;
    layout.columns = 5;  // more than there are images
    layout.cellWidthPx = 4;
    layout.gapPx = 1;
    const Image8 sheet = contactSheet(images, layout);
    EXPECT_EQ(sheet.width(), 11);
    EXPECT_EQ(sheet.height(), 6);
    EXPECT_EQ(sheet.at(2, 2, 0), 96);
    EXPECT_EQ(sheet.at(7, 1, 2), 255);
    EXPECT_EQ(errorText([&] { contactSheet({}, layout); }), "a contact sheet needs an image");
    EXPECT_EQ(errorText([&] { contactSheet(std::vector<Image8>(1), layout); }), "image 1 is empty");
    layout.cellWidthPx = 30000;
    EXPECT_EQ(errorText([&] { contactSheet(images, layout); }),
              "the sheet would have 60003x30002 pixels; 32768 a side are allowed");
    layout.columns = 0;
    EXPECT_EQ(errorText([&] { contactSheet(images, layout); }),
              "a contact sheet of 0 columns of 30000 pixels has no size");
}

}  // namespace
}  // namespace gfxrepro::image
