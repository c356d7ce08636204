// The keys of documents.
#include "runner/config/schema_files.h"

namespace gfxrepro::config {

namespace {

using namespace types;

SchemaSection documents() {
    SchemaSection section{
        "documents", "", "A key is a document: the folder of its configs.", {}, false};
    section.others = refTo("document");
    return section;
}

SchemaSection document() {
    return {"document",
            "ID.",
            "",
            {{"title", "line", "required", "what it is about, for reports", text()},
             {"chapters", "[chapter]", "required", "in the document's order",
              listOf(refTo("chapter"))}},
            false};
}

SchemaSection chapter() {
    return {"chapter",
            "ID.chapters[].",
            "",
            {{"title", "line", "required", "its number and subject, for reports", text()},
             {"has", "[name]", "required",
              "its tables, figures and sections, as in their ids: 2.1, figure-2.6, 2.5.3",
              listOf(text())}},
            false};
}

}  // namespace

SchemaFile documentsSchema() {
    return {"documents",
            "`documents.yaml`: which table belongs to which chapter",
            {documents(), document(), chapter()}};
}

}  // namespace gfxrepro::config
