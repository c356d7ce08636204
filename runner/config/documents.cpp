#include "runner/config/documents.h"

#include <fmt/format.h>

#include <map>

#include "engine/core/checks.h"
#include "engine/core/node.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

const Node& required(const Node& map, const char* key, const std::string& what) {
    const Node* value = map.find(key);
    if (!value) throw Error(map.location(), fmt::format("{}: '{}' is missing", what, key));
    return *value;
}

Chapter readChapter(const Node& node, const std::string& what) {
    requireKeys(node, what, keysOf("chapter"));
    Chapter chapter{required(node, "title", what).text(), {}};
    for (const Node& item : required(node, "has", what).items()) {
        chapter.experiments.push_back(item.text());
    }
    return chapter;
}

Document readDocument(const std::string& id, const Node& node) {
    requireKeys(node, id, keysOf("document"));
    Document document{id, required(node, "title", id).text(), {}};
    std::map<std::string, std::string> chapterOf;
    for (const Node& item : required(node, "chapters", id).items()) {
        Chapter chapter = readChapter(item, id + ".chapters");
        for (const std::string& experiment : chapter.experiments) {
            const auto [known, isNew] = chapterOf.try_emplace(experiment, chapter.title);
            if (isNew) continue;
            throw Error(item.location(),
                        fmt::format("{}: '{}' is of '{}' already", id, experiment, known->second));
        }
        document.chapters.push_back(std::move(chapter));
    }
    return document;
}

}  // namespace

std::vector<Document> readDocuments(const std::filesystem::path& file) {
    std::vector<Document> documents;
    std::error_code isAbsent;
    if (!std::filesystem::exists(file, isAbsent)) return documents;
    const Node whole = parseYamlFile(file);
    if (whole.isNull()) return documents;
    for (const auto& [id, node] : whole.entries()) documents.push_back(readDocument(id, node));
    return documents;
}

SchemaFile documentsSchema() {
    using namespace types;
    SchemaSection documents{
        "documents", "", "A key is a document: the folder of its configs.", {}, false};
    documents.others = refTo("document");
    return {"documents",
            "`documents.yaml`: which table belongs to which chapter",
            {std::move(documents),
             SchemaSection{"document",
                           "ID.",
                           "",
                           {{"title", "line", "required", "what it is about, for reports", text()},
                            {"chapters", "[chapter]", "required", "in the document's order",
                             listOf(refTo("chapter"))}},
                           false},
             SchemaSection{
                 "chapter",
                 "ID.chapters[].",
                 "",
                 {{"title", "line", "required", "its number and subject, for reports", text()},
                  {"has", "[name]", "required",
                   "its tables, figures and sections, as in their ids: 2.1, figure-2.6, 2.5.3",
                   listOf(text())}},
                 false}}};
}

}  // namespace gfxrepro::config
