// The JSON files of a run folder, which may be anybody's: read with their shape checked, so that
// what is wrong in one is said with its place, and nobody below has to ask.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "runner/run/protocol.h"

namespace gfxrepro::run {

/// Throws Error, with the limit, where a file of a run's folder that is read at once is larger than
/// it gets in any run (but for the journal): the largest had records of 75 MB, a plan of 15 MB.
void requireModestFiles(const std::filesystem::path& runDir);

/// Beyond the first a journal gets events in short alone, after one line that says so; beyond the
/// second it gets none, as it would not be read again.
inline constexpr std::size_t kMostWholeJournalBytes = std::size_t{384} << 20;
inline constexpr std::size_t kMostJournalBytes = std::size_t{512} << 20;
/// Throws Error, with the limit, for a journal over the second, which is neither read nor copied.
void requireModestJournal(const std::filesystem::path& file);
Json inShortFromHere();
/// What a run that goes on needs to know of an event: not its texts, nor what a case cost.
Json inShort(const Json& event);

/// manifest.json: what is there that others read (machine, invocations, scenes, notes, …) is of its
/// kind, and all of it is there that a run has from its beginning. Throws Error with the file and
/// the member.
Json readManifest(const std::filesystem::path& file);

/// The events of journal.jsonl; none where there is no such file. Lines that are no JSON object are
/// passed over: a killed runner has torn them. Throws Error with file and line for a member of
/// another kind than the runner writes, for a line over 1 MiB, a file over kMostJournalBytes, and
/// beyond 4,000,000 events.
std::vector<Json> readJournal(const std::filesystem::path& file);

}  // namespace gfxrepro::run
