#include "engine/core/schema.h"

namespace gfxrepro {

std::vector<std::string> SchemaSection::keyNames() const {
    std::vector<std::string> names;
    for (const SchemaKey& key : keys) names.push_back(key.name);
    return names;
}

const SchemaSection* SchemaFile::find(std::string_view section) const {
    for (const SchemaSection& one : sections) {
        if (one.name == section) return &one;
    }
    return nullptr;
}

}  // namespace gfxrepro
