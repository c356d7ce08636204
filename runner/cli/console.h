// What is said to a person.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>

namespace gfxrepro::cli {

/// A text that may be anybody's (of a config, of a run folder), as people are shown it: control
/// characters but tabs are '?', its further lines begin with "| ", and what the runner of GitHub
/// takes for commands ("::" where a line begins, "##[" anywhere) is broken by a blank.
std::string printable(std::string_view text);

/// Texts printable, everything else as it is.
template <class T>
decltype(auto) shown(const T& value) {
    if constexpr (std::is_convertible_v<const T&, std::string_view>) {
        return printable(value);
    } else {
        return (value);
    }
}

/// fmt::format of what is shown.
template <class... Arguments>
std::string shownText(fmt::string_view format, const Arguments&... arguments) {
    const auto formatted = [&](const auto&... values) {
        return fmt::vformat(format, fmt::make_format_args(values...));
    };
    return formatted(shown(arguments)...);
}

/// Writes to standard error. What cannot be written (a full disk, a terminal that is gone) is lost:
/// it ends no run.
template <class... Arguments>
void tell(fmt::format_string<const Arguments&...> format, const Arguments&... arguments) {
    const std::string text = shownText(format, arguments...);
    std::fwrite(text.data(), 1, text.size(), stderr);
}

/// Writes to standard output, as fmt::print.
template <class... Arguments>
void say(fmt::format_string<const Arguments&...> format, const Arguments&... arguments) {
    fmt::print("{}", shownText(format, arguments...));
}

}  // namespace gfxrepro::cli
