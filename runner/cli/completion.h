// What a shell offers behind a command line that is being typed. The program answers itself, from
// what cli.cpp declares and from the configs that it has: nothing can drift.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "runner/cli/commands.h"

namespace gfxrepro::cli {

/// `words` are those behind the program's name; the last is unfinished, perhaps empty. What ends in
/// a slash goes on.
std::vector<std::string> completions(const CLI::App& app, const Context& context,
                                     const std::vector<std::string>& words);

/// A script for "bash", "zsh" or "fish" that asks `gfxrepro complete WORD…`.
std::string completionScript(const std::string& shell);

}  // namespace gfxrepro::cli
