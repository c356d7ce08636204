#include "runner/config/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/scene/catalog_schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

/// Read in runner/run/expectations.cpp.
SchemaFile expectationsSchema() {
    using namespace types;
    const std::vector<SchemaKey> entry = {
        {"table", "id", "required", "the experiment, as zju2005/2.1", text()},
        {"at", "{axis: value | [values]}", "all cases", "axes or parameters", pairs()},
        {"reason", "line", "required", "why", text()},
        {"until",
         "YYYY-MM-DD",
         "required",
         "the last day on which it counts",
         {{"type", "string"}, {"pattern", "^[0-9]{4}-[0-9]{2}-[0-9]{2}$"}}}};
    SchemaSection failure{"expected_failure", "fails[].", "", entry, false};
    failure.keys.push_back({"status", "name", "any", "how the case ends",
                            choice({"ok", "ambiguous", "flaky", "unsupported", "timeout", "oom",
                                    "crash", "device-lost", "missing", "error"})});
    return {
        "expectations",
        "`expect-software.yaml` and `expect-gpu.yaml`, beside configs",
        {SchemaSection{
             "expectations",
             "",
             "",
             {{"fails", "[entry]", "[]", "cases that end otherwise than well",
               listOf(refTo("expected_failure"))},
              {"flakes", "[entry]", "[]", "cases that fail at times", listOf(refTo("expectation"))},
              {"skips", "[entry]", "[]", "cases that are not tried", listOf(refTo("expectation"))}},
             false},
         std::move(failure),
         SchemaSection{"expectation", "flakes[]. or skips[].", "", entry, false}}};
}

using Row = std::array<std::string, 4>;

/// Columns on a screen: `…` is one of them and three bytes.
std::size_t widthOf(const std::string& text) {
    std::size_t width = 0;
    for (const char c : text) width += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return width;
}

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, widthOf(text)) + 2, ' ');
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
        text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, code(key.type),
                            isWords ? key.absent : code(key.absent), cell(key.doc));
    }
    return text;
}

}  // namespace

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

std::string describeConfig() {
    std::vector<Row> rows = {{"key", "type", "default", "meaning"}};
    for (const SchemaSection& section : schema().front().sections) {
        if (!section.doc.empty()) rows.push_back({"", "", "", section.doc});
        for (const SchemaKey& key : section.keys) {
            rows.push_back({section.path + key.name, key.type, key.absent, key.doc});
        }
    }
    std::array<std::size_t, 3> widths = {};
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < 3; ++i) widths[i] = std::max(widths[i], widthOf(row[i]));
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
