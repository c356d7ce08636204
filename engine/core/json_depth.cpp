#include "engine/core/json_depth.h"

#include <cstddef>

namespace gfxrepro {

bool isTooDeepJson(std::string_view text) {
    int level = 0;
    bool isString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') isString = !isString;
        if (isString) {
            if (c == '\\') ++i;
        } else if (c == '[' || c == '{') {
            if (++level > kMostJsonLevels) return true;
        } else if (c == ']' || c == '}') {
            --level;
        }
    }
    return false;
}

}  // namespace gfxrepro
