// Height maps from files: in memory, and larger ones by bands of rows into a file of the cache.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/error.h"
#include "engine/scene/height_holes.h"
#include "engine/scene/height_map.h"
#include "engine/scene/height_rows.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

namespace {

/// A file's rows in metres, NaN where they have no data.
class Metres {
  public:
    Metres(const fs::path& path, const HeightMapUnits& units)
        : rows_(openHeightRows(path)), units_(units) {
        if (units.noData) rows_->noData.push_back(*units.noData);
    }

    const HeightRows& source() const { return *rows_; }
    bool canHaveHoles() const { return rows_->canBeNan || !rows_->noData.empty(); }

    void read(int count, float* heightsM) {
        const std::vector<float>& none = rows_->noData;
        for (int i = 0; i < count; ++i, heightsM += rows_->sizeSamples.x) {
            rows_->read(heightsM);
            for (int column = 0; column < rows_->sizeSamples.x; ++column) {
                float& height = heightsM[column];
                const bool isHole = std::find(none.begin(), none.end(), height) != none.end();
                height = isHole ? NAN : height * units_.heightScaleM;
            }
        }
    }

  private:
    std::unique_ptr<HeightRows> rows_;
    HeightMapUnits units_;
};

HeightMap withoutHeights(const HeightRows& source, const HeightMapUnits& units) {
    HeightMap map;
    map.sizeSamples = source.sizeSamples;
    map.spacingM = units.spacingM;
    map.isEightBit = source.isEightBit;
    return map;
}

template <class Step>
void naming(const fs::path& path, const Step& step) {
    try {
        step();
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path.string(), error.what()));
    }
}

/// Makes the file of a map: one pass over its rows, or two where some may have no data.
class Conversion {
  public:
    Conversion(const fs::path& path, const HeightMapUnits& units)
        : path_(path), units_(units), rows_(std::in_place, path, units) {}

    const HeightRows& source() const { return rows_->source(); }

    std::size_t prepare() {
        if (!rows_->canHaveHoles()) return 0;
        const auto reader = [this](int count, float* heightsM) { rows_->read(count, heightsM); };
        filling_.emplace(source().sizeSamples, reader);
        rows_.emplace(path_, units_);
        if (filling_->holeCount() == 0) {
            filling_.reset();
            return 0;
        }
        naming(path_, [&] { filling_->restart(reader); });
        return filling_->holeCount();
    }

    void makeRows(int count, float* heightsM) {
        if (filling_) {
            filling_->next(heightsM);
        } else {
            rows_->read(count, heightsM);
        }
    }

  private:
    fs::path path_;
    HeightMapUnits units_;
    std::optional<Metres> rows_;
    std::optional<HoleFilling> filling_;
};

static_assert(HoleFilling::kBandRows == HeightFile::kRowsAtOnce);

}  // namespace

void fillHoles(HeightMap& map) {
    map.filledCount = static_cast<std::size_t>(
        std::count_if(map.heightsM.begin(), map.heightsM.end(),
                      [](float height) { return !std::isfinite(height); }));
    if (map.filledCount == 0) return;
    const auto readerOf = [&map](int row) {
        return [&map, row](int count, float* values) mutable {
            const auto width = static_cast<std::size_t>(map.sizeSamples.x);
            std::copy_n(&map.heightsM[static_cast<std::size_t>(row) * width],
                        static_cast<std::size_t>(count) * width, values);
            row += count;
        };
    };
    HoleFilling filling(map.sizeSamples, readerOf(0));
    filling.restart(readerOf(0));
    std::vector<float> filled(map.heightsM.size());
    for (std::size_t done = 0; done < filled.size();
         done +=
         std::size_t{HoleFilling::kBandRows} * static_cast<std::size_t>(map.sizeSamples.x)) {
        filling.next(&filled[done]);
    }
    map.heightsM = std::move(filled);
}

HeightMap loadHeightMap(const fs::path& path, const HeightMapUnits& units) {
    Metres rows(path, units);
    HeightMap map = withoutHeights(rows.source(), units);
    if (std::max(map.sizeSamples.x, map.sizeSamples.y) > kMaxHeightMapSide) {
        throw Error(
            fmt::format("{}: a height map of {} x {} samples; allowed in memory: {} to {} a "
                        "side",
                        path.string(), map.sizeSamples.x, map.sizeSamples.y, kMinHeightMapSide,
                        kMaxHeightMapSide));
    }
    map.heightsM.resize(static_cast<std::size_t>(map.sizeSamples.x) *
                        static_cast<std::size_t>(map.sizeSamples.y));
    rows.read(map.sizeSamples.y, map.heightsM.data());
    naming(path, [&] { fillHoles(map); });
    return map;
}

HeightMap loadHeightMapInFile(const fs::path& path, const HeightMapUnits& units,
                              const fs::path& folder, const std::string& key,
                              int mostSamplesInMemory) {
    Conversion conversion(path, units);
    HeightMap map = withoutHeights(conversion.source(), units);
    if (std::max(map.sizeSamples.x, map.sizeSamples.y) <= mostSamplesInMemory) {
        return loadHeightMap(path, units);
    }
    try {
        map.file = HeightFile::openOrBuild(
            folder, key, map.sizeSamples,
            [&](int, int count, float* heightsM) { conversion.makeRows(count, heightsM); },
            [&] { return conversion.prepare(); });
    } catch (const UnwritableError& error) {
        settleForMemory(path.string(), map.sizeSamples, error);
        return loadHeightMap(path, units);
    }
    map.filledCount = map.file->filledCount();
    return map;
}

}  // namespace gfxrepro::scene
