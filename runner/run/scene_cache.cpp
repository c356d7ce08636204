#include "runner/run/scene_cache.h"

#include <algorithm>
#include <chrono>

#include "engine/core/text.h"
#include "runner/run/child_process.h"
#include "runner/run/process_memory.h"

namespace gfxrepro::run {

namespace {

std::size_t sizeBytesOf(const scene::Scene& scene) {
    std::size_t sizeBytes = 0;
    for (const scene::Mesh& mesh : scene.meshes) sizeBytes += mesh.sizeBytes();
    for (const image::Image8& texture : scene.textures) sizeBytes += texture.values().size();
    const scene::PointCloud& points = scene.points;
    sizeBytes += (points.positions.size() + points.normals.size() + points.colors.size()) *
                     sizeof(glm::vec3) +
                 points.radii.size() * sizeof(float);
    if (scene.heights) sizeBytes += scene.heights->heightsM.size() * sizeof(float);
    return sizeBytes;
}

}  // namespace

void SceneCache::beginCase(const std::string& keep) {
    for (Entry& entry : entries_) entry.isOfThisCase = entry.reference == keep;
    trim();
}

const SceneCache::Entry& SceneCache::get(const std::string& reference) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& e) { return e.reference == reference; });
    if (found != entries_.end()) {
        entries_.splice(entries_.begin(), entries_, found);
        entries_.front().isOfThisCase = true;
        return entries_.front();
    }
    const auto begin = std::chrono::steady_clock::now();
    Entry entry;
    entry.reference = reference;
    entry.scene = catalog_.load(Node::scalar(reference));
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    entry.loadTimeMs = time.count();
    entry.sizeBytes = sizeBytesOf(entry.scene);
    entry.peakResidentBytes = peakResidentBytes();
    entries_.push_front(std::move(entry));
    trim();
    return entries_.front();
}

std::size_t SceneCache::otherBytes() const {
    std::size_t sizeBytes = 0;
    for (const Entry& entry : entries_) {
        if (!entry.isOfThisCase) sizeBytes += entry.sizeBytes;
    }
    return sizeBytes;
}

void SceneCache::trim() {
    std::size_t total = 0;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        total += entry->sizeBytes;
        const bool goes = !entry->isOfThisCase && total > budgetBytes_;
        if (goes) total -= entry->sizeBytes;
        entry = goes ? entries_.erase(entry) : std::next(entry);
    }
}

namespace {

constexpr std::chrono::seconds kVersionLimit{20};

/// The first line that says something.
std::string firstLine(const std::string& output) {
    constexpr std::size_t kLongest = 200;
    for (const std::string& line : split(output, '\n')) {
        const std::string_view text = trimmed(line);
        if (!text.empty()) return std::string(text.substr(0, kLongest));
    }
    return "";
}

}  // namespace

std::vector<ProgramUse> ProgramCache::require(const Case& item, const Node& params) {
    const config::ExternalProgram program = config::readProgram(item.program);
    const std::vector<config::ProgramFile> files =
        config::filesOf(program, program.valuesOf(params));
    const std::string key = config::programKey(files, digests_);
    if (const config::ProgramFile* absent = config::absentOf(files)) {
        throw UnsupportedError("the program '" + absent->name + "' is not on this machine");
    }
    if (!item.programKey.empty() && key != item.programKey) {
        throw Error("the program '" + files.front().name +
                    "', or a file that it reads, changed since the run was planned");
    }
    std::vector<ProgramUse> uses;
    for (const config::ProgramFile& file : files) {
        uses.push_back({file.name, digests_.of(file.path), ""});
    }
    if (program.version.empty()) return uses;
    // Of the file that is asked; of the program where another one is.
    const auto asked =
        std::ranges::find(files, program.version.front(), &config::ProgramFile::name);
    const std::size_t at =
        asked == files.end() ? 0 : static_cast<std::size_t>(asked - files.begin());
    uses[at].version = versionOf(program, uses[at].sha256);
    return uses;
}

std::string ProgramCache::versionOf(const config::ExternalProgram& program,
                                    const std::string& sha256) {
    std::vector<std::string> command;
    for (const std::string& argument : program.version) {
        command.push_back(config::filled(argument, {{config::placeholder::kHere, program.here}}));
    }
    const auto [known, isNew] = versions_.try_emplace(sha256 + ' ' + joined(command, " "));
    if (!isNew) return known->second;
    const std::string path = config::findExecutable(command.front(), program.here).string();
    if (path.empty()) {
        throw UnsupportedError("the program '" + command.front() +
                               "', which says the version, is not on this machine");
    }
    command.front() = path;
    known->second = firstLine(runToEnd(command, kVersionLimit).output);
    return known->second;
}

}  // namespace gfxrepro::run
