// Names of configs as people read them.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace gfxrepro::report {

/// `labels:` of a config: the words for a name.
using Words = std::map<std::string, std::string>;

/// The words for a name; else "bird nest" of "outdoor/bird_nest", "draw ms" of "draw_ms". What is
/// no such name stays as it is.
std::string shownName(std::string_view name, const Words& words = {});

/// The shown names of an axis; those that would be alike keep their folder.
std::map<std::string, std::string> shownNames(const std::set<std::string>& names,
                                              const Words& words = {});

}  // namespace gfxrepro::report
