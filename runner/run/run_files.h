// The JSON files of a run folder, which may be anybody's: read with their shape checked, so that
// what is wrong in one is said with its place, and nobody below has to ask.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "runner/run/protocol.h"

namespace gfxrepro::run {

/// Of a file of a run's folder: the largest so far had records of 75 MB, a plan of 15 MB.
inline constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{1} << 30;
/// Throws Error for a larger one.
void requireModestFiles(const std::filesystem::path& runDir);

/// manifest.json: what is there that others read (machine, invocations, scenes, notes, …) is of its
/// kind, and all of it is there that a run has from its beginning. Throws Error with the file and
/// the member.
Json readManifest(const std::filesystem::path& file);

/// The events of journal.jsonl; none where there is no such file. Lines that are no JSON object are
/// passed over: a killed runner has torn them. Throws Error with file and line for a member of
/// another kind than the runner writes.
std::vector<Json> readJournal(const std::filesystem::path& file);

}  // namespace gfxrepro::run
