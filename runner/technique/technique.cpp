#include "runner/technique/technique.h"

#include "runner/core/error.h"
#include "runner/core/text.h"

namespace gfxrepro::technique {

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
