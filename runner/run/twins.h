// Twins: cases that would be measured in the same way and give the same, in one table or in
// several. A run measures the first of them and records what it gave for each. Times are shared by
// whole tables alone, whose cases are measured in one process each.
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
/// they are spelt. So is, but for times, the parameter `pictures`, which changes no number.
std::string workKey(const Case& item);

/// Cases of one plan.
using Cases = std::set<const Case*>;
Cases pointersTo(std::span<const Case> cases);

/// Tables of times of one process a case, all of whose cases another such table has, too: to each
/// that other, from which it takes its times. It takes all or none, so that what a table compares
/// was measured with one table. Several rounds are of their table, and to the machine as it was
/// then: they are not shared.
std::map<std::string, std::string> lendersOfTimes(const Cases& cases);

/// Of those of the cases that have a twin among them a text that only twins have in common.
std::map<const Case*, std::string> keysOfTwins(const Cases& cases);

/// Whether the case's parameter `pictures` asks for them. Of twins one that has it so is measured.
bool savesPictures(const Case& item);

/// For each of `cases` the place of the twin that is measured: the first, of times the one of the
/// table that lends them; its own where it is that, or has none.
std::vector<std::size_t> firstTwins(std::span<const Case> cases);

/// Times of the cases when twins are measured once: 0 for all but the first.
std::vector<double> withoutTwins(std::span<const Case> cases, std::vector<double> timesS);

/// Gives `twin` what `measured` left in a run's images/, under the names that it would have had:
/// hard links, or copies where the file system has none. The attributes of an EXR file stay those
/// of the measured case. `images` are the measured case's; the twin's are returned, none where only
/// the measured case was asked for pictures. Throws Error.
std::vector<records::ImageEntry> shareFiles(const std::filesystem::path& runDir,
                                            const Case& measured, const Case& twin,
                                            const std::vector<records::ImageEntry>& images);

}  // namespace gfxrepro::run
