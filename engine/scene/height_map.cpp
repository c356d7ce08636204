#include "engine/scene/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "engine/core/error.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

namespace {

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
    const glm::ivec2 at = glm::clamp(glm::ivec2(column, row), glm::ivec2(0), sizeSamples - 1);
    // The border itself need not be on a level's grid.
    const int between = (1 << level) - 1;
    if (!file || level >= file->levelCount() || ((at.x | at.y) & between) != 0) {
        return heightM(at.x, at.y);
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

std::string steepnessWarning(const HeightMap& map) {
    constexpr float kMostSteepness = 0.5F;  // of the highest mountains seen from end to end: 0.3
    const HeightMap::Extremes ends = map.extremes();
    const float longerM =
        static_cast<float>(std::max(map.sizeSamples.x, map.sizeSamples.y) - 1) * map.spacingM;
    if (ends.highestM - ends.lowestM <= kMostSteepness * longerM) return "";
    return fmt::format(
        "heights from {:g} to {:g} m over {:g} m of ground ({} x {} samples, {:g} m apart) look "
        "like spikes; `scene_params: {{spacing_m: …, height_scale_m: …}}` says how far its samples "
        "stand apart and how many metres a value is",
        ends.lowestM, ends.highestM, longerM, map.sizeSamples.x, map.sizeSamples.y, map.spacingM);
}

void settleForMemory(const std::string& name, glm::ivec2 sizeSamples, const UnwritableError& why) {
    if (std::max(sizeSamples.x, sizeSamples.y) > kMaxHeightMapSide) {
        throw Error(
            fmt::format("{}: {} x {} samples have no file: {}; allowed without one, in memory: at "
                        "most {} a side (1 GiB)",
                        name, sizeSamples.x, sizeSamples.y, why.what(), kMaxHeightMapSide));
    }
    fmt::print(stderr, "warning: {} is held in memory, all of it: {}\n", name, why.what());
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
