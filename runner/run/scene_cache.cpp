#include "runner/run/scene_cache.h"

#include <algorithm>
#include <chrono>

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

}  // namespace gfxrepro::run
