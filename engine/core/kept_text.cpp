#include "engine/core/kept_text.h"

#include <mutex>
#include <unordered_set>

namespace gfxrepro {

KeptText::KeptText(const std::string& text) {
    if (text.empty()) return;
    static std::mutex mutex;
    static auto& texts = *new std::unordered_set<std::string>;  // for as long as the program runs
    const std::lock_guard lock(mutex);
    text_ = &*texts.insert(text).first;
}

}  // namespace gfxrepro
