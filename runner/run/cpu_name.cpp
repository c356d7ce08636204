#include "runner/run/cpu_name.h"

#include "engine/core/text.h"

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

}  // namespace gfxrepro::run
