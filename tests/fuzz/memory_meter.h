// How much memory a piece of code asks operator new for.
#pragma once

#include <cstddef>

namespace gfxrepro::test {

/// Begins to measure: the peak becomes what is in use now.
void resetPeakMemory();
/// The most bytes in use since, above what was in use then.
std::size_t peakMemoryBytes();

}  // namespace gfxrepro::test
