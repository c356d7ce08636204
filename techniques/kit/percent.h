// Shares as percentages.
#pragma once

namespace gfxrepro::kit {

/// `part` of `whole` in percent; of nothing 0.
template <class Part, class Whole>
double percent(Part part, Whole whole) {
    return whole > Whole{} ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

}  // namespace gfxrepro::kit
