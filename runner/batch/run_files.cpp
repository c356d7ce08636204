#include "runner/batch/run_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/core/json_depth.h"

namespace gfxrepro::batch {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMiB = std::uintmax_t{1} << 20;
constexpr std::pair<const char*, std::uintmax_t> kMostBytes[] = {{"plan.json", 512 * kMiB},
                                                                 {"manifest.json", 64 * kMiB},
                                                                 {"records.csv", 1024 * kMiB},
                                                                 {"images/index.csv", 256 * kMiB}};
constexpr std::size_t kMostLogBytes = 512 * kMiB;
constexpr std::size_t kMostLineBytes = kMiB;  // RunDirectory::log writes no longer ones
constexpr std::size_t kMostEvents = 4'000'000;

enum class Kind { Text, Line, Whole, Number, Object, List, Texts, Lines, Objects };

bool isOfKind(const Json& value, Kind kind) {
    const auto are = [&](Kind item) {
        return std::ranges::all_of(value, [&](const Json& one) { return isOfKind(one, item); });
    };
    switch (kind) {
        case Kind::Text:
            return value.is_string();
        case Kind::Line:  // which people are shown as such
            return value.is_string() &&
                   std::ranges::none_of(value.get_ref<const std::string&>(),
                                        [](unsigned char c) { return c < 0x20 || c == 0x7F; });
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
        case Kind::Lines:
            return (value.is_array() || value.is_object()) && are(Kind::Line);
        case Kind::Objects:
            return (value.is_array() || value.is_object()) && are(Kind::Object);
    }
    return false;
}

std::string_view nameOf(Kind kind) {
    static constexpr std::array<std::string_view, 9> kNames = {
        "text",   "a line of text", "a whole number", "a number", "an object",
        "a list", "texts",          "lines of text",  "objects"};
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

constexpr Member kManifest[] = {{"/commit", Kind::Line},
                                {"/profile", Kind::Line},
                                {"/device_class", Kind::Line},
                                {"/cpu", Kind::Line},
                                {"/cores", Kind::Whole},
                                {"/gl", Kind::Object},
                                {"/gl/vendor", Kind::Line},
                                {"/gl/renderer", Kind::Line},
                                {"/gl/version", Kind::Line},
                                {"/invocations", Kind::List},
                                {"/invocations", Kind::Objects},
                                {"/scenes", Kind::Objects},
                                {"/sha256", Kind::Texts, false},
                                {"/notes", Kind::List, false},
                                {"/notes", Kind::Lines, false},
                                {"/timing_machines", Kind::Object, false},
                                {"/timing_machines", Kind::Lines, false},
                                {"/rounds", Kind::Objects, false},
                                {"/merged", Kind::List, false},
                                {"/merged", Kind::Objects, false}};
constexpr Member kInvocation[] = {{"/command", Kind::Text}, {"/machine", Kind::Line, false}};
constexpr Member kScene[] = {
    {"/kind", Kind::Text}, {"/description", Kind::Text}, {"/sha256", Kind::Text}};
constexpr Member kMerged[] = {
    {"/machine", Kind::Line}, {"/invocations", Kind::List}, {"/invocations", Kind::Objects}};
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

void requireShallow(std::string_view json, const SourceLocation& where) {
    if (!isTooDeepJson(json)) return;
    throw Error(where, fmt::format("nested deeper than {} levels", kMostJsonLevels));
}

void requireModest(const fs::path& file, std::uintmax_t size, std::uintmax_t mostBytes) {
    if (size <= mostBytes) return;
    throw Error({file.string(), 0, 0},
                fmt::format("{} bytes; at most {} are read", size, mostBytes));
}

}  // namespace

void requireModestFiles(const fs::path& runDir) {
    for (const auto& [name, mostBytes] : kMostBytes) {
        std::error_code isAbsent;
        const std::uintmax_t size = fs::file_size(runDir / name, isAbsent);
        if (!isAbsent) requireModest(runDir / name, size, mostBytes);
    }
}

Json readManifest(const fs::path& file) {
    const SourceLocation where{file.string(), 0, 0};
    const std::string text = readFile(file);
    requireShallow(text, where);
    Json manifest = Json::parse(text, nullptr, false);
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
    const MappedFile mapped(file);
    std::string_view rest = mapped.text();
    requireModest(file, rest.size(), kMostLogBytes);
    for (int line = 1; !rest.empty(); ++line) {
        const std::string_view text = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(text.size() + 1, rest.size()));
        if (text.empty()) continue;
        if (text.size() > kMostLineBytes) {
            throw Error({name, line, 0}, fmt::format("a line of {} bytes; at most {} are read",
                                                     text.size(), kMostLineBytes));
        }
        if (events.size() == kMostEvents) {
            throw Error({name, line, 0},
                        fmt::format("more than {} events, which are not read", kMostEvents));
        }
        requireShallow(text, {name, line, 0});
        Json event = Json::parse(text, nullptr, false);
        if (!event.is_object()) continue;
        requireMembers(event, kEvent, {name, line, 0});
        if (event.contains("cost")) requireMembers(event["cost"], kCost, {name, line, 0}, "/cost");
        events.push_back(std::move(event));
    }
    return events;
}

}  // namespace gfxrepro::batch
