// `slope` of a plot: what its curves are held against.
#pragma once

#include <cstddef>
#include <optional>

#include "runner/config/experiment.h"

namespace gfxrepro::config {

/// Exponent of x that the plot's curves are expected to have, drawn as a dashed line; both axes of
/// such a plot are logarithmic. `plot`: its place in experiment.plots. None where it says none.
std::optional<double> referenceSlope(const Experiment& experiment, std::size_t plot);

}  // namespace gfxrepro::config
