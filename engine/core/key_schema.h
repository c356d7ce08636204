// The schema of files that people write, as data: every key as it is declared (key_info.h), in one
// table with the place that its reader finds it at. What describes them, to people and to editors,
// is made from the same tables. Files that the program itself writes, such as plans and manifests,
// are read by their shape instead (json_shape.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/checks.h"
#include "engine/core/json_shape.h"
#include "engine/core/key_info.h"
#include "engine/core/node.h"

namespace gfxrepro {

// Types as JSON schema writes them. They allow what the readers allow: whatever stands on one line
// is text, also `2.1`.
namespace types {

inline Json text() {
    return {{"type", {"string", "number", "boolean"}}};
}
inline Json number() {
    return {{"type", "number"}};
}
inline Json number(const NumberRange& range) {
    Json type = {{"type", range.isWhole ? "integer" : "number"}};
    const auto bound = [&](const char* including, const char* excluding, bool isExcluded,
                           double value) {
        const bool isWhole = value == std::floor(value) && std::abs(value) < 1e15;
        if (std::isinf(value)) return;
        type[isExcluded ? excluding : including] =
            isWhole ? Json(std::llround(value)) : Json(value);
    };
    bound("minimum", "exclusiveMinimum", range.isLeastExcluded, range.least);
    bound("maximum", "exclusiveMaximum", range.isMostExcluded, range.most);
    return type;
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
/// None twice.
inline Json setOf(Json item) {
    Json set = listOf(std::move(item));
    set["uniqueItems"] = true;
    return set;
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

/// The name that a parameter has in configs may be `12` or `true`: it is read as text, but a YAML
/// reader makes it a number.
inline Json spellingsOf(const std::vector<std::string>& names) {
    Json values = Json::array();
    for (const std::string& name : names) {
        values.push_back(name);
        const Json plain = Node::scalar(name).toJson();
        if (!plain.is_string()) values.push_back(plain);
    }
    return {{"enum", std::move(values)}};
}
/// Of what is declared without words of its own.
inline Json typeOf(const KeyInfo& info) {
    if (info.count > 0) return tupleOf(number(info.range), static_cast<int>(info.count));
    if (!info.choices.empty()) return spellingsOf(info.choices);
    if (info.type == "boolean") return boolean();
    if (info.type == "integer" || info.type == "number") return number(info.range);
    return text();
}

}  // namespace types

/// A key of a map, or a parameter, with its type as JSON schema has it.
struct SchemaKey : KeyInfo {
    SchemaKey(KeyInfo declared) : KeyInfo(std::move(declared)), json(types::typeOf(*this)) {}
    SchemaKey(std::string key, std::string words, std::string ifAbsent, std::string meaning,
              Json ofJson)
        : KeyInfo{std::move(key), std::move(words), std::move(ifAbsent), std::move(meaning)},
          json(std::move(ofJson)) {}

    Json json;
};

namespace types {

inline SchemaKey numberKey(std::string key, const NumberRange& range, std::string absent,
                           std::string doc, std::string unit = "") {
    return KeyInfo{std::move(key),    range.isWhole ? "integer" : "number",
                   std::move(absent), std::move(doc),
                   std::move(unit),   range};
}
inline SchemaKey flagKey(std::string key, std::string doc) {
    return KeyInfo{std::move(key), "boolean", "false", std::move(doc)};
}
/// A key whose value is one of `names`, which stand once.
template <class Names>
SchemaKey choiceKey(std::string key, const Names& names, std::string absent, std::string doc) {
    KeyInfo info{std::move(key), "choice", std::move(absent), std::move(doc)};
    for (const auto& name : names) info.choices.emplace_back(name);
    return info;
}

}  // namespace types

/// The keys of one kind of map.
struct SchemaSection {
    std::string name;           // "camera", also in the JSON schema
    std::string path;           // what stands before its keys: "camera.", "axes.NAME."
    std::string doc;            // begins its table
    bool isRemovable = true;    // a key may be null, which removes what an extended file has set
    Json others = nullptr;      // the type of all further keys; null: there are none
    Json conditions = nullptr;  // further JSON schema: which keys go together
    std::vector<SchemaKey> keys = {};

    std::vector<std::string> keyNames() const {
        std::vector<std::string> names;
        for (const SchemaKey& key : keys) names.push_back(key.name);
        return names;
    }
};

/// The keys of one kind of map, each declared beside the member of `Given` that it is read from: no
/// other can be read, and none is without a reader.
///
///     struct EqualKeys { GivenKey metric, is; };
///     const KeyTable<EqualKeys> table{{"equal", "equal.", "…"},
///                                     {{&EqualKeys::metric, "metric", …}, …}};
///     const EqualKeys given = table.read(node, "equal");
template <class Given>
class KeyTable {
  public:
    struct Key {
        Key(GivenKey Given::*whose, SchemaKey key) : place(whose), declared(std::move(key)) {}
        Key(GivenKey Given::*whose, std::string name, std::string type, std::string absent,
            std::string doc, Json json)
            : place(whose),
              declared(std::move(name), std::move(type), std::move(absent), std::move(doc),
                       std::move(json)) {}

        GivenKey Given::*place;
        SchemaKey declared;
    };
    /// `section` has no keys yet.
    KeyTable(SchemaSection section, const std::vector<Key>& keys) : section_(std::move(section)) {
        for (const Key& key : keys) {
            section_.keys.push_back(key.declared);
            places_.push_back(key.place);
        }
        names_ = section_.keyNames();
    }

    const SchemaSection& section() const { return section_; }
    const std::vector<std::string>& names() const { return names_; }
    const std::string& nameOf(GivenKey Given::*key) const {
        return names_[static_cast<std::size_t>(std::ranges::find(places_, key) - places_.begin())];
    }

    /// A value alone is that of `key`.
    Node mapOf(const Node& node, GivenKey Given::*key) const {
        return node.isMap() ? node : Node::map({{nameOf(key), node}}, node.location());
    }
    /// What the map has at these keys, whatever else it has.
    Given find(const Node& map) const {
        Given given{};
        for (std::size_t i = 0; i < names_.size(); ++i) {
            given.*places_[i] = {map, section_.keys[i]};
        }
        return given;
    }
    /// What the map has at that one, to be changed; null where it is not there.
    Node* find(Node& map, GivenKey Given::*key) const { return map.find(nameOf(key)); }
    /// Throws Error for a key that is none of these; `what` begins the message.
    Given readKnown(const Node& map, std::string_view what) const {
        requireKeys(map, what, names_);
        return find(map);
    }
    /// Throws Error "WHAT needs 'KEY'" at `where` for a required key that is not there.
    void require(const Given& given, const SourceLocation& where, const std::string& what) const {
        for (std::size_t i = 0; i < names_.size(); ++i) {
            if (!section_.keys[i].isRequired() || given.*places_[i]) continue;
            throw Error(where, what + " needs '" + names_[i] + "'");
        }
    }
    /// Both, the latter in the map where it is not said.
    Given read(const Node& map, const std::string& what,
               const SourceLocation* where = nullptr) const {
        const Given given = readKnown(map, what);
        require(given, where ? *where : map.location(), what);
        return given;
    }

  private:
    SchemaSection section_;
    std::vector<std::string> names_;
    std::vector<GivenKey Given::*> places_;
};

/// A kind of file and its sections, the top of the file first.
struct SchemaFile {
    std::string name;  // "scene"
    std::string doc;
    std::vector<SchemaSection> sections;

    /// The section of that name, or null.
    const SchemaSection* find(std::string_view section) const {
        const auto found = std::ranges::find(sections, section, &SchemaSection::name);
        return found == sections.end() ? nullptr : &*found;
    }
};

}  // namespace gfxrepro
