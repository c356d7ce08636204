#include "runner/image/srgb.h"

#include <cmath>
#include <cstddef>

namespace gfxrepro::image {

std::array<float, 256> srgbDecoding() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double value = static_cast<double>(i) / 255.0;
        table[i] = static_cast<float>(value <= 0.04045 ? value / 12.92
                                                       : std::pow((value + 0.055) / 1.055, 2.4));
    }
    return table;
}

}  // namespace gfxrepro::image
