#include "runner/config/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/core/text.h"
#include "engine/scene/catalog_entry.h"
#include "engine/scene/height_rows.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using Row = std::array<std::string, 4>;

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, columnsOf(text)) + 2, ' ');
}

/// The text of a cell: a bar would end it, and `<` begin a tag.
std::string cell(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '|') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

std::string code(const std::string& text) {
    return text.empty() ? "" : fmt::format("`{}`", cell(text));
}

std::string tableOf(const SchemaSection& section) {
    std::string text = "\n";
    if (!section.path.empty()) text += fmt::format("**`{}`**", section.path);
    if (!section.path.empty() && !section.doc.empty()) text += " ";
    text += section.doc;
    if (text != "\n") text += "\n\n";
    text += "| key | type | default | meaning |\n| --- | --- | --- | --- |\n";
    for (const SchemaKey& key : section.keys) {
        const bool isWords = key.isRequired() || key.absent == "none";
        text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, code(key.inWords()),
                            isWords ? key.absent : code(key.absent), cell(key.doc));
    }
    return text;
}

}  // namespace

const std::vector<SchemaFile>& schema() {
    static const std::vector<SchemaFile> files = {experimentSchema(), scene::sceneSchema(),
                                                  scene::rawHeightSchema(), documentsSchema()};
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

std::string describeConfig() {
    std::vector<Row> rows = {{"key", "type", "default", "meaning"}};
    for (const SchemaSection& section : schema().front().sections) {
        if (!section.doc.empty()) rows.push_back({"", "", "", section.doc});
        for (const SchemaKey& key : section.keys) {
            rows.push_back({section.path + key.name, key.inWords(), key.absent, key.doc});
        }
    }
    std::array<std::size_t, 3> widths = {};
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < 3; ++i) widths[i] = std::max(widths[i], columnsOf(row[i]));
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        if (row[0].empty()) {
            line = "\n" + row[3];
        } else {
            for (std::size_t i = 0; i < 3; ++i) line += padded(row[i], widths[i]);
            line += row[3];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string describeConfigInMarkdown() {
    std::string text;
    for (const SchemaFile& file : schema()) {
        text += fmt::format("{}## {}\n", text.empty() ? "" : "\n", file.doc);
        for (const SchemaSection& section : file.sections) text += tableOf(section);
    }
    return text;
}

}  // namespace gfxrepro::config
