// A YAML value that remembers where it stands.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/core/error.h"

namespace gfxrepro {

/// null, a scalar, a sequence or a map, with the place of each. A value type: copies are deep.
///
/// Scalars keep their text; the typed reads decide. Plain `010`, `0x10`, `yes`, `.inf` are never
/// numbers or booleans by accident: numbers are decimal without leading zeros, booleans are `true`
/// and `false`.
class Node {
  public:
    class Entry;
    using Map = std::vector<Entry>;  // in the order of the file
    using Sequence = std::vector<Node>;

    Node() = default;
    static Node scalar(std::string text, SourceLocation where = {}, bool quoted = false);
    /// The shortest text that reads back as the same number.
    static Node number(double value, SourceLocation where = {});
    /// Lines of text, as `|` writes them; `where` is the place of the bar.
    static Node block(std::string text, SourceLocation where = {});
    static Node null(SourceLocation where);
    static Node sequence(Sequence items, SourceLocation where = {});
    /// Of two entries with one key the last counts.
    static Node map(Map entries, SourceLocation where = {});

    const SourceLocation& location() const { return location_; }
    /// Where line `lineIndex` of a block of text stands; the node's own place when it is none.
    SourceLocation lineLocation(std::size_t lineIndex) const;
    /// "a number", "a boolean", "text", "a list", "a map", "nothing": for messages.
    std::string kindName() const;

    bool isNull() const { return std::holds_alternative<std::monostate>(value_); }
    bool isScalar() const { return std::holds_alternative<Scalar>(value_); }
    bool isSequence() const { return std::holds_alternative<Sequence>(value_); }
    bool isMap() const { return std::holds_alternative<Map>(value_); }

    // Typed reads. Each throws Error with the location, what was found and what was allowed.
    const std::string& text() const;
    double asDouble() const;
    long long asInteger() const;
    bool asBool() const;
    const Sequence& items() const;
    const Map& entries() const;
    /// For changing values; keys stay as they are.
    std::span<Entry> entries();

    // Typed reads that answer whether the value is such a one.
    std::optional<double> tryDouble() const;
    std::optional<long long> tryInteger() const;
    std::optional<bool> tryBool() const;

    /// The entry of a map, or null. `this` must be a map.
    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);
    /// Where the key itself stands (for "unknown key" messages); the map's place when not known.
    const SourceLocation& keyLocation(std::string_view key) const;
    /// Adds or replaces an entry; a null node becomes a map.
    void set(const std::string& key, Node value);
    void set(const std::string& key, Node value, SourceLocation keyWhere);
    bool erase(std::string_view key);
    /// Follows "a.b.c"; sets it, making maps on the way. Throws Error when a step is no map.
    void setPath(std::string_view dottedPath, Node value);

    /// Equal content, wherever it stands. Numbers compare as numbers (1.0 equals 1).
    bool sameContent(const Node& other) const;

    nlohmann::ordered_json toJson() const;
    /// One line, for messages and titles: `256`, `[1, 2]`, `{a: 1}`.
    std::string toFlowText() const;

  private:
    struct Scalar {
        std::string text;
        enum class Style { Plain, Quoted, Block } style;  // "12" is text, not a number
    };
    const Scalar* plain() const;  // null: none, or one that is text

    std::variant<std::monostate, Scalar, Sequence, Map> value_;
    SourceLocation location_;
};

/// An entry of a map: `for (const auto& [key, value] : node.entries())`.
class Node::Entry {
  public:
    Entry(std::string key, Node given, SourceLocation keyWhere = {})
        : value(std::move(given)), key_(std::move(key)), keyWhere_(std::move(keyWhere)) {}
    const std::string& key() const { return key_; }

    template <std::size_t index>
    const auto& get() const {
        if constexpr (index == 0) {
            return key();
        } else {
            return value;
        }
    }
    template <std::size_t index>
    auto& get() {
        if constexpr (index == 0) {
            return key();
        } else {
            return value;
        }
    }

    Node value;

  private:
    friend class Node;
    std::string key_;
    SourceLocation keyWhere_;
};

/// Parses one YAML document (JSON is YAML); an empty one is null. Throws Error with
/// file:line:column on syntax errors, duplicate keys, tags, merge keys, keys that are no text,
/// anchors that expand beyond 100,000 nodes, more than one document, and nesting deeper than 64.
Node parseYaml(std::string_view text, const std::string& fileName);
Node parseYamlFile(const std::filesystem::path& path);

/// The same of JSON (json_shape.h parses it); every node has `where` as its place.
Node nodeFromJson(const nlohmann::ordered_json& json, const SourceLocation& where = {});

/// `over` laid on `base`: maps merge key by key, everything else is replaced. An explicit null
/// removes.
Node merged(const Node& base, const Node& over);

}  // namespace gfxrepro

template <>
struct std::tuple_size<gfxrepro::Node::Entry> : std::integral_constant<std::size_t, 2> {};
template <>
struct std::tuple_element<0, gfxrepro::Node::Entry> {
    using type = const std::string;
};
template <>
struct std::tuple_element<1, gfxrepro::Node::Entry> {
    using type = gfxrepro::Node;
};
