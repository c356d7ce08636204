#include "engine/gl/granted_gpus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

#include "engine/core/text.h"
#include "engine/gl/nvml.h"

namespace gfxrepro::gl {

namespace {

constexpr const char* kVariable = "CUDA_VISIBLE_DEVICES";

/// The GPU that an entry means; empty for none.
std::string gpuOf(std::string entry, const std::vector<std::string>& gpus) {
    if (const auto index = parseInteger(entry)) {
        const bool isThere = *index >= 0 && *index < static_cast<long long>(gpus.size());
        return isThere ? gpus[static_cast<std::size_t>(*index)] : "";
    }
    std::ranges::transform(entry, entry.begin(), [](unsigned char c) { return std::tolower(c); });
    if (!entry.starts_with("gpu-") || entry.size() == 4) return "";
    const auto found = std::ranges::find_if(
        gpus, [&](const std::string& uuid) { return uuid.starts_with(entry.substr(4)); });
    return found == gpus.end() ? "" : *found;
}

}  // namespace

GrantedGpus::GrantedGpus(std::optional<std::string> visible, std::vector<std::string> gpus)
    : visible_(std::move(visible)), gpus_(std::move(gpus)) {
    if (!visible_) return;
    for (const std::string& entry : split(*visible_, ',')) {
        const std::string gpu = gpuOf(std::string(trimmed(entry)), gpus_);
        if (gpu.empty()) break;
        granted_.push_back(gpu);
    }
}

GrantedGpus GrantedGpus::fromEnvironment() {
    const char* visible = std::getenv(kVariable);
    return visible ? GrantedGpus(visible, nvidiaGpus()) : GrantedGpus(std::nullopt, {});
}

std::string GrantedGpus::whyNot(const std::string& uuid) const {
    const auto has = [&](const std::vector<std::string>& uuids) {
        return std::ranges::find(uuids, uuid) != uuids.end();
    };
    if (!visible_ || !has(gpus_) || has(granted_)) return "";
    return fmt::format("is not among those that {} gives: '{}'", kVariable, *visible_);
}

}  // namespace gfxrepro::gl
