
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <map>

#include "engine/core/text.h"
#include "runner/cli/experiments.h"
#include "runner/cli/help.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

/// What has been typed before the word that is to be completed.
struct Typed {
    const CLI::App* command;
    const CLI::Option* pending = nullptr;  // the option whose value comes next
    Words arguments = {};                  // positionals that are complete
};

const CLI::Option* findOption(const CLI::App& command, const std::string& word) {
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            if (word == "--" + name) return option;
        }
    }
    return nullptr;
}

const CLI::App* findCommand(const CLI::App& app, const std::string& word) {
    for (const CLI::App* command : visibleCommands(app)) {
        if (command->get_name() == word) return command;
    }
    return nullptr;
}

/// bash takes `--profile=quick` apart at the sign.
bool isEqualsSign(const std::string& word) {
    return word == "=";
}

Typed readTyped(const CLI::App& app, const Words& words) {
    Typed typed{&app};
    const CLI::Option* lastValued = nullptr;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        const std::string& word = words[i];
        if (isEqualsSign(word)) {  // what stood before the sign was not the whole value
            if (lastValued) typed.pending = lastValued;
            continue;
        }
        lastValued = typed.pending;
        if (typed.pending) {
            typed.pending = nullptr;
        } else if (word.starts_with("-")) {
            const CLI::Option* option = findOption(*typed.command, word);
            if (option && !valueName(*option).empty()) typed.pending = option;
        } else if (const CLI::App* command = findCommand(*typed.command, word)) {
            typed.command = command;
        } else {
            typed.arguments.push_back(word);
        }
    }
    return typed;
}

/// The entries of the folder that `prefix` points into, and of `more` folders; folders end in "/".
Words paths(const std::string& prefix, const std::function<bool(const fs::path&)>& isWanted,
            const Words& more = {}) {
    Words found;
    const auto addFrom = [&](const std::string& stem) {
        std::error_code error;
        for (const auto& entry :
             fs::directory_iterator(stem.empty() ? fs::path(".") : fs::path(stem), error)) {
            const std::string file = entry.path().filename().string();
            const std::string name = stem + file;
            if (file.starts_with(".") && !prefix.starts_with(stem + ".")) continue;
            if (isWanted(entry.path())) {
                found.push_back(name);
            } else if (entry.is_directory(error)) {
                found.push_back(name + "/");
            }
        }
    };
    addFrom(prefix.substr(0, prefix.find_last_of('/') + 1));
    for (const std::string& folder : more) addFrom(folder);
    return found;
}

bool isYaml(const fs::path& path) {
    return isYamlFile(path);
}

bool isRun(const fs::path& path) {
    return fs::exists(path / "plan.json");
}

bool isAnyFile(const fs::path& path) {
    return !fs::is_directory(path);
}

void append(Words& words, Words more) {
    for (std::string& word : more) words.push_back(std::move(word));
}

Words sceneNames(const Context& context) {
    Words names;
    const scene::Catalog catalog = openCatalog(context, "");
    for (const auto& [name, entry] : catalog.entries()) names.push_back(name);
    return names;
}

Words describedNames(const Context& context, const std::string& prefix) {
    Words names = {"config"};
    for (const technique::TechniqueInfo& info : context.techniques) names.emplace_back(info.name);
    for (const scene::GeneratorInfo& info : context.generators) names.emplace_back(info.name);
    append(names, sceneNames(context));
    append(names, paperNames());
    append(names, paths(prefix, isYaml));
    return names;
}

/// By what the help calls a value.
Words valuesOf(const std::string& kind, const Context& context, const std::string& prefix) {
    if (kind.find('|') != std::string::npos) {
        Words values = split(kind, '|');
        std::erase(values, "N");
        return values;
    }
    const std::map<std::string, std::function<Words()>> known = {
        {"CONFIG", [&] { return paths(prefix, isYaml); }},
        {"DIR", [&] { return paths(prefix, [](const fs::path&) { return false; }); }},
        {"FILE", [&] { return paths(prefix, isAnyFile); }},
        {"NAME", [&] { return describedNames(context, prefix); }},
        {"DEVICE",
         [] {
             return Words{"auto", "gpu", "software"};
         }},
        {"RUN",
         [&] {
             Words names = paths(prefix, isRun, prefix.empty() ? Words{"runs/"} : Words{});
             if (!runFolders().empty()) names.emplace_back("latest");
             return names;
         }},
        {"SCENE",
         [&] {
             Words names = sceneNames(context);
             append(names, paths(prefix, isAnyFile));
             return names;
         }},
        {"TABLE",
         [&] {
             // "zju2005/figure-4.3" only where "zju2005/f" is typed: "zju2005/4.3" is the same.
             const std::size_t slash = prefix.find('/');
             const bool hasKind = slash != std::string::npos && slash + 1 < prefix.size() &&
                                  std::isalpha(static_cast<unsigned char>(prefix[slash + 1]));
             Words names = hasKind ? paperFileNames() : paperNames();
             append(names, paths(prefix, isYaml));
             return names;
         }},
    };
    const auto found = known.find(kind);
    return found == known.end() ? Words{} : found->second();
}

/// The argument at `index`, or the last one where it takes several.
const CLI::Option* argumentAt(const CLI::App& command, std::size_t index) {
    const CLI::Option* last = nullptr;
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_positional()) continue;
        if (index == 0) return option;
        --index;
        last = option->get_expected_max() > 1 ? option : nullptr;
    }
    return last;
}

Words candidates(const Typed& typed, const Context& context, const std::string& prefix) {
    if (typed.pending) return valuesOf(valueName(*typed.pending), context, prefix);
    if (prefix.starts_with("-")) return optionNames(*typed.command);
    const Words names = commandNames(*typed.command);
    if (!names.empty()) return names;
    const CLI::Option* argument = argumentAt(*typed.command, typed.arguments.size());
    return argument ? valuesOf(valueName(*argument), context, prefix) : Words{};
}

constexpr const char* kBash = R"sh(# gfxrepro for bash: source <(gfxrepro completion bash)
_gfxrepro() {
    mapfile -t COMPREPLY < <("${COMP_WORDS[0]/#\~/$HOME}" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
    if [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *[/=] ]]; then compopt -o nospace 2>/dev/null; fi
    return 0
}
complete -o default -F _gfxrepro gfxrepro
)sh";

constexpr const char* kZsh = R"sh(#compdef gfxrepro
# gfxrepro for zsh: source <(gfxrepro completion zsh)
_gfxrepro() {
    local -a replies
    replies=("${(@f)$("${(Q)words[1]}" complete "${(@Q)words[2,CURRENT]}" 2>/dev/null)}")
    compadd -- ${replies:#*[/=]}
    compadd -S '' -- ${(M)replies:#*[/=]}
}
if [ "$funcstack[1]" = _gfxrepro ]; then _gfxrepro "$@"; else compdef _gfxrepro gfxrepro; fi
)sh";

constexpr const char* kFish = R"sh(# gfxrepro for fish: gfxrepro completion fish | source
complete -c gfxrepro -f -a '(set -l words (commandline -opc) (commandline -ct); $words[1] complete $words[2..-1] 2>/dev/null)'
)sh";

}  // namespace

Words completions(const CLI::App& app, const Context& context, const Words& words) {
    Typed typed = readTyped(app, words);
    std::string prefix = words.empty() || isEqualsSign(words.back()) ? "" : words.back();
    // zsh and fish leave `--profile=qu` together.
    std::string before;
    const std::size_t equals = prefix.find('=');
    if (!typed.pending && prefix.starts_with("--") && equals != std::string::npos) {
        typed.pending = findOption(*typed.command, prefix.substr(0, equals));
        if (!typed.pending) return {};
        before = prefix.substr(0, equals + 1);
        prefix.erase(0, equals + 1);
    }
    Words found;
    for (const std::string& word : candidates(typed, context, prefix)) {
        if (word.starts_with(prefix)) found.push_back(before + word);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::string completionScript(const std::string& shell) {
    return shell == "bash" ? kBash : shell == "zsh" ? kZsh : kFish;
}

}  // namespace gfxrepro::cli
