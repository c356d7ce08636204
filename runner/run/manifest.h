// manifest.json: with what, on what and when a run was made.
#pragma once

#include <filesystem>
#include <istream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runner/run/phase_clock.h"
#include "runner/run/plan.h"
#include "runner/run/protocol.h"

namespace gfxrepro::run {

/// Commit, build, machine, device and profile; no invocation and no scene yet.
Json newManifest(const Plan& plan, const gl::DeviceInfo& device);

/// Throws Error for the manifest of another plan, or of another shard of it: `file`.
void requireOfPlan(const Json& manifest, const Plan& plan, const std::filesystem::path& file);

/// An invocation is one start of the program on the run; a resumed run has several.
void beginInvocation(Json& manifest, const std::string& commandLine);
/// Adds end, wall time, phase totals and the runner's own share to the last invocation: the wall
/// time in which no worker was inside of a phase.
void endInvocation(Json& manifest, const PhaseClock& phases, double wallS);

/// Notes at the end of a run what records.csv and images/index.csv are (`sha256`), so that a later
/// change of them is seen.
void sealRecords(Json& manifest, const std::filesystem::path& runDir);
/// Before a run goes on, which changes them: the seal goes, with what the records came to. What was
/// noted of them stays.
void breakSeal(Json& manifest);
/// Whether records.csv is still what the seal is of.
bool areRecordsSealed(const Json& manifest, const std::filesystem::path& runDir);
/// Adds a note that every reader of the run's results is told; once.
void addNote(Json& manifest, const std::string& note);
/// Adds to the manifest's `notes` which of the sealed files are others than at the end of the run.
/// Nothing for a run that is under way or was killed.
void noteChanges(Json& manifest, const std::filesystem::path& runDir);
/// Every machine that measured something of the run, or of the runs that were merged into it, the
/// first first.
std::vector<std::string> machinesOf(const Json& manifest);
/// Adds to the manifest's `notes` that there are several. Values of other metrics than times may be
/// of any of them; the times of a table are of one.
void noteMachines(Json& manifest);
/// The manifest's notes, for people.
std::vector<std::string> notesOf(const Json& manifest);

/// Adds what workers loaded, by reference, and what its loaders warned of.
void addScenes(Json& manifest, const std::map<std::string, SceneUse>& scenes);
/// Adds the programs that workers ran and the files that these read, each of its versions once.
void addPrograms(Json& manifest, const std::set<ProgramUse>& programs);
std::set<ProgramUse> programsOf(const Json& manifest);
/// Adds what techniques, programs and drivers warned of, each once, for the report.
void addWarnings(Json& manifest, const std::set<std::string>& warnings);

/// "Xeon, 2 cores, llvmpipe (LLVM 15), 4.5 Mesa 22.3.6", or "imported: " and what the importing
/// person calls it: times of two names are not compared.
std::string machineName(const Json& manifest);
/// The machine that the times of an experiment come from: all of them from one.
std::string timingMachine(const Json& manifest, const std::string& experiment);

/// Of the program: commit, the day of it ("2026-11-28", empty where none is known), "Release,
/// GCC 12.2.0".
std::string programCommit();
std::string programCommitDay();
std::string programBuild();

/// Whether a manifest is of a merge that nothing was measured into since.
bool isOnlyMerged(const Json& manifest);

/// From /proc/cpuinfo: the model's name or, on ARM, which has none there, the numbers of its
/// designer and of the part ("ARM 0x41 0xd0c"). "unknown" where neither is there.
std::string cpuName(std::istream& cpuinfo);

}  // namespace gfxrepro::run
