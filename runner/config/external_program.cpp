#include "runner/config/external_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <regex>
#include <utility>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/image/image_file.h"
#include "engine/metrics/mean_test.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;
using ParamType = ProgramParam::Type;

constexpr std::array kFramesOfARun = {"one", "all"};
constexpr std::array kBetter = {"lower", "higher"};

}  // namespace

const KeyTable<ProgramKeys>& programTable() {
    using P = ProgramKeys;
    static const KeyTable<P> table{
        {"program", "program.",
         "Texts may have placeholders: {NAME} of a parameter, {here} (folder of this file), {out} "
         "(an empty folder, in which the program runs), {scene} (the case's scene as a .glb file), "
         "{width}, {height}, {seed} (a parameter of every program that takes it; where it is not "
         "swept, another in each process), {frame} (from 0), {frames} (how many). No shell sees "
         "them. The program says what it measured by lines "
         "of JSON, {\"metric\": …, \"value\": …, \"unit\": …} with \"pass\" and \"frame\" where "
         "there are such, on the descriptor whose number is in GFXREPRO_METRICS_FD, or in the file "
         "that GFXREPRO_METRICS_FILE names."},
        {{&P::command, "command", "line | [arguments]", "required",
          "the program and its arguments; a line is cut at its blanks", oneOrMore(text())},
         {&P::params, "params", "{name: default | [values] | parameter}", "{}",
          "what `params` and `sweep` may have",
          mapOf(anyOf({text(), listOf(text(), 1), refTo("program_param")}))},
         {&P::metrics, "metrics", "{name: unit | metric}", "{}", "what it says of itself",
          mapOf(anyOf({text(), refTo("program_metric")}))},
         {&P::passes, "passes", "{name: meaning}", "{}", "what tells values of a metric apart",
          mapOf(text())},
         {&P::images, "images", "{name: file | image}", "{}",
          "pictures that it leaves in {out}: " + image::readEndings(),
          mapOf(anyOf({text(), refTo("program_image")}))},
         {&P::env, "env", "{NAME: text}", "{}", "variables of its environment", mapOf(text())},
         {&P::version, "version", "line | [arguments]", "none", "what prints its version",
          oneOrMore(text())},
         {&P::starts, "starts", "[program]", "[]", "programs that it starts in turn",
          listOf(text())},
         {&P::files, "files", "[file]", "[]",
          "what else its outcome depends on, beside what arguments name from {here} on",
          listOf(text())},
         {&P::frames,
          choiceKey("frames", kFramesOfARun, "one",
                    "what a run of it gives: one frame, {frame}; or all {frames} of the case, each "
                    "line and picture with its own; the run's time is then shared out among them")},
         {&P::gpu, flagKey("gpu", "whether it works on the GPU: then a run asks which that is")},
         {&P::here, "here", "folder", "that of this file", "what {here} is", text()}}};
    return table;
}

const KeyTable<ParamKeys>& paramTable() {
    using P = ParamKeys;
    static const KeyTable<P> table{
        {"program_param", "program.params.NAME.",
         "A value alone is the default, a list all that is allowed, the default first."},
        {{&P::fallback, "default", "value", "required",
          "in cases that do not say: 4 is a whole number, 4.0 any number, \"4\" text", text()},
         {&P::unit, "unit", "text", "\"\"", "spelt out", text()},
         {&P::min, numberKey("min", {}, "none", "the least that is allowed")},
         {&P::max, numberKey("max", {}, "none", "the most that is allowed")},
         {&P::choices, "choices", "[values]", "none", "all that is allowed", listOf(text(), 1)},
         {&P::doc, "doc", "line", "\"\"", "what it means", text()}}};
    return table;
}

namespace {

struct MetricKeys {
    GivenKey unit, better, pattern, scale, optional, doc;
};
const KeyTable<MetricKeys>& metricTable() {
    using M = MetricKeys;
    static const KeyTable<M> table{
        {"program_metric", "program.metrics.NAME.",
         "A text alone is the unit. A value is given once a pass in each run of the program."},
        {{&M::unit, "unit", "text", "required", "spelt out: byte, ms, triangle; 1 for none",
          text()},
         {&M::better, choiceKey("better", kBetter, "none", "which way is better")},
         {&M::pattern, "pattern", "regular expression", "none",
          "reads it off what the program prints: the number is its first group, as a whole; the "
          "last match counts",
          text()},
         {&M::scale,
          numberKey("scale", kScales, "1",
                    "multiplies that number: 1000 for ms of what is printed in seconds")},
         {&M::optional, flagKey("optional", "whether a run may be without it")},
         {&M::doc, "doc", "line", "\"\"", "what it means", text()}}};
    return table;
}

}  // namespace

const KeyTable<ImageKeys>& imageTable() {
    using I = ImageKeys;
    static const KeyTable<I> table{
        {"program_image", "program.images.NAME.",
         "With a truth its errors are recorded, under the image's name as pass: `gfxrepro "
         "describe` of the technique lists them. EXR, PFM, HDR and TIFF of floats are linear, the "
         "others sRGB, as is their truth."},
        {{&I::file, "file", "file", "required", "in {out}", text()},
         {&I::truth, "truth", "file | {parameter: value}", "none",
          fmt::format(
              "a file, or parameters (seed and frame, too) laid over the case's, with which the "
              "program makes it: once for all cases that agree on the others. With frames (2 or "
              "more) it is made of so many seeds, from frame on, and {} says whether the case's "
              "frames have its expectation",
              metrics::kSameMeanP),
          anyOf({text(), mapOf(anything())})}}};
    return table;
}

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

bool isSnakeCase(std::string_view name) {
    return !name.empty() && std::islower(static_cast<unsigned char>(name.front())) &&
           std::ranges::all_of(name, [](unsigned char c) {
               return std::islower(c) || std::isdigit(c) || c == '_';
           });
}

/// As the default looks.
ParamType typeOf(const ParamKeys& given) {
    const Node& fallback = *given.fallback;
    if (given.choices) return ParamType::Choice;
    if (fallback.tryBool()) return ParamType::Boolean;
    if (fallback.tryInteger()) return ParamType::Integer;
    return fallback.tryDouble() ? ParamType::Number : ParamType::Text;
}

/// The placeholders that every program has.
const Names& reservedNames() {
    static const Names names = {placeholder::kHere,  placeholder::kOut,    placeholder::kScene,
                                placeholder::kWidth, placeholder::kHeight, placeholder::kSeed,
                                placeholder::kFrame, placeholder::kFrames};
    return names;
}

/// Throws Error for a key that is no name in small letters, digits and _; `what` it names.
void requireSnakeCase(const Node& map, const std::string& name, std::string_view what) {
    if (isSnakeCase(name)) return;
    throw Error(map.keyLocation(name), fmt::format("program: {} '{}'; allowed: small letters, "
                                                   "digits and _, a letter first",
                                                   what, name));
}

/// An entry of `program.params`.
ProgramParam readProgramParam(const Node& params, const std::string& name) {
    const Node& given = *params.find(name);
    const std::string what = "program: parameter '" + name + "'";
    requireSnakeCase(params, name, "parameter");
    if (contains(reservedNames(), name)) {
        throw Error(params.keyLocation(name),
                    what + ": every program has that placeholder; give it another name");
    }
    static const Names kOfCases = {"output", "scene_sample", "stands_for"};
    if (contains(kOfCases, name)) {
        throw Error(params.keyLocation(name),
                    what + ": plans and tables have that of every case; give it another name");
    }
    // A value alone is its default, a list all that is allowed, the default first.
    const bool isList = given.isSequence() && !given.items().empty();
    Node map = paramTable().mapOf(isList ? given.items()[0] : given, &ParamKeys::fallback);
    if (isList) map.set(paramTable().nameOf(&ParamKeys::choices), given);
    const ParamKeys keys = paramTable().readKnown(map, what);
    const GivenKey& fallback = keys.fallback;
    if (!fallback || !fallback->isScalar()) {
        throw Error(given.location(),
                    what + " needs '" + fallback.name() + "', a number, a boolean or text");
    }
    ProgramParam param;
    param.name = name;
    param.fallback = *fallback;
    param.doc = optionalLine(keys.doc, what);
    param.unit = optionalLine(keys.unit, what);
    param.type = typeOf(keys);
    param.min = keys.min ? keys.min.number(what) : -kNoLimit;
    param.max = keys.max ? keys.max.number(what) : kNoLimit;
    const bool isNumber = param.type == ParamType::Integer || param.type == ParamType::Number;
    if (const GivenKey& end = keys.min ? keys.min : keys.max; end && !isNumber) {
        throw Error(end.where(), end.in(what) + " is of numbers alone");
    }
    if (const GivenKey& choices = keys.choices) {
        if (!choices->isSequence() || choices->items().empty()) {
            throwNotAllowed(*choices, choices.in(what), "a list of values");
        }
        for (const Node& choice : choices->items()) param.choices.push_back(choice.text());
    }
    const auto value = fallback->tryDouble();
    const auto whole = fallback->tryInteger();
    if (param.type == ParamType::Integer && whole && !std::in_range<int>(*whole)) {
        throwNotAllowed(*fallback, fallback.in(what),
                        "a whole number of 32 bits, or one with a point, as 5000000000.0");
    }
    const bool isLegal = isNumber ? *value >= param.min && *value <= param.max
                         : param.type == ParamType::Boolean ? fallback->tryBool().has_value()
                         : param.type == ParamType::Choice
                             ? contains(param.choices, fallback->text())
                             : true;
    if (!isLegal) throwNotAllowed(*fallback, fallback.in(what), "one of the values it may have");
    return param;
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
    if (node.text().find('\0') != std::string::npos) {
        throw Error(node.location(),
                    fmt::format("{} has a byte of 0; allowed: text without one", what));
    }
    if (hasOpenBrace(node.text())) {
        throw Error(node.location(), fmt::format("{}: a brace of '{}' is not closed; braces as "
                                                 "such are {{{{ and }}}}",
                                                 what, node.text()));
    }
    forEachPart(
        node.text(), [](std::string_view) {},
        [&](std::string_view name) {
            if (contains(known, name)) return;
            throw Error(node.location(),
                        fmt::format("{}: '{{{}}}' stands for nothing{}; braces as such are "
                                    "{{{{ and }}}}",
                                    what, name, suggestionOrAll(name, known)));
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

/// Whether it is the second of the two; where it is not there the first counts.
bool isSecond(const GivenKey& key) {
    return key && key.choice("program") == 1;
}

Better betterOf(const GivenKey& key, const std::string& owner) {
    if (!key) return Better::Neither;
    return key.choice(owner) == 0 ? Better::Lower : Better::Higher;
}

/// Throws Error unless it is a map of that `shape`.
const Node::Map& entriesOf(const GivenKey& key, const char* shape) {
    if (!key->isMap()) throwNotAllowed(*key, key.in("program"), std::string("a map ") + shape);
    return key->entries();
}

void readParams(const GivenKey& params, ExternalProgram& program, Names& known) {
    for (const auto& [name, param] : entriesOf(params, "{name: parameter}")) {
        program.params.push_back(readProgramParam(*params, name));
        known.push_back(name);
    }
}

void readEnvironment(const GivenKey& variables, const Names& known, ExternalProgram& program) {
    const std::string what = variables.in("program");
    for (const auto& [name, text] : entriesOf(variables, "{NAME: text}")) {
        if (name.empty() || name.find('=') != std::string::npos) {
            throw Error(variables->keyLocation(name),
                        fmt::format("{}: '{}' is no name of a variable; allowed: one without '='",
                                    what, name));
        }
        program.environment.emplace_back(name, templateOf(text, what, known));
    }
}

/// Of which {here} may be a part.
Names filesIn(const GivenKey& list) {
    Names names;
    if (!list) return names;
    const std::string what = list.in("program");
    if (!list->isSequence()) throwNotAllowed(*list, what, "a list of names");
    for (const Node& name : list->items()) {
        names.push_back(templateOf(name, what, {placeholder::kHere}));
    }
    return names;
}

/// A claim knows a row and a column by one name each.
void requireNameOfItsOwn(const Node& metrics, const std::string& name) {
    static const Names kAxes = {"scene", placeholder::kSeed, placeholder::kFrame};
    const bool isFrameTime = name == kFrameTime;
    if (!isFrameTime && !contains(kAxes, name)) return;
    throw Error(metrics.keyLocation(name),
                fmt::format("program: metric '{}' has the name of {}; allowed: another", name,
                            isFrameTime ? "the column of wall_time_ms, a frame's time"
                                        : "an axis that any program may have"));
}

void readMetrics(const GivenKey& metrics, ExternalProgram& program) {
    for (const auto& [name, given] : entriesOf(metrics, "{name: metric}")) {
        const std::string what = "program: metric '" + name + "'";
        requireSnakeCase(*metrics, name, "metric");
        requireNameOfItsOwn(*metrics, name);
        // A unit alone is all that a metric needs.
        const Node map = metricTable().mapOf(given, &MetricKeys::unit);
        const MetricKeys keys = metricTable().readKnown(map, what);
        if (!keys.unit || keys.unit->isNull())
            throw Error(metrics->keyLocation(name),
                        what + " needs '" + keys.unit.name() + "'; \"1\" for none");
        const std::string& unit = lineOf(*keys.unit, keys.unit.in(what));
        if (const std::string why = whyNoTimeName(name, unit); !why.empty()) {
            const char* more = keys.pattern ? "; 'scale' multiplies the pattern's number" : "";
            throw Error(keys.unit->location(), "program: metric " + why + more);
        }
        program.outputs.metrics.push_back(
            {name, unit, optionalLine(keys.doc, what), betterOf(keys.better, what)});
        if (keys.optional && keys.optional.flag(what)) program.optionalMetrics.push_back(name);
        const GivenKey &pattern = keys.pattern, &scale = keys.scale;
        if (scale && !pattern)
            throw Error(scale.where(),
                        what + ": '" + scale.name() + "' is of a pattern's number alone");
        if (!pattern) continue;
        if (program.givesAllFrames) {
            throw Error(pattern->location(), what +
                                                 ": a pattern does not tell frames apart, and "
                                                 "one run gives them all ('frames: all')");
        }
        const std::string& text = lineOf(*pattern, pattern.in(what));
        try {
            if (std::regex(text).mark_count() < 1) {
                throwNotAllowed(*pattern, pattern.in(what), "one with the number in ( )");
            }
        } catch (const std::regex_error& error) {
            throw Error(pattern->location(), pattern.in(what) + ": " + error.what());
        }
        const double factor = scale ? scale.number(what) : 1.0;
        program.patterns.push_back({name, text, factor});
    }
}

void readPasses(const GivenKey& passes, ExternalProgram& program) {
    for (const auto& [name, doc] : entriesOf(passes, "{name: meaning}")) {
        requireSnakeCase(*passes, name, "pass");
        program.outputs.passes.push_back({name, lineOf(doc, "program: pass '" + name + "'")});
    }
}

/// Several pictures of a truth are other seeds: `frame` says which.
void readTruthFrames(const Node& truth, const std::string& what, const ExternalProgram& program,
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
    if (text.ends_with('}') || image::hasReadEnding(text)) return;
    throwNotAllowed(file, what, "a name that ends in one of " + image::readEndings());
}

void readTruth(const Node& truth, const std::string& what, const Names& known,
               ExternalProgram& program, ProgramPicture& picture) {
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

void readPictures(const GivenKey& pictures, const Names& known, ExternalProgram& program) {
    for (const auto& [name, given] : entriesOf(pictures, "{name: file}")) {
        const std::string what = "program: image '" + name + "'";
        requireSnakeCase(*pictures, name, "image");
        const Node map = imageTable().mapOf(given, &ImageKeys::file);
        const ImageKeys keys = imageTable().read(map, what, &pictures->keyLocation(name));
        ProgramPicture picture;
        picture.name = name;
        const std::string whatFile = keys.file.in(what);
        picture.file = templateOf(*keys.file, whatFile, known);
        requirePictureType(*keys.file, whatFile);
        if (program.givesAllFrames && !hasPlaceholder(picture.file, placeholder::kFrame)) {
            throwNotAllowed(*keys.file, whatFile,
                            "one with {frame}, as one run leaves the pictures of all frames");
        }
        if (keys.truth) readTruth(*keys.truth, keys.truth.in(what), known, program, picture);
        program.pictures.push_back(picture);
        if (!picture.hasTruth()) continue;
        program.outputs.withTruth.push_back(name);
        if (picture.truthFrames > 1) program.outputs.tested.push_back(name);
        if (program.outputs.hasPass(name)) continue;
        program.outputs.passes.push_back({name, "the picture against its truth"});
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

bool ExternalProgram::uses(std::string_view name) const {
    const auto has = [&](const std::string& text) { return hasPlaceholder(text, name); };
    return std::ranges::any_of(command, has) ||
           std::ranges::any_of(environment, [&](const auto& one) { return has(one.second); });
}

const SourceLocation& placeOfMetric(const Node& program, const std::string& name) {
    return programTable().find(program).metrics->keyLocation(name);
}

const Node& programOf(const Experiment& experiment) {
    static const Node kNone;
    const GivenKey program = contentOf(experiment.document).program;
    return program ? *program : kNone;
}

namespace {

/// Whether a truth may have the case's random numbers: it differs by words alone.
bool mayShareSeeds(const ProgramPicture& picture) {
    const auto isNumber = [](const auto& one) { return one.value.tryDouble().has_value(); };
    return picture.truthParams.isMap() &&
           std::ranges::none_of(picture.truthParams.entries(), isNumber);
}

}  // namespace

ExternalProgram readProgram(const Node& node) {
    const std::string what = "program";
    const ProgramKeys given = programTable().readKnown(node, what);
    ExternalProgram program;
    program.here = optionalLine(given.here, what);
    if (given.gpu) program.usesGpu = given.gpu.flag(what);
    program.givesAllFrames = isSecond(given.frames);
    Names known = reservedNames();
    if (given.params) readParams(given.params, program, known);
    programTable().require(given, node.location(), what);
    program.command = argumentsOf(*given.command, given.command.in(what), known);
    if (given.env) readEnvironment(given.env, known, program);
    if (program.givesAllFrames && program.uses(placeholder::kFrame)) {
        throw Error(given.command->location(),
                    "program: {frame}, and one run gives all frames; allowed: "
                    "{frames}, their number");
    }
    if (given.version) {
        program.version = argumentsOf(*given.version, given.version.in(what), {placeholder::kHere});
    }
    program.starts = filesIn(given.starts);
    program.files = filesIn(given.files);
    if (given.metrics) readMetrics(given.metrics, program);
    if (given.passes) readPasses(given.passes, program);
    if (given.images) readPictures(given.images, known, program);
    program.sharesSeeds = std::ranges::any_of(program.pictures, mayShareSeeds);
    program.framesAreSeeds =
        !program.uses(placeholder::kSeed) &&
        std::ranges::any_of(program.pictures, [](const ProgramPicture& picture) {
            const Node& truth = picture.truthParams;
            return picture.truthFrames > 1 || (!truth.isNull() && truth.find(placeholder::kFrame));
        });
    for (const ProgramParam& param : program.params) {
        if (program.uses(param.name)) continue;
        throw Error(
            given.params->keyLocation(param.name),
            fmt::format("program: parameter '{0}': no argument and no variable has '{{{0}}}'",
                        param.name));
    }
    return program;
}

std::vector<SchemaSection> programKeys() {
    return {programTable().section(), paramTable().section(), metricTable().section(),
            imageTable().section()};
}

}  // namespace gfxrepro::config
