#include "runner/run/manifest.h"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/core/foreign_text.h"
#include "engine/core/hash.h"
#include "runner/run/commit.h"  // made by the build
#include "runner/run/run_directory.h"

namespace gfxrepro::run {

std::string cpuName(std::istream& cpuinfo) {
    std::string designer, part;
    for (std::string line; std::getline(cpuinfo, line);) {
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos) continue;
        const std::string_view key = trimmed(std::string_view(line).substr(0, colon));
        const std::string value(trimmed(std::string_view(line).substr(colon + 1)));
        if (key == "model name") return value;
        if (key == "CPU implementer") designer = value;
        if (key == "CPU part") part = value;
    }
    return designer.empty() ? "unknown" : "ARM " + designer + ' ' + part;
}

namespace {

constexpr int kManifestSchema = 1;
// What a run's end fixes the sums of.
constexpr const char* kSealedFiles[] = {"records.csv", "images/index.csv"};

long long memoryBytes() {
    return static_cast<long long>(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGESIZE);
}

}  // namespace

std::string programCommit() {
    return GFXREPRO_COMMIT;
}

std::string programCommitDay() {
    return GFXREPRO_COMMIT_DAY;
}

std::string programBuild() {
#if defined(__clang__)
    const std::string compiler = "Clang " + std::string(__clang_version__);
#else
    const std::string compiler = "GCC " + std::string(__VERSION__);
#endif
    return std::string(GFXREPRO_BUILD_TYPE) + ", " + compiler;
}

Json newManifest(const Plan& plan, const gl::DeviceInfo& device) {
    std::ifstream cpuinfo("/proc/cpuinfo");
    Json manifest = {{"schema", kManifestSchema},
                     {"commit", programCommit()},
                     {"build", programBuild()},
                     {"build_id", plan.buildId},
                     {"plan", plan.hash},
                     {"profile", plan.profile},
                     {"started", utcTime()},
                     {"cpu", cpuName(cpuinfo)},
                     {"cores", ::sysconf(_SC_NPROCESSORS_ONLN)},
                     {"memory_bytes", memoryBytes()},
                     {"device_class", plan.deviceClass},
                     {"gl", toJson(device)},
                     {"scenes", Json::object()},
                     {"invocations", Json::array()}};
    if (plan.shard) manifest["shard"] = plan.shard->name();
    return manifest;
}

void requireOfPlan(const Json& manifest, const Plan& plan, const std::filesystem::path& file) {
    const std::string shard = plan.shard ? plan.shard->name() : "";
    const std::string hash = manifest.value("plan", plan.hash),
                      own = manifest.value("shard", shard);
    if (hash == plan.hash && own == shard) return;
    const auto named = [](const std::string& text, const std::string& part) {
        return fmt::format("the plan {}{}{}", text.substr(0, 12), part.empty() ? "" : ", shard ",
                           part);
    };
    throw Error({file.string(), 0, 0}, fmt::format("is of {}, and the plan.json beside it is {}",
                                                   named(hash, own), named(plan.hash, shard)));
}

void beginInvocation(Json& manifest, const std::string& commandLine) {
    manifest["invocations"].push_back(Json{{"command", commandLine}, {"started", utcTime()}});
}

void endInvocation(Json& manifest, const PhaseClock& phases, double wallS) {
    Json& invocation = manifest["invocations"].back();
    invocation["ended"] = utcTime();
    invocation["wall_s"] = wallS;
    Json& totals = invocation["phases_s"] = Json::object();
    for (const char* phase : {"device", "load", "setup", "warm-up", "render", "record"}) {
        const auto found = phases.totalsS().find(phase);
        totals[phase] = found == phases.totalsS().end() ? 0.0 : found->second;
    }
    invocation["overhead_s"] = wallS - phases.busyS();
    invocation["overhead_share"] = (wallS - phases.busyS()) / wallS;
}

void sealRecords(Json& manifest, const std::filesystem::path& runDir) {
    Json& sums = manifest["sha256"] = Json::object();
    for (const char* file : kSealedFiles) {
        if (std::filesystem::exists(runDir / file)) sums[file] = sha256OfFile(runDir / file);
    }
}

void breakSeal(Json& manifest) {
    manifest.erase("sha256");
    manifest.erase("units");
}

bool areRecordsSealed(const Json& manifest, const std::filesystem::path& runDir) {
    const std::string file = kSealedFiles[0];
    const auto sums = manifest.find("sha256");
    return sums != manifest.end() && sums->contains(file) &&
           std::filesystem::exists(runDir / file) && sums->at(file) == sha256OfFile(runDir / file);
}

void noteChanges(Json& manifest, const std::filesystem::path& runDir) {
    if (!manifest.contains("sha256")) return;
    const Json sums = manifest.at("sha256");  // a note moves what is in the manifest
    for (const char* file : kSealedFiles) {   // no other file, whatever the manifest names
        if (!sums.contains(file)) continue;
        const std::string then = sums.at(file).get<std::string>();
        const bool isThere = std::filesystem::exists(runDir / file);
        const std::string now = isThere ? sha256OfFile(runDir / file) : "";
        if (now == then) continue;
        const std::string note =
            fmt::format("{} was {} after the run (SHA-256 {} at its end{})", file,
                        isThere ? "changed" : "removed", then.substr(0, 12),
                        isThere ? ", now " + now.substr(0, 12) : "");
        addNote(manifest, note);
    }
}

void addNote(Json& manifest, const std::string& note) {
    Json& notes = manifest["notes"];
    if (std::ranges::find(notes, Json(note)) == notes.end()) notes.push_back(note);
}

std::vector<std::string> machinesOf(const Json& manifest) {
    std::vector<std::string> machines;
    const auto add = [&](const Json& run, const std::string& first) {
        std::vector<std::string> names = {first};
        for (const Json& invocation : run.at("invocations")) {
            names.push_back(invocation.value("machine", first));
        }
        for (std::string& name : names) {
            const bool isNew = std::ranges::find(machines, name) == machines.end();
            if (isNew) machines.push_back(std::move(name));
        }
    };
    const auto merged = manifest.find("merged");
    if (merged == manifest.end()) {
        add(manifest, machineName(manifest));
        return machines;
    }
    for (const Json& run : *merged) add(run, run.at("machine").get<std::string>());
    add(manifest, machines.empty() ? machineName(manifest) : machines.front());
    return machines;
}

void noteMachines(Json& manifest) {
    constexpr std::string_view kBegin = "measured on several machines, ";
    const std::vector<std::string> machines = machinesOf(manifest);
    if (machines.size() < 2) return;
    std::vector<std::string> notes = notesOf(manifest);
    std::erase_if(notes, [&](const std::string& note) { return note.starts_with(kBegin); });
    notes.push_back(fmt::format("{}the times of each table on one of them: {}", kBegin,
                                joined(machines, "; ")));
    manifest["notes"] = notes;
}

std::vector<std::string> notesOf(const Json& manifest) {
    return manifest.value("notes", std::vector<std::string>{});
}

void addScenes(Json& manifest, const std::map<std::string, SceneUse>& scenes) {
    std::set<std::string> warnings;
    for (const auto& [reference, use] : scenes) {
        manifest["scenes"][reference] = {
            {"kind", use.kind}, {"description", use.description}, {"sha256", use.sha256}};
        for (const std::string& line : use.warnings) {
            warnings.insert("scene '" + reference + "': " + line);
        }
    }
    addWarnings(manifest, warnings);
}

void addPrograms(Json& manifest, const std::set<ProgramUse>& programs) {
    for (const ProgramUse& use : programs) {
        const Json entry = {{"file", use.file}, {"sha256", use.sha256}, {"version", use.version}};
        Json& known = manifest["programs"];
        if (std::ranges::find(known, entry) == known.end()) known.push_back(entry);
    }
}

void addWarnings(Json& manifest, const std::set<std::string>& warnings) {
    constexpr std::size_t kMost = 100;
    Json known = manifest.value("warnings", Json::array());
    for (const std::string& warning : warnings) {
        std::string line = asUtf8(warning);
        std::ranges::replace_if(
            line, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
        if (known.size() > kMost || std::ranges::find(known, Json(line)) != known.end()) continue;
        known.push_back(known.size() < kMost ? line : "further ones are not listed");
    }
    if (!known.empty()) manifest["warnings"] = known;
}

std::set<ProgramUse> programsOf(const Json& manifest) {
    std::set<ProgramUse> programs;
    for (const Json& use : manifest.value("programs", Json::array())) {
        programs.insert({use.at("file"), use.at("sha256"), use.at("version")});
    }
    return programs;
}

std::string machineName(const Json& manifest) {
    const Json& gl = manifest.at("gl");
    if (manifest.contains("imported")) return "imported: " + gl.at("renderer").get<std::string>();
    const std::string version = gl.at("version").get<std::string>();  // empty without a device
    return manifest.at("cpu").get<std::string>() + ", " +
           std::to_string(manifest.at("cores").get<long>()) + " cores, " +
           gl.at("renderer").get<std::string>() + (version.empty() ? "" : ", " + version);
}

std::string timingMachine(const Json& manifest, const std::string& experiment) {
    const auto machines = manifest.find("timing_machines");
    if (machines == manifest.end() || !machines->contains(experiment)) return machineName(manifest);
    return machines->at(experiment).get<std::string>();
}

bool isOnlyMerged(const Json& manifest) {
    return manifest.contains("merged") && manifest.at("invocations").size() == 1;
}

}  // namespace gfxrepro::run
