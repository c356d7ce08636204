// The help of every command, on one screen. It is made from what cli.cpp declares; here stand the
// order of the commands and an example of each.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "runner/cli/commands.h"

namespace gfxrepro::cli {

/// Sets the groups, examples and formatter of all commands.
void arrangeHelp(CLI::App& app);

/// `RUN`, or what is allowed, `quick|full|paper`; empty for a flag.
std::string valueName(const CLI::Option& option);

/// The commands that people see, in the order of the help; those below `app` alone.
std::vector<const CLI::App*> visibleCommands(const CLI::App& app);

/// Their names.
std::vector<std::string> commandNames(const CLI::App& app);

/// "--profile", …
std::vector<std::string> optionNames(const CLI::App& app);

struct HelpEntry {
    std::string name;  // "-h, --help", "--profile quick|full|paper", "CONFIG…"
    std::string doc;
};
/// The arguments and options of a command.
std::vector<HelpEntry> helpEntries(const CLI::App& app);

/// Lines of a screen's width: `name`, and `doc` wrapped beside it from `column` on.
std::string entryLines(const std::string& name, const std::string& doc, std::size_t column);

/// "gfxrepro run [OPTION…] [CONFIG…]" for the full `name` of a command.
std::string usageLine(const CLI::App& app, const std::string& name);

/// In the man macros of roff.
std::string manPage(const CLI::App& app);

/// `words` are those behind the program's name; the last is unfinished, perhaps empty. What ends in
/// a slash goes on.
std::vector<std::string> completions(const CLI::App& app, const Context& context,
                                     const std::vector<std::string>& words);

/// A script for "bash", "zsh" or "fish" that asks `gfxrepro complete WORD…`.
std::string completionScript(const std::string& shell);

}  // namespace gfxrepro::cli
