#include "tests/unit/report/well_formed.h"

#include <fmt/format.h>
#include <regex>
#include <vector>

namespace gfxrepro::test {

namespace {

const std::regex kTag(
    R"(^<(/?)([A-Za-z][\w:.-]*)((?:\s+[\w:.-]+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*)\s*(/?)>)");
const std::regex kAttribute(R"(([\w:.-]+)\s*=\s*(?:"([^"]*)\"|'([^']*)'))");
const std::regex kText(R"(^(?:[^<&\x01-\x08\x0b\x0c\x0e-\x1f]|&(?:amp|lt|gt|quot|apos|#\d+);)+)");

std::string idsProblem(const std::string& attributes, std::set<std::string>& ids) {
    std::set<std::string> names;
    for (std::sregex_iterator at(attributes.begin(), attributes.end(), kAttribute), end; at != end;
         ++at) {
        if (!names.insert((*at)[1]).second) return fmt::format("twice: {}", (*at)[1].str());
        if ((*at)[1] != "id") continue;
        const std::string id = (*at)[2].str() + (*at)[3].str();
        if (!ids.insert(id).second) return fmt::format("id twice: {}", id);
    }
    return "";
}

}  // namespace

std::string xmlProblem(const std::string& xml, std::set<std::string>& ids) {
    std::vector<std::string> open;
    bool hasRoot = false;
    for (std::size_t at = 0; at < xml.size();) {
        // Pieces end at the next tag: std::regex recurses on long texts.
        const std::size_t end = xml[at] == '<' ? xml.find('>', at) + 1 : xml.find('<', at);
        const std::string piece = xml.substr(at, end - at);
        std::smatch match;
        if (xml[at] != '<') {
            const bool isBlank = piece.find_first_not_of(" \t\r\n") == std::string::npos;
            if (!std::regex_match(piece, kText) || piece.find("]]>") != std::string::npos ||
                (open.empty() && !isBlank)) {
                return fmt::format("text '{}'", piece);
            }
        } else if (!std::regex_match(piece, match, kTag)) {
            return fmt::format("tag '{}'", piece);
        } else if (match[1] == "/") {
            if (open.empty() || open.back() != match[2]) return fmt::format("end of {}", piece);
            open.pop_back();
        } else {
            if (open.empty() && hasRoot) return "a second root";
            hasRoot = true;
            const std::string problem = idsProblem(match[3], ids);
            if (!problem.empty()) return problem;
            if (match[4] != "/") open.push_back(match[2]);
        }
        at = end == std::string::npos ? xml.size() : end;
    }
    return open.empty() && hasRoot ? "" : "not closed";
}

}  // namespace gfxrepro::test
