#include "runner/run/expectations.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/core/files.h"
#include "engine/core/params.h"
#include "engine/core/text.h"
#include "runner/config/schema.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

constexpr std::pair<std::string_view, Expectation::Kind> kLists[] = {
    {"fails", Expectation::Kind::Fails},
    {"flakes", Expectation::Kind::Flakes},
    {"skips", Expectation::Kind::Skips}};

std::string listName(std::string_view deviceClass) {
    return fmt::format("expect-{}.yaml", deviceClass);
}

bool isOneOf(const Node& value, const Node& allowed) {
    if (!allowed.isSequence()) return value.sameContent(allowed);
    const auto& items = allowed.items();
    return std::any_of(items.begin(), items.end(),
                       [&](const Node& item) { return value.sameContent(item); });
}

/// "2027-01-31"; compares as text.
void requireDay(const std::string& text, const SourceLocation& where) {
    constexpr std::string_view kPattern = "dddd-dd-dd";
    bool isDay = text.size() == kPattern.size();
    for (std::size_t i = 0; isDay && i < text.size(); ++i) {
        isDay = kPattern[i] == 'd' ? text[i] >= '0' && text[i] <= '9' : text[i] == '-';
    }
    if (!isDay) {
        throw Error(where,
                    fmt::format("until: found '{}', expected a day such as 2027-01-31", text));
    }
}

Expectation readEntry(const Node& node, Expectation::Kind kind, const std::string& list) {
    if (!node.isMap()) {
        throw Error(node.location(),
                    fmt::format("{}: expected a map, found {}", list, node.kindName()));
    }
    Node values = node;
    Expectation entry;
    entry.kind = kind;
    entry.location = node.location();
    if (const Node* at = node.find("at")) {
        entry.at = at->entries();
        values.erase("at");
    }
    Params params(values, "an entry of '" + list + "'");
    entry.table = params.getText("table", "", {"experiment, as in zju2005/2.1"});
    entry.reason = params.getText("reason", "", {"why"});
    entry.until = params.getText("until", "", {"the last day on which it counts"});
    std::string status;
    if (kind == Expectation::Kind::Fails) {
        status = params.getText("status", "", {"how the case ends"});
    }
    params.finish();
    for (const auto& [name, text] :
         {std::pair{"table", &entry.table}, std::pair{"reason", &entry.reason},
          std::pair{"until", &entry.until}}) {
        if (text->empty()) {
            throw Error(node.location(), fmt::format("{}: '{}' is missing", list, name));
        }
    }
    requireDay(entry.until, params.locationOf("until"));
    if (status.empty()) return entry;
    try {
        entry.status = records::statusFromName(status);
    } catch (const Error& error) {
        throw Error(params.locationOf("status"), error.what());
    }
    return entry;
}

/// What the case has of an axis or parameter, or `scene`; null for no such one.
const Node* valueOf(const Case& item, const std::string& axis) {
    const Node* value = item.axes.find(axis);
    if (!value) value = item.params.find(axis);
    return !value && axis == "scene" ? &item.scene : value;
}

}  // namespace

bool Expectation::matches(const Case& item) const {
    if (item.experiment != table) return false;
    for (const auto& [axis, allowed] : at) {
        const Node* value = valueOf(item, axis);
        if (!value || !isOneOf(*value, allowed)) return false;
    }
    return true;
}

namespace {

/// Where the lists of these configs would be.
std::set<fs::path> listFiles(const std::vector<fs::path>& configs) {
    std::set<fs::path> files;
    for (const fs::path& config : configs) {
        const fs::path folder = fs::absolute(config).lexically_normal().parent_path();
        for (const std::string_view deviceClass : config::kDeviceClasses) {
            files.insert(folder / listName(deviceClass));
        }
    }
    return files;
}

}  // namespace

std::vector<ExpectationList> findExpectations(const std::vector<fs::path>& configs) {
    std::vector<ExpectationList> lists;
    for (const fs::path& file : listFiles(configs)) {
        if (fs::exists(file)) lists.push_back({file, readFile(file)});
    }
    return lists;
}

std::vector<std::string> changedExpectations(const Plan& plan) {
    std::map<std::string, std::string> then;
    std::set<fs::path> files;
    for (const ExpectationList& list : plan.expectations) {
        then[list.file] = list.text;
        files.insert(list.file);
    }
    std::vector<fs::path> configs;
    for (const config::Experiment& experiment : plan.experiments) {
        configs.push_back(experiment.file);
    }
    files.merge(listFiles(configs));
    std::vector<std::string> changed;
    for (const fs::path& file : files) {
        try {
            if (!fs::is_directory(file.parent_path())) continue;
            const auto frozen = then.find(file);
            const bool isSame = fs::exists(file)
                                    ? frozen != then.end() && frozen->second == readFile(file)
                                    : frozen == then.end();
            if (!isSame) changed.push_back(file.string() + " changed");
        } catch (const std::exception& error) {  // another user's, or a file system that is away
            changed.push_back(
                fmt::format("{} cannot be compared ({})", file.string(), error.what()));
        }
    }
    return changed;
}

std::vector<Expectation> readExpectations(const ExpectationList& list) {
    const Node document = parseYaml(list.text, list.file);
    std::vector<Expectation> entries;
    if (document.isNull()) return entries;
    for (const auto& [name, items] : document.entries()) {
        const auto* found = std::find_if(std::begin(kLists), std::end(kLists),
                                         [&key = name](const auto& l) { return l.first == key; });
        if (found == std::end(kLists)) {
            throw Error(document.keyLocation(name),
                        fmt::format("unknown list '{}'; allowed: fails, flakes, skips", name));
        }
        for (const Node& node : items.items()) {
            entries.push_back(readEntry(node, found->second, name));
        }
    }
    return entries;
}

void requireKnown(const Expectation& entry, const std::vector<Case>& cases) {
    for (const auto& [axis, allowed] : entry.at) {
        std::vector<std::string> names = {"scene"}, values;
        std::vector<const Node*> nodes;
        for (const Case& item : cases) {
            for (const Node* map : {&item.axes, &item.params}) {
                for (const auto& [name, value] : map->entries()) names.push_back(name);
            }
            if (const Node* value = valueOf(item, axis)) {
                nodes.push_back(value);
                values.push_back(value->toFlowText());
            }
        }
        if (nodes.empty()) {
            throw Error(allowed.location(),
                        fmt::format("at: '{}' is no axis or parameter of {}{}", axis, entry.table,
                                    suggestion(axis, names)));
        }
        const Node::Sequence one = {allowed};
        for (const Node& value : allowed.isSequence() ? allowed.items() : one) {
            const bool isKnown = std::ranges::any_of(
                nodes, [&](const Node* node) { return node->sameContent(value); });
            if (isKnown) continue;
            throw Error(value.location(),
                        fmt::format("at: no case of {} has {}={}{}", entry.table, axis,
                                    value.toFlowText(), suggestion(value.toFlowText(), values)));
        }
    }
}

Expectations::Expectations(const std::vector<ExpectationList>& lists,
                           const std::string& deviceClass, std::string_view today) {
    for (const ExpectationList& list : lists) {
        if (fs::path(list.file).filename() != listName(deviceClass)) continue;
        for (Expectation& entry : readExpectations(list)) {
            const bool isExpired = entry.until < today;
            entries_.push_back({std::move(entry), isExpired});
        }
    }
}

const Expectation* Expectations::skipOf(const Case& item) const {
    for (const Entry& entry : entries_) {
        if (entry.isExpired || entry.expectation.kind != Expectation::Kind::Skips) continue;
        if (entry.expectation.matches(item)) return &entry.expectation;
    }
    return nullptr;
}

namespace {

bool allows(const Expectation& expectation, records::Status status) {
    switch (expectation.kind) {
        case Expectation::Kind::Fails:
            return status != records::Status::Ok && status != records::Status::Flaky &&
                   (!expectation.status || expectation.status == status);
        case Expectation::Kind::Flakes:
            return status == records::Status::Flaky;
        case Expectation::Kind::Skips:
            return status == records::Status::Missing;
    }
    return false;
}

}  // namespace

const Expectation* Expectations::excuseOf(const Case& item, records::Status status) const {
    for (const Entry& entry : entries_) {
        if (entry.isExpired || !allows(entry.expectation, status)) continue;
        if (entry.expectation.matches(item)) return &entry.expectation;
    }
    return nullptr;
}

const Expectation* Expectations::failureOf(const Case& item) const {
    for (const Entry& entry : entries_) {
        if (entry.isExpired || entry.expectation.kind != Expectation::Kind::Fails) continue;
        if (entry.expectation.matches(item)) return &entry.expectation;
    }
    return nullptr;
}

void Expectations::note(const Case& item, records::Status status) {
    for (Entry& entry : entries_) {
        if (entry.isExpired || !entry.expectation.matches(item)) continue;
        if (allows(entry.expectation, status)) ++entry.met;
        if (status == records::Status::Ok) ++entry.passed;
    }
}

std::vector<std::string> Expectations::complaints() const {
    std::vector<std::string> lines;
    for (const Entry& entry : entries_) {
        const Expectation& expectation = entry.expectation;
        const std::string where = toString(expectation.location);
        if (entry.isExpired) {
            lines.push_back(fmt::format("{}: the expectation expired on {} ({})", where,
                                        expectation.until, expectation.reason));
        } else if (entry.passed > 0 && entry.met == 0) {
            lines.push_back(
                fmt::format("{}: the expectation is not needed: every case that it "
                            "names passed ({})",
                            where, expectation.reason));
        }
    }
    return lines;
}

}  // namespace gfxrepro::run
