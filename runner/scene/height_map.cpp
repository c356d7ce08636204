#include "runner/scene/height_map.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runner/core/error.h"
#include "runner/scene/scene.h"

namespace gfxrepro::scene {

namespace {

/// One step of the pyramid that fills holes: NaN is "no data".
struct Level {
    glm::ivec2 size{0};
    std::vector<float> values;

    float& at(int x, int y) {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
                      static_cast<std::size_t>(x)];
    }
    float clamped(int x, int y) {
        return at(std::clamp(x, 0, size.x - 1), std::clamp(y, 0, size.y - 1));
    }
};

/// Each value the mean of those of the four below it that have data.
Level pushed(Level& fine) {
    Level coarse;
    coarse.size = (fine.size + 1) / 2;
    coarse.values.resize(static_cast<std::size_t>(coarse.size.x) *
                         static_cast<std::size_t>(coarse.size.y));
    tbb::parallel_for(0, coarse.size.y, [&](int y) {
        for (int x = 0; x < coarse.size.x; ++x) {
            float sum = 0.0F;
            int count = 0;
            for (int i = 0; i < 4; ++i) {
                const int fineX = 2 * x + i % 2;
                const int fineY = 2 * y + i / 2;
                if (fineX >= fine.size.x || fineY >= fine.size.y) continue;
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

/// Holes take the bilinear value of the level above, which has none.
void pull(Level& coarse, Level& fine) {
    tbb::parallel_for(0, fine.size.y, [&](int y) {
        for (int x = 0; x < fine.size.x; ++x) {
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

/// 0, step, 2 · step … and the last.
std::vector<int> everyNth(int count, int maxCount) {
    const int step = std::max(1, (count - 2 + maxCount - 1) / std::max(1, maxCount - 1));
    std::vector<int> places;
    for (int i = 0; i < count - 1; i += step) places.push_back(i);
    places.push_back(count - 1);
    return places;
}

}  // namespace

float HeightMap::clampedHeightM(int column, int row, int level) const {
    const glm::ivec2 at(std::max(column, 0), std::max(row, 0));
    // The border itself need not be on a level's grid.
    if (!file || level >= file->levelCount() || at.x >= sizeSamples.x || at.y >= sizeSamples.y) {
        return clampedHeightM(column, row);
    }
    const auto width = static_cast<std::size_t>(file->sizeSamples(level).x);
    return file->heightsM(level)[static_cast<std::size_t>(at.y >> level) * width +
                                 static_cast<std::size_t>(at.x >> level)];
}

HeightMap::Extremes HeightMap::extremes() const {
    GFXREPRO_ASSERT(!isEmpty());
    if (file) return {file->lowestM(), file->highestM(), file->highestSample()};
    const auto lowest = std::min_element(heightsM.begin(), heightsM.end());
    const auto highest = std::max_element(heightsM.begin(), heightsM.end());
    const auto index = static_cast<int>(highest - heightsM.begin());
    return {*lowest, *highest, {index % sizeSamples.x, index / sizeSamples.x}};
}

Box HeightMap::bounds() const {
    Box box;
    if (isEmpty()) return box;
    const Extremes ends = extremes();
    box.add(glm::vec3(0.0F, ends.lowestM, 0.0F));
    box.add(glm::vec3(static_cast<float>(sizeSamples.x - 1) * spacingM, ends.highestM,
                      static_cast<float>(sizeSamples.y - 1) * spacingM));
    return box;
}

void fillHoles(HeightMap& map) {
    const auto holes = static_cast<std::size_t>(
        std::count_if(map.heightsM.begin(), map.heightsM.end(),
                      [](float height) { return !std::isfinite(height); }));
    map.filledCount = holes;
    if (holes == 0) return;
    if (holes == map.heightsM.size()) {
        throw Error("no sample has data; allowed: at least one");
    }
    std::vector<Level> levels;
    levels.push_back({map.sizeSamples, std::move(map.heightsM)});
    while (levels.back().size != glm::ivec2(1)) {
        Level coarse = pushed(levels.back());
        levels.push_back(std::move(coarse));
    }
    for (std::size_t i = levels.size() - 1; i > 0; --i) pull(levels[i], levels[i - 1]);
    map.heightsM = std::move(levels.front().values);
}

Mesh heightMapMesh(const HeightMap& map, int maxSamples) {
    GFXREPRO_ASSERT(maxSamples >= 2);
    Mesh mesh;
    mesh.name = "terrain";
    if (map.isEmpty()) return mesh;
    const std::vector<int> columns = everyNth(map.sizeSamples.x, maxSamples);
    const std::vector<int> rows = everyNth(map.sizeSamples.y, maxSamples);
    for (const int row : rows) {
        for (const int column : columns) mesh.positions.push_back(map.position(column, row));
    }
    const auto width = static_cast<std::uint32_t>(columns.size());
    for (std::uint32_t row = 0; row + 1 < rows.size(); ++row) {
        for (std::uint32_t column = 0; column + 1 < width; ++column) {
            const std::uint32_t northWest = row * width + column;
            const std::uint32_t southWest = northWest + width;
            mesh.triangles.emplace_back(northWest, southWest, southWest + 1);
            mesh.triangles.emplace_back(northWest, southWest + 1, northWest + 1);
        }
    }
    mesh.normals = vertexNormals(mesh);
    return mesh;
}

}  // namespace gfxrepro::scene
