#include "engine/metrics/mean_test.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "engine/core/error.h"
#include "engine/core/random.h"

namespace gfxrepro::metrics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSeenAtP = 0.01;
// Equal deals may differ in the last bits of their sums.
constexpr double kRounding = 1e-9;

using Samples = std::vector<std::vector<double>>;

/// Which samples are dealt to the first side.
using Deal = std::vector<std::size_t>;

/// The number of ways to choose; infinite where it does not fit.
double waysOf(std::size_t count, std::size_t chosen) {
    double ways = 1.0;
    for (std::size_t i = 0; i < chosen; ++i) {
        ways *= static_cast<double>(count - i) / static_cast<double>(i + 1);
    }
    return std::round(ways);
}

/// The next deal in lexical order; false behind the last.
bool advance(Deal& deal, std::size_t count) {
    for (std::size_t i = deal.size(); i-- > 0;) {
        if (deal[i] == count - deal.size() + i) continue;
        ++deal[i];
        for (std::size_t j = i + 1; j < deal.size(); ++j) deal[j] = deal[j - 1] + 1;
        return true;
    }
    return false;
}

/// Welch's t of every tile for any deal, of sums that are made once.
class WelchStatistic {
  public:
    explicit WelchStatistic(Samples samples) : samples_(std::move(samples)) {
        const std::size_t tiles = samples_.front().size();
        sums_.assign(tiles, 0.0);
        squares_.assign(tiles, 0.0);
        // About their mean, where sums of squares keep their digits.
        const auto count = static_cast<double>(samples_.size());
        for (std::size_t tile = 0; tile < tiles; ++tile) {
            double mean = 0.0, largest = 0.0;
            for (const auto& sample : samples_) {
                mean += sample[tile] / count;
                largest = std::max(largest, std::abs(sample[tile]));
            }
            for (auto& sample : samples_) {
                sample[tile] -= mean;
                if (std::abs(sample[tile]) <= kRounding * largest) sample[tile] = 0.0;
                sums_[tile] += sample[tile];
                squares_[tile] += sample[tile] * sample[tile];
            }
        }
    }

    /// How the two sides of a deal differ over all tiles.
    struct Outcome {
        double largest = 0.0;   // |t|; +∞ where some tile differs and has no noise
        double logNoise = 0.0;  // of the ratio of the two sides' noise
    };
    Outcome of(const Deal& deal) const {
        Outcome outcome;
        double noiseA = 0.0, noiseB = 0.0;
        for (std::size_t tile = 0; tile < sums_.size(); ++tile) {
            const Difference difference = at(tile, deal);
            noiseA += std::sqrt(difference.varianceA);
            noiseB += std::sqrt(difference.varianceB);
            if (difference.mean == 0.0) continue;
            outcome.largest = std::max(outcome.largest, difference.mean / difference.error());
        }
        if (noiseA != noiseB) outcome.logNoise = std::log(noiseA / noiseB);
        return outcome;
    }

    /// The standard errors of all tiles.
    std::vector<double> errors(const Deal& deal) const {
        std::vector<double> errors;
        for (std::size_t tile = 0; tile < sums_.size(); ++tile) {
            errors.push_back(at(tile, deal).error());
        }
        return errors;
    }

    /// By Student's distribution, of all tiles together.
    double studentsP(const Deal& deal) const {
        double least = 1.0;
        for (std::size_t tile = 0; tile < sums_.size(); ++tile) {
            const Difference difference = at(tile, deal);
            if (difference.mean == 0.0) continue;
            least = std::min(least, studentP(difference.mean / difference.error(),
                                             difference.freedom(deal.size())));
        }
        return std::min(1.0, least * static_cast<double>(sums_.size()));
    }

    std::size_t tileCount() const { return sums_.size(); }

  private:
    struct Difference {
        double mean = 0.0;                        // of the two sides' means, absolute
        double varianceA = 0.0, varianceB = 0.0;  // of the two means

        double error() const { return std::sqrt(varianceA + varianceB); }
        /// Welch and Satterthwaite's, of as many samples on both sides; rounded down.
        int freedom(std::size_t count) const {
            const double sum = varianceA + varianceB;
            const double squares = varianceA * varianceA + varianceB * varianceB;
            const double each = static_cast<double>(count) - 1.0;
            return squares > 0.0 ? static_cast<int>(each * sum * sum / squares + kRounding)
                                 : static_cast<int>(each);
        }
    };

    Difference at(std::size_t tile, const Deal& deal) const {
        const auto a = static_cast<double>(deal.size());
        const double b = static_cast<double>(samples_.size()) - a;
        double sum = 0.0, square = 0.0;
        for (const std::size_t one : deal) {
            const double value = samples_[one][tile];
            sum += value;
            square += value * value;
        }
        const auto varianceOfMean = [](double total, double squares, double count) {
            return std::max(0.0, squares - total * total / count) / (count - 1.0) / count;
        };
        const double rest = sums_[tile] - sum;
        // What rounding leaves of no noise at all is none.
        const auto noise = [&](double variance) {
            return variance > kRounding * squares_[tile] ? variance : 0.0;
        };
        return {std::abs(sum / a - rest / b), noise(varianceOfMean(sum, square, a)),
                noise(varianceOfMean(rest, squares_[tile] - square, b))};
    }

    Samples samples_;  // less the mean of all
    std::vector<double> sums_, squares_;
};

/// Of every deal, or of so many; that of the pictures as they are first.
std::vector<WelchStatistic::Outcome> outcomesOf(const WelchStatistic& statistic, std::size_t count,
                                                std::size_t chosen) {
    Deal deal(chosen);
    std::iota(deal.begin(), deal.end(), std::size_t{0});
    std::vector<WelchStatistic::Outcome> values = {statistic.of(deal)};
    if (waysOf(count, chosen) <= static_cast<double>(kMostDeals)) {
        while (advance(deal, count)) values.push_back(statistic.of(deal));
        return values;
    }
    Random random(1);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    while (values.size() < kMostDeals) {
        for (std::size_t i = 0; i < chosen; ++i) {
            const auto left = static_cast<std::uint32_t>(count - i);
            std::swap(order[i], order[i + random.index(left)]);
        }
        deal.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(chosen));
        values.push_back(statistic.of(deal));
    }
    return values;
}

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// The least t that comes to a p of kSeenAtP or less; +∞ where none does.
double criticalOf(const std::vector<WelchStatistic::Outcome>& outcomes, std::size_t tileCount,
                  int freedom) {
    std::vector<double> all;
    for (const WelchStatistic::Outcome& outcome : outcomes) all.push_back(outcome.largest);
    std::ranges::sort(all, std::greater<>());
    const auto allowed = static_cast<std::size_t>(kSeenAtP * static_cast<double>(all.size()));
    if (allowed == 0) return kInfinity;
    double student = 1.0;
    while (static_cast<double>(tileCount) * studentP(student, freedom) > kSeenAtP) student *= 1.02;
    return std::max(all[allowed - 1], student);
}

/// The means of so many samples that as many are left as `count`.
Samples grouped(std::span<const std::vector<double>> samples, std::size_t count) {
    const std::size_t size = samples.size() / count;
    Samples groups;
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<double>& mean = groups.emplace_back(samples[i * size].size(), 0.0);
        for (const std::vector<double>& sample : samples.subspan(i * size, size)) {
            GFXREPRO_ASSERT_EQ(sample.size(), mean.size());
            for (std::size_t tile = 0; tile < mean.size(); ++tile) {
                mean[tile] += sample[tile] / static_cast<double>(size);
            }
        }
    }
    return groups;
}

}  // namespace

std::vector<double> tileMeans(const image::ImageF& picture) {
    std::vector<double> means;
    const int width = picture.width(), height = picture.height();
    for (int sizePx = kMeanTilePx;; sizePx *= 2) {
        for (int top = 0; top < height; top += sizePx) {
            for (int left = 0; left < width; left += sizePx) {
                const int right = std::min(left + sizePx, width);
                const int bottom = std::min(top + sizePx, height);
                for (int channel = 0; channel < picture.channels(); ++channel) {
                    double sum = 0.0;
                    for (int y = top; y < bottom; ++y) {
                        for (int x = left; x < right; ++x) sum += picture.at(x, y, channel);
                    }
                    means.push_back(sum / (static_cast<double>(right - left) * (bottom - top)));
                }
            }
        }
        if (sizePx >= std::max(width, height)) return means;
    }
}

image::ImageF tileDifferences(std::span<const std::vector<double>> a,
                              std::span<const std::vector<double>> b, int width, int height,
                              int channels) {
    const int columns = (width + kMeanTilePx - 1) / kMeanTilePx;
    const int colours = channels < 3 ? 1 : 3;
    const auto meanOf = [&](const std::vector<double>& sample, int x, int y) {
        const int tile = y / kMeanTilePx * columns + x / kMeanTilePx;
        const auto first = sample.begin() + static_cast<std::ptrdiff_t>(tile) * channels;
        return std::accumulate(first, first + colours, 0.0) / colours;
    };
    struct Side {
        double mean = 0.0, variance = 0.0;  // the latter of the mean
    };
    const auto sideOf = [&](std::span<const std::vector<double>> samples, int x, int y) {
        const auto count = static_cast<double>(samples.size());
        Side side;
        for (const auto& sample : samples) side.mean += meanOf(sample, x, y) / count;
        for (const auto& sample : samples) {
            side.variance +=
                std::pow(meanOf(sample, x, y) - side.mean, 2.0) / (count - 1.0) / count;
        }
        return side;
    };
    image::ImageF errors(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int left = x - x % kMeanTilePx, top = y - y % kMeanTilePx;
            if (left < x || top < y) {
                errors.at(x, y) = errors.at(left, top);
                continue;
            }
            const Side sideA = sideOf(a, x, y), sideB = sideOf(b, x, y);
            const double difference = sideA.mean - sideB.mean;
            if (std::abs(difference) <= kRounding * std::abs(sideA.mean)) continue;
            constexpr double kMost = std::numeric_limits<float>::max();
            errors.at(x, y) = static_cast<float>(
                std::clamp(difference / std::sqrt(sideA.variance + sideB.variance), -kMost, kMost));
        }
    }
    return errors;
}

MeanTest testMeans(std::span<const std::vector<double>> a, std::span<const std::vector<double>> b) {
    const std::size_t count = std::min(a.size(), b.size());
    GFXREPRO_ASSERT(count >= 2);
    Samples samples = grouped(a, count);
    for (std::vector<double>& sample : grouped(b, count)) samples.push_back(std::move(sample));
    double total = 0.0;
    for (const std::vector<double>& sample : samples) {
        GFXREPRO_ASSERT_EQ(sample.size(), samples.front().size());
        total += std::accumulate(sample.begin(), sample.end(), 0.0);
    }
    const auto values = static_cast<double>(samples.size() * samples.front().size());
    const WelchStatistic statistic(std::move(samples));
    const std::vector<WelchStatistic::Outcome> all = outcomesOf(statistic, 2 * count, count);
    const auto asLarge = std::ranges::count_if(all, [&](const WelchStatistic::Outcome& one) {
        return one.largest >= all.front().largest * (1.0 - kRounding);
    });
    const double logNoise = std::abs(all.front().logNoise);
    const auto asUnlike = std::ranges::count_if(all, [&](const WelchStatistic::Outcome& one) {
        return std::abs(one.logNoise) >= logNoise * (1.0 - kRounding);
    });
    Deal asTheyAre(count);
    std::iota(asTheyAre.begin(), asTheyAre.end(), std::size_t{0});
    const auto share = [&](std::ptrdiff_t some) {
        return static_cast<double>(some) / static_cast<double>(all.size());
    };
    MeanTest test;
    test.p = std::max(share(asLarge), statistic.studentsP(asTheyAre));
    test.noiseRatio = std::exp(all.front().logNoise);
    test.isUnlike = logNoise > std::log(kMostNoiseRatio) && share(asUnlike) <= kSeenAtP;
    const double mean = std::abs(total) / values;
    const double critical = criticalOf(all, statistic.tileCount(), 2 * static_cast<int>(count) - 2);
    constexpr double kOftenFound = 1.5;  // of the least that may be found
    test.seen = mean > 0.0 && std::isfinite(critical)
                    ? kOftenFound * critical * medianOf(statistic.errors(asTheyAre)) / mean
                    : kInfinity;
    return test;
}

double studentP(double t, int freedom) {
    if (std::isinf(t)) return 0.0;
    const double angle = std::atan(t / std::sqrt(static_cast<double>(freedom)));
    const double square = std::pow(std::cos(angle), 2.0);
    const bool isOdd = freedom % 2 == 1;
    // cos θ + 2/3 cos³ θ + … of odd, 1 + 1/2 cos² θ + … of even degrees of freedom.
    double term = isOdd ? std::cos(angle) : 1.0;
    double sum = freedom == 1 ? 0.0 : term;
    for (int i = isOdd ? 3 : 2; i < freedom; i += 2) {
        term *= square * (i - 1.0) / i;
        sum += term;
    }
    const double inside = std::sin(angle) * sum;
    return std::max(0.0, 1.0 - (isOdd ? (angle + inside) * 2.0 / std::numbers::pi : inside));
}

double leastP(std::size_t aCount, std::size_t bCount) {
    const std::size_t count = std::min(aCount, bCount);
    const double ways = waysOf(2 * count, count);
    // Of all deals, each has one that swaps the two sides.
    return ways <= static_cast<double>(kMostDeals) ? 2.0 / ways
                                                   : 1.0 / static_cast<double>(kMostDeals);
}

}  // namespace gfxrepro::metrics
