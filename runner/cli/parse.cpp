#include "runner/cli/parse.h"

#include <fmt/core.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "engine/gl/device.h"
#include "runner/cli/experiments.h"
#include "runner/cli/help.h"
#include "runner/config/schema.h"

namespace gfxrepro::cli {

namespace {

/// The innermost command that was named.
const CLI::App* chosenCommand(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? &app : chosenCommand(*chosen.front());
}

/// What follows `gfxrepro help` to say more of a command: "image crop".
std::string nameBehindHelp(const CLI::App& command) {
    const CLI::App* above = command.get_parent();
    const bool isNested = above && above->get_parent();
    return (isNested ? nameBehindHelp(*above) + ' ' : "") + command.get_name();
}

/// What a command asks for and was not given, with an example.
UsageError missingError(const CLI::App& command, const std::string& problem) {
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_required() || option->count() > 0) continue;
        const std::string name = option->get_positional() ? valueName(*option) : option->get_name();
        const std::string example = command.get_footer();
        return UsageError(fmt::format("{}: {} is missing: {}{}", command.get_name(), name,
                                      option->get_description(),
                                      example.empty() ? "" : "; for example: " + example));
    }
    return UsageError(command.get_name() + ": " + problem);
}

/// One clear message for what the parser did not take.
UsageError usageError(const CLI::App& app, const CLI::ParseError& problem) {
    const CLI::App& command = *chosenCommand(app);
    const std::string name = command.get_name();
    const std::string whose = &command == &app ? "" : name + ": ";
    const std::vector<std::string> extras = app.remaining(true);
    if (!extras.empty()) {
        const std::string& extra = extras.front();
        if (extra.starts_with("-")) {
            const std::string option = extra.substr(0, extra.find('='));
            return UsageError(whose + "unknown option '" + option + "'" +
                              suggestion(option, optionNames(command)) +
                              (&command == &app
                                   ? "; see 'gfxrepro --help'"
                                   : "; see 'gfxrepro help " + nameBehindHelp(command) + "'"));
        }
        if (&command == &app) {
            return UsageError("unknown command '" + extra + "'" +
                              suggestion(extra, commandNames(app)) + "; see 'gfxrepro --help'");
        }
        return UsageError(whose + "unexpected argument '" + extra + "'");
    }
    if (dynamic_cast<const CLI::RequiredError*>(&problem)) {
        return missingError(command, problem.what());
    }
    return UsageError(whose + problem.what());
}

/// Of all commands those whose value the help calls so.
std::vector<CLI::Option*> optionsCalled(const std::string& value, CLI::App& app) {
    std::vector<CLI::Option*> found;
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        for (CLI::Option* option : command->get_options()) {
            if (valueName(*option) == value) found.push_back(option);
        }
    }
    return found;
}

/// `latest` is the newest run of runs/ wherever a run is named.
void takeLatest(CLI::App& app) {
    const auto toFolder = [](std::string& name) {
        if (name != "latest" || std::filesystem::exists(name)) return std::string();
        const std::vector<std::filesystem::path> runs = runFolders();
        if (runs.empty()) return std::string("latest: there is no run in runs/");
        name = runs.back().string();
        return std::string();
    };
    for (CLI::Option* option : optionsCalled("RUN", app)) {
        option->transform(CLI::Validator(toFolder, "", "latest"));
    }
}

void refuseUnknownDevices(CLI::App& app) {
    const auto whyNot = [](std::string& name) -> std::string {
        try {
            gl::requireDeviceName(name);
            return "";
        } catch (const UsageError& error) {
            return error.what();
        }
    };
    for (CLI::Option* option : optionsCalled("DEVICE", app)) {
        option->check(CLI::Validator(whyNot, "", "device"));
    }
}

/// `gfxrepro help run` is `gfxrepro run --help`, `gfxrepro version` is `gfxrepro --version`.
std::vector<const char*> spelledOut(int argc, const char* const* argv) {
    std::vector<const char*> words(argv, argv + argc);
    if (argc < 2) return words;
    if (std::string_view(words[1]) == "version" && argc == 2) words[1] = "--version";
    if (std::string_view(words[1]) == "help") {
        words.erase(words.begin() + 1);
        words.push_back("--help");
    }
    return words;
}

}  // namespace

void addProfile(CLI::App* app, std::string& profile, const std::string& doc) {
    app->add_option("--profile", profile, doc + " (default " + profile + ")")
        ->check(CLI::IsMember(
            std::vector<std::string>(config::kProfiles.begin(), config::kProfiles.end())));
}

void parse(CLI::App& app, int argc, const char* const* argv) {
    takeLatest(app);
    refuseUnknownDevices(app);
    try {
        const std::vector<const char*> words = spelledOut(argc, argv);
        app.parse(static_cast<int>(words.size()), words.data());
    } catch (const CLI::Success& help) {  // --help, --version: CLI11 answers them by throwing
        const std::vector<std::string> extras = app.remaining(true);
        if (!extras.empty() && !extras.front().starts_with('-')) throw usageError(app, help);
        std::ostringstream text;
        app.exit(help, text, text);
        fmt::print("{}", text.str());  // flushed, and checked, with all else at the program's end
    } catch (const CLI::ParseError& problem) {
        throw usageError(app, problem);
    }
}

}  // namespace gfxrepro::cli
