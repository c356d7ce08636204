#include "engine/metrics/image_error.h"

#include <cmath>
#include <limits>

#include "engine/core/random.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::metrics {
namespace {

using image::ImageF;

ImageF noise(int width, int height, int channels, std::uint64_t seed) {
    Random random(seed);
    ImageF image(width, height, channels);
    for (float& value : image.values()) value = random.uniform();
    return image;
}

TEST(ImageError, KnownAnswers) {
    ImageF a(2, 1, 3, 0.5F);
    ImageF b = a;
    b.at(1, 0, 2) = 0.75F;
    EXPECT_DOUBLE_EQ(meanSquaredError(a, b), 0.0625 / 6.0);
    EXPECT_DOUBLE_EQ(peakSignalToNoiseDb(a, b), 10.0 * std::log10(96.0));
    // One value in six: (0.5 − 0.75)² ÷ (0.5² + 0.01), and the other way about by 0.75².
    EXPECT_DOUBLE_EQ(relativeMeanSquaredError(a, b), 0.0625 / 0.26 / 6.0);
    EXPECT_DOUBLE_EQ(relativeMeanSquaredError(b, a), 0.0625 / 0.5725 / 6.0);
    EXPECT_DOUBLE_EQ(maxAbsoluteError(a, b), 0.25);
    EXPECT_EQ(peakSignalToNoiseDb(a, a), std::numeric_limits<double>::infinity());
    const ImageF difference = absoluteDifference(b, a, 4.0F);
    EXPECT_EQ(difference.at(1, 0, 2), 1.0F);
    EXPECT_EQ(difference.at(0, 0, 0), 0.0F);
}

TEST(ImageError, SimilarityOfEqualImagesIsOne) {
    const ImageF a = noise(24, 17, 3, 1);
    EXPECT_NEAR(structuralSimilarity(a, a), 1.0, 1e-12);
}

/// Constant images have no variance: what is left is the luminance term, (2ab + C₁)/(a² + b² + C₁).
TEST(ImageError, SimilarityOfConstantImages) {
    const ImageF a(16, 16, 1, 0.5F);
    const ImageF b(16, 16, 1, 0.25F);
    EXPECT_NEAR(structuralSimilarity(a, b), (0.25 + 1e-4) / (0.3125 + 1e-4), 1e-9);
}

/// Against the definition, summed window by window.
TEST(ImageError, SimilarityFollowsTheDefinition) {
    const ImageF a = noise(14, 13, 1, 2);
    const ImageF b = noise(14, 13, 1, 3);
    double total = 0.0;
    for (int y0 = 0; y0 + 11 <= 13; ++y0) {
        for (int x0 = 0; x0 + 11 <= 14; ++x0) {
            double weight = 0.0, ma = 0.0, mb = 0.0, va = 0.0, vb = 0.0, cov = 0.0;
            const auto g = [](int i, int j) {
                return std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / 4.5);
            };
            for (const auto [j, i] : test::grid(11, 11)) {
                weight += g(i, j);
                ma += g(i, j) * double{a.at(x0 + i, y0 + j)};
                mb += g(i, j) * double{b.at(x0 + i, y0 + j)};
            }
            ma /= weight;
            mb /= weight;
            for (const auto [j, i] : test::grid(11, 11)) {
                const double da = double{a.at(x0 + i, y0 + j)} - ma;
                const double db = double{b.at(x0 + i, y0 + j)} - mb;
                va += g(i, j) / weight * da * da;
                vb += g(i, j) / weight * db * db;
                cov += g(i, j) / weight * da * db;
            }
            total += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) /
                     ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
        }
    }
    EXPECT_NEAR(structuralSimilarity(a, b), total / 12.0, 1e-10);
}

TEST(ImageError, ColourIsComparedByLuminance) {
    ImageF green(16, 16, 3);
    ImageF grey(16, 16, 1, 0.7152F);
    for (const auto [y, x] : test::grid(16, 16)) green.at(x, y, 1) = 1.0F;
    ImageF black3(16, 16, 3);
    ImageF black1(16, 16, 1);
    EXPECT_NEAR(structuralSimilarity(green, black3), structuralSimilarity(grey, black1), 1e-6);
}

TEST(ImageError, RefusesWhatCannotBeCompared) {
    EXPECT_EQ(errorText([] { meanSquaredError(ImageF(2, 3, 1), ImageF(2, 3, 4)); }),
              "the images differ in shape: 2x3 with 1 channel and 2x3 with 4 channels");
    EXPECT_EQ(errorText([] { meanSquaredError(ImageF(), ImageF()); }), "the images are empty");
    ImageF bad(3, 2, 1);
    bad.at(2, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(errorText([&] { maxAbsoluteError(ImageF(3, 2, 1), bad); }),
              "the second image holds nan at pixel (2, 1)");
    EXPECT_EQ(
        errorText([] { structuralSimilarity(ImageF(10, 20, 3), ImageF(10, 20, 3)); }),
        "structural similarity needs images of at least 11x11 pixels, found 10x20 with 3 channels");
}

}  // namespace
}  // namespace gfxrepro::metrics
