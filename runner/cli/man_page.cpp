#include "runner/cli/man_page.h"

#include <fmt/format.h>

#include "runner/cli/help.h"
#include "runner/run/manifest.h"

namespace gfxrepro::cli {

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
