#include "runner/config/schema.h"

#include <fmt/format.h>

#include <stdexcept>

#include "engine/scene/catalog_schema.h"
#include "runner/config/schema_files.h"

namespace gfxrepro::config {

const std::vector<SchemaFile>& schema() {
    static const std::vector<SchemaFile> files = {experimentSchema(), scene::sceneSchema(),
                                                  documentsSchema()};
    return files;
}

const SchemaSection& schemaSection(std::string_view name) {
    for (const SchemaFile& file : schema()) {
        if (const SchemaSection* section = file.find(name)) return *section;
    }
    throw std::logic_error(fmt::format("the schema has no section '{}'", name));
}

std::vector<std::string> keysOf(std::string_view section) {
    return schemaSection(section).keyNames();
}

}  // namespace gfxrepro::config
