// What well-kept implementations of others give for the pairs of pairs.h.
//
// FLIP: the published reference implementation, NVlabs/flip, python/flip_api.py at commit 313517b4,
// run with NumPy 1.24.2 and its defaults (67.02 pixels a degree; HDR: ACES, exposures from the
// reference); its calls of OpenCV's filter2D with replicated borders were SciPy's correlate with
// mode='nearest'. LDR-FLIP takes sRGB: the pairs were encoded by the same code first.
// SSIM, PSNR, MSE: scikit-image 0.19.3, structural_similarity(…, gaussian_weights=True, sigma=1.5,
// use_sample_covariance=False, data_range=1) of the luminance 0.2126 R + 0.7152 G + 0.0722 B in
// double precision, peak_signal_noise_ratio(…, data_range=1), mean_squared_error().

#include <filesystem>

#include "engine/core/files.h"
#include "engine/image/exr_io.h"
#include "engine/metrics/flip.h"
#include "engine/metrics/image_error.h"
#include "tests/support/support.h"
#include "tests/unit/metrics/pairs.h"

namespace gfxrepro::metrics {
namespace {

using image::ImageF;

/// What is printed with four decimals is the same.
constexpr double kFourDecimals = 5e-5;

struct Pair {
    ImageF reference, test;
};

Pair shiftedPair() {
    return {shapes(120, 80, 0), shapes(120, 80, 2)};
}

Pair noisyPair() {
    const ImageF reference = shapes(120, 80, 0);
    return {reference, noisy(reference, 0.1F, 7)};
}

Pair blurredPair() {
    const ImageF reference = shapes(120, 80, 0);
    return {reference, blurred(reference)};
}

TEST(ReferenceValues, Flip) {
    const Pair shifted = shiftedPair(), noise = noisyPair(), blur = blurredPair();
    EXPECT_NEAR(flip(shifted.reference, shifted.test), 0.098931, kFourDecimals);
    EXPECT_NEAR(flip(noise.reference, noise.test), 0.110460, kFourDecimals);
    EXPECT_NEAR(flip(blur.reference, blur.test), 0.030757, kFourDecimals);
}

TEST(ReferenceValues, HdrFlip) {
    const Pair shifted = shiftedPair(), noise = noisyPair();
    const ImageF reference = ranged(shifted.reference);
    const Exposures exposures = flipExposures(reference);
    EXPECT_NEAR(exposures.start, -2.717553, 1e-5);
    EXPECT_NEAR(exposures.stop, 2.881592, 1e-5);
    EXPECT_EQ(exposures.count, 6);
    EXPECT_NEAR(hdrFlip(reference, ranged(shifted.test)), 0.073821, kFourDecimals);
    EXPECT_NEAR(hdrFlip(reference, ranged(noise.test)), 0.109833, kFourDecimals);
    EXPECT_NEAR(hdrFlip(reference, blurred(reference)), 0.063445, kFourDecimals);
}

/// Values up to 976 against their blurred and their shifted selves, and one that is mostly
/// blue: exr/ of the assets, from OpenEXR's collection of images.
TEST(ReferenceValues, HdrFlipOfRealImages) {
    const fs::path folder = assetsFolder() / "exr";
    if (!fs::exists(folder)) GTEST_SKIP() << "no images in " << folder;
    struct Expected {
        const char* file;
        double start, stop;
        int count;
        double blurred, shifted;
    };
    for (const Expected& e :
         {Expected{"BrightRings.exr", -8.848180, 1.083297, 10, 0.006446, 0.006631},
          Expected{"t01.exr", 1.191411, 4.875154, 4, 0.398132, 0.021507}}) {
        SCOPED_TRACE(e.file);
        const ImageF whole = image::readExr(folder / e.file).colour();
        const int left = whole.width() / 2 - 100, top = whole.height() / 2 - 80;
        const ImageF reference = cropped(whole, left, top, 200, 160);
        const Exposures exposures = flipExposures(reference);
        EXPECT_NEAR(exposures.start, e.start, 1e-5);
        EXPECT_NEAR(exposures.stop, e.stop, 1e-5);
        EXPECT_EQ(exposures.count, e.count);
        EXPECT_NEAR(hdrFlip(reference, blurred(reference)), e.blurred, kFourDecimals);
        EXPECT_NEAR(hdrFlip(reference, cropped(whole, left + 2, top, 200, 160)), e.shifted,
                    kFourDecimals);
    }
}

TEST(ReferenceValues, SimilarityAndNoise) {
    const Pair shifted = shiftedPair(), noise = noisyPair(), blur = blurredPair();
    const auto expect = [](const Pair& pair, double ssim, double psnrDb, double mse) {
        EXPECT_NEAR(structuralSimilarity(pair.reference, pair.test), ssim, 1e-7);
        EXPECT_NEAR(peakSignalToNoiseDb(pair.reference, pair.test), psnrDb, 1e-6);
        EXPECT_NEAR(meanSquaredError(pair.reference, pair.test), mse, 1e-10);
    };
    expect(shifted, 0.74158928, 21.85593429, 0.006522387028);
    expect(noise, 0.52134392, 24.92879431, 0.003214552845);
    expect(blur, 0.89256062, 28.46113475, 0.001425235156);
}

}  // namespace
}  // namespace gfxrepro::metrics
