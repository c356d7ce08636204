// From a file on disk to the one document that is read: extends, profile, overrides, scene files.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "engine/core/checks.h"
#include "engine/core/near_file.h"
#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"
#include "runner/config/experiment.h"
#include "runner/config/external_program.h"
#include "runner/config/printed_section.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace fs = std::filesystem;

namespace {

using namespace types;

struct CompositionKeys {
    GivenKey extends, profiles;
};
const KeyTable<CompositionKeys>& compositionTable() {
    static const KeyTable<CompositionKeys> table{
        {"composition", "", "What the file is put together from."},
        {{&CompositionKeys::extends, "extends", "file | [files]", "[]",
          "files laid under this one, later over earlier; in configs/, then beside this file",
          oneOrMore(text())},
         {&CompositionKeys::profiles, kProfilesKey, "{quick, paper}", "none",
          "parts laid over the file by --profile", refTo("profiles")}}};
    return table;
}

struct ProfileKeys {
    GivenKey quick, paper;
};
const KeyTable<ProfileKeys>& profileTable() {
    const auto key = [](const std::string& name) {
        return SchemaKey(name, "part of a config", "none",
                         "laid over the file by --profile " + name, refTo("content"));
    };
    static const KeyTable<ProfileKeys> table{
        {"profiles", "profiles.", ""},
        {{&ProfileKeys::quick, key("quick")}, {&ProfileKeys::paper, key("paper")}}};
    return table;
}

/// A file with what it extends. Profiles stay apart: their nulls remove keys only once the profile
/// is laid over the whole.
struct Merged {
    Node document;
    std::vector<std::pair<std::string, Node>> profiles;  // in order; later ones win
};

/// A text with a comma, unquoted in `{…}`, ends at the comma: its rest is a key without a value,
/// which merging would take for a removal.
void refuseTornTexts(const Node& whole) {
    const ContentKeys given = contentOf(whole);
    for (const GivenKey& entries : {given.claims, given.assumptions}) {
        if (!entries || !entries->isMap()) continue;
        for (const auto& [name, entry] : entries->entries()) {
            if (!entry.isMap()) continue;
            for (const auto& [key, value] : entry.entries()) {
                if (!value.isNull()) continue;
                throw Error(entry.keyLocation(key), entries.name() + '.' + name + ": '" + key +
                                                        "' has no value; a text that holds a "
                                                        "comma needs quotes");
            }
        }
    }
}

/// A scene without a value takes away what a file has of it that is extended; else it says nothing.
void refuseEmptyScenes(const Node& own, const Node& extended) {
    const ContentKeys given = contentOf(own), below = contentOf(extended);
    for (const auto& [scenes, earlier] : {std::pair(given.paramsByScene, below.paramsByScene),
                                          std::pair(given.sceneInstead, below.sceneInstead)}) {
        if (!scenes || !scenes->isMap()) continue;
        for (const auto& [scene, value] : scenes->entries()) {
            const SourceLocation& where = scenes->keyLocation(scene);
            const std::string name = withSceneFile(Node::scalar(scene, where)).text();
            if (!value.isNull() || (earlier && earlier->isMap() && earlier->find(name))) continue;
            throw Error(
                where,
                fmt::format("{}: '{}' has no value; allowed: {{scene: {}}}", scenes.name(), scene,
                            scenes.name() == kSceneInstead ? "scene" : "{name: value}"));
        }
    }
}

class FileReader {
  public:
    explicit FileReader(fs::path configsFolder) : configsFolder_(std::move(configsFolder)) {}

    /// Throws Error beyond: 30 files that extend the next one twice would be read for an hour.
    static constexpr int kMostFiles = 1000;

    Merged read(const fs::path& file) {
        const Node whole = parseYamlFile(file);
        if (!whole.isMap()) {
            throw Error(SourceLocation{file.string(), 1, 1},
                        "a config is a map of keys and values, found " + whole.kindName());
        }
        requireFileKeys(whole);
        refuseTornTexts(whole);
        open_.push_back(fs::weakly_canonical(file));
        if (++count_ > kMostFiles) {
            throw Error(
                whole.location(),
                "extends: more than 1000 files, those that are extended twice counted twice");
        }
        Merged result{Node::map({}, whole.location()), {}};
        const CompositionKeys given = compositionTable().find(whole);
        if (given.extends) {
            const Node::Sequence names = given.extends->isSequence()
                                             ? given.extends->items()
                                             : Node::Sequence{*given.extends};
            for (const Node& name : names) {
                Merged preset = read(find(name, file));
                result.document = merged(result.document, preset.document);
                std::move(preset.profiles.begin(), preset.profiles.end(),
                          std::back_inserter(result.profiles));
            }
        }
        if (given.profiles) addProfiles(*given.profiles, result);
        Node own = whole;
        for (const std::string& key : compositionTable().names()) own.erase(key);
        refuseEmptyScenes(own, result.document);
        resolveSceneKeys(own);
        result.document = merged(result.document, own);
        open_.pop_back();
        return result;
    }

  private:
    void requireFileKeys(const Node& whole) const {
        Names allowed = sectionKeys();
        allowed.insert(allowed.end(), identityKeys().begin(), identityKeys().end());
        for (const std::string& key : compositionTable().names()) allowed.push_back(key);
        requireInSections(whole, allowed);
        for (const auto& [key, value] : whole.entries()) {
            const bool isKnown = contains(allowed, key);
            if (isKnown || !suggestion(key, allowed).empty()) continue;
            throw Error(whole.keyLocation(key),
                        "config: unknown key '" + key +
                            "'; a parameter of the technique stands below `params:`, or with "
                            "several values below `sweep:`; allowed here: " +
                            joined(allowed));
        }
        requireKeys(whole, "config", allowed);
        if (open_.empty()) return;
        for (const std::string& key : identityKeys()) {
            if (!whole.find(key)) continue;
            throw Error(whole.keyLocation(key),
                        "'" + key +
                            "' in a file that is extended; only the experiment's own file "
                            "names it");
        }
    }

    fs::path find(const Node& name, const fs::path& file) const {
        const fs::path relative = lineOf(name, "extends");
        const fs::path beside = file.has_parent_path() ? file.parent_path() : fs::path(".");
        for (const fs::path& folder : {configsFolder_, beside}) {
            const fs::path candidate = folder / relative;
            if (!fs::is_regular_file(candidate)) continue;
            const fs::path real = fs::weakly_canonical(candidate);
            if (contains(open_, real)) {
                throw Error(name.location(),
                            "extends: '" + relative.string() + "' extends this file in turn");
            }
            return candidate;
        }
        throw Error(name.location(), "extends: no file '" + relative.string() + "' in " +
                                         configsFolder_.string() + " or " + beside.string() +
                                         suggestedFile(beside / relative));
    }

    static void addProfiles(const Node& profiles, Merged& result) {
        requireKeys(profiles, "profiles", profileTable().names());
        for (const auto& [name, overlay] : profiles.entries()) {
            if (!overlay.isNull()) requireKeys(overlay, "profile '" + name + "'", sectionKeys());
            result.profiles.emplace_back(name, overlay.isNull() ? Node::map({}) : overlay);
            resolveSceneKeys(result.profiles.back().second);
        }
    }

    int count_ = 0;
    fs::path configsFolder_;
    std::vector<fs::path> open_;
};

Node relocated(const Node& node, const SourceLocation& where) {
    if (node.isSequence()) {
        Node::Sequence items;
        for (const Node& item : node.items()) items.push_back(relocated(item, where));
        return Node::sequence(std::move(items), where);
    }
    if (node.isMap()) {
        Node map = Node::map({}, where);
        for (const auto& [key, value] : node.entries())
            map.set(key, relocated(value, where), where);
        return map;
    }
    if (node.isNull()) return Node::null(where);
    const bool isText = !node.tryDouble() && !node.tryBool();
    return Node::scalar(node.text(), where, isText);
}

std::string parameterName(const std::string& key) {
    constexpr std::string_view kPrefix = "params.";
    return key.starts_with(kPrefix) ? key.substr(kPrefix.size()) : key;
}

/// `64,128` is a list; a list or {range: …} stands for itself.
Node axisOf(const Override& sweep) {
    if (!sweep.value.isScalar()) return sweep.value;
    const SourceLocation& where = sweep.value.location();
    return relocated(parseYaml("[" + sweep.value.text() + "]", where.file.text()), where);
}

void applySweeps(const std::vector<Override>& sweeps, Node& document) {
    const std::string& section = contentTable().nameOf(&ContentKeys::sweep);
    for (const Override& given : sweeps) {
        const std::string axis = parameterName(given.key);
        Node values = axisOf(given);
        const Node* swept = document.find(section);
        const bool isSwept = swept && swept->isMap() && swept->find(axis);
        if (values.isNull() && !isSwept) {
            throw Error(given.value.location(), "'" + axis + "' is not swept; nothing to remove");
        }
        if (axis == "scene") values = withSceneFile(values, fs::current_path());
        if (!swept) document.set(section, Node::map({}, values.location()));
        Node& sweep = *document.find(section);
        if (!sweep.isMap()) throwNotAllowed(sweep, section, "a map, axis: values");
        sweep.set(axis, std::move(values));
    }
}

void requireNotOverridden(const Override& given, const std::string& name, Node document) {
    resolveNames(document);  // patterns of scene files are lists from then on
    const GivenKey sweep = contentOf(document).sweep;
    if (!sweep) return;
    for (const AxisPoint& point : expandSweep(*sweep)) {
        for (const auto& [axis, value] : point) {
            if (axis != name) continue;
            throw Error(given.value.location(),
                        "'" + name + "' is swept here; allowed: --sweep " + name + "=VALUES");
        }
    }
}

/// A parameter that the command line sets is of all scenes.
void dropFromScenes(const std::string& name, Node& document) {
    Node* scenes = document.find(kParamsByScene);
    if (!scenes || !scenes->isMap()) return;
    for (auto& [scene, params] : scenes->entries()) {
        if (params.isMap()) params.erase(name);
    }
}

void applySets(const std::vector<Override>& sets, Node& document) {
    for (const Override& given : sets) {
        const std::string first = given.key.substr(0, given.key.find('.'));
        const auto& sections = sectionKeys();
        const bool isPath = contains(sections, first);
        const std::string path = isPath ? given.key : "params." + given.key;
        requireNotOverridden(given, parameterName(path), document);
        const Node value =
            path == "scene" ? withSceneFile(given.value, fs::current_path()) : given.value;
        document.setPath(path, value);
        if (path.starts_with("params.")) dropFromScenes(parameterName(path), document);
    }
    // A key that is set to nothing goes.
    document = merged(Node::map({}, document.location()), document);
}

Node withProfile(const Node& document, const std::vector<std::pair<std::string, Node>>& overlays,
                 const std::string& profile) {
    Node result = document;
    for (const auto& [name, overlay] : overlays) {
        if (name == profile) result = merged(result, overlay);
    }
    return result;
}

/// `over` laid on `base`, both to be laid on a document later: what they remove stays a null.
Node overlayOf(const Node& base, const Node& over) {
    if (!base.isMap() || !over.isMap()) return over;
    Node result = base;
    for (const auto& [key, value] : over.entries()) {
        const Node* old = result.find(key);
        result.set(key, old ? overlayOf(*old, value) : value, over.keyLocation(key));
    }
    return result;
}

/// A file of the configs, or one beside `file`.
fs::path configNamed(const Node& name, const fs::path& file, const fs::path& configsFolder,
                     const std::string& what) {
    for (const fs::path& folder : {configsFolder, file.parent_path()}) {
        if (fs::is_regular_file(folder / name.text())) return folder / name.text();
    }
    throw Error(name.location(), what + ": no file '" + name.text() + "' in " +
                                     configsFolder.string() +
                                     suggestedFile(configsFolder / name.text()));
}

/// The one swept axis that has all of the values; empty where none has, or several have.
std::string axisWith(const Names& values, Node document) {
    resolveNames(document);
    const GivenKey sweep = contentOf(document).sweep;
    std::map<std::string, std::set<std::string>> found;  // those of the values that an axis has
    for (const AxisPoint& point : expandSweep(sweep ? *sweep : Node())) {
        for (const auto& [axis, value] : point) {
            const bool isWanted = value.isScalar() && contains(values, value.text());
            if (isWanted) found[axis].insert(value.text());
        }
    }
    std::erase_if(found, [&](const auto& one) { return one.second.size() < values.size(); });
    return found.size() == 1 ? found.begin()->first : "";
}

/// The list of words that operands of claims are, `order: [sobol, jittered]`, as [pattern=sobol,
/// pattern=jittered], by the sweep of the whole file: a profile may leave out what they are of.
void nameAxes(const Node& whole, Node& document) {
    Node* claims = contentTable().find(document, &ContentKeys::claims);
    if (!claims || !claims->isMap()) return;
    const auto isWord = [](const Node& item) {
        return item.isScalar() && !item.tryDouble() && item.text().find('=') == std::string::npos;
    };
    const auto nameIn = [&](Node& operands) {
        Node::Sequence items = operands.items();
        Names words;
        for (const Node& item : items) {
            if (isWord(item)) words.push_back(item.text());
        }
        const std::string axis = words.empty() ? "" : axisWith(words, whole);
        if (axis.empty()) return;
        for (Node& item : items) {
            if (isWord(item)) item = Node::scalar(axis + '=' + item.text(), item.location(), true);
        }
        operands = Node::sequence(std::move(items), operands.location());
    };
    for (auto& [id, claim] : claims->entries()) {
        for (const claims::Kind& kind : claims::kinds()) {
            Node* operands = claim.isMap() && kind.axisOf ? claim.find(kind.name()) : nullptr;
            if (operands && operands->isSequence()) nameIn(*operands);
        }
    }
}

/// Who gives a program need not say what measures it.
void addTechnique(Node& document) {
    const ContentKeys given = contentOf(document);
    if (!given.program || given.program->isNull() || given.technique) return;
    document.set(given.technique.name(), Node::scalar(kProgramTechnique, given.program->location()),
                 document.keyLocation(given.program.name()));
}

/// The experiment, with the printed cells that its fit names.
Experiment readWhole(const Node& document, const fs::path& file, bool isComplete,
                     const fs::path& configsFolder) {
    Experiment experiment = readExperiment(document, file, isComplete);
    requireNotFixed(experiment);
    requireTimed(experiment);
    const GivenKey fit = contentOf(document).fit;
    if (!fit) return experiment;
    Node cells = *fit;
    for (auto& [column, cell] : cells.entries()) {
        const std::string what = "fit: '" + column + "'";
        const Node& table = tableOfFit(cell, fit->keyLocation(column), column);
        const fs::path place = configNamed(table, file, configsFolder, what);
        cell = withPrintedCell(cell, column, experiment, loadExperiment(place, {}, configsFolder));
    }
    Node whole = document;
    whole.set(fit.name(), std::move(cells), document.keyLocation(fit.name()));
    return readExperiment(whole, file, isComplete);
}

/// The document without these, and without the maps and lists that are empty then: of a file that
/// is extended they may stand, of the one that has all they are refused.
Node without(const std::vector<NoEffect>& places, const Node& node) {
    const auto has = [&](const SourceLocation& where) {
        return std::ranges::find(places, where, &NoEffect::where) != places.end();
    };
    const auto isEmptied = [](const Node& before, const Node& after) {
        return (after.isMap() && after.entries().empty() && !before.entries().empty()) ||
               (after.isSequence() && after.items().empty() && !before.items().empty());
    };
    if (node.isSequence()) {
        Node::Sequence items;
        for (const Node& item : node.items()) {
            if (!has(item.location())) items.push_back(without(places, item));
        }
        return Node::sequence(std::move(items), node.location());
    }
    if (!node.isMap()) return node;
    Node result = Node::map({}, node.location());
    for (const auto& [key, value] : node.entries()) {
        // A map in block style stands where its first key does.
        if (has(node.keyLocation(key)) || (!value.isMap() && has(value.location()))) continue;
        Node rest = without(places, value);
        if (!isEmptied(value, rest)) result.set(key, std::move(rest), node.keyLocation(key));
    }
    return result;
}

}  // namespace

Override parseOverride(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || trimmed(text.substr(0, equals)).empty()) {
        throw UsageError("'" + text + "' on the command line; allowed: key=value");
    }
    // Perhaps of a shell's variable that is not set.
    if (trimmed(text.substr(equals + 1)).empty()) {
        throw UsageError("'" + text + "' on the command line has no value; null removes the key");
    }
    const SourceLocation where{kCommandLine + text, 0, 0};
    const Node value = parseYaml(text.substr(equals + 1), where.file.text());
    return {std::string(trimmed(text.substr(0, equals))), relocated(value, where)};
}

Node wholeDocument(const fs::path& file, const fs::path& configsFolder) {
    auto [document, overlays] = FileReader(configsFolder).read(file);
    resolveNames(document);
    const Experiment asItStands = loadExperiment(file, {}, configsFolder);
    document = without(valuesInVain(asItStands), without(keysInVain(asItStands), document));
    Node profiles = Node::map({});
    for (auto& [name, overlay] : overlays) {
        resolveNames(overlay);
        overlay =
            without(valuesInVain(loadExperiment(file, {name, {}, {}}, configsFolder)), overlay);
        const Node* earlier = profiles.find(name);
        profiles.set(name, earlier ? overlayOf(*earlier, overlay) : overlay);
    }
    if (!profiles.entries().empty()) document.set(kProfilesKey, std::move(profiles));
    Node whole = Node::map({}, document.location());
    for (const Names& keys : {identityKeys(), sectionKeys(), Names{kProfilesKey}}) {
        for (const std::string& key : keys) {
            if (const Node* value = document.find(key)) whole.set(key, *value);
        }
    }
    return whole;
}

Experiment loadExperiment(const fs::path& file, const ExperimentOptions& options,
                          const fs::path& configsFolder) {
    const std::string& profile = options.profile;
    if (!contains(kProfiles, profile)) {
        throw UsageError("profile '" + profile +
                         "'; allowed: " + joined(Names(kProfiles.begin(), kProfiles.end())));
    }
    auto [document, overlays] = FileReader(configsFolder).read(file);
    Node::Sequence declared;
    for (const std::string& name : profileTable().names()) {
        const bool isDeclared = std::any_of(overlays.begin(), overlays.end(),
                                            [&](const auto& one) { return one.first == name; });
        if (isDeclared) declared.push_back(Node::scalar(name));
    }
    document.set(kProfilesKey, Node::sequence(std::move(declared)));
    addTechnique(document);
    const Node whole = document;
    nameAxes(whole, document);
    for (auto& [name, overlay] : overlays) nameAxes(whole, overlay);

    // The file as it stands must be right whatever is chosen: only there are all names known. But
    // its times may be asked for by the command line alone.
    Node asItStands = document;
    Node set = Node::map({}, document.location());
    for (const Override& given : options.sets) {
        if (given.key.starts_with("measure")) set.setPath(given.key, given.value);
    }
    const GivenKey lane = measureOf(set).lane;
    const bool isTimed = lane && lane->isScalar() && lane->text() == "timing";
    if (isTimed) asItStands.setPath("measure." + lane.name(), *lane);
    resolveNames(asItStands);
    Experiment experiment = readWhole(asItStands, file, true, configsFolder);

    if (experiment.isPublished()) {
        experiment.paperDocument = withProfile(document, overlays, "paper");
        resolveNames(experiment.paperDocument);
    }
    requireEffect(experiment);
    bool isChanged = !options.sets.empty() || !options.sweeps.empty();
    for (const auto& [name, overlay] : overlays) isChanged |= name == profile;
    if (!isChanged) return experiment;
    document = withProfile(document, overlays, profile);
    applySweeps(options.sweeps, document);
    applySets(options.sets, document);
    resolveNames(document);
    Experiment changed = readWhole(document, file, false, configsFolder);
    changed.paperDocument = std::move(experiment.paperDocument);
    return changed;
}

SchemaSection compositionKeys() {
    return compositionTable().section();
}

SchemaSection profileKeys() {
    return profileTable().section();
}

}  // namespace gfxrepro::config
