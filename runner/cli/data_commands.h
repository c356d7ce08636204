// Data that leaves and comes in: `export`, `import`, `history`; options in, exit code out.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runner/cli/commands.h"

namespace CLI {
class App;
}

namespace gfxrepro::cli {

struct ExportOptions {
    std::string runDir;
    std::string out;  // folder; empty: DIR-artifact, or DIR-tidy
    std::string assets;
    bool isTidy = false;  // tables for other programs in place of an artifact
};

/// Numbers that were measured elsewhere.
struct ImportOptions {
    std::string file;
    std::string cases;                 // file that says what `case_id` is; empty: none
    std::vector<std::string> metrics;  // "COLUMN=UNIT": columns of numbers
    std::vector<std::string> configs;  // how they are shown, and what must follow
    std::string profile = "full";
    std::string machine;
    std::string out;
    std::string assets;
    bool isOfGpu = false;
};

/// Histories that `compare --history` has kept.
struct HistoryOptions {
    std::vector<std::string> files;
    std::string out = "history.html";
};

struct DataOptions {
    ExportOptions exported;
    ImportOptions imported;
    HistoryOptions history;
};

int exportRun(const Context& context, const ExportOptions& options);
int importRun(const Context& context, const ImportOptions& options);
int historyPage(const HistoryOptions& options);

/// Adds them to the program's; `command` becomes the one that was chosen.
void addDataCommands(CLI::App& app, const Context& context, DataOptions& options,
                     std::function<int()>& command);

}  // namespace gfxrepro::cli
