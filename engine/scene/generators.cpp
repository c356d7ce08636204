#include "engine/scene/generators.h"

#include "engine/core/text.h"

namespace gfxrepro::scene {

std::vector<KeyInfo> declaredParams(const GeneratorInfo& generator, const Node& values) {
    Params params(values, "generator '" + std::string(generator.name) + "'");
    params.stopWhenFinished();
    try {
        generator.generate(params, 1);
    } catch (const Params::Finished&) {  // no error: what was asked is known
    }
    return params.declared();
}

const GeneratorInfo& findGenerator(std::span<const GeneratorInfo> generators, std::string_view name,
                                   const SourceLocation& where) {
    std::vector<std::string> names;
    for (const GeneratorInfo& generator : generators) {
        if (generator.name == name) return generator;
        names.emplace_back(generator.name);
    }
    throw Error(where, "unknown generator '" + std::string(name) + "'" + suggestion(name, names) +
                           " (there are: " + joined(names) + ")");
}

}  // namespace gfxrepro::scene
