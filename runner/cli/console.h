// What is said to a person.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace gfxrepro::cli {

/// Writes to standard error. What cannot be written (a full disk, a terminal that is gone) is lost:
/// it ends no run.
template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    const std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
    std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace gfxrepro::cli
