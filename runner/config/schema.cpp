#include "runner/config/schema.h"

#include <fmt/format.h>

#include <stdexcept>

#include "runner/config/schema_files.h"

namespace gfxrepro::config {

const std::vector<SchemaFile>& schema() {
    static const std::vector<SchemaFile> files = {experimentSchema(), sceneSchema(),
                                                  expectationsSchema(), documentsSchema()};
    return files;
}

const SchemaSection& schemaSection(std::string_view name) {
    for (const SchemaFile& file : schema()) {
        for (const SchemaSection& section : file.sections) {
            if (section.name == name) return section;
        }
    }
    throw std::logic_error(fmt::format("the schema has no section '{}'", name));
}

std::vector<std::string> keysOf(std::string_view section) {
    std::vector<std::string> names;
    for (const SchemaKey& key : schemaSection(section).keys) names.push_back(key.name);
    return names;
}

}  // namespace gfxrepro::config
