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

}  // namespace

void requireModestFiles(const fs::path& runDir) {
    for (const char* name :
         {"plan.json", "manifest.json", "records.csv", "journal.jsonl", "images/index.csv"}) {
        const fs::path file = runDir / name;
        std::error_code isAbsent;
        const std::uintmax_t size = fs::file_size(file, isAbsent);
        if (isAbsent || size <= kMostFileBytes) continue;
        throw Error({file.string(), 0, 0},
                    fmt::format("{} bytes; at most {} are read", size, kMostFileBytes));
    }
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

std::vector<Json> readJournal(const fs::path& file) {
    std::vector<Json> events;
    if (!fs::exists(file)) return events;
    const std::string name = file.string();
    const MappedFile mapped(file);
    std::string_view rest = mapped.text();
    for (int line = 1; !rest.empty(); ++line) {
        const std::string_view text = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(text.size() + 1, rest.size()));
        if (text.empty()) continue;
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
