// A key that people write, or a parameter: declared once, where it is read. Its default, range,
// unit and meaning, what reads its value and what messages say of it all come from that
// declaration, and so do `gfxrepro describe` and the JSON schema.
#pragma once

#include <string>
#include <vector>

#include "engine/core/node.h"
#include "engine/core/number_range.h"

namespace gfxrepro {

struct KeyInfo {
    std::string name;
    std::string type;    // "integer", "number", "boolean", "text", "choice", "vector3"; or in words
    std::string absent;  // the default, as it is written; or what absence means: "none", "required"
    std::string doc;
    std::string unit = {};
    NumberRange range = {};
    std::vector<std::string> choices = {};
    std::size_t count = 0;  // of a vector's numbers

    bool isRequired() const { return absent == "required"; }
    /// "8 … 1024", "a | b | c", "".
    std::string allowed() const;
    /// The type with that: "integer, 8 … 1024 voxels", "a | b | c".
    std::string inWords() const;
};

/// What a map has at a declared key: null where it is not there, and of what is no map.
class GivenKey {
  public:
    GivenKey() = default;
    GivenKey(const Node& map, const KeyInfo& declared)
        : map_(&map),
          node_(map.isMap() ? map.find(declared.name) : nullptr),
          declared_(&declared) {}

    operator const Node*() const { return node_; }
    const Node* operator->() const { return node_; }
    const std::string& name() const { return declared_->name; }
    /// Where the key itself stands.
    const SourceLocation& where() const { return map_->keyLocation(name()); }
    /// "OWNER: KEY", which begins the messages.
    std::string in(const std::string& owner) const;

    // What is there. Each throws Error "OWNER: KEY is VALUE; allowed: …" for another value than
    // declared.
    double number(const std::string& owner = "") const;
    bool flag(const std::string& owner = "") const;
    /// The place of the choice among those that are declared.
    std::size_t choice(const std::string& owner = "") const;

  private:
    const Node* map_ = nullptr;
    const Node* node_ = nullptr;
    const KeyInfo* declared_ = nullptr;  // the table's
};

}  // namespace gfxrepro
