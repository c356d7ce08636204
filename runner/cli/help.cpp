#include "runner/cli/help.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <cctype>
#include <memory>

#include "engine/core/text.h"
#include "runner/run/manifest.h"

namespace gfxrepro::cli {

namespace {

/// Of the terminal that is written to, within what can be read; 80 of anything else.
std::size_t screenWidth() {
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return std::clamp<std::size_t>(size.ws_col, 50, 120);
}

constexpr std::size_t kMaxNameWidth = 30;

/// A command's place in the help, and an example.
struct Place {
    std::string_view command;
    std::string_view group;
    std::string_view example;
};
constexpr Place kPlaces[] = {
    {"doctor", "look", "gfxrepro doctor"},
    {"list", "look", "gfxrepro list tables"},
    {"describe", "look", "gfxrepro describe models/bunny"},
    {"check", "look", "gfxrepro check my-scene.yaml"},
    {"scene", "look", "gfxrepro scene models/bunny --render bunny.png"},
    {"", "look", ""},  // those of techniques, which have their examples
    {"plan", "measure", "gfxrepro plan my-scene.yaml --profile quick"},
    {"run", "measure", "gfxrepro run my-scene.yaml --set resolution=64 --out my-run"},
    {"reproduce", "measure", "gfxrepro reproduce zju2005/2.1 --profile quick"},
    {"table", "results", "gfxrepro table runs/my-run"},
    {"claims", "results", "gfxrepro claims runs/my-run"},
    {"report", "results", "gfxrepro report runs/my-run"},
    {"export", "results", "gfxrepro export runs/my-run --out artifact"},
    {"import", "results", "gfxrepro import theirs.csv --metric render_time_ms=ms"},
    {"compare", "compare", "gfxrepro compare runs/before runs/after"},
    {"history", "compare", "gfxrepro history runs/nightly/history.csv --out nights.html"},
    {"sensitivity", "compare", "gfxrepro sensitivity zju2005/2.1"},
    {"image", "compare", "gfxrepro image diff a.exr b.exr"},
    {"submit", "cluster", "gfxrepro submit zju2005 --shards 8 --gres gpu:1 --out whole"},
    {"merge", "cluster", "gfxrepro merge shard-1 shard-2 --out whole"},
    {"completion", "shell", "source <(gfxrepro completion bash)"},
};

std::size_t helpPlaceOf(const CLI::App& command) {
    const auto placeOf = [](std::string_view name) {
        return std::ranges::find(kPlaces, name, &Place::command);
    };
    const Place* found = placeOf(command.get_name());
    if (found == std::end(kPlaces)) found = placeOf("");
    return static_cast<std::size_t>(found - std::begin(kPlaces));
}

bool isChoice(const std::string& value) {
    return value.find('|') != std::string::npos;
}

std::string inCapitals(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return name;
}

/// "CONFIG…"; of a choice its own name, as the choices would be too long.
std::string argumentName(const CLI::Option& argument) {
    std::string name = valueName(argument);
    if (isChoice(name)) name = inCapitals(argument.get_name());
    return argument.get_expected_max() > 1 ? name + "…" : name;
}

std::string commandLines(const CLI::App& app) {
    const std::vector<const CLI::App*> commands = visibleCommands(app);
    std::size_t groupWidth = 0, nameWidth = 0;
    for (const CLI::App* command : commands) {
        groupWidth = std::max(groupWidth, command->get_group().size());
        nameWidth = std::max(nameWidth, command->get_name().size());
    }
    std::string text, last;
    for (const CLI::App* command : commands) {
        const std::string group = command->get_group() == last ? "" : command->get_group();
        last = command->get_group();
        const std::string name =
            fmt::format("{:<{}}  {:<{}}", group, groupWidth, command->get_name(), nameWidth);
        text += entryLines(name, command->get_description(), groupWidth + nameWidth + 4);
    }
    return text;
}

/// CLI11's own does not wrap, and spends a line on each group.
class ScreenFormatter : public CLI::FormatterBase {
  public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode) const override {
        std::string text = app->get_description() + "\nUsage: " + usageLine(*app, name);
        if (!visibleCommands(*app).empty()) {
            return text + "; with --help a command says more\n\n" + commandLines(*app);
        }
        text += "\n\n";
        const std::vector<HelpEntry> entries = helpEntries(*app);
        std::size_t column = 0;
        for (const HelpEntry& entry : entries) {
            const std::size_t width = columnsOf(entry.name);
            if (width <= kMaxNameWidth) column = std::max(column, width + 4);
        }
        for (const HelpEntry& entry : entries) {
            text += entryLines("  " + entry.name, entry.doc, column);
        }
        const std::string example = app->get_footer();
        return example.empty() ? text : text + "\nExample: " + example + "\n";
    }
};

void setFormatter(CLI::App& app, const std::shared_ptr<CLI::FormatterBase>& formatter) {
    app.formatter(formatter);
    for (CLI::App* command : app.get_subcommands({})) setFormatter(*command, formatter);
}

}  // namespace

std::string entryLines(const std::string& name, const std::string& doc, std::size_t column) {
    std::string text;
    std::string line = name;
    if (columnsOf(line) + 2 > column) {
        text = line + "\n";
        line.clear();
    }
    line.append(column - columnsOf(line), ' ');
    const std::size_t width = screenWidth();
    for (const std::string& word : split(doc, ' ')) {
        const bool isFirst = line.find_last_not_of(' ') == std::string::npos || line.back() == ' ';
        if (!isFirst && columnsOf(line) + 1 + columnsOf(word) > width) {
            text += line + "\n";
            line = std::string(column, ' ');
        } else if (!isFirst) {
            line += ' ';
        }
        line += word;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return text + line + "\n";
}

void arrangeHelp(CLI::App& app) {
    for (CLI::App* command : app.get_subcommands({})) {
        if (command->get_group().empty()) continue;  // not shown
        const Place& place = kPlaces[helpPlaceOf(*command)];
        command->group(std::string(place.group));
        if (!place.example.empty()) command->footer(std::string(place.example));
        for (CLI::App* part : command->get_subcommands({})) part->group(command->get_name());
    }
    setFormatter(app, std::make_shared<ScreenFormatter>());  // CLI11 wants it shared
}

std::string valueName(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0) return "";
    if (!option.get_option_text().empty()) return option.get_option_text();
    // Of the values that are checked for CLI11 says "TEXT:{quick,full,paper}".
    const std::string type = option.get_type_name();
    const std::size_t first = type.find('{');
    const std::size_t last = type.find('}');
    if (first != std::string::npos && last != std::string::npos && first < last) {
        return joined(split(type.substr(first + 1, last - first - 1), ','), "|");
    }
    return option.get_positional() ? inCapitals(option.get_name()) : "VALUE";
}

std::vector<const CLI::App*> visibleCommands(const CLI::App& app) {
    std::vector<const CLI::App*> commands =
        app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
    std::stable_sort(commands.begin(), commands.end(), [](const auto* a, const auto* b) {
        return helpPlaceOf(*a) < helpPlaceOf(*b);
    });
    return commands;
}

std::vector<std::string> commandNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : visibleCommands(app)) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::vector<HelpEntry> helpEntries(const CLI::App& app) {
    std::vector<HelpEntry> arguments, options;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;
        const std::string value = valueName(*option);
        if (option->get_positional()) {
            std::string doc = option->get_description();
            if (isChoice(value)) doc += fmt::format(": {}", joined(split(value, '|'), " | "));
            arguments.push_back({argumentName(*option), doc});
            continue;
        }
        std::string name;
        for (const std::string& letter : option->get_snames()) name += "-" + letter + ", ";
        name += "--" + option->get_lnames().front();
        if (!value.empty()) name += " " + value;
        options.push_back({name, option->get_description()});
    }
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
}

std::string usageLine(const CLI::App& app, const std::string& name) {
    std::string line = name;
    if (!visibleCommands(app).empty()) return line + " COMMAND [OPTION…]";
    line += " [OPTION…]";
    for (const CLI::Option* option : app.get_options()) {
        if (!option->get_positional()) continue;
        const std::string value = argumentName(*option);
        line += option->get_required() ? " " + value : " [" + value + "]";
    }
    return line;
}

namespace {

/// Text as roff takes it: a plain hyphen may become another sign, a dot begins a macro.
std::string roff(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\') {
            escaped += "\\e";
        } else if (c == '-') {
            escaped += "\\-";
        } else {
            escaped += c;
        }
    }
    const bool isMacro = !text.empty() && (text.front() == '.' || text.front() == '\'');
    return isMacro ? "\\&" + escaped : escaped;
}

std::string entryText(const std::string& name, const std::string& doc) {
    return fmt::format(".TP\n.B {}\n{}\n", roff(name), roff(doc.empty() ? "see above" : doc));
}

/// A command with its options, and those below it.
std::string commandText(const CLI::App& command, const std::string& name) {
    std::string text;
    const auto below = visibleCommands(command);
    if (below.empty()) {
        text = fmt::format(".SS {}\n{}\n", roff(usageLine(command, name)),
                           roff(command.get_description()));
        for (const HelpEntry& entry : helpEntries(command)) {
            if (entry.name != "-h, --help") text += entryText(entry.name, entry.doc);
        }
    }
    for (const CLI::App* next : below) {
        text += commandText(*next, fmt::format("{} {}", name, next->get_name()));
    }
    return text;
}

std::string examples(const CLI::App& app) {
    std::string text = ".SH EXAMPLES\n";
    for (const CLI::App* command : visibleCommands(app)) {
        if (command->get_footer().empty()) continue;
        text += fmt::format(".TP\n.B {}\n{}\n", roff(command->get_footer()),
                            roff(command->get_description()));
    }
    return text;
}

constexpr const char* kDescription = R"(.SH DESCRIPTION
Experiments are YAML files: one published table, figure or section each, with its printed numbers,
what is measured for it, and the claims that must follow.
.B gfxrepro
measures them headless through EGL and OpenGL 4.5, on a GPU or on Mesa's software device, and writes
tables, verdicts and a report.
Every command has
.BR \-\-help .
)";

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
All is well.
.TP
.B 1
A claim failed, or a comparison gave an alarm.
.TP
.B 2
The command line, a config or a file is wrong, or cannot be read or written; the message says where.
.TP
.B 3
No usable device;
.B gfxrepro doctor
says what to do.
.TP
.B 4
Incomplete: some case did not finish, also where a claim failed, or a submission is not complete.
.TP
.B 130
Interrupted by Ctrl-C or SIGTERM;
.B \-\-resume
goes on.
)";

constexpr const char* kEnvironment = R"(.SH ENVIRONMENT
.TP
.B GFXREPRO_ASSETS
The folder of real models;
.B \-\-assets
wins over it.
.TP
.B GFXREPRO_DATA
The folder that holds
.I configs
and
.IR shaders ,
instead of the one beside the program.
.TP
.B GFXREPRO_MACHINE_ROOT
A folder in the place of / from which the load, the throttling and the heat of the machine are read.
.TP
.B GFXREPRO_START_LIMIT_S
Seconds that a driver has to open a device; 60 when unset.
.TP
.B XDG_CACHE_HOME
Where
.I gfxrepro/assets
is looked for when no other folder of models is named;
.I ~/.cache
when unset.
)";

constexpr const char* kFiles = R"(.SH FILES
.TP
.I PREFIX/share/gfxrepro/configs
The experiments, presets and scenes, with a README of all keys.
.TP
.I PREFIX/share/gfxrepro/configs/schema
JSON schemas of these files, for editors.
.TP
.I PREFIX/share/gfxrepro/shaders
The techniques' shaders.
.TP
.I runs/
Below the working directory: a folder a run, unless
.B \-\-out
names another.
)";

}  // namespace

std::string manPage(const CLI::App& app) {
    std::string text = fmt::format(
        ".TH GFXREPRO 1 \"{}\" \"gfxrepro {}\" \"User Commands\"\n"
        ".SH NAME\ngfxrepro \\- measure the tables of rendering papers again\n"
        ".SH SYNOPSIS\n.B gfxrepro\n.I COMMAND\n[\\fIOPTION\\fR…]\n",
        run::programCommitDay(), GFXREPRO_VERSION);
    text += kDescription;
    text += ".SH COMMANDS\n";
    for (const CLI::App* command : visibleCommands(app)) {
        text += commandText(*command, fmt::format("gfxrepro {}", command->get_name()));
    }
    return text + kExitStatus + kEnvironment + kFiles + examples(app);
}

}  // namespace gfxrepro::cli
