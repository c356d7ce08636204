#include "runner/config/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <regex>
#include <utility>

#include "runner/config/checks.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"
#include "runner/core/text.h"

namespace gfxrepro::config {

namespace {

using Names = std::vector<std::string>;
using Type = ProgramParam::Type;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const Names& reservedNames() {
    static const Names names = {placeholder::kHere,  placeholder::kOut,    placeholder::kScene,
                                placeholder::kWidth, placeholder::kHeight, placeholder::kSeed,
                                placeholder::kFrame, placeholder::kFrames};
    return names;
}

bool isSnakeCase(std::string_view name) {
    return !name.empty() && std::islower(static_cast<unsigned char>(name.front())) &&
           std::ranges::all_of(name, [](unsigned char c) {
               return std::islower(c) || std::isdigit(c) || c == '_';
           });
}

void requireSnakeCase(const Node& map, const std::string& name, std::string_view what) {
    if (isSnakeCase(name)) return;
    throw Error(map.keyLocation(name), fmt::format("program: {} '{}'; allowed: small letters, "
                                                   "digits and _, a letter first",
                                                   what, name));
}

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

/// A text with placeholders, each of which is one of `known`.
std::string templateOf(const Node& node, std::string_view what, const Names& known) {
    if (!node.isScalar()) {
        throwNotAllowed(node, what, "text; one that begins with a brace needs quotes");
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

std::string optionalLine(const Node& map, const char* key, const std::string& what) {
    const Node* node = map.find(key);
    return node ? lineOf(*node, what + ": " + key) : "";
}

double optionalNumber(const Node& map, const char* key, double fallback) {
    const Node* node = map.find(key);
    return node ? node->asDouble() : fallback;
}

constexpr std::pair<std::string_view, Type> kTypes[] = {{"integer", Type::Integer},
                                                        {"number", Type::Number},
                                                        {"boolean", Type::Boolean},
                                                        {"text", Type::Text}};

/// As it is said, else as the default looks.
Type typeOf(const Node& map, const Node& fallback, const std::string& what) {
    const Node* choices = map.find("choices");
    const Node* type = map.find("type");
    if (type) {
        for (const auto& [name, known] : kTypes) {
            if (type->isScalar() && type->text() == name && !choices) return known;
        }
        throwNotAllowed(*type, what + ": type",
                        choices ? "none beside 'choices'" : "integer, number, boolean, text");
    }
    if (choices) return Type::Choice;
    if (fallback.tryBool()) return Type::Boolean;
    if (fallback.tryInteger()) return Type::Integer;
    return fallback.tryDouble() ? Type::Number : Type::Text;
}

ProgramParam paramOf(const Node& params, const std::string& name) {
    const Node& given = *params.find(name);
    const std::string what = "program: parameter '" + name + "'";
    requireSnakeCase(params, name, "parameter");
    if (std::ranges::find(reservedNames(), name) != reservedNames().end()) {
        throw Error(params.keyLocation(name),
                    what + ": every program has that placeholder; give it another name");
    }
    static const Names kOfCases = {"output", "scene_sample", "stands_for"};
    if (std::ranges::find(kOfCases, name) != kOfCases.end()) {
        throw Error(params.keyLocation(name),
                    what + ": plans and tables have that of every case; give it another name");
    }
    // A value alone is its default.
    const Node map = given.isMap() ? given : Node::map({{"default", given}}, given.location());
    requireKeys(map, what, keysOf("program_param"));
    const Node* fallback = map.find("default");
    if (!fallback || !fallback->isScalar()) {
        throw Error(given.location(), what + " needs 'default', a number, a boolean or text");
    }
    ProgramParam param;
    param.name = name;
    param.fallback = *fallback;
    param.doc = optionalLine(map, "doc", what);
    param.unit = optionalLine(map, "unit", what);
    param.type = typeOf(map, *fallback, what);
    param.min = optionalNumber(map, "min", -kInfinity);
    param.max = optionalNumber(map, "max", kInfinity);
    const bool isNumber = param.type == Type::Integer || param.type == Type::Number;
    for (const char* key : {"min", "max"}) {
        if (map.find(key) && !isNumber) {
            throw Error(map.keyLocation(key), what + ": '" + key + "' is of numbers alone");
        }
    }
    if (const Node* choices = map.find("choices")) {
        if (!choices->isSequence() || choices->items().empty()) {
            throwNotAllowed(*choices, what + ": choices", "a list of values");
        }
        for (const Node& choice : choices->items()) param.choices.push_back(choice.text());
    }
    const auto value = fallback->tryDouble();
    const auto whole = fallback->tryInteger();
    if (param.type == Type::Integer && whole && !std::in_range<int>(*whole)) {
        throwNotAllowed(*fallback, what + ": default",
                        "a whole number of 32 bits, or 'type: number' beside it");
    }
    const bool isWhole = param.type != Type::Integer || whole;
    const bool isLegal =
        isNumber ? value && isWhole && *value >= param.min && *value <= param.max
        : param.type == Type::Boolean ? fallback->tryBool().has_value()
        : param.type == Type::Choice
            ? std::ranges::find(param.choices, fallback->text()) != param.choices.end()
            : true;
    if (!isLegal) throwNotAllowed(*fallback, what + ": default", "one of the values it may have");
    return param;
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
        if (!unit) throw Error(metrics.keyLocation(name), what + " needs 'unit'; \"1\" for none");
        program.outputs.metrics.push_back({name, lineOf(*unit, what + ": unit"),
                                           optionalLine(map, "doc", what), betterOf(map, what)});
        const Node* optional = map.find("optional");
        if (optional && optional->asBool()) program.optionalMetrics.push_back(name);
        const Node* pattern = map.find("pattern");
        if (!pattern) continue;
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
    if (!first || !first->tryInteger() || !program.uses(placeholder::kFrame)) {
        throw Error(frames.location(),
                    what +
                        ": 'frames' are other seeds from 'frame' on: give that, a whole number, "
                        "and {frame} to the program");
    }
    picture.truthFrames = static_cast<int>(*count);
}

void readTruth(const Node& truth, const std::string& what, const Names& known, Program& program,
               ProgramPicture& picture) {
    if (!truth.isMap()) {
        picture.truthFile = templateOf(truth, what, known);
        return;
    }
    Names allowed = {placeholder::kSeed, placeholder::kFrame, placeholder::kFrames};
    for (const ProgramParam& param : program.params) allowed.push_back(param.name);
    requireKeys(truth, what, allowed);
    Node given = truth;  // read as a case's
    for (const char* name : {placeholder::kSeed, placeholder::kFrame, placeholder::kFrames}) {
        given.erase(name);
    }
    Params values(given, what);
    program.declare(values);
    values.finish();
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
    Names known = reservedNames();
    section("params", [&](const Node& params) {
        if (!params.isMap()) throwNotAllowed(params, "program: params", "a map {name: parameter}");
        for (const auto& [name, param] : params.entries()) {
            program.params.push_back(paramOf(params, name));
            known.push_back(name);
        }
    });
    const Node* command = node.find("command");
    if (!command) throw Error(node.location(), "program: 'command' is missing");
    program.command = argumentsOf(*command, "program: command", known);
    section("env", [&](const Node& variables) {
        if (!variables.isMap()) throwNotAllowed(variables, "program: env", "a map {NAME: text}");
        for (const auto& [name, text] : variables.entries()) {
            program.environment.emplace_back(name, templateOf(text, "program: env", known));
        }
    });
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
