// Types as JSON schema writes them; private to this module. They allow what the readers allow:
// whatever stands on one line is text, also `2.1`.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "runner/config/schema.h"

namespace gfxrepro::config::types {

inline Json text() {
    return {{"type", {"string", "number", "boolean"}}};
}
inline Json number() {
    return {{"type", "number"}};
}
inline Json count() {
    return {{"type", "integer"}, {"minimum", 1}};
}
inline Json boolean() {
    return {{"type", "boolean"}};
}
inline Json anything() {
    return Json::object();
}
template <class Names>
Json choice(const Names& names) {
    Json values = Json::array();
    for (const auto& name : names) values.push_back(std::string(name));
    return {{"enum", std::move(values)}};
}
inline Json choice(std::initializer_list<std::string_view> names) {
    return choice<std::initializer_list<std::string_view>>(names);
}
inline Json listOf(Json item, int atLeast = 0) {
    Json list = {{"type", "array"}, {"items", std::move(item)}};
    if (atLeast > 0) list["minItems"] = atLeast;
    return list;
}
/// Exactly `size` items.
inline Json tupleOf(Json item, int size) {
    Json list = listOf(std::move(item), size);
    list["maxItems"] = size;
    return list;
}
inline Json anyOf(std::initializer_list<Json> types) {
    Json list = Json::array();
    for (const Json& type : types) list.push_back(type);
    return {{"anyOf", std::move(list)}};
}
/// Null removes what an extended file has set.
inline Json orNull(Json type) {
    if (type.empty()) return type;
    if (type.contains("anyOf")) {
        type["anyOf"].push_back({{"type", "null"}});
    } else if (type.contains("enum")) {
        type["enum"].push_back(nullptr);
    } else if (type.contains("type") && type["type"].is_array()) {
        type["type"].push_back("null");
    } else if (type.contains("type")) {
        type["type"] = Json::array({type["type"], "null"});
    } else {
        return anyOf({std::move(type), {{"type", "null"}}});
    }
    return type;
}
/// Any keys, each with such a value.
inline Json mapOf(Json value) {
    return {{"type", "object"}, {"additionalProperties", orNull(std::move(value))}};
}
inline Json refTo(std::string_view definition) {
    return {{"$ref", "#/definitions/" + std::string(definition)}};
}
/// A value or several of them.
inline Json oneOrMore(Json value) {
    return anyOf({value, listOf(value)});
}
/// {axis: value}, {axis: [values]}.
inline Json pairs() {
    return mapOf(anything());
}
/// One of these groups of keys must be there: {{"a"}, {"b", "c"}} is a, or b and c.
inline Json needsOneOf(std::initializer_list<std::initializer_list<std::string_view>> groups) {
    Json list = Json::array();
    for (const auto& group : groups) {
        Json keys = Json::array();
        for (const std::string_view key : group) keys.push_back(std::string(key));
        list.push_back({{"required", std::move(keys)}});
    }
    return {{"anyOf", std::move(list)}};
}

}  // namespace gfxrepro::config::types
