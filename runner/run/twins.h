// Twins: cases that would be measured in the same way and give the same, in one table or in
// several. A run measures the first of them and records what it gave for each.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "runner/records/images.h"
#include "runner/run/plan.h"

namespace gfxrepro::run {

/// The SHA-256 of all that a measurement of the case depends on beside device and build, which are
/// the plan's: technique, scene as it is loaded, every parameter with the value in force, size of
/// the output, seed, frames, and how often and within which limits it is measured. Cases with one
/// key are twins. What names a case only is left out: its table, its axes, which scene of the
/// config it stands for, which values were given and which are defaults; numbers are equal however
/// they are spelt. So is the parameter `pictures`, which changes no number. Empty in the timing
/// lane: there the rounds of a table belong together, and its times to the machine as it was then,
/// so nothing is shared.
std::string workKey(const Case& item);

/// Of those of the cases that have a twin among them, the workKey().
std::map<const Case*, std::string> keysOfTwins(const std::set<const Case*>& cases);

/// Whether the case's parameter `pictures` asks for them. Of twins one that has it so is measured.
bool savesPictures(const Case& item);

/// For each of `cases` the place of its first twin: its own where it is the first, or has none.
std::vector<std::size_t> firstTwins(std::span<const Case> cases);

/// Times of the cases when twins are measured once: 0 for all but the first.
std::vector<double> withoutTwins(std::span<const Case> cases, std::vector<double> timesS);

/// Gives `twin` what `measured` left in a run's images/ and artifacts/, under the names that it
/// would have had: hard links, or copies where the file system has none. The attributes of an EXR
/// file stay those of the measured case. `images` are the measured case's; the twin's are returned,
/// none where only the measured case was asked for pictures. Throws Error.
std::vector<records::ImageEntry> shareFiles(const std::filesystem::path& runDir,
                                            const Case& measured, const Case& twin,
                                            const std::vector<records::ImageEntry>& images);

}  // namespace gfxrepro::run
