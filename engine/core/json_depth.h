// How deep JSON is nested: the library's copies and texts recurse, and a file of brackets alone
// would take the whole stack.
#pragma once

#include <string_view>

namespace gfxrepro {

/// More than anything that the program writes has.
constexpr int kMostJsonLevels = 200;

/// Whether brackets outside of strings are open deeper than that, at any place of the text.
bool isTooDeepJson(std::string_view text);

}  // namespace gfxrepro
