// Heights in a file: maps that are made once, shared by processes, and larger than memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace gfxrepro::scene {

/// The whole map and, for the tiles of coarser levels, every 2nd, 4th, … sample of it once more,
/// each level row by row. The file is mapped: what is looked at becomes resident until release(),
/// and with it as much of its surroundings as the system keeps in one piece (2 MiB on Linux 6.18):
/// who looks here and there does it a few samples at a time.
class HeightFile {
  public:
    /// The most that a folder of them keeps; those that were opened longest ago go first.
    static constexpr std::uintmax_t kMostBytes = std::uintmax_t{12} << 30;
    /// Rows are made so many at a time, the last fewer.
    static constexpr int kRowsAtOnce = 64;
    /// Fills `count` rows of sizeSamples.x heights, from `first` on; called from north to south.
    using RowsMaker = std::function<void(int first, int count, float* heightsM)>;
    /// Fills a row; called from several threads.
    using RowMaker = std::function<void(int row, float* heightsM)>;
    /// Rows that do not depend on each other.
    static RowsMaker inParallel(int width, RowMaker makeRow);
    /// What has to be known before the first row; called once where the file is made. Returns how
    /// many samples the source has no data for.
    using Preparation = std::function<std::size_t()>;

    /// Maps `folder`/<key>.heights, made first where it is not there, is cut off, or is another
    /// version's: a few rows at a time, under a temporary name that is renamed when it is whole, by
    /// one process while others wait. Throws WriteError where the folder cannot be written,
    /// and what the makers throw.
    static std::shared_ptr<const HeightFile> openOrBuild(const std::filesystem::path& folder,
                                                         const std::string& key,
                                                         glm::ivec2 sizeSamples,
                                                         const RowsMaker& makeRows,
                                                         const Preparation& prepare,
                                                         std::uintmax_t mostBytes = kMostBytes);

    const std::string& key() const { return key_; }
    float lowestM() const { return lowestM_; }
    float highestM() const { return highestM_; }
    /// Of the samples as high as that the first, row by row.
    glm::ivec2 highestSample() const { return highestSample_; }
    /// Samples that the source has no data for.
    std::size_t filledCount() const { return filledCount_; }

    int levelCount() const { return static_cast<int>(levels_.size()); }
    /// Samples (column, row) · 2^level.
    glm::ivec2 sizeSamples(int level) const { return (sizeSamples_ - 1) / (1 << level) + 1; }
    const float* heightsM(int level) const { return levels_[static_cast<std::size_t>(level)]; }
    /// Takes what was looked at out of the process's memory. The system keeps it as long as it has
    /// room, so that to look again costs little. May be called while others look.
    void release() const;

  private:
    HeightFile(const std::filesystem::path& path, std::string key, glm::ivec2 sizeSamples);

    std::string key_;
    glm::ivec2 sizeSamples_{0};
    MappedFile file_;
    std::vector<const float*> levels_;
    float lowestM_ = 0.0F, highestM_ = 0.0F;
    glm::ivec2 highestSample_{0};
    std::size_t filledCount_ = 0;
};

}  // namespace gfxrepro::scene
