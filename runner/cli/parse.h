// A command line taken apart by CLI11, with our words for what it does not take.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace gfxrepro::cli {

/// Adds `--profile`, whose default, the present value of `profile`, the help tells.
void addProfile(CLI::App* app, std::string& profile,
                const std::string& doc = "how many cases, frames and repeats");

/// Runs the callbacks of the commands that were named; none where help or version was printed.
/// Throws UsageError, with the nearest name, for what is unknown. `gfxrepro help run` is `gfxrepro
/// run --help`, `gfxrepro version` is `gfxrepro --version`.
void parse(CLI::App& app, int argc, const char* const* argv);

}  // namespace gfxrepro::cli
