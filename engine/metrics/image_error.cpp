#include "engine/metrics/image_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/core/error.h"

namespace gfxrepro::metrics {
namespace {

using image::ImageF;

std::string shape(const ImageF& image) {
    return std::to_string(image.width()) + "x" + std::to_string(image.height()) + " with " +
           std::to_string(image.channels()) + (image.channels() == 1 ? " channel" : " channels");
}

void checkFinite(const ImageF& image, const char* which) {
    for (std::size_t i = 0; i < image.values().size(); ++i) {
        if (std::isfinite(image.values()[i])) continue;
        const std::size_t pixel = i / static_cast<std::size_t>(image.channels());
        const auto width = static_cast<std::size_t>(image.width());
        throw Error("the " + std::string(which) + " image holds " +
                    std::to_string(image.values()[i]) + " at pixel (" +
                    std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")");
    }
}

/// One channel: itself; three or four: luminance of linear Rec. 709 colour; two: the first.
std::vector<double> luminance(const ImageF& image) {
    const auto channels = static_cast<std::size_t>(image.channels());
    std::vector<double> result(image.values().size() / channels);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const float* pixel = &image.values()[i * channels];
        result[i] = channels < 3 ? double{pixel[0]}
                                 : 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
    }
    return result;
}

constexpr int kWindow = 11;

/// Weights of the 11-tap Gaussian with σ = 1.5, summing to 1.
std::array<double, kWindow> gaussianWeights() {
    std::array<double, kWindow> weights{};
    double sum = 0.0;
    for (int i = 0; i < kWindow; ++i) {
        const double x = i - kWindow / 2;
        weights[static_cast<std::size_t>(i)] = std::exp(-x * x / (2.0 * 1.5 * 1.5));
        sum += weights[static_cast<std::size_t>(i)];
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Separable weighted mean over each window that lies wholly inside: (width − 10) × (height − 10).
std::vector<double> windowMeans(const std::vector<double>& values, int width, int height) {
    const std::array<double, kWindow> weights = gaussianWeights();
    const int outWidth = width - kWindow + 1;
    const int outHeight = height - kWindow + 1;
    const auto at = [](int x, int y, int stride) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) +
               static_cast<std::size_t>(x);
    };
    std::vector<double> rows(at(0, height, outWidth));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < outWidth; ++x) {
            for (int i = 0; i < kWindow; ++i) {
                rows[at(x, y, outWidth)] +=
                    weights[static_cast<std::size_t>(i)] * values[at(x + i, y, width)];
            }
        }
    }
    std::vector<double> means(at(0, outHeight, outWidth));
    for (int y = 0; y < outHeight; ++y) {
        for (int i = 0; i < kWindow; ++i) {
            for (int x = 0; x < outWidth; ++x) {
                means[at(x, y, outWidth)] +=
                    weights[static_cast<std::size_t>(i)] * rows[at(x, y + i, outWidth)];
            }
        }
    }
    return means;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::multiplies<>());
    return result;
}

}  // namespace

void requireComparable(const ImageF& a, const ImageF& b) {
    if (a.width() != b.width() || a.height() != b.height() || a.channels() != b.channels()) {
        throw Error("the images differ in shape: " + shape(a) + " and " + shape(b));
    }
    if (a.empty()) throw Error("the images are empty");
    checkFinite(a, "first");
    checkFinite(b, "second");
}

double meanSquaredError(const ImageF& a, const ImageF& b) {
    requireComparable(a, b);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.values().size(); ++i) {
        const double difference = double{a.values()[i]} - double{b.values()[i]};
        sum += difference * difference;
    }
    return sum / static_cast<double>(a.values().size());
}

double peakSignalToNoiseDb(const ImageF& a, const ImageF& b) {
    return 10.0 * std::log10(1.0 / meanSquaredError(a, b));
}

double relativeMeanSquaredError(const ImageF& truth, const ImageF& test) {
    requireComparable(truth, test);
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.values().size(); ++i) {
        const double value = truth.values()[i];
        const double difference = value - double{test.values()[i]};
        sum += difference * difference / (value * value + 0.01);
    }
    return sum / static_cast<double>(truth.values().size());
}

std::vector<double> largestDifferences(const ImageF& a, const ImageF& b) {
    requireComparable(a, b);
    const auto channels = static_cast<std::size_t>(a.channels());
    std::vector<double> largest(a.values().size() / channels, 0.0);
    for (std::size_t i = 0; i < a.values().size(); ++i) {
        const double difference = std::abs(double{a.values()[i]} - b.values()[i]);
        largest[i / channels] = std::max(largest[i / channels], difference);
    }
    return largest;
}

double maxAbsoluteError(const ImageF& a, const ImageF& b) {
    requireComparable(a, b);
    double largest = 0.0;
    for (std::size_t i = 0; i < a.values().size(); ++i) {
        largest = std::max(largest, std::abs(double{a.values()[i]} - double{b.values()[i]}));
    }
    return largest;
}

double structuralSimilarity(const ImageF& a, const ImageF& b) {
    requireComparable(a, b);
    if (a.width() < kWindow || a.height() < kWindow) {
        throw Error("structural similarity needs images of at least 11x11 pixels, found " +
                    shape(a));
    }
    const std::vector<double> x = luminance(a);
    const std::vector<double> y = luminance(b);
    const auto means = [&](const std::vector<double>& values) {
        return windowMeans(values, a.width(), a.height());
    };
    const std::vector<double> meanX = means(x);
    const std::vector<double> meanY = means(y);
    const std::vector<double> meanXX = means(product(x, x));
    const std::vector<double> meanYY = means(product(y, y));
    const std::vector<double> meanXY = means(product(x, y));
    // Wang et al. 2004, Eq. (13) with α = β = γ = 1, L = 1, K₁ = 0.01, K₂ = 0.03; mean by Eq. (17).
    constexpr double kC1 = 0.01 * 0.01;
    constexpr double kC2 = 0.03 * 0.03;
    double sum = 0.0;
    for (std::size_t i = 0; i < meanX.size(); ++i) {
        const double varianceX = meanXX[i] - meanX[i] * meanX[i];
        const double varianceY = meanYY[i] - meanY[i] * meanY[i];
        const double covariance = meanXY[i] - meanX[i] * meanY[i];
        sum += (2.0 * meanX[i] * meanY[i] + kC1) * (2.0 * covariance + kC2) /
               ((meanX[i] * meanX[i] + meanY[i] * meanY[i] + kC1) * (varianceX + varianceY + kC2));
    }
    return sum / static_cast<double>(meanX.size());
}

ImageF absoluteDifference(const ImageF& a, const ImageF& b, float gain) {
    requireComparable(a, b);
    ImageF result(a.width(), a.height(), a.channels());
    for (std::size_t i = 0; i < a.values().size(); ++i) {
        result.values()[i] = std::abs(a.values()[i] - b.values()[i]) * gain;
    }
    return result;
}

}  // namespace gfxrepro::metrics
