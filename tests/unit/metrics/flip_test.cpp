
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <thread>

#include "engine/core/random.h"
#include "engine/metrics/flip.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"
#include "tests/unit/metrics/pairs.h"

namespace gfxrepro::metrics {
namespace {

using image::ImageF;

// The method once more, from the paper: double precision, two-dimensional filters, nothing shared
// with the code under test.
using Vec = std::array<double, 3>;

/// Linear Rec. 709 to XYZ, from its primaries' chromaticities and the white of D65.
Vec xyzOf(const Vec& c) {
    return {0.4123907992659595 * c[0] + 0.3575843393838780 * c[1] + 0.1804807884018343 * c[2],
            0.2126390058715103 * c[0] + 0.7151686787677560 * c[1] + 0.0721923153607337 * c[2],
            0.0193308187155918 * c[0] + 0.1191947797946259 * c[1] + 0.9505321522496608 * c[2]};
}
const Vec kWhite = xyzOf({1.0, 1.0, 1.0});

/// Inverse of xyzOf() by Cramer's rule.
Vec rgbOf(const Vec& xyz) {
    const Vec r = xyzOf({1, 0, 0}), g = xyzOf({0, 1, 0}), b = xyzOf({0, 0, 1});
    const auto determinant = [](const Vec& p, const Vec& q, const Vec& s) {
        return p[0] * (q[1] * s[2] - q[2] * s[1]) - p[1] * (q[0] * s[2] - q[2] * s[0]) +
               p[2] * (q[0] * s[1] - q[1] * s[0]);
    };
    const double whole = determinant(r, g, b);
    return {determinant(xyz, g, b) / whole, determinant(r, xyz, b) / whole,
            determinant(r, g, xyz) / whole};
}

Vec huntLab(const Vec& rgb) {
    const Vec xyz = xyzOf(rgb);
    const auto f = [](double t) {
        return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
    };
    const double x = f(xyz[0] / kWhite[0]), y = f(xyz[1] / kWhite[1]), z = f(xyz[2] / kWhite[2]);
    const double lightness = 116.0 * y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)};
}

double hyAb(const Vec& a, const Vec& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Error of two colours that fill their images: nothing to filter, no features.
double colourError(const Vec& a, const Vec& b) {
    const double largest = std::pow(hyAb(huntLab({0, 1, 0}), huntLab({0, 0, 1})), 0.7);
    const double difference = std::pow(hyAb(huntLab(a), huntLab(b)), 0.7);
    const double knee = 0.4 * largest;
    return difference < knee ? 0.95 * difference / knee
                             : 0.95 + 0.05 * (difference - knee) / (largest - knee);
}

/// A square filter of (2·radius + 1)² weights, in pixels from the centre.
struct Filter2D {
    int radius = 0;
    std::function<double(double x, double y)> weight;

    /// Positive and negative weights each made to sum to 1 where there are both.
    double over(const std::function<double(int, int)>& values, int x, int y) const {
        double positive = 0.0, negative = 0.0, result = 0.0, negativeResult = 0.0;
        for (int j = -radius; j <= radius; ++j) {
            for (int i = -radius; i <= radius; ++i) {
                const double w = weight(i, j);
                const double value = values(x + i, y + j);
                (w > 0.0 ? positive : negative) += w;
                (w > 0.0 ? result : negativeResult) += w * value;
            }
        }
        return result / positive - (negative < 0.0 ? negativeResult / negative : 0.0);
    }
};

struct Brute {
    const ImageF& image;
    double pixelsPerDegree;

    Vec yCxCz(int x, int y) const {
        x = std::clamp(x, 0, image.width() - 1);
        y = std::clamp(y, 0, image.height() - 1);
        const Vec xyz = xyzOf({image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)});
        const Vec n = {xyz[0] / kWhite[0], xyz[1] / kWhite[1], xyz[2] / kWhite[2]};
        return {116.0 * n[1] - 16.0, 500.0 * (n[0] - n[1]), 200.0 * (n[1] - n[2])};
    }
    double achromatic(int x, int y) const { return (yCxCz(x, y)[0] + 16.0) / 116.0; }

    /// Colour as seen: filtered by contrast sensitivity, clamped, in Hunt's CIELAB.
    Vec seen(int x, int y) const {
        constexpr double kPi = std::numbers::pi;
        constexpr double kA[3][2] = {{1.0, 0.0}, {1.0, 0.0}, {34.1, 13.5}};
        constexpr double kB[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
        Vec filtered;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Filter2D sensitivity{
                static_cast<int>(
                    std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * pixelsPerDegree)),
                [&](double i, double j) {
                    const double d2 = (i * i + j * j) / (pixelsPerDegree * pixelsPerDegree);
                    double sum = 0.0;
                    for (std::size_t k = 0; k < 2; ++k) {
                        const double b = kB[channel][k];
                        sum += kA[channel][k] * std::sqrt(kPi / b) * std::exp(-kPi * kPi * d2 / b);
                    }
                    return sum;
                }};
            filtered[channel] =
                sensitivity.over([&](int i, int j) { return yCxCz(i, j)[channel]; }, x, y);
        }
        const double n = (filtered[0] + 16.0) / 116.0;
        Vec rgb = rgbOf({(n + filtered[1] / 500.0) * kWhite[0], n * kWhite[1],
                         (n - filtered[2] / 200.0) * kWhite[2]});
        for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
        return huntLab(rgb);
    }

    /// Lengths of the gradient (derivative 1) or of the second derivatives (2).
    double feature(int x, int y, int derivative) const {
        const double deviation = 0.5 * 0.082 * pixelsPerDegree;
        const auto along = [=](double u, double v) {
            const double g = std::exp(-(u * u + v * v) / (2.0 * deviation * deviation));
            return derivative == 1 ? -u * g : (u * u / (deviation * deviation) - 1.0) * g;
        };
        const int radius = static_cast<int>(std::ceil(3.0 * deviation));
        const auto values = [&](int i, int j) { return achromatic(i, j); };
        const Filter2D alongX{radius, along};
        const Filter2D alongY{radius, [&](double i, double j) { return along(j, i); }};
        return std::hypot(alongX.over(values, x, y), alongY.over(values, x, y));
    }
};

double bruteFlip(const ImageF& reference, const ImageF& test, double pixelsPerDegree, int x,
                 int y) {
    const Brute a{reference, pixelsPerDegree}, b{test, pixelsPerDegree};
    const double largest = std::pow(hyAb(huntLab({0, 1, 0}), huntLab({0, 0, 1})), 0.7);
    const double difference = std::pow(hyAb(a.seen(x, y), b.seen(x, y)), 0.7);
    const double knee = 0.4 * largest;
    const double colour = difference < knee ? 0.95 * difference / knee
                                            : 0.95 + 0.05 * (difference - knee) / (largest - knee);
    const double feature = std::sqrt(std::max(std::abs(a.feature(x, y, 1) - b.feature(x, y, 1)),
                                              std::abs(a.feature(x, y, 2) - b.feature(x, y, 2))) /
                                     std::numbers::sqrt2);
    return std::pow(colour, 1.0 - feature);
}

ImageF colouredNoise(int width, int height, std::uint64_t seed) {
    Random random(seed);
    ImageF image(width, height, 3);
    for (float& value : image.values()) value = random.uniform();
    return image;
}

/// A dark ground, a bright square, a coloured line: edges, points, and the colours between.
ImageF drawing(int width, int height, int shift) {
    ImageF image(width, height, 3, 0.05F);
    for (const auto [y, x] : test::grid(height, width)) {
        const int u = x - shift;
        if (u >= 5 && u < 14 && y >= 4 && y < 12) {
            image.at(x, y, 0) = 0.9F;
            image.at(x, y, 1) = 0.7F;
        }
        if (u == 17) image.at(x, y, 2) = 1.0F;
    }
    return image;
}

ImageF filled(int width, int height, const std::array<float, 3>& colour) {
    ImageF image(width, height, 3);
    for (std::size_t i = 0; i < image.values().size(); ++i) image.values()[i] = colour[i % 3];
    return image;
}

template <class Source>
ImageF remapped(const ImageF& image, int width, int height, Source&& source) {
    ImageF result(width, height, image.channels());
    for (const auto [y, x] : test::grid(height, width)) {
        const auto [fromX, fromY] = source(x, y);
        for (int c = 0; c < image.channels(); ++c) {
            result.at(x, y, c) = image.at(fromX, fromY, c);
        }
    }
    return result;
}

void expectNear(const ImageF& a, const ImageF& b, float tolerance) {
    ASSERT_EQ(a.width(), b.width());
    ASSERT_EQ(a.height(), b.height());
    for (const auto [y, x] : test::grid(a.height(), a.width())) {
        ASSERT_NEAR(a.at(x, y), b.at(x, y), tolerance) << "at (" << x << ", " << y << ")";
    }
}

TEST(Flip, EqualImagesDoNotDiffer) {
    const ImageF a = colouredNoise(31, 17, 1);
    const ImageF map = flipMap(a, a);
    for (const float value : map.values()) EXPECT_EQ(value, 0.0F);
    EXPECT_EQ(flip(a, a), 0.0);
}

/// Nothing to filter and no features: the colours' difference alone.
TEST(Flip, ConstantImagesDifferByTheirColours) {
    const std::array<float, 3> colours[] = {
        {0, 0, 0},          {1, 1, 1},       {0.18F, 0.2F, 0.24F},
        {0.2F, 0.2F, 0.2F}, {1, 0.5F, 0.1F}, {0.001F, 0, 0}};
    for (const auto& a : colours) {
        for (const auto& b : colours) {
            EXPECT_NEAR(flip(filled(13, 9, a), filled(13, 9, b)),
                        colourError({a[0], a[1], a[2]}, {b[0], b[1], b[2]}), 1e-4);
        }
    }
    // By definition the largest; and black and white differ in lightness alone, by 100.
    EXPECT_NEAR(flip(filled(4, 4, {0, 1, 0}), filled(4, 4, {0, 0, 1})), 1.0, 1e-6);
    EXPECT_NEAR(flip(filled(4, 4, {0, 0, 0}), filled(4, 4, {1, 1, 1})), 0.967379, 5e-5);
}

TEST(Flip, FollowsTheDefinition) {
    struct Case {
        ImageF reference, test;
        double pixelsPerDegree;
    };
    const Case cases[] = {{drawing(26, 19, 0), drawing(26, 19, 2), kFlipPixelsPerDegree},
                          {drawing(26, 19, 0), filled(26, 19, {0.05F, 0.05F, 0.05F}), 20.0},
                          {colouredNoise(15, 22, 2), colouredNoise(15, 22, 3), 40.0},
                          {colouredNoise(7, 1, 4), drawing(7, 1, -5), kFlipPixelsPerDegree}};
    for (const Case& c : cases) {
        const ImageF map = flipMap(c.reference, c.test, c.pixelsPerDegree);
        double sum = 0.0;
        for (const auto [y, x] : test::grid(map.height(), map.width())) {
            const double expected = bruteFlip(c.reference, c.test, c.pixelsPerDegree, x, y);
            sum += expected;
            // D65 as the reference implementation rounds it, and single precision.
            EXPECT_NEAR(map.at(x, y), expected, 3e-4) << "at (" << x << ", " << y << ")";
        }
        EXPECT_NEAR(flip(c.reference, c.test, c.pixelsPerDegree),
                    sum / (map.width() * map.height()), 1e-4);
    }
}

TEST(Flip, OfAReferenceThatIsSeenOnceIsTheSame) {
    const ImageF reference = drawing(26, 19, 0);
    const FlipReference seen(reference, 40.0);
    for (const int shift : {0, 1, 3}) {
        const ImageF test = drawing(26, 19, shift);
        EXPECT_EQ(seen.mapOf(test), flipMap(reference, test, 40.0)) << shift;
    }
    EXPECT_EQ(errorText([&] { seen.mapOf(ImageF(3, 3, 3)); }),
              "the images differ in shape: 26x19 with 3 channels and 3x3 with 3 channels");
    EXPECT_EQ(errorText([] { FlipReference(ImageF(2, 3, 1)); }),
              "FLIP compares images of 3 channels, found 1");
}

/// Neither direction of the features is preferred, nor one image.
TEST(Flip, IsSymmetric) {
    const int width = 26, height = 19;
    const ImageF a = drawing(width, height, 0), b = drawing(width, height, 3);
    const ImageF map = flipMap(a, b);
    EXPECT_GT(*std::max_element(map.values().begin(), map.values().end()), 0.5F);
    EXPECT_EQ(flipMap(b, a), map);
    const auto transposed = [&](const ImageF& image) {
        return remapped(image, height, width, [](int x, int y) { return std::pair(y, x); });
    };
    expectNear(flipMap(transposed(a), transposed(b)), transposed(map), 1e-4F);
    const auto turned = [&](const ImageF& image) {
        return remapped(image, width, height,
                        [&](int x, int y) { return std::pair(width - 1 - x, height - 1 - y); });
    };
    expectNear(flipMap(turned(a), turned(b)), turned(map), 1e-4F);
}

TEST(Flip, ClampsWhatADisplayCannotShow) {
    const ImageF a = filled(5, 5, {2.0F, -1.0F, 0.5F}), b = filled(5, 5, {1.0F, 0.0F, 0.5F});
    EXPECT_EQ(flip(a, b), 0.0);
}

TEST(Flip, OfFilesTakesNoMoreThan8192SquaredPixels) {
    requireFlipSize(ImageF(32768, 2048, 1));
    EXPECT_EQ(errorText([] { requireFlipSize(ImageF(32768, 2049, 1)); }),
              "FLIP compares pictures of at most 8192² pixels, found 32768 x 2049");
}

TEST(Flip, LargePicturesAreTakenOneAfterAnother) {
    constexpr std::int64_t kSmall = 2048 * 2048, kLarge = kSmall + 1;
    std::atomic<int> atOnce = 0, mostAtOnce = 0;
    std::array<std::atomic<int>, 16> calls{};
    forEachPicture(
        calls.size(), [&](std::size_t i) { return i % 2 == 0 ? kSmall : kLarge; },
        [&](std::size_t i) {
            ++calls[i];
            if (i % 2 == 0) return;
            mostAtOnce = std::max(mostAtOnce.load(), ++atOnce);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            --atOnce;
        });
    EXPECT_EQ(mostAtOnce, 1);
    for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
}

TEST(Flip, RefusesWhatCannotBeCompared) {
    EXPECT_EQ(errorText([] { flip(ImageF(2, 3, 3), ImageF(3, 3, 3)); }),
              "the images differ in shape: 2x3 with 3 channels and 3x3 with 3 channels");
    EXPECT_EQ(errorText([] { flip(ImageF(2, 3, 4), ImageF(2, 3, 4)); }),
              "FLIP compares images of 3 channels, found 4");
    EXPECT_EQ(errorText([] { flip(ImageF(), ImageF()); }), "the images are empty");
    ImageF bad(3, 2, 3);
    bad.at(2, 1, 1) = std::numeric_limits<float>::infinity();
    EXPECT_EQ(errorText([&] { flip(bad, ImageF(3, 2, 3)); }),
              "the first image holds inf at pixel (2, 1)");
    EXPECT_EQ(errorText([] { flip(ImageF(2, 2, 3), ImageF(2, 2, 3), 0.5); }),
              "FLIP allows 1 to 1000 pixels a degree, found 0.5");
    EXPECT_EQ(errorText([] {
                  flip(ImageF(2, 2, 3), ImageF(2, 2, 3), std::numeric_limits<double>::quiet_NaN());
              }),
              "FLIP allows 1 to 1000 pixels a degree, found nan");
}

/// One luminance is compared at one exposure, that which shows it as 0.85.
TEST(HdrFlip, ConstantReferenceHasOneExposure) {
    const ImageF grey(4, 4, 3, 8.0F);
    const Exposures exposures = flipExposures(grey);
    EXPECT_EQ(exposures.count, 1);
    EXPECT_EQ(exposures.start, exposures.stop);
    const double x = 8.0 * std::exp2(exposures.start);
    EXPECT_NEAR((0.9036 * x * x + 0.018 * x) / (0.8748 * x * x + 0.354 * x + 0.14), 0.85, 1e-6);
}

/// Twice the light moves the exposures by one stop and no error.
TEST(HdrFlip, DoesNotDependOnTheScaleOfTheLight) {
    const ImageF a = ranged(shapes(60, 40, 0)), b = ranged(shapes(60, 40, 3));
    ImageF a2 = a, b2 = b;
    for (float& value : a2.values()) value *= 2.0F;
    for (float& value : b2.values()) value *= 2.0F;
    EXPECT_NEAR(flipExposures(a2).start, flipExposures(a).start - 1.0, 1e-6);
    EXPECT_NEAR(hdrFlip(a2, b2), hdrFlip(a, b), 1e-5);
}

/// A difference far above 1 is none for LDR-FLIP, and one in the dark is small.
TEST(HdrFlip, SeesWhatOneExposureHides) {
    ImageF a(40, 20, 3, 0.5F), b = a;
    for (int y = 5; y < 10; ++y) {
        for (int x = 5; x < 10; ++x) {
            for (int c = 0; c < 3; ++c) {
                a.at(x, y, c) = 100.0F;
                b.at(x, y, c) = 10.0F;
            }
        }
    }
    EXPECT_EQ(flip(a, b), 0.0);
    EXPECT_GT(hdrFlip(a, b), 0.02);
    EXPECT_EQ(hdrFlip(a, a), 0.0);
}

TEST(HdrFlip, BlackReferences) {
    const ImageF black(6, 6, 3);
    EXPECT_EQ(flipExposures(black).count, 1);
    EXPECT_EQ(hdrFlip(black, black), 0.0);
    // Most is black: the median of the rest.
    ImageF spot = black;
    for (int c = 0; c < 3; ++c) spot.at(0, 0, c) = 2.0F;
    for (int c = 0; c < 3; ++c) spot.at(1, 0, c) = -3.0F;  // counts as black
    const Exposures exposures = flipExposures(spot);
    EXPECT_EQ(exposures.count, 1);
    EXPECT_TRUE(std::isfinite(exposures.stop));
    EXPECT_GT(hdrFlip(spot, black), 0.0);
}

TEST(HdrFlip, RefusesWhatCannotBeCompared) {
    EXPECT_EQ(errorText([] { hdrFlip(ImageF(2, 3, 3), ImageF(3, 3, 3)); }),
              "the images differ in shape: 2x3 with 3 channels and 3x3 with 3 channels");
    EXPECT_EQ(errorText([] { hdrFlip(ImageF(2, 3, 1), ImageF(2, 3, 1)); }),
              "FLIP compares images of 3 channels, found 1");
}

}  // namespace

}  // namespace gfxrepro::metrics
