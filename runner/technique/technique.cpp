#include "runner/technique/technique.h"

#include "runner/core/error.h"
#include "runner/core/text.h"

namespace gfxrepro::technique {

void Recorder::share(std::string_view name, double part, double whole, std::string_view unit,
                     std::string_view pass) {
    if (whole == 0.0) return;
    metric(name, 100.0 * part / whole, "%", pass);
    metric(std::string(name).append("_of"), whole, unit, pass);
}

const TechniqueInfo& findTechnique(std::span<const TechniqueInfo> techniques, std::string_view name,
                                   const SourceLocation& where) {
    std::vector<std::string> names;
    for (const TechniqueInfo& info : techniques) {
        if (info.name == name) return info;
        names.emplace_back(info.name);
    }
    throw Error(where, "unknown technique '" + std::string(name) + "'" + suggestion(name, names) +
                           "; known: " + joined(names));
}

}  // namespace gfxrepro::technique
