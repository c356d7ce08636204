#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/cli/commands.h"
#include "runner/cli/experiments.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

using Rows = std::vector<std::vector<std::string>>;  // name first, what it is last

Rows tables() {
    run::Request request;
    for (const fs::path& file : paperConfigs()) request.configs.push_back(file.string());
    Rows rows;
    for (const config::Experiment& experiment : loadExperiments(request, "full")) {
        rows.push_back({experiment.id, experiment.label() + ": " + experiment.title});
    }
    return rows;
}

Rows configs() {
    const fs::path folder = dataFolder("configs");
    Rows rows;
    for (const fs::directory_entry& file : entriesBelow(folder)) {
        const fs::path path = fs::relative(file.path(), folder);
        const std::string first = *path.begin();
        if (path.extension() == ".yaml" && first != "scenes" && first != "presets" &&
            first != "documents.yaml") {
            rows.push_back({file.path().lexically_normal().string()});
        }
    }
    std::sort(rows.begin(), rows.end());
    return rows;
}

Rows scenes(const Context& context, const std::string& assets) {
    Rows rows;
    const scene::Catalog catalog = openCatalog(context, assets);
    for (const auto& [name, entry] : catalog.entries()) {
        rows.push_back({name, sceneState(catalog, name), entry.doc});
    }
    return rows;
}

Rows techniques(const Context& context) {
    Rows rows;
    for (const technique::TechniqueInfo& info : context.techniques) {
        rows.push_back({std::string(info.name), std::string(info.summary)});
    }
    return rows;
}

Rows generators(const Context& context) {
    Rows rows;
    for (const scene::GeneratorInfo& info : context.generators) {
        rows.push_back({std::string(info.name), std::string(info.summary)});
    }
    return rows;
}

/// What first measured a run, or why that cannot be told.
std::string commandOf(const fs::path& manifest) {
    if (!fs::exists(fs::symlink_status(manifest))) return "not begun";
    try {
        return run::readManifest(manifest)["invocations"][0]["command"];
    } catch (const Error& error) {
        return error.what();
    }
}

/// Those in runs/, the newest last.
Rows runs() {
    Rows rows;
    for (const fs::path& run : runFolders()) {
        rows.push_back({run.string(), commandOf(run / "manifest.json")});
    }
    return rows;
}

}  // namespace

int list(const Context& context, const std::string& what, const std::string& assets, bool asJson) {
    const std::map<std::string, std::function<Rows()>> kinds = {
        {"configs", configs}, {"generators", [&] { return generators(context); }},
        {"runs", runs},       {"scenes", [&] { return scenes(context, assets); }},
        {"tables", tables},   {"techniques", [&] { return techniques(context); }},
    };
    const auto kind = kinds.find(what);
    if (kind == kinds.end()) {
        std::vector<std::string> names;
        for (const auto& [name, rows] : kinds) names.push_back(name);
        throw UsageError("list: unknown kind '" + what + "'" + suggestion(what, names) +
                         "; known: " + joined(names));
    }
    const Rows rows = kind->second();
    if (!asJson) {
        fmt::print("{}", alignedColumns(rows));
        return kExitOk;
    }
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const auto& row : rows) {
        json.push_back({{"name", row[0]}, {"summary", row.size() > 1 ? row.back() : ""}});
        if (row.size() > 2) json.back()["state"] = row[1];
    }
    fmt::print("{}\n", json.dump(2));
    return kExitOk;
}

}  // namespace gfxrepro::cli
