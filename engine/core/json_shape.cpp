#include "engine/core/json_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <climits>
#include <deque>
#include <unordered_set>
#include <vector>

#include "engine/core/node.h"

namespace gfxrepro {

namespace {

bool isOfKind(const Json& value, JsonKind kind) {
    const auto areAll = [&](JsonKind item) {
        return value.is_structured() &&
               std::ranges::all_of(value, [&](const Json& one) { return isOfKind(one, item); });
    };
    const auto isWholeUpTo = [&](long long most) {
        if (value.is_number_unsigned()) {
            return value.get<unsigned long long>() <= static_cast<unsigned long long>(most);
        }
        return value.is_number_integer() && value.get<long long>() >= -most - 1;
    };
    switch (kind) {
        case JsonKind::Text:
            return value.is_string();
        case JsonKind::Line:
            return value.is_string() &&
                   std::ranges::none_of(value.get_ref<const std::string&>(),
                                        [](unsigned char c) { return c < 0x20 || c == 0x7F; });
        case JsonKind::Boolean:
            return value.is_boolean();
        case JsonKind::Int:
            return isWholeUpTo(INT_MAX);
        case JsonKind::Whole:
            return isWholeUpTo(LLONG_MAX);
        case JsonKind::Number:
            return value.is_number();
        case JsonKind::Infinite:
            return value.is_number() || value == "inf" || value == "-inf";
        case JsonKind::Object:
            return value.is_object();
        case JsonKind::List:
            return value.is_array();
        case JsonKind::Texts:
            return areAll(JsonKind::Text);
        case JsonKind::Lines:
            return areAll(JsonKind::Line);
        case JsonKind::Ints:
            return areAll(JsonKind::Int);
        case JsonKind::Objects:
            return areAll(JsonKind::Object);
    }
    return false;
}

std::string_view nameOf(JsonKind kind) {
    static constexpr std::array<std::string_view, 13> kNames = {"text",
                                                                "a line of text",
                                                                "true or false",
                                                                "a whole number below 2^31",
                                                                "a whole number",
                                                                "a number",
                                                                "a number, \"inf\" or \"-inf\"",
                                                                "an object",
                                                                "a list",
                                                                "texts",
                                                                "lines of text",
                                                                "whole numbers below 2^31",
                                                                "objects"};
    return kNames[static_cast<std::size_t>(kind)];
}

void requireKind(const Json& value, JsonKind kind, const SourceLocation& where,
                 const std::string& place) {
    if (isOfKind(value, kind)) return;
    throw Error(where,
                fmt::format("'{}' is {}; expected {}", place, value.type_name(), nameOf(kind)));
}

}  // namespace

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

Node nodeFromJson(const Json& json, const SourceLocation& where) {
    if (json.is_object()) {
        Node::Map entries;
        for (const auto& [key, value] : json.items()) {
            entries.emplace_back(key, nodeFromJson(value, where));
        }
        return Node::map(std::move(entries), where);
    }
    if (json.is_array()) {
        Node::Sequence items;
        items.reserve(json.size());
        for (const Json& item : json) items.push_back(nodeFromJson(item, where));
        return Node::sequence(std::move(items), where);
    }
    if (json.is_null()) return Node::null(where);
    if (json.is_string()) return Node::scalar(json.get<std::string>(), where, true);
    return Node::scalar(json.dump(), where);
}

void requireShallowJson(std::string_view text, const SourceLocation& where) {
    if (!isTooDeepJson(text)) return;
    throw Error(where, fmt::format("is nested deeper than {} levels", kMostJsonLevels));
}

namespace {

/// A key that stands twice in an object of sound JSON, as it is written the second time: the
/// library takes the last of its values, and its callbacks take ten times as long as its parser.
std::optional<std::string_view> keyTwiceIn(std::string_view text) {
    std::deque<std::string> decoded;                         // those that are written with escapes
    std::vector<std::unordered_set<std::string_view>> open;  // keys of objects and lists that are
    for (std::size_t i = 0; i < text.size() && text[i] != '\0'; ++i) {  // where the library ends
        if (text[i] == '{' || text[i] == '[') open.emplace_back();
        if (text[i] == '}' || text[i] == ']') open.pop_back();
        if (text[i] != '"') continue;
        const std::size_t begin = ++i;
        while (text[i] != '"') i += text[i] == '\\' ? 2 : 1;
        if (text[text.find_first_not_of(" \t\r\n", i + 1)] != ':') continue;
        const std::string_view written = text.substr(begin, i - begin);
        std::string_view key = written;
        if (written.find('\\') != written.npos) {
            key = decoded.emplace_back(
                Json::parse(text.substr(begin - 1, i + 2 - begin)).get<std::string>());
        }
        if (!open.back().insert(key).second) return written;
    }
    return std::nullopt;
}

}  // namespace

std::optional<Json> jsonObjectIn(std::string_view text, const SourceLocation& where) {
    requireShallowJson(text, where);
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    if (const auto key = keyTwiceIn(text)) {
        throw Error(where, fmt::format("has \"{}\" twice", *key));
    }
    return json;
}

Json parseJsonObject(std::string_view text, const SourceLocation& where) {
    if (std::optional<Json> json = jsonObjectIn(text, where)) return *std::move(json);
    throw Error(where, "is no JSON object");
}

void requireMembers(const Json& object, std::span<const JsonMember> members,
                    const SourceLocation& where, const std::string& prefix) {
    for (const JsonMember& member : members) {
        const Json::json_pointer place(member.place);
        if (object.contains(place)) {
            requireKind(object.at(place), member.kind, where, prefix + member.place);
        } else if (member.isRequired) {
            throw Error(where, fmt::format("'{}{}' is missing", prefix, member.place));
        }
    }
}

void requireEach(const Json& object, const char* place, std::span<const JsonMember> members,
                 const SourceLocation& where, const std::string& prefix) {
    const Json::json_pointer pointer(place);
    if (!object.contains(pointer)) return;
    for (const auto& [name, value] : object.at(pointer).items()) {
        requireMembers(value, members, where, fmt::format("{}{}/{}", prefix, place, name));
    }
}

void requireRows(const Json& object, const char* place, std::span<const JsonKind> columns,
                 const SourceLocation& where) {
    const JsonMember list{place, JsonKind::List};
    requireMembers(object, {&list, 1}, where);
    const Json& rows = object.at(Json::json_pointer(place));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string row = fmt::format("{}/{}", place, i);
        requireKind(rows[i], JsonKind::List, where, row);
        if (rows[i].size() != columns.size()) {
            throw Error(where, fmt::format("'{}' has {} values; expected {}", row, rows[i].size(),
                                           columns.size()));
        }
        for (std::size_t k = 0; k < columns.size(); ++k) {
            requireKind(rows[i][k], columns[k], where, fmt::format("{}/{}", row, k));
        }
    }
}

}  // namespace gfxrepro
