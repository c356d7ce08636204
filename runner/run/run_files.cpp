#include "runner/run/run_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/json_shape.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMiB = std::uintmax_t{1} << 20;
constexpr std::pair<const char*, std::uintmax_t> kMostFileBytes[] = {
    {"plan.json", 512 * kMiB},
    {"manifest.json", 64 * kMiB},
    {"records.csv", 1024 * kMiB},
    {"images/index.csv", 256 * kMiB}};
constexpr std::string_view kLeftOutInShort[] = {"as", "command", "message", "output", "title"};
constexpr std::size_t kMostLineBytes = kMiB;  // RunDirectory::log writes no longer ones
constexpr std::size_t kMostEvents = 4'000'000;

constexpr JsonMember kManifest[] = {{"/commit", JsonKind::Line},
                                    {"/plan", JsonKind::Line, false},
                                    {"/profile", JsonKind::Line},
                                    {"/started", JsonKind::Line, false},
                                    {"/device_class", JsonKind::Line},
                                    {"/cpu", JsonKind::Line},
                                    {"/cores", JsonKind::Int},
                                    {"/gl", JsonKind::Object},
                                    {"/gl/vendor", JsonKind::Line},
                                    {"/gl/renderer", JsonKind::Line},
                                    {"/gl/version", JsonKind::Line},
                                    {"/gl/balance", JsonKind::Object, false},
                                    {"/invocations", JsonKind::List},
                                    {"/invocations", JsonKind::Objects},
                                    {"/scenes", JsonKind::Objects},
                                    {"/programs", JsonKind::List, false},
                                    {"/programs", JsonKind::Objects, false},
                                    {"/sha256", JsonKind::Texts, false},
                                    {"/notes", JsonKind::List, false},
                                    {"/notes", JsonKind::Lines, false},
                                    {"/timing_machines", JsonKind::Object, false},
                                    {"/timing_machines", JsonKind::Lines, false},
                                    {"/rounds", JsonKind::Objects, false},
                                    {"/machine_states", JsonKind::Objects, false},
                                    {"/imported", JsonKind::Object, false},
                                    {"/imported/file", JsonKind::Line, false},
                                    {"/imported/machine", JsonKind::Line, false},
                                    {"/merged", JsonKind::List, false},
                                    {"/merged", JsonKind::Objects, false}};
constexpr JsonMember kInvocation[] = {{"/command", JsonKind::Text},
                                      {"/started", JsonKind::Line, false},
                                      {"/machine", JsonKind::Line, false}};
constexpr JsonMember kSceneMembers[] = {
    {"/kind", JsonKind::Text}, {"/description", JsonKind::Text}, {"/sha256", JsonKind::Text}};
constexpr JsonMember kProgramMembers[] = {
    {"/file", JsonKind::Text}, {"/sha256", JsonKind::Text}, {"/version", JsonKind::Text}};
constexpr JsonMember kMerged[] = {{"/machine", JsonKind::Line},
                                  {"/invocations", JsonKind::List},
                                  {"/invocations", JsonKind::Objects}};
constexpr JsonMember kEvent[] = {
    {"/time", JsonKind::Text, false},   {"/event", JsonKind::Text, false},
    {"/case", JsonKind::Text, false},   {"/table", JsonKind::Text, false},
    {"/process", JsonKind::Int, false}, {"/status", JsonKind::Text, false},
    {"/as", JsonKind::Text, false},     {"/message", JsonKind::Text, false},
    {"/output", JsonKind::Text, false}, {"/cost", JsonKind::Object, false}};
constexpr JsonMember kCost[] = {{"/load_s", JsonKind::Number},
                                {"/setup_s", JsonKind::Number},
                                {"/render_s", JsonKind::Number},
                                {"/record_s", JsonKind::Number},
                                {"/peak_bytes", JsonKind::Whole}};

void requireModest(const fs::path& file, std::uintmax_t mostBytes) {
    std::error_code isAbsent;
    const std::uintmax_t size = fs::file_size(file, isAbsent);
    if (isAbsent || size <= mostBytes) return;
    throw Error({file.string(), 0, 0},
                fmt::format("{} bytes; at most {} are read", size, mostBytes));
}

}  // namespace

void requireModestFiles(const fs::path& runDir) {
    for (const auto& [name, mostBytes] : kMostFileBytes) requireModest(runDir / name, mostBytes);
}

void requireModestJournal(const fs::path& file) {
    requireModest(file, kMostJournalBytes);
}

Json readManifest(const fs::path& file) {
    const SourceLocation where{file.string(), 0, 0};
    Json manifest = parseJsonObject(MappedFile(file).text(), where);
    requireMembers(manifest, kManifest, where);
    if (const auto& gl = manifest["gl"]; gl.contains("balance")) {
        balanceFromJson(gl["balance"], where, "/gl/balance");
    }
    requireEach(manifest, "/invocations", kInvocation, where);
    requireEach(manifest, "/scenes", kSceneMembers, where);
    requireEach(manifest, "/programs", kProgramMembers, where);
    requireEach(manifest, "/merged", kMerged, where);
    if (manifest["invocations"].empty()) throw Error(where, "'/invocations' is empty");
    return manifest;
}

Json inShortFromHere() {
    return {{"event", "in_short"},
            {"message", fmt::format("the journal has {} MiB: what follows is without its texts",
                                    kMostWholeJournalBytes >> 20)}};
}

Json inShort(const Json& event) {
    Json kept = Json::object();
    for (const auto& [name, value] : event.items()) {
        const bool isText = std::ranges::find(kLeftOutInShort, name) != std::end(kLeftOutInShort);
        if (value.is_primitive() && !isText) kept[name] = value;
    }
    return kept;
}

std::vector<Json> readJournal(const fs::path& file) {
    std::vector<Json> events;
    if (!fs::exists(file)) return events;
    requireModestJournal(file);
    const std::string name = file.string();
    const MappedFile mapped(file);
    std::string_view rest = mapped.text();
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
        requireShallowJson(text, {name, line, 0});
        Json event = Json::parse(text, nullptr, false);
        if (!event.is_object()) continue;
        requireMembers(event, kEvent, {name, line, 0});
        if (event.contains("cost")) requireMembers(event["cost"], kCost, {name, line, 0}, "/cost");
        events.push_back(std::move(event));
    }
    return events;
}

}  // namespace gfxrepro::run
