#include "engine/scene/height_holes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/core/error.h"

namespace gfxrepro::scene {

namespace {

/// Steps of the pyramid from the map to the levels that are kept.
constexpr int kFineLevels = std::bit_width(unsigned{HoleFilling::kBandRows}) - 1;

std::size_t valueCount(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// Each value the mean of those of the four below it that have data. The fine rows begin at an even
/// one, and end at one or with the map.
HoleLevel pushed(HoleLevel& fine) {
    HoleLevel coarse{(fine.sizeSamples + 1) / 2, fine.firstRow / 2, {}};
    const int end = (fine.endRow() + 1) / 2;
    coarse.values.resize(valueCount({coarse.sizeSamples.x, end - coarse.firstRow}));
    tbb::parallel_for(coarse.firstRow, end, [&](int y) {
        for (int x = 0; x < coarse.sizeSamples.x; ++x) {
            float sum = 0.0F;
            int count = 0;
            for (int i = 0; i < 4; ++i) {
                const int fineX = 2 * x + i % 2;
                const int fineY = 2 * y + i / 2;
                if (fineX >= fine.sizeSamples.x || fineY >= fine.sizeSamples.y) continue;
                const float value = fine.at(fineX, fineY);
                if (!std::isfinite(value)) continue;
                sum += value;
                ++count;
            }
            coarse.at(x, y) = count > 0 ? sum / static_cast<float>(count) : NAN;
        }
    });
    return coarse;
}

/// Holes of rows [from, end) take the bilinear value of the level above, which has none there.
void pull(HoleLevel& coarse, HoleLevel& fine, int from, int end) {
    tbb::parallel_for(from, end, [&](int y) {
        for (int x = 0; x < fine.sizeSamples.x; ++x) {
            float& value = fine.at(x, y);
            if (std::isfinite(value)) continue;
            // A coarse value stands between its four: the nearest weighs 3/4 a direction.
            const int nearX = x / 2;
            const int nearY = y / 2;
            const int farX = nearX + (x % 2 == 0 ? -1 : 1);
            const int farY = nearY + (y % 2 == 0 ? -1 : 1);
            value = 0.5625F * coarse.clamped(nearX, nearY) + 0.1875F * coarse.clamped(farX, nearY) +
                    0.1875F * coarse.clamped(nearX, farY) + 0.0625F * coarse.clamped(farX, farY);
        }
    });
}

}  // namespace

int HoleLevel::endRow() const {
    return firstRow + static_cast<int>(values.size() / static_cast<std::size_t>(sizeSamples.x));
}

float& HoleLevel::at(int x, int y) {
    return values[static_cast<std::size_t>(y - firstRow) * static_cast<std::size_t>(sizeSamples.x) +
                  static_cast<std::size_t>(x)];
}

float HoleLevel::clamped(int x, int y) {
    return at(std::clamp(x, 0, sizeSamples.x - 1), std::clamp(y, 0, sizeSamples.y - 1));
}

HoleFilling::HoleFilling(glm::ivec2 sizeSamples, const Reader& read) : sizeSamples_(sizeSamples) {
    HoleLevel kept;
    for (int row = 0; row < sizeSamples.y; row += kBandRows) {
        HoleLevel band{sizeSamples, row, {}};
        const int count = std::min(kBandRows, sizeSamples.y - row);
        band.values.resize(valueCount({sizeSamples.x, count}));
        read(count, band.values.data());
        holeCount_ += static_cast<std::size_t>(
            std::count_if(band.values.begin(), band.values.end(),
                          [](float value) { return !std::isfinite(value); }));
        for (int level = 0; level < kFineLevels; ++level) band = pushed(band);
        kept.sizeSamples = band.sizeSamples;
        kept.values.insert(kept.values.end(), band.values.begin(), band.values.end());
    }
    coarse_.push_back(std::move(kept));
    while (coarse_.back().sizeSamples != glm::ivec2(1)) {
        HoleLevel coarser = pushed(coarse_.back());
        coarse_.push_back(std::move(coarser));
    }
    for (std::size_t i = coarse_.size() - 1; i > 0; --i) {
        pull(coarse_[i], coarse_[i - 1], 0, coarse_[i - 1].sizeSamples.y);
    }
}

void HoleFilling::restart(Reader read) {
    if (holeCount_ == valueCount(sizeSamples_)) {
        throw Error("no sample has data; allowed: at least one");
    }
    read_ = std::move(read);
    window_ = {sizeSamples_, 0, {}};
    nextRow_ = 0;
    readBand();
}

void HoleFilling::readBand() {
    const int count = std::min(kBandRows, sizeSamples_.y - window_.endRow());
    if (count <= 0) return;
    const std::size_t before = window_.values.size();
    window_.values.resize(before + valueCount({sizeSamples_.x, count}));
    read_(count, &window_.values[before]);
}

void HoleFilling::next(float* values) {
    GFXREPRO_ASSERT(nextRow_ < sizeSamples_.y);
    if (nextRow_ - window_.firstRow > kBandRows) {
        window_.values.erase(window_.values.begin(),
                             window_.values.begin() + std::ptrdiff_t{kBandRows} * sizeSamples_.x);
        window_.firstRow += kBandRows;
    }
    readBand();
    const int end = std::min(nextRow_ + kBandRows, sizeSamples_.y);
    std::vector<HoleLevel> fine{window_};
    for (int level = 1; level < kFineLevels; ++level) fine.push_back(pushed(fine.back()));
    // Rows of each level that holes of the band reach: the one before, and the one after.
    std::vector<glm::ivec2> rows{{nextRow_, end}};
    for (int level = 1; level < kFineLevels; ++level) {
        const glm::ivec2 below = rows.back();
        rows.emplace_back(
            std::max(below.x / 2 - 1, 0),
            std::min((below.y - 1) / 2 + 2, fine[static_cast<std::size_t>(level)].sizeSamples.y));
    }
    for (std::size_t level = fine.size(); level > 0; --level) {
        HoleLevel& coarser = level == fine.size() ? coarse_.front() : fine[level];
        pull(coarser, fine[level - 1], rows[level - 1].x, rows[level - 1].y);
    }
    std::copy_n(&fine.front().at(0, nextRow_), valueCount({sizeSamples_.x, end - nextRow_}),
                values);
    nextRow_ = end;
}

}  // namespace gfxrepro::scene
