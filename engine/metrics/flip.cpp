// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, "FLIP: A Difference
// Evaluator for Alternating Images". Constants and borders are those of the published reference
// implementation, so that values compare with values that others print.
#include "engine/metrics/flip.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/core/wide.h"
#include "engine/image/srgb.h"
#include "engine/metrics/image_error.h"

namespace gfxrepro::metrics {
namespace {

using image::ImageF;

constexpr float kQc = 0.7F;    // exponent of the colour difference
constexpr float kPc = 0.4F;    // this share of the largest colour difference …
constexpr float kPt = 0.95F;   // … is mapped to this error
constexpr double kW = 0.082;   // width of the feature detectors, degrees
constexpr float kQf = 0.5F;    // exponent of the feature difference
constexpr double kRadius = 3;  // filters end here, in standard deviations

struct Colour {
    float x = 0.0F, y = 0.0F, z = 0.0F;
};

// White of D65 as the reference implementation rounds it: the XYZ of linear (1, 1, 1).
constexpr Colour kWhite{0.950428545F, 1.0F, 1.088900371F};
constexpr Colour kInverseWhite{1.052156925F, 1.0F, 0.918357670F};

/// XYZ in units of white. The matrix is that of linear Rec. 709 colour.
Colour whiteRelativeXyzOf(const Colour& rgb) {
    constexpr float k1 = 24577794.0F, k2 = 12288897.0F, k3 = 73733382.0F;
    const float x =
        (10135552.0F / k1) * rgb.x + (8788810.0F / k1) * rgb.y + (4435075.0F / k1) * rgb.z;
    const float y =
        (2613072.0F / k2) * rgb.x + (8788810.0F / k2) * rgb.y + (887015.0F / k2) * rgb.z;
    const float z =
        (1425312.0F / k3) * rgb.x + (8788810.0F / k3) * rgb.y + (70074185.0F / k3) * rgb.z;
    return {x * kInverseWhite.x, y * kInverseWhite.y, z * kInverseWhite.z};
}

/// The opponent space in which contrast sensitivity is measured: linear in the colour.
Colour yCxCzOf(const Colour& rgb) {
    const Colour xyz = whiteRelativeXyzOf(rgb);
    return {116.0F * xyz.y - 16.0F, 500.0F * (xyz.x - xyz.y), 200.0F * (xyz.y - xyz.z)};
}

Colour rgbOfYCxCz(const Colour& yCxCz) {
    const float relativeY = (yCxCz.x + 16.0F) / 116.0F;
    const float x = (relativeY + yCxCz.y / 500.0F) * kWhite.x;
    const float y = relativeY * kWhite.y;
    const float z = (relativeY - yCxCz.z / 200.0F) * kWhite.z;
    return {3.241003275F * x - 1.537398934F * y - 0.498615861F * z,
            -0.969224334F * x + 1.875930071F * y + 0.041554224F * z,
            0.055639423F * x - 0.204011202F * y + 1.057148933F * z};
}

/// CIELAB with Hunt's adjustment: colours look the less colourful the darker they are.
Colour huntLabOf(const Colour& rgb) {
    const auto compressed = [](float value) {
        constexpr float kDelta = 6.0F / 29.0F;
        return value > kDelta * kDelta * kDelta ? std::cbrt(value)
                                                : value / (3.0F * kDelta * kDelta) + 4.0F / 29.0F;
    };
    const Colour xyz = whiteRelativeXyzOf(rgb);
    const float x = compressed(xyz.x), y = compressed(xyz.y), z = compressed(xyz.z);
    const float lightness = 116.0F * y - 16.0F;
    const float hunt = 0.01F * lightness;
    return {lightness, hunt * 500.0F * (x - y), hunt * 200.0F * (y - z)};
}

float lengthOf(float x, float y) {
    return std::sqrt(x * x + y * y);
}

/// HyAB: city-block in lightness, Euclidean in chroma.
float hyAb(const Colour& a, const Colour& b) {
    return std::abs(a.x - b.x) + lengthOf(a.y - b.y, a.z - b.z);
}

/// One channel of an image.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;

    Plane(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    float* row(int y) {
        return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
    const float* row(int y) const {
        return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
};

template <class Action>
void forEachRow(int height, Action&& action) {
    tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const auto& rows) {
        for (int y = rows.begin(); y < rows.end(); ++y) action(y);
    });
}

using Weights = std::vector<float>;  // at −radius … radius

template <class Function>
std::vector<double> sampled(int radius, Function&& function) {
    std::vector<double> weights;
    for (int i = -radius; i <= radius; ++i) weights.push_back(function(static_cast<double>(i)));
    return weights;
}

double sumOf(const std::vector<double>& weights) {
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    return sum;
}

Weights scaled(const std::vector<double>& weights, double factor) {
    Weights result;
    for (const double weight : weights) result.push_back(static_cast<float>(weight * factor));
    return result;
}

/// The contrast sensitivity of each channel as a filter (Table 1): a sum of Gaussians
/// a·√(π/b)·exp(−π²d²/b) of the distance d in degrees. Those of Y and Cx have one term; that of Cz
/// has two, each separable by itself.
struct SensitivityFilters {
    Weights y, cx, cz[2];

    explicit SensitivityFilters(double pixelsPerDegree) {
        constexpr double kPi = std::numbers::pi;
        constexpr double kBY = 0.0047, kBCx = 0.0053;
        constexpr double kACz[2] = {34.1, 13.5}, kBCz[2] = {0.04, 0.025};
        // All as wide as the widest.
        const double deviation = std::sqrt(kBCz[0] / (2.0 * kPi * kPi)) * pixelsPerDegree;
        const int radius = static_cast<int>(std::ceil(kRadius * deviation));
        const auto gaussian = [&](double b) {
            return sampled(radius, [&](double i) {
                const double d = i / pixelsPerDegree;
                return std::exp(-kPi * kPi * d * d / b);
            });
        };
        const std::vector<double> gaussianY = gaussian(kBY), gaussianCx = gaussian(kBCx);
        y = scaled(gaussianY, 1.0 / sumOf(gaussianY));
        cx = scaled(gaussianCx, 1.0 / sumOf(gaussianCx));
        // The two-dimensional filter, w₀·G₀ ⊗ G₀ + w₁·G₁ ⊗ G₁, sums to 1.
        double sum = 0.0;
        for (int k = 0; k < 2; ++k) {
            const double s = sumOf(gaussian(kBCz[k]));
            sum += kACz[k] * std::sqrt(kPi / kBCz[k]) * s * s;
        }
        for (int k = 0; k < 2; ++k) {
            const double weight = kACz[k] * std::sqrt(kPi / kBCz[k]) / sum;
            cz[k] = scaled(gaussian(kBCz[k]), std::sqrt(weight));
        }
    }
};

/// A Gaussian with its first and second derivative, each side of which sums to 1 (Sec. 4.2).
struct FeatureFilters {
    Weights gaussian, edge, point;

    explicit FeatureFilters(double pixelsPerDegree) {
        const double deviation = 0.5 * kW * pixelsPerDegree;
        const int radius = static_cast<int>(std::ceil(kRadius * deviation));
        const auto g = [&](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
        const std::vector<double> weights = sampled(radius, g);
        gaussian = scaled(weights, 1.0 / sumOf(weights));
        edge = balanced(sampled(radius, [&](double x) { return -x * g(x); }));
        point = balanced(sampled(
            radius, [&](double x) { return (x * x / (deviation * deviation) - 1.0) * g(x); }));
    }

    static Weights balanced(const std::vector<double>& weights) {
        double positive = 0.0, negative = 0.0;
        for (const double weight : weights) (weight > 0.0 ? positive : negative) += weight;
        Weights result;
        for (const double weight : weights) {
            result.push_back(static_cast<float>(weight / (weight > 0.0 ? positive : -negative)));
        }
        return result;
    }
};

int radiusOf(const Weights& weights) {
    return static_cast<int>(weights.size()) / 2;
}

/// A weight, and the row of values that it weighs.
struct Tap {
    float weight;
    const float* values;
};

/// to[x] = the sum of weight · values[x], in the order of the taps.
GFXREPRO_WIDE void addTaps(const Tap* taps, std::size_t count, int width, float* to) {
    constexpr int kBlock = 32;  // as many sums as fit into registers
    int x = 0;
    for (; x + kBlock <= width; x += kBlock) {
        float sums[kBlock] = {};
        for (std::size_t t = 0; t < count; ++t) {
            const float weight = taps[t].weight;
            const float* values = taps[t].values + x;
            for (int i = 0; i < kBlock; ++i) sums[i] += weight * values[i];
        }
        std::copy_n(sums, kBlock, to + x);
    }
    for (; x < width; ++x) {
        float sum = 0.0F;
        for (std::size_t t = 0; t < count; ++t) sum += taps[t].weight * taps[t].values[x];
        to[x] = sum;
    }
}

/// Correlation along x; beyond its borders the image goes on as it ends.
Plane filteredAlongX(const Plane& plane, const Weights& weights) {
    const int radius = radiusOf(weights);
    Plane result(plane.width, plane.height);
    forEachRow(plane.height, [&](int y) {
        const float* from = plane.row(y);
        std::vector<float> padded(static_cast<std::size_t>(plane.width + 2 * radius));
        for (int x = 0; x < plane.width + 2 * radius; ++x) {
            padded[static_cast<std::size_t>(x)] = from[std::clamp(x - radius, 0, plane.width - 1)];
        }
        std::vector<Tap> taps;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            taps.push_back({weights[i], padded.data() + i});
        }
        addTaps(taps.data(), taps.size(), plane.width, result.row(y));
    });
    return result;
}

/// Likewise along y, the sum of one filter a plane.
struct Term {
    const Plane& plane;
    const Weights& weights;
};
Plane filteredAlongY(std::initializer_list<Term> terms) {
    const int width = terms.begin()->plane.width;
    const int height = terms.begin()->plane.height;
    Plane result(width, height);
    forEachRow(height, [&](int y) {
        std::vector<Tap> taps;
        for (const Term& term : terms) {
            const int radius = radiusOf(term.weights);
            for (int i = -radius; i <= radius; ++i) {
                taps.push_back({term.weights[static_cast<std::size_t>(i + radius)],
                                term.plane.row(std::clamp(y + i, 0, height - 1))});
            }
        }
        addTaps(taps.data(), taps.size(), width, result.row(y));
    });
    return result;
}

/// What the eye makes of one image.
struct Perceived {
    Plane y, cx, cz;                     // filtered by contrast sensitivity
    Plane edgeX, edgeY, pointX, pointY;  // of the achromatic channel in [0, 1]

    bool hasColourOf(const Perceived& other, int x, int row) const {
        return y.row(row)[x] == other.y.row(row)[x] && cx.row(row)[x] == other.cx.row(row)[x] &&
               cz.row(row)[x] == other.cz.row(row)[x];
    }
    Colour lab(int x, int row) const {
        const Colour rgb = rgbOfYCxCz({y.row(row)[x], cx.row(row)[x], cz.row(row)[x]});
        return huntLabOf({std::clamp(rgb.x, 0.0F, 1.0F), std::clamp(rgb.y, 0.0F, 1.0F),
                          std::clamp(rgb.z, 0.0F, 1.0F)});
    }
    float edge(int x, int row) const { return lengthOf(edgeX.row(row)[x], edgeY.row(row)[x]); }
    float point(int x, int row) const { return lengthOf(pointX.row(row)[x], pointY.row(row)[x]); }
};

Perceived perceived(const ImageF& image, double pixelsPerDegree) {
    const int width = image.width(), height = image.height();
    Plane y(width, height), cx(width, height), cz(width, height), achromatic(width, height);
    forEachRow(height, [&](int row) {
        for (int x = 0; x < width; ++x) {
            const auto shown = [&](int channel) {
                return std::clamp(image.at(x, row, channel), 0.0F, 1.0F);
            };
            const Colour yCxCz = yCxCzOf({shown(0), shown(1), shown(2)});
            y.row(row)[x] = yCxCz.x;
            cx.row(row)[x] = yCxCz.y;
            cz.row(row)[x] = yCxCz.z;
            achromatic.row(row)[x] = (yCxCz.x + 16.0F) / 116.0F;
        }
    });
    const SensitivityFilters seen(pixelsPerDegree);
    const FeatureFilters feature(pixelsPerDegree);
    const Plane smooth = filteredAlongX(achromatic, feature.gaussian);
    return {filteredAlongY({{filteredAlongX(y, seen.y), seen.y}}),
            filteredAlongY({{filteredAlongX(cx, seen.cx), seen.cx}}),
            filteredAlongY({{filteredAlongX(cz, seen.cz[0]), seen.cz[0]},
                            {filteredAlongX(cz, seen.cz[1]), seen.cz[1]}}),
            filteredAlongY({{filteredAlongX(achromatic, feature.edge), feature.gaussian}}),
            filteredAlongY({{smooth, feature.edge}}),
            filteredAlongY({{filteredAlongX(achromatic, feature.point), feature.gaussian}}),
            filteredAlongY({{smooth, feature.point}})};
}

/// The largest colour difference: that of pure green and pure blue.
float largestColourDifference() {
    return std::pow(hyAb(huntLabOf({0.0F, 1.0F, 0.0F}), huntLabOf({0.0F, 0.0F, 1.0F})), kQc);
}

/// Compresses what is beyond the share kPc of the largest difference (Sec. 4.1).
float redistributed(float difference, float largest) {
    const float knee = kPc * largest;
    return difference < knee ? difference * kPt / knee
                             : kPt + (difference - knee) / (largest - knee) * (1.0F - kPt);
}

void requireFlip(const ImageF& reference, double pixelsPerDegree) {
    if (reference.channels() != 3) {
        throw Error(
            fmt::format("FLIP compares images of 3 channels, found {}", reference.channels()));
    }
    // Below, the feature detectors' weights underflow; above, the filters outgrow any image.
    if (!(pixelsPerDegree >= 1.0 && pixelsPerDegree <= 1000.0)) {
        throw Error(
            fmt::format("FLIP allows 1 to 1000 pixels a degree, found {}", pixelsPerDegree));
    }
}

ImageF differenceOf(const Perceived& a, const Perceived& b) {
    const float largest = largestColourDifference();
    ImageF map(a.y.width, a.y.height, 1);
    forEachRow(map.height(), [&](int y) {
        for (int x = 0; x < map.width(); ++x) {
            const float edge = std::abs(a.edge(x, y) - b.edge(x, y));
            const float point = std::abs(a.point(x, y) - b.point(x, y));
            // 0 to a power above 0, which is most of what is alike.
            if (a.hasColourOf(b, x, y) && std::max(edge, point) < 1.0F) continue;
            const float difference = std::pow(hyAb(a.lab(x, y), b.lab(x, y)), kQc);
            const float colour = redistributed(difference, largest);
            const float feature =
                std::pow(std::max(edge, point) / std::numbers::sqrt2_v<float>, kQf);
            map.at(x, y) = std::pow(colour, 1.0F - feature);
        }
    });
    return map;
}

}  // namespace

void requireFlipSize(const ImageF& image) {
    if (std::int64_t{image.width()} * image.height() <= kMaxFlipPixels) return;
    throw Error(fmt::format("FLIP compares pictures of at most 8192² pixels, found {} x {}",
                            image.width(), image.height()));
}

void forEachPicture(std::size_t count, const std::function<std::int64_t(std::size_t)>& pixelsOf,
                    const std::function<void(std::size_t)>& body) {
    constexpr std::int64_t kLarge = 1 << 22;
    std::vector<std::size_t> small, large;
    for (std::size_t i = 0; i < count; ++i) (pixelsOf(i) > kLarge ? large : small).push_back(i);
    tbb::parallel_for(std::size_t{0}, small.size(), [&](std::size_t i) { body(small[i]); });
    for (const std::size_t i : large) body(i);
}

struct FlipReference::Seen {
    Perceived perceived;
};

FlipReference::FlipReference(ImageF reference, double pixelsPerDegree)
    : reference_(std::move(reference)), pixelsPerDegree_(pixelsPerDegree) {
    requireFlip(reference_, pixelsPerDegree);
    seen_ = std::make_unique<const Seen>(perceived(reference_, pixelsPerDegree));
}

FlipReference::~FlipReference() = default;

ImageF FlipReference::mapOf(const ImageF& test) const {
    requireComparable(reference_, test);
    return differenceOf(seen_->perceived, perceived(test, pixelsPerDegree_));
}

ImageF flipMap(const ImageF& reference, const ImageF& test, double pixelsPerDegree) {
    requireComparable(reference, test);
    requireFlip(reference, pixelsPerDegree);
    return differenceOf(perceived(reference, pixelsPerDegree), perceived(test, pixelsPerDegree));
}

double meanOfFlip(const ImageF& map) {
    double sum = 0.0;
    for (const float value : map.values()) sum += double{value};
    return sum / static_cast<double>(map.values().size());
}

double flip(const ImageF& reference, const ImageF& test, double pixelsPerDegree) {
    return meanOfFlip(flipMap(reference, test, pixelsPerDegree));
}

// Andersson, Nilsson, Shirley, Akenine-Möller 2021, "Visualizing Errors in Rendered High Dynamic
// Range Images". Exposures, their number and the tone mapper are the defaults of the published
// reference implementation.

namespace {

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
