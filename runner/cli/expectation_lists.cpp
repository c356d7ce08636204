#include "runner/cli/expectation_lists.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/cli/experiments.h"
#include "runner/run/expectations.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

/// The tables of a folder. What cannot be loaded is none: a preset, or a config that `check` tells
/// of when it is asked.
class Folder {
  public:
    Folder(const Context& context, const fs::path& path, const std::string& assets)
        : context_(context), catalog_(openCatalog(context, assets)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
            const fs::path& file = entry.path();
            if (file.extension() != ".yaml" || file.filename().string().starts_with("expect-")) {
                continue;
            }
            try {
                const config::Experiment experiment =
                    config::loadExperiment(file, {}, dataFolder("configs"));
                tables_[experiment.id] = {file, experiment.profiles};
                names_.push_back(experiment.id);
            } catch (const Error&) {
            }
        }
    }

    void require(const run::Expectation& entry) {
        const auto table = tables_.find(entry.table);
        if (table == tables_.end()) {
            throw Error(entry.location, "table: no config beside the list is '" + entry.table +
                                            "'" + suggestion(entry.table, names_));
        }
        run::requireKnown(entry, casesOf(table->second));
    }

  private:
    struct Table {
        fs::path file;
        std::vector<std::string> profiles;
        std::vector<config::Case> cases = {};
    };

    const std::vector<config::Case>& casesOf(Table& table) {
        if (!table.cases.empty()) return table.cases;
        std::vector<std::string> profiles = table.profiles;
        profiles.emplace_back("full");
        for (const std::string& profile : profiles) {
            config::ExperimentOptions options;
            options.profile = profile;
            const config::Experiment experiment =
                config::loadExperiment(table.file, options, dataFolder("configs"));
            std::ranges::move(run::resolveCases(experiment, catalog_, context_.techniques, 1),
                              std::back_inserter(table.cases));
        }
        return table.cases;
    }

    const Context& context_;
    scene::Catalog catalog_;
    std::map<std::string, Table> tables_;
    std::vector<std::string> names_;
};

}  // namespace

std::vector<Error> unknownExpectations(const Context& context,
                                       const std::vector<std::string>& configs,
                                       const std::vector<std::string>& deviceClasses,
                                       const std::string& assets) {
    std::set<fs::path> folders;
    for (const std::string& config : configs) {
        folders.insert(fs::absolute(config).lexically_normal().parent_path());
    }
    std::vector<Error> unknown;
    for (const fs::path& path : folders) {
        std::vector<run::Expectation> entries;
        for (const std::string& deviceClass : deviceClasses) {
            const fs::path list = path / ("expect-" + deviceClass + ".yaml");
            if (!fs::exists(list)) continue;
            std::ranges::move(run::readExpectations({list, readFile(list)}),
                              std::back_inserter(entries));
        }
        if (entries.empty()) continue;
        Folder folder(context, path, assets);
        for (const run::Expectation& entry : entries) {
            try {
                folder.require(entry);
            } catch (const Error& error) {
                unknown.push_back(error);
            }
        }
    }
    return unknown;
}

}  // namespace gfxrepro::cli
