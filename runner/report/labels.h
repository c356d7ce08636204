// Names of configs as people read them.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace gfxrepro::report {

/// "bird nest" of "outdoor/bird_nest", "draw ms" of "draw_ms"; what is no such name stays as it is.
std::string shownName(std::string_view name);

/// The shown names of an axis; those that would be alike keep their folder.
std::map<std::string, std::string> shownNames(const std::set<std::string>& names);

}  // namespace gfxrepro::report
