// The parameters of a program: as its config declares them, and as a case has them.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/program_parts.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using Names = std::vector<std::string>;
using ParamType = ProgramParam::Type;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

bool isSnakeCase(std::string_view name) {
    return !name.empty() && std::islower(static_cast<unsigned char>(name.front())) &&
           std::ranges::all_of(name, [](unsigned char c) {
               return std::islower(c) || std::isdigit(c) || c == '_';
           });
}

double optionalNumber(const Node& map, const char* key, double fallback) {
    const Node* node = map.find(key);
    return node ? node->asDouble() : fallback;
}

/// As the default looks.
ParamType typeOf(const Node& map, const Node& fallback) {
    if (map.find("choices")) return ParamType::Choice;
    if (fallback.tryBool()) return ParamType::Boolean;
    if (fallback.tryInteger()) return ParamType::Integer;
    return fallback.tryDouble() ? ParamType::Number : ParamType::Text;
}

/// One of a list that is known only now.
void readChoice(const ProgramParam& param, Params& values) {
    const std::string allowed = joined(param.choices, " | ");
    const std::string doc = param.doc.empty() ? allowed : param.doc + " (" + allowed + ")";
    const std::string value = values.getText(param.name, param.fallback.text(), {doc, param.unit});
    if (std::ranges::find(param.choices, value) != param.choices.end()) return;
    throw Error(values.locationOf(param.name),
                fmt::format("{} is '{}'; allowed: {}", param.name, value, allowed));
}

}  // namespace

const Names& reservedNames() {
    static const Names names = {placeholder::kHere,  placeholder::kOut,    placeholder::kScene,
                                placeholder::kWidth, placeholder::kHeight, placeholder::kSeed,
                                placeholder::kFrame, placeholder::kFrames};
    return names;
}

void requireSnakeCase(const Node& map, const std::string& name, std::string_view what) {
    if (isSnakeCase(name)) return;
    throw Error(map.keyLocation(name), fmt::format("program: {} '{}'; allowed: small letters, "
                                                   "digits and _, a letter first",
                                                   what, name));
}

std::string optionalLine(const Node& map, const char* key, const std::string& what) {
    const Node* node = map.find(key);
    return node ? lineOf(*node, what + ": " + key) : "";
}

ProgramParam readProgramParam(const Node& params, const std::string& name) {
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
    param.type = typeOf(map, *fallback);
    param.min = optionalNumber(map, "min", -kNoLimit);
    param.max = optionalNumber(map, "max", kNoLimit);
    const bool isNumber = param.type == ParamType::Integer || param.type == ParamType::Number;
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
    if (param.type == ParamType::Integer && whole && !std::in_range<int>(*whole)) {
        throwNotAllowed(*fallback, what + ": default",
                        "a whole number of 32 bits, or one with a point, as 5000000000.0");
    }
    const bool isLegal =
        isNumber                           ? *value >= param.min && *value <= param.max
        : param.type == ParamType::Boolean ? fallback->tryBool().has_value()
        : param.type == ParamType::Choice
            ? std::ranges::find(param.choices, fallback->text()) != param.choices.end()
            : true;
    if (!isLegal) throwNotAllowed(*fallback, what + ": default", "one of the values it may have");
    return param;
}

void Program::declare(Params& values) const {
    for (const ProgramParam& param : params) {
        const ParamSpec spec{param.doc, param.unit, param.min, param.max};
        switch (param.type) {
            case ProgramParam::Type::Integer:
                values.getInt(param.name, static_cast<int>(param.fallback.asInteger()), spec);
                break;
            case ProgramParam::Type::Number:
                values.getDouble(param.name, param.fallback.asDouble(), spec);
                break;
            case ProgramParam::Type::Boolean:
                values.getBool(param.name, param.fallback.asBool(), spec);
                break;
            case ProgramParam::Type::Text:
                values.getText(param.name, param.fallback.text(), spec);
                break;
            case ProgramParam::Type::Choice:
                readChoice(param, values);
                break;
        }
    }
    if (uses(placeholder::kSeed)) {
        values.getInt(placeholder::kSeed, 1, {"{seed}, of its random numbers", "", 0, 1e9});
    }
}

}  // namespace gfxrepro::config
