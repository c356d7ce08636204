#include "runner/batch/run_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/core/text.h"

namespace gfxrepro::batch {

namespace fs = std::filesystem;

namespace {

enum class Kind { Text, Whole, Number, Object, List, Texts, Objects };

bool isOfKind(const Json& value, Kind kind) {
    const auto are = [&](Kind item) {
        return std::ranges::all_of(value, [&](const Json& one) { return isOfKind(one, item); });
    };
    switch (kind) {
        case Kind::Text:
            return value.is_string();
        case Kind::Whole:
            return value.is_number_integer();
        case Kind::Number:
            return value.is_number();
        case Kind::Object:
            return value.is_object();
        case Kind::List:
            return value.is_array();
        case Kind::Texts:
            return (value.is_array() || value.is_object()) && are(Kind::Text);
        case Kind::Objects:
            return (value.is_array() || value.is_object()) && are(Kind::Object);
    }
    return false;
}

std::string_view nameOf(Kind kind) {
    static constexpr std::array<std::string_view, 7> kNames = {
        "text", "a whole number", "a number", "an object", "a list", "texts", "objects"};
    return kNames[static_cast<std::size_t>(kind)];
}

struct Member {
    const char* place;  // a JSON pointer
    Kind kind;
    bool isRequired = true;
};

/// `prefix` stands before the places in messages.
void requireMembers(const Json& object, std::span<const Member> members,
                    const SourceLocation& where, const std::string& prefix = "") {
    for (const Member& member : members) {
        const Json::json_pointer place(member.place);
        if (!object.contains(place)) {
            if (!member.isRequired) continue;
            throw Error(where, fmt::format("'{}{}' is missing", prefix, member.place));
        }
        const Json& value = object.at(place);
        if (isOfKind(value, member.kind)) continue;
        throw Error(where, fmt::format("'{}{}' is {}; expected {}", prefix, member.place,
                                       value.type_name(), nameOf(member.kind)));
    }
}

constexpr Member kManifest[] = {{"/commit", Kind::Text},
                                {"/profile", Kind::Text},
                                {"/device_class", Kind::Text},
                                {"/cpu", Kind::Text},
                                {"/cores", Kind::Whole},
                                {"/gl", Kind::Object},
                                {"/gl/vendor", Kind::Text},
                                {"/gl/renderer", Kind::Text},
                                {"/gl/version", Kind::Text},
                                {"/invocations", Kind::List},
                                {"/invocations", Kind::Objects},
                                {"/scenes", Kind::Objects},
                                {"/sha256", Kind::Texts, false},
                                {"/notes", Kind::List, false},
                                {"/notes", Kind::Texts, false},
                                {"/timing_machines", Kind::Object, false},
                                {"/timing_machines", Kind::Texts, false},
                                {"/rounds", Kind::Objects, false},
                                {"/merged", Kind::List, false},
                                {"/merged", Kind::Objects, false}};
constexpr Member kInvocation[] = {{"/command", Kind::Text}, {"/machine", Kind::Text, false}};
constexpr Member kScene[] = {
    {"/kind", Kind::Text}, {"/description", Kind::Text}, {"/sha256", Kind::Text}};
constexpr Member kMerged[] = {
    {"/machine", Kind::Text}, {"/invocations", Kind::List}, {"/invocations", Kind::Objects}};
constexpr Member kEvent[] = {{"/time", Kind::Text, false},     {"/event", Kind::Text, false},
                             {"/case", Kind::Text, false},     {"/table", Kind::Text, false},
                             {"/process", Kind::Whole, false}, {"/status", Kind::Text, false},
                             {"/as", Kind::Text, false},       {"/message", Kind::Text, false},
                             {"/output", Kind::Text, false},   {"/cost", Kind::Object, false}};
constexpr Member kCost[] = {{"/load_s", Kind::Number},
                            {"/setup_s", Kind::Number},
                            {"/render_s", Kind::Number},
                            {"/record_s", Kind::Number},
                            {"/peak_bytes", Kind::Number}};

/// Each of the list or object at `place`, where it is there.
void requireEach(const Json& object, const char* place, std::span<const Member> members,
                 const SourceLocation& where) {
    const auto found = object.find(place);
    if (found == object.end()) return;
    for (const auto& [name, value] : found->items()) {
        requireMembers(value, members, where, fmt::format("/{}/{}", place, name));
    }
}

}  // namespace

Json readManifest(const fs::path& file) {
    Json manifest = Json::parse(readFile(file), nullptr, false);
    const SourceLocation where{file.string(), 0, 0};
    if (!manifest.is_object()) throw Error(where, "is no JSON object");
    requireMembers(manifest, kManifest, where);
    requireEach(manifest, "invocations", kInvocation, where);
    requireEach(manifest, "scenes", kScene, where);
    requireEach(manifest, "merged", kMerged, where);
    if (manifest["invocations"].empty()) throw Error(where, "'/invocations' is empty");
    return manifest;
}

std::vector<Json> readLog(const fs::path& file) {
    std::vector<Json> events;
    if (!fs::exists(file)) return events;
    const std::string name = file.string();
    int line = 0;
    for (const std::string& text : split(readFile(file), '\n')) {
        ++line;
        Json event = Json::parse(text, nullptr, false);
        if (!event.is_object()) continue;
        requireMembers(event, kEvent, {name, line, 0});
        if (event.contains("cost")) requireMembers(event["cost"], kCost, {name, line, 0}, "/cost");
        events.push_back(std::move(event));
    }
    return events;
}

}  // namespace gfxrepro::batch
