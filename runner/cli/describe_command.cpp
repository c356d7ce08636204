#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/cli/help.h"
#include "runner/config/external_program.h"
#include "runner/config/schema.h"
#include "runner/tables/table.h"

namespace gfxrepro::cli {

namespace {

ParamInfos paramsGiven(const technique::TechniqueInfo& info, Node values) {
    Params params(std::move(values), "technique '" + std::string(info.name) + "'");
    // A choice may ask for others beside it: what was declared until then counts. So this catches.
    try {
        if (info.create) info.create(params);
    } catch (const Error&) {
    }
    return params.declared();
}

}  // namespace

ParamInfos paramsOf(const technique::TechniqueInfo& technique) {
    const ParamInfos usual = paramsGiven(technique, {});
    ParamInfos all = usual;
    for (const KeyInfo& param : usual) {
        for (const std::string& choice : param.choices) {
            const auto value = Node::scalar(choice, {}, true);
            for (KeyInfo& info : paramsGiven(technique, Node::map({{param.name, value}}))) {
                const bool isKnown = std::ranges::any_of(
                    all, [&](const auto& known) { return known.name == info.name; });
                if (isKnown) continue;
                info.doc += fmt::format("; with {}: {}", param.name, choice);
                all.push_back(std::move(info));
            }
        }
    }
    return all;
}

namespace {

constexpr std::size_t kColumn = 28;

/// "[256; 32 … 1024 voxels]"; a number that was given as a float is printed as one.
std::string valuesText(const KeyInfo& info) {
    std::string text = info.absent;
    const auto number = parseDouble(text);
    const auto single = static_cast<float>(number.value_or(0.0));
    if (number && static_cast<double>(single) == *number) text = fmt::format("{}", single);
    const std::string unit = info.unit.empty() || info.unit == "1" ? "" : ' ' + info.unit;
    text += info.allowed().empty() ? unit : "; " + info.allowed() + unit;
    return fmt::format("[{}]", text);
}

void printParams(const std::vector<KeyInfo>& params) {
    fmt::print("\nparameters, each with [default; what is allowed]\n");
    for (const KeyInfo& info : params) {
        fmt::print("{}", entryLines("  " + info.name, info.doc + ' ' + valuesText(info), kColumn));
    }
}

void printMetrics(std::span<const config::MetricInfo> metrics) {
    for (const config::MetricInfo& info : metrics) {
        std::string unit = info.unit == "1" ? "" : info.unit;
        if (const auto better = config::betterText(info.better); !better.empty()) {
            unit += (unit.empty() ? "" : ", ") + std::string(better);
        }
        fmt::print("{}", entryLines("  " + info.name,
                                    info.doc + (unit.empty() ? "" : " [" + unit + "]"), kColumn));
    }
}

void printOutputs(const config::Outputs& outputs) {
    fmt::print("\nmetrics\n");
    printMetrics(outputs.metrics);
    if (outputs.areRandom) {
        fmt::print(
            "  of random numbers: each process draws others (`measure: {{processes: 6}}`)\n");
    }
    fmt::print("\npasses: what times are of, and what tells values of a metric apart\n");
    for (const config::PassInfo& info : outputs.passes) {
        fmt::print("{}", entryLines("  " + info.name, info.doc, kColumn));
    }
    fmt::print("\nmetrics of every technique\n");
    printMetrics(technique::commonMetrics());
}

void describeTechnique(const technique::TechniqueInfo& info) {
    fmt::print("{}",
               entryLines("technique " + std::string(info.name), std::string(info.summary), 4));
    if (info.createFrom != nullptr) {
        fmt::print("{}", entryLines("\nparameters, metrics and passes",
                                    "those that 'program' of its config declares: 'gfxrepro "
                                    "describe config'; and these",
                                    4));
    } else {
        printParams(paramsOf(info));
    }
    printOutputs(info.outputs());
}

void describeProgram(const config::Experiment& experiment,
                     const technique::TechniqueInfo& technique) {
    const config::ExternalProgram program = config::readProgram(config::programOf(experiment));
    Params params(Node::map({}), "program");
    program.declare(params);
    fmt::print("\nprogram\n");
    for (const config::ProgramFile& file :
         config::filesOf(program, program.valuesOf(params.resolved()))) {
        fmt::print("{}", entryLines("  " + file.name,
                                    file.path.empty() ? "not on this machine" : file.path.string(),
                                    kColumn));
    }
    fmt::print("\ncommand\n  {}\n", joined(program.command, " "));
    printParams(params.declared());
    fmt::print("\nmetrics\n");
    printMetrics(program.outputs.metrics);
    std::vector<std::string> errors;  // of a picture against its truth
    for (const config::MetricInfo& metric : technique.outputs().metrics)
        errors.push_back(metric.name);
    if (!program.pictures.empty()) fmt::print("\nimages\n");
    for (const config::ProgramPicture& picture : program.pictures) {
        fmt::print(
            "{}",
            entryLines("  " + picture.name,
                       picture.file + (picture.hasTruth() ? ": " + joined(errors) : ""), kColumn));
    }
    if (program.outputs.passes.empty()) return;
    fmt::print("\npasses\n");
    for (const config::PassInfo& info : program.outputs.passes) {
        fmt::print("{}", entryLines("  " + info.name, info.doc, kColumn));
    }
}

void describeGenerator(const scene::GeneratorInfo& info) {
    say("generator {}: {}\n", info.name, info.summary);
    printParams(scene::declaredParams(info, {}));
}

void describeScene(const scene::SceneEntry& entry, const scene::Catalog& catalog) {
    say("scene {}: {}\n", entry.name, entry.doc);
    if (!entry.canonical.empty()) say("real one  {}\n", entry.canonical);
    for (const scene::SceneSource& source : entry.sources) {
        const std::string_view kind = scene::kindName(source.kind);
        if (source.file.empty()) {
            say("source    {}: generator {}, seed {}\n", kind, source.generator->name, source.seed);
            continue;
        }
        const std::filesystem::path path = catalog.assetsFolder() / source.file;
        say("source    {}: {}{}\n", kind, path.string(),
            std::filesystem::exists(path) ? "" : " (not there)");
    }
}

void describeExperiment(const Context& context, const config::Experiment& experiment) {
    say("{} ({}): {}\n", experiment.id, experiment.label(), experiment.title);
    say("file       {}\n", experiment.file.string());
    const bool isPrinted = experiment.technique.empty();
    say("technique  {}\n", isPrinted ? "none, only printed" : experiment.technique);
    const std::vector<config::Case> cases =
        run::resolveCases(experiment, openCatalog(context, ""), context.techniques, 1);
    say("cases      {}\n", cases.size());
    // What claims and curves may name.
    const tables::Table table = tables::buildTable(experiment, cases, {});
    std::vector<std::string> columns;
    for (const tables::TableColumn& column : table.columns) columns.push_back(column.label);
    say("rows       {}\n", joined(table.rowAxes));
    say("columns    {}\n", joined(columns));
    for (const auto& [scene, params] : experiment.paramsByScene.entries()) {
        say("of scene   {}: {}\n", scene, params.toFlowText());
    }
    if (!experiment.sceneParams.entries().empty()) {
        say("of scenes  {}\n", experiment.sceneParams.toFlowText());
    }
    say("profiles   full{}\n",
        experiment.profiles.empty() ? "" : ", " + joined(experiment.profiles));
    if (!experiment.printed.hardware.empty()) {
        say("printed    on {}\n", experiment.printed.hardware);
    }
    for (const config::ClaimSpec& claim : experiment.claims) {
        say("claim      {}: {}\n", claim.id, claim.text);
    }
    for (const config::Assumption& assumption : experiment.assumptions) {
        // A parameter's value is the cases'.
        const bool isFreeText = !assumption.value.isNull();
        say("assumed    {}{}{}: {}\n", assumption.name, isFreeText ? " = " : "",
            isFreeText ? assumption.value.toFlowText() : "", assumption.why);
    }
    if (config::programOf(experiment).isNull()) return;
    describeProgram(experiment,
                    technique::findTechnique(context.techniques, experiment.technique, {}));
}

template <class Infos>
auto findNamed(const Infos& infos, const std::string& name) {
    return std::find_if(infos.begin(), infos.end(),
                        [&](const auto& info) { return info.name == name; });
}

config::SchemaNames schemaNames(const Context& context) {
    config::SchemaNames names;
    for (const technique::TechniqueInfo& info : context.techniques) {
        names.techniques.push_back({std::string(info.name), paramsOf(info),
                                    technique::outputsOf(info), info.createFrom != nullptr});
    }
    for (const scene::GeneratorInfo& info : context.generators) {
        names.generators.emplace_back(info.name);
    }
    return names;
}

/// The keys of configs, for people or for editors.
bool describeSchema(const Context& context, const DescribeOptions& options) {
    if (options.asJsonSchema) {
        const std::string kind = options.name.empty() ? "experiment" : options.name;
        fmt::print("{}", config::jsonSchema(kind, schemaNames(context)));
    } else if (options.asMarkdown) {
        if (!options.name.empty() && options.name != "config") {
            throw UsageError("describe: --markdown is for 'config' alone");
        }
        fmt::print("{}", config::describeConfigInMarkdown());
    } else if (options.name == "config") {
        fmt::print("{}", config::describeConfig());
    } else {
        return false;
    }
    return true;
}

void writeYaml(const std::string& prefix, const Node& node, std::size_t indent, std::string& text);

/// The entries of a map or the items of a list, in block style.
std::string yamlBelow(const Node& node, std::size_t indent) {
    std::string text;
    if (node.isMap()) {
        for (const auto& [key, value] : node.entries()) {
            writeYaml(Node::scalar(key).toFlowText() + ":", value, indent, text);
        }
    } else {
        for (const Node& item : node.items()) writeYaml("-", item, indent, text);
    }
    return text;
}

/// Behind "key:" or "-". What does not fit on a line is in block style.
void writeYaml(const std::string& prefix, const Node& node, std::size_t indent, std::string& text) {
    constexpr std::size_t kColumns = 100;
    const std::string pad(indent, ' '), below(indent + 2, ' ');
    const std::string line = pad + prefix + ' ' + node.toFlowText();
    const bool isLong = line.size() > kColumns;
    if (node.isScalar() && node.text().find('\n') != std::string::npos &&
        !node.text().starts_with(' ') && !node.text().ends_with("\n\n")) {
        text += pad + prefix + (node.text().ends_with('\n') ? " |\n" : " |-\n");
        for (const std::string& row : split(trimmed(node.text()), '\n')) {
            text += (row.empty() ? "" : below + row) + '\n';
        }
    } else if (node.isScalar() && isLong && node.text().find("  ") == std::string::npos &&
               trimmed(node.text()) == node.text() && !parseDouble(node.text())) {
        text += pad + prefix + " >-\n";
        std::string row = below;
        for (const std::string& word : split(node.text(), ' ')) {
            if (row.size() > below.size() && row.size() + 1 + word.size() > kColumns) {
                text += row + '\n';
                row = below;
            }
            row += (row.size() > below.size() ? " " : "") + word;
        }
        text += row + '\n';
    } else if (isLong && (node.isMap() || node.isSequence())) {
        const std::string inner = yamlBelow(node, indent + 2);
        text += prefix == "-" ? pad + "- " + inner.substr(indent + 2) : pad + prefix + '\n' + inner;
    } else {
        text += line + '\n';
    }
}

std::string mergedYaml(const std::filesystem::path& file) {
    return fmt::format("# {} with all that it extends\n{}", file.filename().generic_string(),
                       yamlBelow(config::wholeDocument(file, dataFolder("configs")), 0));
}

/// Whether there is such a table or file; else adds the names of those that there are.
bool describeTable(const Context& context, const DescribeOptions& options,
                   std::vector<std::string>& known) {
    run::Request request;
    for (const std::filesystem::path& file : paperConfigs()) {
        request.configs.push_back(file.string());
    }
    if (isYamlFile(options.name)) request.configs = {options.name};
    for (const config::Experiment& experiment : loadExperiments(request, "full")) {
        known.push_back(experiment.id);
        if (experiment.id != options.name && !isYamlFile(options.name)) continue;
        if (options.isMerged) {
            fmt::print("{}", mergedYaml(experiment.file));
        } else {
            describeExperiment(context, experiment);
        }
        return true;
    }
    return false;
}

}  // namespace

int describe(const Context& context, const DescribeOptions& options) {
    const std::string& name = options.name;
    if (describeSchema(context, options)) return kExitOk;
    if (name.empty()) throw UsageError("describe: say what; see 'gfxrepro describe --help'");
    std::vector<std::string> known = {"config"};
    if (options.isMerged) {
        if (describeTable(context, options, known)) return kExitOk;
        throw UsageError("describe: no table or file is called '" + name + "'" +
                         suggestion(name, known) + "; --merged is for these alone");
    }
    const auto technique = findNamed(context.techniques, name);
    if (technique != context.techniques.end()) {
        describeTechnique(*technique);
        return kExitOk;
    }
    const auto generator = findNamed(context.generators, name);
    if (generator != context.generators.end()) {
        describeGenerator(*generator);
        return kExitOk;
    }
    const scene::Catalog catalog = openCatalog(context, options.assets);
    const auto entry = catalog.entries().find(name);
    if (entry != catalog.entries().end()) {
        describeScene(entry->second, catalog);
        return kExitOk;
    }
    if (describeTable(context, options, known)) return kExitOk;
    for (const technique::TechniqueInfo& info : context.techniques) known.emplace_back(info.name);
    for (const scene::GeneratorInfo& info : context.generators) known.emplace_back(info.name);
    for (const auto& [sceneName, unused] : catalog.entries()) known.push_back(sceneName);
    throw UsageError("describe: nothing is called '" + name + "'" + suggestion(name, known) +
                     "; see 'gfxrepro list tables|techniques|scenes|configs|generators'");
}

}  // namespace gfxrepro::cli
