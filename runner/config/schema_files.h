// The parts of the schema; private to this module.
#pragma once

#include "runner/config/schema.h"

namespace gfxrepro::config {

SchemaFile experimentSchema();
std::vector<SchemaSection> programSections();
std::vector<SchemaSection> claimSections();
SchemaFile documentsSchema();

/// The JSON schema of a declared parameter's values.
Json jsonTypeOf(const ParamInfo& info);

}  // namespace gfxrepro::config
