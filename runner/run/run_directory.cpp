#include "runner/run/run_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "engine/core/near_file.h"
#include "engine/core/output_files.h"
#include "runner/records/images.h"
#include "runner/records/records.h"
#include "runner/run/plan.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

constexpr JsonMember kManifest[] = {{"/commit", JsonKind::Line},
                                    {"/plan", JsonKind::Line, false},
                                    {"/shard", JsonKind::Line, false},
                                    {"/profile", JsonKind::Line},
                                    {"/started", JsonKind::Line, false},
                                    {"/device_class", JsonKind::Line},
                                    {"/cpu", JsonKind::Line},
                                    {"/cores", JsonKind::Int},
                                    {"/gl", JsonKind::Object},
                                    {"/gl/vendor", JsonKind::Line},
                                    {"/gl/renderer", JsonKind::Line},
                                    {"/gl/version", JsonKind::Line},
                                    {"/invocations", JsonKind::List},
                                    {"/invocations", JsonKind::Objects},
                                    {"/scenes", JsonKind::Objects},
                                    {"/programs", JsonKind::List, false},
                                    {"/programs", JsonKind::Objects, false},
                                    {"/sha256", JsonKind::Texts, false},
                                    {"/units", JsonKind::Object, false},
                                    {"/notes", JsonKind::List, false},
                                    {"/notes", JsonKind::Lines, false},
                                    {"/warnings", JsonKind::List, false},
                                    {"/warnings", JsonKind::Lines, false},
                                    {"/timing_machines", JsonKind::Object, false},
                                    {"/timing_machines", JsonKind::Lines, false},
                                    {"/rounds", JsonKind::Objects, false},
                                    {"/machine_states", JsonKind::Objects, false},
                                    {"/imported", JsonKind::Object, false},
                                    {"/imported/file", JsonKind::Line, false},
                                    {"/imported/machine", JsonKind::Line, false},
                                    {"/merged", JsonKind::List, false},
                                    {"/merged", JsonKind::Objects, false}};
constexpr JsonMember kUnits[] = {
    {"/planned", JsonKind::Int}, {"/missing", JsonKind::Int}, {"/failed", JsonKind::Int}};
constexpr JsonMember kRounds[] = {{"/times_of", JsonKind::Line, false},
                                  {"/taken", JsonKind::Int, false},
                                  {"/cases", JsonKind::Int, false}};
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
    {"/time", JsonKind::Text, false},     {"/event", JsonKind::Text, false},
    {"/unit", JsonKind::Text, false},     {"/case", JsonKind::Text, false},
    {"/table", JsonKind::Text, false},    {"/process", JsonKind::Int, false},
    {"/status", JsonKind::Text, false},   {"/as", JsonKind::Text, false},
    {"/times_of", JsonKind::Text, false}, {"/message", JsonKind::Text, false},
    {"/output", JsonKind::Text, false},   {"/cost", JsonKind::Object, false}};
constexpr JsonMember kCost[] = {{"/load_s", JsonKind::Number},
                                {"/setup_s", JsonKind::Number},
                                {"/render_s", JsonKind::Number},
                                {"/record_s", JsonKind::Number},
                                {"/peak_bytes", JsonKind::Whole}};

void requirePlain(const fs::directory_entry& entry) {
    std::error_code isGone;  // meanwhile
    const bool isLink = entry.is_symlink(isGone);
    if (!isLink && (entry.is_regular_file(isGone) || entry.is_directory(isGone))) return;
    if (!isLink && !fs::exists(entry.symlink_status(isGone))) return;
    throw Error(entry.path().string() +
                ": a link, a pipe or a device, which a run folder does not hold");
}

}  // namespace

void requireModestFiles(const fs::path& runDir) {
    constexpr std::pair<const char*, std::uintmax_t> kMostBytes[] = {
        {"plan.json", kMostPlanBytes},
        {"manifest.json", kMostPlanBytes},
        {"records.csv", records::kMostRecordBytes},
        {"journal.jsonl", kMostJournalBytes},
        {"images/index.csv", records::kMostIndexBytes}};
    for (const auto& [name, most] : kMostBytes) {
        const fs::path file = runDir / name;
        std::error_code isAbsent;
        const std::uintmax_t size = fs::file_size(file, isAbsent);
        if (isAbsent || size <= most) continue;
        throw Error({file.string(), 0, 0},
                    fmt::format("{} bytes; at most {} are read", size, most));
    }
}

Json readManifest(const fs::path& file) {
    requirePlain(fs::directory_entry(file));
    const SourceLocation where{file.string(), 0, 0};
    Json manifest = parseJsonObject(MappedFile(file).text(), where);
    requireMembers(manifest, kManifest, where);
    if (manifest.contains("units")) requireMembers(manifest["units"], kUnits, where, "/units");
    requireEach(manifest, "/invocations", kInvocation, where);
    requireEach(manifest, "/rounds", kRounds, where);
    requireEach(manifest, "/scenes", kSceneMembers, where);
    requireEach(manifest, "/programs", kProgramMembers, where);
    requireEach(manifest, "/merged", kMerged, where);
    if (manifest["invocations"].empty()) throw Error(where, "'/invocations' is empty");
    return manifest;
}

void forEachEvent(const fs::path& file, const std::function<void(Json&&)>& take) {
    if (!fs::exists(file)) return;
    const std::string name = file.string();
    const MappedFile mapped(file);
    std::string_view rest = mapped.text();
    for (int line = 1; !rest.empty(); ++line) {
        const std::string_view text = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(text.size() + 1, rest.size()));
        if (text.empty()) continue;
        const SourceLocation where{name, line, 0};
        std::optional<Json> event = jsonObjectIn(text, where);
        if (!event) continue;
        requireMembers(*event, kEvent, where);
        if (event->contains("cost")) requireMembers((*event)["cost"], kCost, where, "/cost");
        take(std::move(*event));
    }
}

std::vector<Json> readJournal(const fs::path& file) {
    std::vector<Json> events;
    forEachEvent(file, [&](Json&& event) {
        if (event.contains("case")) {
            for (const char* text : {"time", "title", "as", "message", "output", "cost"}) {
                event.erase(text);
            }
        }
        events.push_back(std::move(event));
    });
    return events;
}

namespace {

constexpr std::size_t kMostTextBytes = std::size_t{32} << 10;
// In a journal of this size what drivers print is left out.
constexpr off_t kMostBytesWithOutput = off_t{64} << 20;

/// A worker that its runner began when it was killed has the lock until it is its own program.
constexpr std::chrono::seconds kLockPatience{2};

off_t sizeOf(int fd) {
    struct stat now = {};
    ::fstat(fd, &now);
    return now.st_size;
}

/// The beginning of a long text, or its end.
std::string shortened(const std::string& text, bool isEndKept) {
    if (text.size() <= kMostTextBytes) return text;
    const std::string mark = fmt::format("[{} bytes left out]", text.size() - kMostTextBytes);
    return isEndKept ? mark + text.substr(text.size() - kMostTextBytes)
                     : text.substr(0, kMostTextBytes) + mark;
}

/// The event as a journal that has `journalBytes` takes it.
nlohmann::ordered_json shortened(nlohmann::ordered_json event, off_t journalBytes) {
    for (const auto& [name, value] : event.items()) {
        if (!value.is_string()) continue;
        const std::string& text = value.get_ref<const std::string&>();
        const bool isOutput = name == "output";
        value = isOutput && journalBytes > kMostBytesWithOutput
                    ? fmt::format("[{} bytes left out: the journal has {} MiB]", text.size(),
                                  journalBytes >> 20)
                    : shortened(text, isOutput);
    }
    return event;
}

std::string utcTime(const char* format) {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof(text), format, &parts);
    return text;
}

void removeScratchOf(const fs::path& folder) {
    std::error_code isAbsent;
    fs::remove_all(folder / kScratchFolder, isAbsent);  // of a link the link
}

/// What killed processes left of files that they were writing; the folder is locked.
void removeTemporaryFiles(const fs::path& folder) {
    removeScratchOf(folder);
    std::vector<fs::path> files;
    for (const auto& entry : entriesBelow(folder)) {
        if (entry.is_regular_file() && isTemporary(entry.path())) files.push_back(entry.path());
    }
    for (const fs::path& file : files) fs::remove(file);
}

bool isBegun(const fs::path& folder) {
    return fs::exists(folder / "lock") || fs::exists(folder / "plan.json");
}

/// A folder in which no run ever began keeps what it has: the name of the first file that a run
/// write over; empty when there is none.
std::string foreignFile(const fs::path& folder) {
    if (isBegun(folder)) return "";
    for (const char* name : {"manifest.json", "records.csv", "cases.csv", "claims.csv",
                             "nearness.csv", "junit.xml", "report.html", "journal.jsonl", "images",
                             "tables", "plots", "thumbnails", kScratchFolder}) {
        if (fs::exists(fs::symlink_status(folder / name))) return name;
    }
    return "";
}

Descriptor openFile(const fs::path& path, int flags) {
    const int safe = O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;  // no link, no pipe's reader
    Descriptor file(::open(path.c_str(), flags | safe, 0644));
    if (file.get() < 0) throw Error("cannot write " + path.string() + ": " + std::strerror(errno));
    return file;
}

}  // namespace

std::string utcTime() {
    return utcTime("%Y-%m-%dT%H:%M:%SZ");
}

fs::path defaultRunPath(const std::string& slug) {
    const fs::path base = "runs/" + utcTime("%Y%m%d-%H%M%S") + "-" + slug;
    fs::path path = base;
    for (int i = 2; fs::exists(path); ++i) path = base.string() + "-" + std::to_string(i);
    return path;
}

void requirePlainFiles(const fs::path& runDir) {
    std::error_code problem;
    fs::recursive_directory_iterator entry(runDir, problem);
    for (; !problem && entry != fs::recursive_directory_iterator(); entry.increment(problem)) {
        if (entry.depth() == 0 && entry->path().filename() == kScratchFolder) {
            entry.disable_recursion_pending();
            if (!entry->is_symlink()) continue;
        }
        requirePlain(*entry);
    }
    if (problem) throw Error("cannot read " + runDir.string() + ": " + problem.message());
}

RunDirectory::RunDirectory(const fs::path& path, std::uintmax_t fullJournalBytes)
    : path_(path), fullJournalBytes_(fullJournalBytes), lock_(openFile(path / "lock", O_RDWR)) {
    const auto until = std::chrono::steady_clock::now() + kLockPatience;
    while (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) {
        if (std::chrono::steady_clock::now() >= until) {
            throw Error(path.string() + ": another run is writing to this folder");
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    journal_ = openFile(path_ / "journal.jsonl", O_RDWR | O_APPEND);
}

RunDirectory RunDirectory::create(const fs::path& path, std::uintmax_t fullJournalBytes) {
    std::error_code problem;
    fs::create_directories(path, problem);
    if (problem) throw Error("cannot make the folder " + path.string() + ": " + problem.message());
    if (const std::string file = foreignFile(path); !file.empty()) {
        throw Error(path.string() + ": has a " + file +
                    " that is of no run and would be written over; give another folder");
    }
    const bool wasBegun = isBegun(path);
    if (wasBegun) requirePlainFiles(path);
    RunDirectory directory(path, fullJournalBytes);
    if (fs::exists(directory.planFile())) {
        throw Error(path.string() + ": holds a run already; continue it with --resume " +
                    path.string() + ", or give another folder");
    }
    if (wasBegun) removeTemporaryFiles(path);
    return directory;
}

RunDirectory RunDirectory::open(const fs::path& path) {
    if (!fs::exists(path / "plan.json")) {
        throw Error(path.string() + ": is not a run directory (it has no plan.json)" +
                    suggestedFile(path));
    }
    requirePlainFiles(path);
    RunDirectory directory(path, kFullJournalBytes);
    removeTemporaryFiles(path);
    return directory;
}

void RunDirectory::removeScratch() const {
    removeScratchOf(path_);
}

void RunDirectory::requireOurs() const {
    if (isStillAt(path_ / "lock", lock_.get())) return;
    throw Error(path_.string() +
                ": was removed or moved, or its lock was, while a run wrote to it; nothing is "
                "measured into it any more");
}

void RunDirectory::requireRoom() const {
    const auto bytes = static_cast<std::uintmax_t>(sizeOf(journal_.get()));
    if (bytes < fullJournalBytes_) return;
    throw records::FullError(
        fmt::format("{}: has {} bytes; with {} or more it takes no further case. Measure the rest "
                    "in a run of its own (--only, --shard)",
                    (path_ / "journal.jsonl").string(), bytes, fullJournalBytes_));
}

void RunDirectory::note(const nlohmann::ordered_json& event) const {
    requireOurs();
    const off_t end = sizeOf(journal_.get());
    nlohmann::ordered_json line = {{"time", utcTime()}};
    line.update(shortened(event, end));
    char last = '\n';
    const bool isTorn = end > 0 && ::pread(journal_.get(), &last, 1, end - 1) == 1 && last != '\n';
    std::string text = isTorn ? "\n" : "";  // it is a line of its own, wherever the last was torn
    text += line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
    // One write a line; a journal that cannot be written (disk full) does not stop the measurement.
    // Of a line that is cut nothing stays: the next one would be part of it.
    const ssize_t written = ::write(journal_.get(), text.data(), text.size());
    if (written > 0 && static_cast<std::size_t>(written) < text.size()) {
        [[maybe_unused]] const int isCut = ::ftruncate(journal_.get(), end);
    }
}

void RunDirectory::noteFlushed(const nlohmann::ordered_json& event) const {
    note(event);
    ::fdatasync(journal_.get());
}

}  // namespace gfxrepro::run
