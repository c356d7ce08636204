#include "runner/config/documents.h"

#include <fmt/format.h>

#include <map>

#include "engine/core/checks.h"
#include "engine/core/node.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

struct ChapterKeys {
    GivenKey title, has;
};
const KeyTable<ChapterKeys>& chapterTable() {
    static const KeyTable<ChapterKeys> table{
        {"chapter", "ID.chapters[].", "", false},
        {{&ChapterKeys::title, "title", "line", "required", "its number and subject, for reports",
          text()},
         {&ChapterKeys::has, "has", "[name]", "required",
          "its tables, figures and sections, as in their ids: 2.1, figure-2.6, 2.5.3",
          listOf(text())}}};
    return table;
}

Chapter readChapter(const Node& node, const std::string& what) {
    const ChapterKeys given = chapterTable().read(node, what);
    Chapter chapter{given.title->text(), {}};
    for (const Node& item : given.has->items()) chapter.experiments.push_back(item.text());
    return chapter;
}

struct DocumentKeys {
    GivenKey title, chapters;
};
const KeyTable<DocumentKeys>& documentTable() {
    static const KeyTable<DocumentKeys> table{
        {"document", "ID.", "", false},
        {{&DocumentKeys::title, "title", "line", "required", "what it is about, for reports",
          text()},
         {&DocumentKeys::chapters, "chapters", "[chapter]", "required", "in the document's order",
          listOf(refTo("chapter"))}}};
    return table;
}

Document readDocument(const std::string& id, const Node& node) {
    const DocumentKeys given = documentTable().read(node, id);
    Document document{id, given.title->text(), {}};
    std::map<std::string, std::string> chapterOf;
    for (const Node& item : given.chapters->items()) {
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
    SchemaSection documents{"documents", "", "A key is a document: the folder of its configs.",
                            false};
    documents.others = refTo("document");
    return {"documents",
            "`documents.yaml`: which table belongs to which chapter",
            {std::move(documents), documentTable().section(), chapterTable().section()}};
}

}  // namespace gfxrepro::config
