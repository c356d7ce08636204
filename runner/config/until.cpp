// `measure: {until: {…}}`: the keys that it stands for.
#include <fmt/format.h>

#include "engine/core/checks.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

struct UntilKey {
    const char* name;
    const char* meant;  // of `measure`
};
constexpr UntilKey kUntilKeys[] = {{"relative_error", "relative_error"},
                                   {"at_most_s", "time_budget_s"},
                                   {"processes", "processes_at_most"},
                                   {"repeats", "repeats_at_most"}};

Node shareOf(const Node& value, const std::string& what) {
    const std::optional<double> share = fractionOf(value);
    if (share && *share > 0.0 && *share <= 1.0) return Node::number(*share, value.location());
    throwNotAllowed(value, what, "a percentage as 1 %, or a fraction, above 0 and to 1");
}

/// Below as many rounds as an interval takes none follow, and those that are there would be all.
void requireRounds(const Node& measure, const Node& until) {
    const Node* error = until.find("relative_error");
    const Node* repeats = until.find("repeats");
    if (!error || error->isNull() || (repeats && !repeats->isNull())) return;
    if (measure.find("repeats_at_most")) return;
    const Node* processes = measure.find("processes");
    const std::optional<long long> count = processes ? processes->tryInteger() : std::nullopt;
    if (!count || *count >= kFewestRounds) return;
    throw Error(processes->location(),
                fmt::format("measure: processes is {}, from which 'until' does not go on, as an "
                            "interval takes {}; allowed: {} or more, none, or 'repeats' in 'until'",
                            *count, kFewestRounds, kFewestRounds));
}

}  // namespace

void spreadUntil(Node& document) {
    Node* measure = document.find("measure");
    if (!measure || !measure->isMap() || !measure->find("until")) return;
    const Node until = *measure->find("until");
    const SourceLocation where = measure->keyLocation("until");
    measure->erase("until");
    if (until.isNull()) return measure->set("relative_error", until, where);  // they do not go on
    requireKeys(until, "measure: until", keysOf("until"));
    const Node* lane = measure->find("lane");
    if (lane && lane->isScalar() && lane->text() == "quality" &&
        lane->location().file == until.location().file) {
        throw Error(where,
                    "measure: until: times alone are known to an error, and 'lane: quality' beside "
                    "it takes none; allowed: lane: timing");
    }
    requireRounds(*measure, until);
    for (const auto& [name, meant] : kUntilKeys) {
        const Node* value = until.find(name);
        if (!value) continue;
        const std::string what = std::string("measure: until: ") + name;
        const Node* same = measure->find(meant);
        if (same && same->location().file == value->location().file) {
            throw Error(until.keyLocation(name),
                        what + ": '" + meant + "' beside it says the same; allowed: one of them");
        }
        // Else as many as an interval takes would be measured first, however long they are.
        if (name == std::string_view("at_most_s") && !value->isNull() &&
            !measure->find("processes_at_least")) {
            measure->set("processes_at_least", Node::number(1), until.keyLocation(name));
        }
        const bool isShare = !value->isNull() && name == std::string_view("relative_error");
        measure->set(meant, isShare ? shareOf(*value, what) : *value, until.keyLocation(name));
    }
}

}  // namespace gfxrepro::config
