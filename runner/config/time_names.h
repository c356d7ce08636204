// By which names claims know what varies from run to run.
#pragma once

#include <string>
#include <string_view>

namespace gfxrepro::config {

/// Claims know times and rates by their names (tables::timePower) and judge everything else from
/// one sample. Why a metric of that name and unit would be taken for what it is not, as a sentence;
/// empty where it is not. A time is `…_ms` in ms, or `…_us_per_…` in us; what is per second is
/// `…frame_rate` or `…_per_second`.
std::string whyNoTimeName(std::string_view name, std::string_view unit);

}  // namespace gfxrepro::config
