// The conditions of a sweep's points.
#pragma once

#include <string_view>

#include "runner/config/experiment.h"

namespace gfxrepro::config {

/// Null where the point does not have the axis.
const Node* valueAt(const AxisPoint& point, std::string_view axis);

/// Whether the point has each axis that `conditions` names, with a value that matches.
bool matchesAll(const AxisPoint& point, const Node& conditions);

/// Leaves out the axes whose condition in `when` is false. That may make further conditions false.
void applyWhen(const Node& when, AxisPoint& point);

}  // namespace gfxrepro::config
