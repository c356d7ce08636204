#include "runner/technique/shared_results.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace gfxrepro::technique {

void SharedResults::beginCase(std::string work, Node params) {
    work_ = std::move(work);
    params_ = std::move(params);
    for (KeptResult& entry : entries_) entry.isOfThisCase = false;
}

std::string SharedResults::keyOf(const std::string& name,
                                 std::initializer_list<const char*> regardless) const {
    nlohmann::ordered_json params = params_.toJson();
    params.erase("pictures");  // whether they are saved changes nothing that is made
    for (const char* parameter : regardless) params.erase(parameter);
    return name + '\n' + work_ + '\n' + params.dump();
}

std::shared_ptr<const void> SharedResults::find(const std::string& key) {
    const auto found = std::ranges::find(entries_, key, &KeptResult::key);
    if (found == entries_.end()) return nullptr;
    found->isOfThisCase = true;
    entries_.splice(entries_.begin(), entries_, found);
    return found->result;
}

void SharedResults::add(const std::string& key, std::shared_ptr<const void> result,
                        std::size_t sizeBytes) {
    entries_.push_front({key, std::move(result), sizeBytes});
    std::size_t total = 0;
    std::erase_if(entries_,
                  [&](const KeptResult& entry) { return (total += entry.sizeBytes) > mostBytes_; });
}

std::size_t SharedResults::otherBytes() const {
    std::size_t sizeBytes = 0;
    for (const KeptResult& entry : entries_) {
        if (!entry.isOfThisCase) sizeBytes += entry.sizeBytes;
    }
    return sizeBytes;
}

}  // namespace gfxrepro::technique
