#include "runner/config/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/program_parts.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"
#include "runner/config/time_names.h"

namespace gfxrepro::config {

namespace {

using Names = std::vector<std::string>;

/// Calls `text` and `name` for the parts of a text outside and inside of braces.
template <class OnText, class OnName>
void forEachPart(std::string_view text, OnText&& onText, OnName&& onName) {
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if ((c == '{' || c == '}') && text.substr(at + 1).starts_with(c)) {
            onText(text.substr(at, 1));
            at += 2;
            continue;
        }
        const std::size_t end = c == '{' ? text.find('}', at) : std::string_view::npos;
        if (end != std::string_view::npos) {
            onName(text.substr(at + 1, end - at - 1));
            at = end + 1;
            continue;
        }
        onText(text.substr(at, 1));
        ++at;
    }
}

bool hasPlaceholder(std::string_view text, std::string_view name) {
    bool isThere = false;
    forEachPart(
        text, [](std::string_view) {}, [&](std::string_view one) { isThere |= one == name; });
    return isThere;
}

/// Whether a brace is opened that nothing closes.
bool hasOpenBrace(std::string_view text) {
    for (std::size_t at = text.find('{'); at != std::string_view::npos; at = text.find('{', at)) {
        if (text.substr(at + 1).starts_with('{')) {
            at += 2;
            continue;
        }
        at = text.find('}', at);
        if (at == std::string_view::npos) return true;
    }
    return false;
}

/// A text with placeholders, each of which is one of `known`.
std::string templateOf(const Node& node, std::string_view what, const Names& known) {
    if (!node.isScalar()) {
        throwNotAllowed(node, what, "text; one that begins with a brace needs quotes");
    }
    if (hasOpenBrace(node.text())) {
        throw Error(node.location(), fmt::format("{}: a brace of '{}' is not closed; braces as "
                                                 "such are {{{{ and }}}}",
                                                 what, node.text()));
    }
    forEachPart(
        node.text(), [](std::string_view) {},
        [&](std::string_view name) {
            if (std::ranges::find(known, name) != known.end()) return;
            const std::string near = suggestion(name, known);
            throw Error(
                node.location(),
                fmt::format("{}: '{{{}}}' stands for nothing{}; braces as such are "
                            "{{{{ and }}}}",
                            what, name, near.empty() ? "; allowed: " + joined(known) : near));
        });
    return node.text();
}

/// A list of arguments; a text is one at every blank.
Names argumentsOf(const Node& node, std::string_view what, const Names& known) {
    Names arguments;
    if (node.isSequence()) {
        for (const Node& item : node.items()) arguments.push_back(templateOf(item, what, known));
    } else {
        for (std::string& word : split(templateOf(node, what, known), ' ')) {
            if (!trimmed(word).empty()) arguments.emplace_back(trimmed(word));
        }
    }
    if (arguments.empty() || arguments.front().empty()) {
        throwNotAllowed(node, what, "a program and its arguments");
    }
    return arguments;
}

/// Whether the text at `key` is the second of the two; where it is not there the first counts.
bool isSecond(const Node& map, const char* key, const char* first, const char* second) {
    const Node* node = map.find(key);
    if (!node || (node->isScalar() && node->text() == first)) return false;
    if (node->isScalar() && node->text() == second) return true;
    throwNotAllowed(*node, std::string("program: ") + key, std::string(first) + ", " + second);
}

Better betterOf(const Node& metric, const std::string& what) {
    const Node* better = metric.find("better");
    if (!better) return Better::Neither;
    const std::string text = better->isScalar() ? better->text() : "";
    if (text == "lower") return Better::Lower;
    if (text == "higher") return Better::Higher;
    throwNotAllowed(*better, what + ": better", "lower, higher");
}

void readMetrics(const Node& metrics, Program& program) {
    if (!metrics.isMap()) throwNotAllowed(metrics, "program: metrics", "a map {name: metric}");
    for (const auto& [name, given] : metrics.entries()) {
        const std::string what = "program: metric '" + name + "'";
        requireSnakeCase(metrics, name, "metric");
        // A unit alone is all that a metric needs.
        const Node map = given.isMap() ? given : Node::map({{"unit", given}}, given.location());
        requireKeys(map, what, keysOf("program_metric"));
        const Node* unit = map.find("unit");
        if (!unit || unit->isNull())
            throw Error(metrics.keyLocation(name), what + " needs 'unit'; \"1\" for none");
        if (const std::string why = whyNoTimeName(name, lineOf(*unit, what + ": unit"));
            !why.empty()) {
            throw Error(unit->location(), "program: metric " + why);
        }
        program.outputs.metrics.push_back({name, lineOf(*unit, what + ": unit"),
                                           optionalLine(map, "doc", what), betterOf(map, what)});
        const Node* optional = map.find("optional");
        if (optional && optional->asBool()) program.optionalMetrics.push_back(name);
        const Node* pattern = map.find("pattern");
        if (!pattern) continue;
        if (program.givesAllFrames) {
            throw Error(pattern->location(), what +
                                                 ": a pattern does not tell frames apart, and "
                                                 "one run gives them all ('frames: all')");
        }
        const std::string& text = lineOf(*pattern, what + ": pattern");
        try {
            if (std::regex(text).mark_count() < 1) {
                throwNotAllowed(*pattern, what + ": pattern", "one with the number in ( )");
            }
        } catch (const std::regex_error& error) {
            throw Error(pattern->location(), what + ": pattern: " + error.what());
        }
        program.patterns.push_back({name, text});
    }
}

void readPasses(const Node& passes, Program& program) {
    if (!passes.isMap()) throwNotAllowed(passes, "program: passes", "a map {name: meaning}");
    for (const auto& [name, doc] : passes.entries()) {
        requireSnakeCase(passes, name, "pass");
        program.outputs.passes.push_back({name, lineOf(doc, "program: pass '" + name + "'")});
    }
}

/// Several pictures of a truth are other seeds: `frame` says which.
void readTruthFrames(const Node& truth, const std::string& what, const Program& program,
                     ProgramPicture& picture) {
    constexpr long long kMost = 1000;
    const Node& frames = *truth.find(placeholder::kFrames);
    const std::optional<long long> count = frames.tryInteger();
    if (!count || *count < 2 || *count > kMost) {
        throwNotAllowed(frames, what + ": frames", "2 … 1000 pictures, each of another seed");
    }
    const Node* first = truth.find(placeholder::kFrame);
    if (program.givesAllFrames) {
        if (!program.uses(placeholder::kFrames)) {
            throw Error(frames.location(), what +
                                               ": 'frames', and the program's command has no "
                                               "{frames}");
        }
    } else if (!first || !first->tryInteger() || !program.uses(placeholder::kFrame)) {
        throw Error(frames.location(),
                    what +
                        ": 'frames' are other seeds from 'frame' on: give that, a whole number, "
                        "and {frame} to the program");
    }
    picture.truthFrames = static_cast<int>(*count);
}

/// Of one that ends with a placeholder the type is not known yet.
void requirePictureType(const Node& file, const std::string& what) {
    const std::string& text = file.text();
    if (text.ends_with('}') || text.ends_with(".exr") || text.ends_with(".png")) return;
    throwNotAllowed(file, what, "a name that ends in .exr or .png");
}

void readTruth(const Node& truth, const std::string& what, const Names& known, Program& program,
               ProgramPicture& picture) {
    if (!truth.isMap()) {
        picture.truthFile = templateOf(truth, what, known);
        return requirePictureType(truth, what);
    }
    if (truth.entries().empty()) {  // it would be the picture itself, and every error 0
        throwNotAllowed(truth, what, "a file, or parameters that are not the case's");
    }
    Names allowed = {placeholder::kFrames};
    if (!program.givesAllFrames) allowed.emplace_back(placeholder::kFrame);
    if (program.uses(placeholder::kSeed)) allowed.emplace_back(placeholder::kSeed);
    for (const ProgramParam& param : program.params) allowed.push_back(param.name);
    requireKeys(truth, what, allowed);
    if (program.seedsByProcess && !truth.find(placeholder::kSeed)) {
        throw Error(truth.location(), what +
                                          " needs 'seed', as that of the cases is another in "
                                          "each process");
    }
    Node given = truth;  // read as a case's
    for (const char* name : {placeholder::kFrame, placeholder::kFrames}) given.erase(name);
    Params values(given, what);
    program.declare(values);
    values.finish();
    const Node* frame = truth.find(placeholder::kFrame);
    if (frame && !truth.find(placeholder::kFrames) && !program.uses(placeholder::kFrame)) {
        throw Error(frame->location(),
                    what + ": 'frame', and the program's command has no {frame}");
    }
    picture.truthParams = truth;
    picture.truthParams.erase(placeholder::kFrames);
    if (truth.find(placeholder::kFrames)) readTruthFrames(truth, what, program, picture);
}

void readPictures(const Node& pictures, const Names& known, Program& program) {
    if (!pictures.isMap()) throwNotAllowed(pictures, "program: images", "a map {name: file}");
    for (const auto& [name, given] : pictures.entries()) {
        const std::string what = "program: image '" + name + "'";
        requireSnakeCase(pictures, name, "image");
        const Node map = given.isMap() ? given : Node::map({{"file", given}}, given.location());
        requireKeys(map, what, keysOf("program_image"));
        const Node* file = map.find("file");
        if (!file) throw Error(pictures.keyLocation(name), what + " needs 'file'");
        ProgramPicture picture;
        picture.name = name;
        picture.file = templateOf(*file, what + ": file", known);
        requirePictureType(*file, what + ": file");
        if (program.givesAllFrames && !hasPlaceholder(picture.file, placeholder::kFrame)) {
            throwNotAllowed(*file, what + ": file",
                            "one with {frame}, as one run leaves the pictures of all frames");
        }
        if (const Node* truth = map.find("truth")) {
            readTruth(*truth, what + ": truth", known, program, picture);
        }
        program.pictures.push_back(picture);
        const bool isPass = program.outputs.hasPass(name);
        if (picture.hasTruth() && !isPass) {
            program.outputs.passes.push_back({name, "the picture against its truth"});
        }
    }
}

}  // namespace

std::string filled(std::string_view text, const Placeholders& values) {
    std::string result;
    forEachPart(
        text, [&](std::string_view part) { result += part; },
        [&](std::string_view name) {
            const auto found = values.find(std::string(name));
            result += found == values.end() ? fmt::format("{{{}}}", name) : found->second;
        });
    return result;
}

bool Program::uses(std::string_view name) const {
    const auto has = [&](const std::string& text) { return hasPlaceholder(text, name); };
    return std::ranges::any_of(command, has) ||
           std::ranges::any_of(environment, [&](const auto& one) { return has(one.second); });
}

const Node& programOf(const Experiment& experiment) {
    static const Node kNone;
    const Node* program = experiment.document.find("program");
    return program ? *program : kNone;
}

Program readProgram(const Node& node) {
    requireKeys(node, "program", keysOf("program"));
    Program program;
    const auto section = [&](const char* key, auto&& read) {
        if (const Node* found = node.find(key)) read(*found);
    };
    section("here", [&](const Node& here) { program.here = lineOf(here, "program: here"); });
    section("gpu", [&](const Node& gpu) { program.usesGpu = gpu.asBool(); });
    program.givesAllFrames = isSecond(node, "frames", "one", "all");
    program.seedsByProcess = isSecond(node, "seeds", "case", "process");
    Names known = reservedNames();
    section("params", [&](const Node& params) {
        if (!params.isMap()) throwNotAllowed(params, "program: params", "a map {name: parameter}");
        for (const auto& [name, param] : params.entries()) {
            program.params.push_back(readProgramParam(params, name));
            known.push_back(name);
        }
    });
    const Node* command = node.find("command");
    if (!command) throw Error(node.location(), "program: 'command' is missing");
    program.command = argumentsOf(*command, "program: command", known);
    section("env", [&](const Node& variables) {
        if (!variables.isMap()) throwNotAllowed(variables, "program: env", "a map {NAME: text}");
        for (const auto& [name, text] : variables.entries()) {
            const std::string& variable = name;
            if (variable.empty() || variable.find('=') != std::string::npos) {
                throw Error(variables.keyLocation(name),
                            fmt::format("program: env: '{}' is no name of a variable; allowed: one "
                                        "without '='",
                                        variable));
            }
            program.environment.emplace_back(name, templateOf(text, "program: env", known));
        }
    });
    if (program.givesAllFrames && program.uses(placeholder::kFrame)) {
        throw Error(command->location(),
                    "program: {frame}, and one run gives all frames; allowed: "
                    "{frames}, their number");
    }
    if (program.seedsByProcess && !program.uses(placeholder::kSeed)) {
        throw Error(node.keyLocation("seeds"), "program: seeds: the command has no {seed}");
    }
    section("version", [&](const Node& version) {
        program.version = argumentsOf(version, "program: version", {placeholder::kHere});
    });
    const auto listOf = [&](const char* key, Names& names) {
        const Node* list = node.find(key);
        if (!list) return;
        const std::string what = std::string("program: ") + key;
        if (!list->isSequence()) throwNotAllowed(*list, what, "a list of names");
        for (const Node& name : list->items()) names.push_back(lineOf(name, what));
    };
    listOf("starts", program.starts);
    listOf("files", program.files);
    section("metrics", [&](const Node& metrics) { readMetrics(metrics, program); });
    section("passes", [&](const Node& passes) { readPasses(passes, program); });
    section("images", [&](const Node& images) { readPictures(images, known, program); });
    for (const ProgramParam& param : program.params) {
        if (program.uses(param.name)) continue;
        throw Error(
            node.find("params")->keyLocation(param.name),
            fmt::format("program: parameter '{0}': no argument and no variable has '{{{0}}}'",
                        param.name));
    }
    return program;
}

}  // namespace gfxrepro::config
