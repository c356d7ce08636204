#include "runner/config/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <tuple>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/scene/catalog_entry.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/external_program.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

/// Begins the number in the id of a figure: papers count tables and figures apart.
constexpr std::string_view kFigurePrefix = "figure-";

/// A key that names the experiment: in the order of ExperimentKind.
struct IdentityKeys {
    GivenKey table, figure, section, sweepOf;
};
constexpr std::array kLabels = {"Table", "Figure", "Section", "Sweep"};
const KeyTable<IdentityKeys>& identityTable() {
    using I = IdentityKeys;
    static const KeyTable<I> table{
        {"identity", "",
         "Exactly one key names the experiment; a file that others extend has none.", false},
        {{&I::table, "table", "PAPER/NUMBER", "none", "a table, as zju2005/2.1", text()},
         {&I::figure, "figure", "PAPER/NUMBER", "none", "a figure", text()},
         {&I::section, "section", "PAPER/NUMBER", "none", "numbers in running text", text()},
         {&I::sweepOf, "sweep_of", "NAME", "none",
          "an experiment of one's own; its id is sweep/NAME", text()}}};
    return table;
}

}  // namespace

const KeyTable<ContentKeys>& contentTable() {
    using C = ContentKeys;
    static const KeyTable<C> table{
        {"content", "", "What is measured and shown."},
        {{&C::title, "title", "line", "required", "what is shown, in the paper's words", text()},
         {&C::technique, "technique", "name",
          fmt::format("none, with program {}", kProgramTechnique),
          "what measures; `imported`: numbers that `gfxrepro import` takes; without it the file is "
          "only `printed`",
          text()},
         {&C::program, "program", "map", "none",
          "what a technique measures that takes one: `gfxrepro list techniques`", refTo("program")},
         {&C::scene, "scene", "reference", "none", "a catalogued name, or a file beside this one",
          text()},
         {&C::sceneSeeds,
          numberKey("scene_seeds", {.least = 1, .most = kMostSceneSample + 1, .isWhole = true}, "1",
                    "seeds of a generated scene, from the catalogue's on: a case each, without "
                    "times")},
         {&C::sceneParams, "scene_params", "{name: value}", "{}",
          "of the generated scenes, laid over the catalogue's: `gfxrepro describe GENERATOR`; of a "
          "height map beside this file: " +
              joined(scene::ownFileParams(true)),
          mapOf(anything())},
         {&C::sceneInstead, kSceneInstead, "{scene: scene}", "{}",
          "takes the place of a scene, whose rows it fills: another one, or NAME@SEED",
          mapOf(text())},
         {&C::params, "params", "{name: value}", "{}",
          "of the technique: `gfxrepro describe TECHNIQUE`", mapOf(anything())},
         {&C::paramsByScene, kParamsByScene, "{scene: {name: value}}", "{}",
          "laid over `params` in the cases of a scene, whatever its seed; a swept axis wins",
          mapOf(mapOf(anything()))},
         {&C::paramsInstead, kParamsInstead, "{name: value}", "{}",
          "takes the place of a parameter's value or default in the cases that take it",
          mapOf(anything())},
         {&C::output, "output", "map", fmt::format("{0} × {0}", kDefaultOutputPx),
          "size of the image, and how many", refTo("output")},
         {&C::sweep, "sweep", "{axis: values}", "{}", "axes multiply: each point is a case",
          refTo("sweep")},
         {&C::measure, "measure", "map",
          "once, a program twice, and with an unswept {seed} six times; where times are shown, and "
          "of sweep_of without layout: six rounds, or a minute",
          "lane, repeats and processes", refTo("measure")},
         {&C::shows, "shows", "[name]", "those with a truth",
          "pictures that the document shows, by the names that the technique gives them (`classes` "
          "is also classes_0, …): the report folds the others",
          listOf(text())},
         {&C::labels, "labels", "{name: words}", "{}",
          "what the report says for a parameter, a scene, a row or a column; a preset may have "
          "names that a file lacks",
          mapOf(text())},
         {&C::layout, "layout", "map", "none", "what the table looks like", refTo("layout")},
         {&C::printed, "printed", "map", "none", "what the paper printed; never reaches a worker",
          refTo("printed")},
         {&C::claims, "claims", "{ID: claim}", "{}",
          "what must follow from the numbers; of sweep_of without layout, too, whose table has the "
          "columns that it shows",
          mapOf(refTo("claim_part"))},
         {&C::plots, "plots", "[plot]", "[]", "curves of the table's numbers, with their intervals",
          listOf(refTo("plot"))},
         {&C::fit, "fit", "{column: printed cell}", "{}",
          "columns held against printed cells of other tables, all of the method of `params`: the "
          "best row is shown",
          mapOf(refTo("fit"))},
         {&C::assumptions, "assumptions", "{NAME: assumption}", "{}",
          "what the paper left open: a parameter, `output`, `scene`, `scene_seed`, "
          "`output.frames`, or free text",
          mapOf(refTo("assumption_part"))}}};
    return table;
}

namespace {

struct AssumptionKeys {
    GivenKey value, range, unit, why;
};
const KeyTable<AssumptionKeys>& assumptionTable() {
    using A = AssumptionKeys;
    static const KeyTable<A> table{
        {"assumption", "assumptions.NAME.", "", false},
        {{&A::value, "value", "value", "the cases'",
          "what is taken: of free text alone, a parameter's is filled in", anything()},
         {&A::range, "range", "[values] | [first, last] | {NAME: [names]}", "none",
          "what `gfxrepro sensitivity` tries instead: of a parameter as it allows; of scenes, "
          "for each NAME what takes its place",
          anything()},
         {&A::unit, "unit", "line", "the parameter's", "of value and range: of free text alone",
          text()},
         {&A::why, "why", "line", "required", "why this value", text()}}};
    return table;
}

constexpr std::size_t kLongestName = 80;  // two, a suffix and a date fit into the name of a file

bool isName(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '-' || c == '_' || c == '.';
    });
}

/// Sets kind and id from the one key that names the experiment.
void readIdentity(const Node& document, Experiment& experiment) {
    const IdentityKeys given = identityTable().find(document);
    const GivenKey* found = nullptr;
    int kind = 0;
    for (const GivenKey* one : {&given.table, &given.figure, &given.section, &given.sweepOf}) {
        if (*one && found) {
            throw Error(one->where(),
                        fmt::format("both '{}' and '{}' name the experiment; allowed: "
                                    "one",
                                    found->name(), one->name()));
        }
        if (*one) {
            found = one;
            experiment.kind = ExperimentKind(kind);
        }
        ++kind;
    }
    if (!found) {
        throw Error(document.location(),
                    "nothing names the experiment; allowed: one of " + joined(identityKeys()));
    }
    const std::string& key = found->name();
    const Node& name = **found;
    const std::string& text = lineOf(name, key);
    const Names parts = split(text, '/');
    for (const std::string& part : parts) {
        if (part.size() <= kLongestName) continue;
        throw Error(name.location(), key + ": a name of " + std::to_string(part.size()) +
                                         " letters; at most " + std::to_string(kLongestName) +
                                         ", for files are named after it");
    }
    if (experiment.kind == ExperimentKind::Sweep) {
        if (!isName(text)) throwNotAllowed(name, key, "letters, digits, - _ .");
        experiment.id = "sweep/" + text;
        return;
    }
    if (parts.size() != 2 || !isName(parts[0]) || !isName(parts[1])) {
        throwNotAllowed(name, key, "PAPER/NUMBER, such as zju2005/2.1");
    }
    experiment.id = experiment.kind == ExperimentKind::Figure
                        ? parts[0] + "/" + std::string(kFigurePrefix) + parts[1]
                        : text;
}

void requireAxisNames(const Node& sweep, const std::vector<AxisPoint>& points) {
    std::set<std::string> names;
    for (const AxisPoint& point : points) {
        for (const auto& [name, value] : point) {
            if (name.starts_with("output.")) {
                if (name != "output.width" && name != "output.height") {
                    throw Error(sweep.keyLocation(name),
                                "axis '" + name + "'; allowed: output.width, output.height");
                }
                outputSize(value, name);
            }
        }
    }
}

Vocabulary vocabularyOf(const Experiment& experiment, const std::vector<AxisPoint>& points,
                        bool isComplete) {
    Vocabulary vocabulary;
    vocabulary.isComplete = isComplete;
    std::set<std::string> seen;
    for (const AxisPoint& point : points) {
        for (const auto& [axis, value] : point) {
            if (seen.insert(axis + "=" + contentKey(value)).second) {
                vocabulary.axes[axis].push_back(value);
            }
        }
    }
    // What is not swept has the one value, or one a scene.
    std::map<std::string, Node::Sequence> fixed;
    const auto add = [&](const std::string& name, const Node& value) {
        const bool isNew = seen.insert(name + "=" + contentKey(value)).second;
        if (isNew && !vocabulary.axes.contains(name)) fixed[name].push_back(value);
    };
    for (const auto& [name, value] : experiment.params.entries()) add(name, value);
    for (const auto& [scene, params] : experiment.paramsByScene.entries()) {
        for (const auto& [name, value] : params.entries()) add(name, value);
    }
    for (const auto& [name, value] : experiment.sceneParams.entries()) {
        add(std::string(kSceneAxisPrefix) + name, value);
    }
    vocabulary.axes.merge(fixed);
    if (!experiment.scene.isNull()) {
        vocabulary.axes.try_emplace("scene", Node::Sequence{experiment.scene});
    }
    return vocabulary;
}

std::vector<Assumption> readAssumptions(const Node& node) {
    if (!node.isMap()) throwNotAllowed(node, "assumptions", "a map {name: assumption}");
    std::vector<Assumption> assumptions;
    for (const auto& [name, entry] : node.entries()) {
        const std::string what = "assumption '" + name + "'";
        const AssumptionKeys given = assumptionTable().read(entry, what, &node.keyLocation(name));
        Assumption assumption;
        assumption.name = name;
        assumption.why = lineOf(*given.why, given.why.in(what));
        assumption.location = node.keyLocation(name);
        if (given.value) assumption.value = *given.value;
        if (given.range) assumption.range = *given.range;
        assumption.unit = optionalLine(given.unit, what);
        assumptions.push_back(std::move(assumption));
    }
    return assumptions;
}

/// A file without a technique measures nothing: it holds what the paper printed.
void requireOnlyPrinted(const Node& document, const ContentKeys& given) {
    const std::string &technique = given.technique.name(), &printed = given.printed.name();
    const Names ofPrint = {given.title.name(), given.labels.name(), printed,
                           given.assumptions.name()};
    for (const std::string& key : sectionKeys()) {
        if (contains(ofPrint, key) || !document.find(key)) continue;
        throw Error(document.keyLocation(key), "'" + key + "' without '" + technique + "'");
    }
    if (!given.printed) {
        throw Error(document.location(),
                    "neither '" + technique + "' nor '" + printed + "'; allowed: either or both");
    }
}

/// A map, empty where the section is not there.
Node mapIn(const GivenKey& key, const Node& document) {
    if (!key || key->isNull()) return Node::map({}, document.location());
    if (!key->isMap()) throwNotAllowed(*key, key.name(), "a map");
    return *key;
}

Node paramsByScene(const GivenKey& given, const Node& document) {
    Node scenes = mapIn(given, document);
    for (const auto& [scene, params] : scenes.entries()) {
        const std::string what = fmt::format("{}: '{}'", given.name(), scene);
        if (!params.isMap()) throwNotAllowed(params, what, "a map {name: value}");
        if (scene::sceneName(scene) != scene) {
            throw Error(
                scenes.keyLocation(scene),
                what + "; allowed: a scene without seed and parameters, whose cases it is of");
        }
    }
    return scenes;
}

/// What a program is not told of it cannot follow.
void requireTold(const ContentKeys& given, const Experiment& experiment) {
    if (programOf(experiment).isNull()) return;
    const ExternalProgram program = readProgram(programOf(experiment));
    const auto require = [&](const GivenKey& key, bool isGiven, const std::string& names,
                             bool isTold) {
        if (!isGiven || isTold) return;
        throw Error(key.where(), "'" + key.name() + "': the program's command has no " + names);
    };
    const auto isSwept = [&](std::string_view axis) {
        return experiment.sweep.isMap() && experiment.sweep.find(axis);
    };
    const bool hasScene = !experiment.scene.isNull() || isSwept("scene");
    const OutputKeys output = outputOf(experiment.document);
    const bool hasSize =
        output.width || output.height || isSwept("output.width") || isSwept("output.height");
    require(given.scene, hasScene, "{scene}", program.uses(placeholder::kScene));
    require(given.output, hasSize, "{width} or {height}",
            program.uses(placeholder::kWidth) || program.uses(placeholder::kHeight));
    const char* told = program.givesAllFrames ? placeholder::kFrames : placeholder::kFrame;
    require(given.output, experiment.measure.frames > 1,
            fmt::format("{{{}}}, of which there are several", told), program.uses(told));
}

/// Of a program: each process draws others, but where the seed is swept or a truth may share it.
Measure::Seeds seedsOf(const Experiment& experiment) {
    if (programOf(experiment).isNull()) return Measure::Seeds::None;
    const ExternalProgram program = readProgram(programOf(experiment));
    if (program.framesAreSeeds) return Measure::Seeds::Case;
    if (!program.uses(placeholder::kSeed)) return Measure::Seeds::None;
    const bool isSwept = std::ranges::any_of(expandSweep(experiment.sweep), [](const auto& point) {
        return std::ranges::any_of(point,
                                   [](const auto& one) { return one.key() == placeholder::kSeed; });
    });
    return isSwept || program.sharesSeeds ? Measure::Seeds::Case : Measure::Seeds::Process;
}

/// Of a program it is known which pictures there are.
void requirePicture(const Node& name, const std::string& what, const Experiment& experiment) {
    if (programOf(experiment).isNull()) return;
    Names known;
    for (const ProgramPicture& picture : readProgram(programOf(experiment)).pictures) {
        known.push_back(picture.name);
    }
    if (contains(known, name.text())) return;
    throwNotAllowed(name, what,
                    known.empty() ? "none, as the program leaves no images" : joined(known, " | "));
}

void readMeasurement(const Node& document, const ContentKeys& given, Experiment& experiment) {
    const auto valueOf = [](const Node* node) { return node ? *node : Node(); };
    experiment.technique = lineOf(*given.technique, given.technique.name());
    experiment.params = mapIn(given.params, document);
    experiment.paramsByScene = paramsByScene(given.paramsByScene, document);
    experiment.paramsInstead = mapIn(given.paramsInstead, document);
    for (const auto& [name, value] : experiment.paramsInstead.entries()) {
        if (Node* replaced = experiment.params.find(name)) *replaced = value;
    }
    experiment.scene = valueOf(given.scene);
    experiment.sceneParams = mapIn(given.sceneParams, document);
    experiment.sceneInstead = mapIn(given.sceneInstead, document);
    experiment.sweep = valueOf(given.sweep);
    std::tie(experiment.outputWidthPx, experiment.outputHeightPx, experiment.measure.frames) =
        readOutput(mapIn(given.output, document));
    if (given.sceneSeeds) {
        experiment.measure.sceneSeeds =
            static_cast<int>(given.sceneSeeds.number(given.sceneSeeds.name()));
    }
    if (!given.shows) return;
    const std::string& what = given.shows.name();
    if (!given.shows->isSequence()) {
        throwNotAllowed(*given.shows, what, "a list of names of pictures");
    }
    for (const Node& name : given.shows->items()) {
        experiment.shows.push_back(lineOf(name, what));
        requirePicture(name, what, experiment);
    }
}

/// How it is measured, which depends on what is shown: who shows times, or anything that there is,
/// wants times.
void readLane(const Node& document, const ContentKeys& keys, Experiment& experiment) {
    const bool isTimed = experiment.hasDefaultLayout() || showsTimes(experiment.layout);
    Measure defaults = experiment.measure;
    if (isTimed) defaults.lane = Measure::Lane::Timing;
    defaults.seeds = seedsOf(experiment);
    if (!programOf(experiment).isNull()) {
        // Other seeds in each process give an interval. One run of a program without a seed does
        // not tell whether another comes to the same.
        if (defaults.seeds == Measure::Seeds::Process) defaults.processes = kFewestRounds;
        if (defaults.seeds == Measure::Seeds::None) defaults.processes = 2;
    }
    experiment.measure = readMeasure(mapIn(keys.measure, document), defaults);
    if (experiment.measure.sceneSeeds > 1 && experiment.measure.lane == Measure::Lane::Timing) {
        throw Error(keys.sceneSeeds->location(),
                    "'scene_seeds' takes no times; allowed: 1, or with lane: quality");
    }
    requireTold(keys, experiment);
}

/// `printed.at` is of all cases alike.
void requireNotSwept(const Printed& printed, const std::vector<AxisPoint>& points) {
    for (const auto& [name, value] : printed.at) {
        for (const AxisPoint& point : points) {
            for (const auto& [axis, swept] : point) {
                if (axis != name) continue;
                throw Error(value.location(),
                            "printed.at: '" + name + "' is swept; allowed: what all cases share");
            }
        }
    }
}

void requireColumns(const GivenKey& fit, const TableNames& names) {
    if (!fit->isMap() || fit->entries().empty()) {
        throwNotAllowed(*fit, fit.name(), "a map {column: printed cell}");
    }
    for (const auto& [column, cell] : fit->entries()) {
        const bool isKnown = contains(names.columns, column);
        if (isKnown || !names.hasAllColumns) continue;
        throw Error(fit->keyLocation(column), fit.name() + ": no column '" + column + "'" +
                                                  suggestion(column, names.columns));
    }
}

std::map<std::string, std::string> labelsOf(const GivenKey& given, const Node& document) {
    std::map<std::string, std::string> labels;
    const Node map = mapIn(given, document);
    for (const auto& [name, words] : map.entries()) {
        labels[name] = lineOf(words, given.name() + ": '" + name + "'");
    }
    return labels;
}

/// Of a table that nobody laid out: a row a point of the sweep; columns are what is recorded.
TableNames sweptNames(const std::vector<AxisPoint>& points, const Vocabulary& vocabulary) {
    TableNames names;
    names.hasAllColumns = false;
    for (const AxisPoint& point : points) {
        for (const auto& [axis, value] : point) {
            if (contains(names.rowAxes, axis)) continue;
            names.rowAxes.push_back(axis);
            if (vocabulary.isComplete) names.rowValues[axis] = vocabulary.axes.at(axis);
        }
    }
    return names;
}

/// Layout, and what is checked against it: printed values, claims, plots.
void readTable(const ContentKeys& given, bool isComplete, Experiment& experiment) {
    const GivenKey &printed = given.printed, &layout = given.layout, &claims = given.claims;
    if (experiment.technique.empty()) {
        experiment.printed = readPrinted(*printed, nullptr, nullptr);
        return;
    }
    const std::vector<AxisPoint> points = expandSweep(experiment.sweep);
    requireAxisNames(experiment.sweep, points);
    const bool isOwn = experiment.kind == ExperimentKind::Sweep;
    for (const GivenKey* key : {&given.fit, &claims, &given.plots}) {
        if (!*key || layout || (isOwn && key == &claims)) continue;
        throw Error(key->where(), "'" + key->name() + "' without '" + layout.name() + "'");
    }
    if (!layout) {
        if (claims) {
            const TableNames names =
                sweptNames(points, vocabularyOf(experiment, points, isComplete));
            experiment.claims = readClaims(*claims, names, false, false);
        }
        if (!printed) return;
        // What a preset says of the print: on which hardware, of how many frames.
        experiment.printed = readPrinted(*printed, &experiment.layout, nullptr);
        return;
    }
    const Vocabulary vocabulary = vocabularyOf(experiment, points, isComplete);
    experiment.layout = readLayout(*layout, vocabulary);
    const TableNames names = tableNames(experiment.layout, vocabulary);
    if (printed) experiment.printed = readPrinted(*printed, &experiment.layout, &names);
    if (isComplete) requireNotSwept(experiment.printed, points);
    if (given.fit) requireColumns(given.fit, names);
    if (claims) {
        experiment.claims = readClaims(*claims, names, !experiment.printed.rows.empty(),
                                       experiment.kind != ExperimentKind::Sweep);
    }
    if (given.plots) experiment.plots = readPlots(*given.plots, names);
}

}  // namespace

const Names& identityKeys() {
    return identityTable().names();
}

ContentKeys contentOf(const Node& document) {
    return contentTable().find(document);
}

const Names& sectionKeys() {
    return contentTable().names();
}

Experiment readExperiment(const Node& document, const std::filesystem::path& file,
                          bool isComplete) {
    Names allowed = identityKeys();
    allowed.insert(allowed.end(), sectionKeys().begin(), sectionKeys().end());
    allowed.emplace_back(kProfilesKey);
    requireKeys(document, "config", allowed);
    const ContentKeys given = contentOf(document);
    Experiment experiment;
    experiment.file = file;
    experiment.document = document;
    experiment.params = Node::map({});
    readIdentity(document, experiment);
    contentTable().require(given, document.location(), "config");
    experiment.title = lineOf(*given.title, given.title.name());
    experiment.labels = labelsOf(given.labels, document);
    if (given.technique) {
        readMeasurement(document, given, experiment);
    } else {
        requireOnlyPrinted(document, given);
    }
    readTable(given, isComplete, experiment);
    if (given.technique) readLane(document, given, experiment);
    if (given.assumptions) experiment.assumptions = readAssumptions(*given.assumptions);
    if (const Node* profiles = document.find(kProfilesKey)) {
        for (const Node& name : profiles->items()) experiment.profiles.push_back(name.text());
    }
    return experiment;
}

Experiment experimentFromDocument(const Node& document, const std::filesystem::path& file) {
    return readExperiment(document, file, false);
}

bool goesByClock(const Experiment& experiment) {
    return experiment.technique == kImported || !programOf(experiment).isNull();
}

bool Experiment::hasDefaultLayout() const {
    return kind == ExperimentKind::Sweep && !technique.empty() && !layout.isGiven;
}

bool Experiment::isPublished() const {
    return !technique.empty() && (kind != ExperimentKind::Sweep || !printed.rows.empty());
}

std::string Experiment::slug() const {
    std::string text = id;
    std::replace(text.begin(), text.end(), '/', '-');
    return text;
}

std::string Experiment::label() const {
    std::string number = id.substr(id.find('/') + 1);
    if (kind == ExperimentKind::Figure) number.erase(0, kFigurePrefix.size());
    return kLabels.at(static_cast<std::size_t>(kind)) + (" " + number);
}

SchemaFile experimentSchema() {
    SchemaFile file{"experiment",
                    "A table, figure, section or sweep",
                    {identityTable().section(), compositionKeys(), contentTable().section()}};
    const auto add = [&](std::vector<SchemaSection> sections) {
        for (SchemaSection& section : sections) file.sections.push_back(std::move(section));
    };
    add(programKeys());
    add({outputKeys()});
    add(sweepKeys());
    add({measureKeys(), profileKeys()});
    add(layoutKeys());
    add(printedKeys());
    add({plotKeys(), assumptionTable().section()});
    add(claimSections());
    return file;
}

}  // namespace gfxrepro::config
