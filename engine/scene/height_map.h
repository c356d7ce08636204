// Height maps: regular grids of terrain heights, loaded, generated, repaired, resampled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/height_file.h"

namespace gfxrepro::scene {

struct Box;
struct Mesh;

/// Sample (column, row) stands at (column · spacingM.x, height, row · spacingM.y): x is east, z
/// south, y up; the north-western sample is at x = z = 0. All heights are finite. They are in
/// memory, or in a file of which only what is looked at is read.
struct HeightMap {
    glm::ivec2 sizeSamples{0};     // x: columns from west to east, y: rows from north to south
    glm::vec2 spacingM{1.0F};      // from west to east, from north to south
    bool isSpacingOfFile = false;  // the file's own, as nobody else said it
    std::string spacingWarning;    // where that is a guess; for the log
    std::string unitWarning;       // of heights that are taken as metres; likewise
    std::vector<float> heightsM;   // row by row, the northernmost first; empty with a file
    // Shared, against the house's rule: copies of a scene look at one file.
    std::shared_ptr<const HeightFile> file;
    std::size_t filledCount = 0;  // samples without data in the source, filled from around
    bool isEightBit = false;      // of a source with 256 steps: terraces are to be expected

    bool isEmpty() const { return heightsM.empty() && !file; }
    float heightM(int column, int row) const {
        const float* all = file ? file->heightsM(0) : heightsM.data();
        return all[static_cast<std::size_t>(row) * static_cast<std::size_t>(sizeSamples.x) +
                   static_cast<std::size_t>(column)];
    }
    /// The sample's, or that of the nearest one on the border for places beyond it.
    float clampedHeightM(int column, int row) const {
        return heightM(glm::clamp(column, 0, sizeSamples.x - 1),
                       glm::clamp(row, 0, sizeSamples.y - 1));
    }
    /// The same for a place whose column and row are multiples of 2^level, as a file has it at
    /// hand.
    float clampedHeightM(int column, int row, int level) const;
    /// What was looked at of a file's heights leaves the memory (HeightFile::release()).
    void release() const {
        if (file) file->release();
    }
    struct Extremes {
        float lowestM = 0.0F, highestM = 0.0F;
        glm::ivec2 highestSample{0};  // the first of them, row by row
        /// From the lowest to the highest, or a hundred thousandth of the height where that is
        /// more: what a plain is drawn with is rounded to some millionths.
        float reliefM() const;
    };
    /// Of a map with samples.
    Extremes extremes() const;
    glm::vec3 position(int column, int row) const {
        return {static_cast<float>(column) * spacingM.x, heightM(column, row),
                static_cast<float>(row) * spacingM.y};
    }
    Box bounds() const;
};

/// Of files: fewer samples span no ground.
constexpr int kMinHeightMapSide = 2;
/// Of heights in memory, and of those in a file.
constexpr int kMaxHeightMapSide = 16385, kMaxHeightFileSide = 65537;
/// Maps with longer sides are kept in a file where there is a choice: 64 MiB of heights.
constexpr int kMostSamplesInMemory = 4097;

/// How a file's values become metres: height = (value · scale + offset) · heightScaleM, with the
/// scale and the offset that a GeoTIFF may state.
struct HeightMapUnits {
    std::optional<float> spacingM;  // both ways; none: what the file says, else 1
    float heightScaleM = 1.0F;
    std::optional<float> noData;  // a further value, before scaling, that means "none"
};

/// By extension, any case: .png (8 or 16 bits), .tif .tiff (integers up to 32 bits, floats), .hgt
/// (SRTM), .raw .r16 .bin (with a sidecar <file>.yaml: rawHeightSchema()).
/// Samples without data are filled (fillHoles). Throws one Error that names the file for all that
/// it refuses, before it allocates more than the file can hold.
HeightMap loadHeightMap(const std::filesystem::path& path, const HeightMapUnits& units);
/// The same in a file of `folder`, where the sides are longer than kMostSamplesInMemory: made there
/// from a band of rows at a time (and those beside it, where there are holes: some 2 KiB of memory
/// a column) unless `key`, which stands for the file and the units, is there. In memory where the
/// folder cannot be written (settleForMemory).
HeightMap loadHeightMapInFile(const std::filesystem::path& path, const HeightMapUnits& units,
                              const std::filesystem::path& folder, const std::string& key,
                              int mostSamplesInMemory = kMostSamplesInMemory);
bool isHeightMapFile(const std::filesystem::path& path);

/// Fills samples that are not finite by a push-pull pyramid: each from the finest level that has
/// data around it. Counts them in filledCount. Throws Error when no sample has data.
void fillHoles(HeightMap& map);

/// The same ground with `sizeSamples` a side (bicubic, through the old samples) and fractal detail
/// between the old samples, at most `detailM` up or down: a stand-in for a finer survey.
HeightMap resampled(const HeightMap& map, int sizeSamples, float detailM, std::uint64_t seed);
/// The same in a file of `folder`, made there a few rows at a time unless `key`, which stands for
/// all of these, is there. In memory where the folder cannot be written (settleForMemory).
HeightMap resampledInFile(const HeightMap& map, int sizeSamples, float detailM, std::uint64_t seed,
                          const std::filesystem::path& folder, const std::string& key);

/// How far samples stand apart: `30 m`, or `30 x 10 m` from west to east and from north to south.
std::string metresText(glm::vec2 spacingM);

/// What to say of a map whose heights differ by more than half of its longer side, as they do where
/// nobody said how far its samples stand apart; empty of others.
std::string steepnessWarning(const HeightMap& map);

/// Where the file of a map cannot be written: says in the log that the map is held in memory
/// instead, or throws Error where its sides are longer than kMaxHeightMapSide.
void settleForMemory(const std::string& name, glm::ivec2 sizeSamples, const WriteError& why);

/// Triangles over every n-th sample (and the last), at most `maxSamples` a side, for previews.
Mesh heightMapMesh(const HeightMap& map, int maxSamples = 513);

}  // namespace gfxrepro::scene
