#include "runner/cli/parse.h"

#include <fmt/core.h>

#include <sstream>
#include <string>
#include <vector>

#include "runner/cli/help.h"
#include "runner/core/error.h"
#include "runner/core/text.h"

namespace gfxrepro::cli {

namespace {

/// The innermost command that was named.
const CLI::App* chosenCommand(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? &app : chosenCommand(*chosen.front());
}

/// One clear message for what the parser did not take.
UsageError usageError(const CLI::App& app, const CLI::ParseError& problem) {
    const CLI::App& command = *chosenCommand(app);
    const std::string name = command.get_name();
    const std::vector<std::string> extras = app.remaining(true);
    if (!extras.empty()) {
        const std::string& extra = extras.front();
        if (extra.starts_with("-")) {
            const std::string option = extra.substr(0, extra.find('='));
            return UsageError(name + ": unknown option '" + option + "'" +
                              suggestion(option, optionNames(command)) + "; see '" + name +
                              " --help'");
        }
        if (&command == &app) {
            return UsageError("unknown command '" + extra + "'" +
                              suggestion(extra, commandNames(app)) + "; see 'gfxrepro --help'");
        }
        return UsageError(name + ": unexpected argument '" + extra + "'");
    }
    return UsageError(name + ": " + problem.what());
}

}  // namespace

void parse(CLI::App& app, int argc, const char* const* argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {  // --help, --version: CLI11 answers them by throwing
        std::ostringstream text;
        app.exit(help, text, text);
        fmt::print("{}", text.str());  // flushed, and checked, with all else at the program's end
    } catch (const CLI::ParseError& problem) {
        throw usageError(app, problem);
    }
}

}  // namespace gfxrepro::cli
