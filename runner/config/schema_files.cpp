// The keys of expectations and documents.
#include "runner/config/schema_files.h"

namespace gfxrepro::config {

namespace {

using namespace types;

SchemaSection lists() {
    return {"expectations",
            "",
            "",
            {{"fails", "[entry]", "[]", "cases that end otherwise than well",
              listOf(refTo("expected_failure"))},
             {"flakes", "[entry]", "[]", "cases that fail at times", listOf(refTo("expectation"))},
             {"skips", "[entry]", "[]", "cases that are not tried", listOf(refTo("expectation"))}},
            false};
}

std::vector<SchemaKey> entryKeys() {
    return {{"table", "id", "required", "the experiment, as zju2005/2.1", text()},
            {"at", "{axis: value | [values]}", "all cases", "axes or parameters", pairs()},
            {"reason", "line", "required", "why", text()},
            {"until",
             "YYYY-MM-DD",
             "required",
             "the last day on which it counts",
             {{"type", "string"}, {"pattern", "^[0-9]{4}-[0-9]{2}-[0-9]{2}$"}}}};
}

SchemaSection entries() {
    return {"expectation", "flakes[]. or skips[].", "", entryKeys(), false};
}

SchemaSection failures() {
    SchemaSection section{"expected_failure", "fails[].", "", entryKeys(), false};
    section.keys.push_back({"status", "name", "any", "how the case ends",
                            choice({"ok", "ambiguous", "flaky", "unsupported", "timeout", "oom",
                                    "crash", "device-lost", "missing", "error"})});
    return section;
}

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

SchemaFile expectationsSchema() {
    return {"expectations",
            "`expect-software.yaml` and `expect-gpu.yaml`, beside configs",
            {lists(), failures(), entries()}};
}

SchemaFile documentsSchema() {
    return {"documents",
            "`documents.yaml`: which table belongs to which chapter",
            {documents(), document(), chapter()}};
}

}  // namespace gfxrepro::config
