// JSON that the program wrote itself → Node. As JSON, not as the YAML that JSON nearly is: there
// control characters in texts and keys over 1,024 characters are refused.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "runner/config/node.h"
#include "runner/core/files.h"

namespace gfxrepro::config {

namespace {

using Json = nlohmann::ordered_json;
constexpr int kDeepest = 200;

Node nodeOf(const Json& value, const SourceLocation& where) {
    if (value.is_null()) return Node::null(where);
    if (value.is_string()) return Node::scalar(value.get<std::string>(), where, true);
    if (value.is_array()) {
        Node::Sequence items;
        items.reserve(value.size());
        for (const Json& item : value) items.push_back(nodeOf(item, where));
        return Node::sequence(std::move(items), where);
    }
    if (value.is_object()) {
        Node::Map entries;
        entries.reserve(value.size());
        for (const auto& [key, item] : value.items())
            entries.emplace_back(key, nodeOf(item, where));
        return Node::map(std::move(entries), where);
    }
    return Node::scalar(value.dump(), where);  // as it was written: 1.0 stays no integer
}

SourceLocation placeOf(std::string_view text, std::size_t byte, const std::string& fileName) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    const std::size_t lineBegin = before.rfind('\n') + 1;  // npos + 1: 0
    return {fileName, static_cast<int>(std::ranges::count(before, '\n')) + 1,
            static_cast<int>(before.size() - lineBegin)};
}

}  // namespace

Node parseJson(std::string_view text, const std::string& fileName) {
    const auto limit = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > kDeepest) {
            throw Error({fileName, 0, 0}, "nested deeper than " + std::to_string(kDeepest));
        }
        return true;
    };
    try {
        return nodeOf(Json::parse(text, limit), {fileName, 0, 0});
    } catch (const Json::parse_error& error) {
        throw Error(placeOf(text, error.byte, fileName), "this is no JSON");
    }
}

Node parseJsonFile(const std::filesystem::path& path) {
    return parseJson(readFile(path), path.string());
}

}  // namespace gfxrepro::config
