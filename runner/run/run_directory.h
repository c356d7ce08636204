// A run directory: its files, and the lock that keeps a second run out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/core/descriptor.h"
#include "runner/run/protocol.h"

namespace gfxrepro::run {

inline constexpr std::uintmax_t kMostJournalBytes = std::uintmax_t{4} << 30;
/// A journal of this size takes no further unit; the end of those under way has its place.
inline constexpr std::uintmax_t kFullJournalBytes = kMostJournalBytes - (std::uintmax_t{64} << 20);

/// plan.json, manifest.json, records.csv, journal.jsonl, images/, tables/, … under one
/// folder, locked for writing as long as the object lives.
class RunDirectory {
  public:
    /// Makes the folder; of one whose run was killed before it had a plan, removes the temporary
    /// files. Throws Error when it holds a run already, when another run writes to it, and when it
    /// is no run's but has a file that a run writes.
    static RunDirectory create(const std::filesystem::path& path,
                               std::uintmax_t fullJournalBytes = kFullJournalBytes);
    /// A run that was begun; removes the temporary files of processes that were killed. Throws
    /// Error when there is none, when another run writes to it, and as requirePlainFiles().
    static RunDirectory open(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path planFile() const { return path_ / "plan.json"; }
    std::filesystem::path manifestFile() const { return path_ / "manifest.json"; }
    std::filesystem::path recordsFile() const { return path_ / "records.csv"; }
    /// Removes what cases keep for each other only while the run is under way.
    void removeScratch() const;

    /// Appends one line to journal.jsonl: "time" and the members of `event`; texts over 32 KiB are
    /// cut, and outputs left out once it has 64 MiB. Throws as requireOurs().
    void note(const nlohmann::ordered_json& event) const;
    /// … and waits until it is on the disk.
    void noteFlushed(const nlohmann::ordered_json& event) const;

    /// Throws FullError where the journal is so large that it takes no further unit.
    void requireRoom() const;

    /// Throws Error where the folder is no longer this run's: removed, moved, or without its lock,
    /// so that another one may write to it.
    void requireOurs() const;

  private:
    RunDirectory(const std::filesystem::path& path, std::uintmax_t fullJournalBytes);

    std::filesystem::path path_;
    std::uintmax_t fullJournalBytes_;
    Descriptor lock_, journal_;
};

/// Below a run folder, where programs of any kind work while it is under way; it goes at the end.
inline constexpr const char* kScratchFolder = "scratch";

/// Below a run folder there are files and folders alone: what is written to it goes nowhere else,
/// and nothing is waited for. The folder itself may be a link; what programs left in
/// kScratchFolder is not looked at, nor ever read. Throws Error naming what is neither.
void requirePlainFiles(const std::filesystem::path& runDir);

/// "2026-11-21T03:14:00Z", for manifests and logs.
std::string utcTime();
/// "runs/20261121-031400-zju2005": where a run goes when no folder is given.
std::filesystem::path defaultRunPath(const std::string& slug);

/// Throws Error for a file of a run that is larger than any that is written: plan and manifest of
/// more than 1 GiB, a journal of more than kMostJournalBytes, records, a list of images.
void requireModestFiles(const std::filesystem::path& runDir);

/// manifest.json: what is there that others read (machine, invocations, scenes, notes, …) is of its
/// kind, and all of it is there that a run has from its beginning. Throws Error with the file and
/// the member.
Json readManifest(const std::filesystem::path& file);

/// Gives `take` the events of journal.jsonl, one after another; none where there is no such file.
/// Lines that are no JSON object are passed over: a killed runner has torn them. Throws Error with
/// file and line for a member of another kind than the runner writes.
void forEachEvent(const std::filesystem::path& file, const std::function<void(Json&&)>& take);
/// All of them, those of units without their texts and costs.
std::vector<Json> readJournal(const std::filesystem::path& file);

}  // namespace gfxrepro::run
