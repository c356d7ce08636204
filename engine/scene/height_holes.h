// Samples without data, filled by a push-pull pyramid: of a map in memory, and of one that comes in
// bands of rows.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace gfxrepro::scene {

/// Rows of one step of the pyramid; NaN is "no data".
struct HoleLevel {
    glm::ivec2 sizeSamples{0};  // of the whole step
    int firstRow = 0;
    std::vector<float> values;  // of whole rows

    int endRow() const;
    float& at(int x, int y);
    float clamped(int x, int y);
};

/// Each hole takes a value from the finest level that has data around it. Levels coarser than a
/// band's are kept whole, the finer ones made again for each band and the bands beside it.
class HoleFilling {
  public:
    /// A coarse row stands for as many rows of the map.
    static constexpr int kBandRows = 64;
    /// Reads kBandRows rows, or those that are left, behind those that were read before.
    using Reader = std::function<void(int count, float* values)>;

    /// Reads all rows.
    HoleFilling(glm::ivec2 sizeSamples, const Reader& read);

    std::size_t holeCount() const { return holeCount_; }

    /// Reads all rows once more, band by band as they are asked for. Throws Error where no sample
    /// has data.
    void restart(Reader read);
    /// The next band, filled.
    void next(float* values);

  private:
    void readBand();

    glm::ivec2 sizeSamples_;
    std::size_t holeCount_ = 0;
    std::vector<HoleLevel> coarse_;
    Reader read_;
    HoleLevel window_;  // the band and those beside it, as read
    int nextRow_ = 0;
};

}  // namespace gfxrepro::scene
