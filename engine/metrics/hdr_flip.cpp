// Andersson, Nilsson, Shirley, Akenine-Möller 2021, "Visualizing Errors in Rendered High Dynamic
// Range Images". Exposures, their number and the tone mapper are the defaults of the published
// reference implementation.
#include "engine/metrics/hdr_flip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/image/tone_map.h"
#include "engine/metrics/image_error.h"

namespace gfxrepro::metrics {

namespace {

using image::ImageF;

/// The positive luminances of linear Rec. 709 colour, and how many there are in all.
struct Luminances {
    std::vector<double> positive;
    std::size_t count = 0;
};

Luminances luminancesOf(const ImageF& image) {
    Luminances result;
    const std::span<const float> values = image.values();
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        const double luminance = 0.2126 * std::max(values[i], 0.0F) +
                                 0.7152 * std::max(values[i + 1], 0.0F) +
                                 0.0722 * std::max(values[i + 2], 0.0F);
        if (luminance > 0.0) result.positive.push_back(luminance);
        ++result.count;
    }
    return result;
}

/// Of all `count` values, of which those that are not given are 0; of those given where it is 0.
double medianOfPositive(std::vector<double>& positive, std::size_t count) {
    std::sort(positive.begin(), positive.end());
    const std::size_t zeros = count - positive.size();
    const auto at = [&](std::size_t i) { return i < zeros ? 0.0 : positive[i - zeros]; };
    const double median = 0.5 * (at((count - 1) / 2) + at(count / 2));
    if (median > 0.0) return median;
    return 0.5 * (positive[(positive.size() - 1) / 2] + positive[positive.size() / 2]);
}

/// Which value the ACES curve shows as 0.85: the positive root of a quadratic.
double shownAs85() {
    const image::AcesCurve curve;
    constexpr double kShown = 0.85;
    const double a = curve.n2 - kShown * curve.d2;
    const double b = curve.n1 - kShown * curve.d1;
    const double c = -kShown * curve.d0;
    return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

}  // namespace

ImageF coloursOf(const ImageF& image) {
    ImageF result(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < 3; ++c) {
                result.at(x, y, c) = image.at(x, y, image.channels() < 3 ? 0 : c);
            }
        }
    }
    return result;
}

bool exceedsDisplay(const ImageF& image) {
    return std::ranges::any_of(image.values(), [](float value) { return value > 1.0F; });
}

Exposures flipExposures(const ImageF& reference) {
    Luminances luminances = luminancesOf(reference);
    if (luminances.positive.empty()) return {};
    const double most = *std::max_element(luminances.positive.begin(), luminances.positive.end());
    Exposures exposures;
    exposures.start = std::log2(shownAs85() / most);
    exposures.stop =
        std::log2(shownAs85() / medianOfPositive(luminances.positive, luminances.count));
    const double stops = exposures.stop - exposures.start;
    if (stops > 0.0) exposures.count = std::max(2, static_cast<int>(std::ceil(stops)));
    return exposures;
}

ImageF hdrFlipMap(const ImageF& reference, const ImageF& test, double pixelsPerDegree) {
    requireComparable(reference, test);
    const Exposures exposures = flipExposures(reference);
    const double step =
        (exposures.stop - exposures.start) / static_cast<double>(std::max(exposures.count - 1, 1));
    ImageF map(reference.width(), reference.height(), 1);
    for (int i = 0; i < exposures.count; ++i) {
        const auto exposure = static_cast<float>(exposures.start + i * step);
        const ImageF ofExposure =
            flipMap(image::toneMapped(reference, exposure, image::ToneMap::Aces),
                    image::toneMapped(test, exposure, image::ToneMap::Aces), pixelsPerDegree);
        std::transform(map.values().begin(), map.values().end(), ofExposure.values().begin(),
                       map.values().begin(), [](float a, float b) { return std::max(a, b); });
    }
    return map;
}

double hdrFlip(const ImageF& reference, const ImageF& test, double pixelsPerDegree) {
    return meanOfFlip(hdrFlipMap(reference, test, pixelsPerDegree));
}

}  // namespace gfxrepro::metrics
