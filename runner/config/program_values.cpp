// The parameters of a program as a case has them.
#include <fmt/format.h>

#include <algorithm>

#include "runner/config/program.h"
#include "runner/core/text.h"

namespace gfxrepro::config {

namespace {

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
}

}  // namespace gfxrepro::config
