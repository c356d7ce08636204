// The shape of a JSON document, as a list of its members: checked where the document is opened, so
// that what is wrong is said with file and place, and nobody below has to ask.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.h"

namespace gfxrepro {

using Json = nlohmann::ordered_json;

/// Line: a text without control characters, which people are shown. Int: a whole number that fits
/// into one. Infinite: a number, or "inf" or "-inf", which JSON has not. The plural ones: a list or
/// an object of such.
enum class JsonKind {
    Text,
    Line,
    Boolean,
    Int,
    Whole,
    Number,
    Infinite,
    Object,
    List,
    Texts,
    Lines,
    Ints,
    Objects
};

struct JsonMember {
    const char* place;  // a JSON pointer
    JsonKind kind;
    bool isRequired = true;
};

/// How deep JSON may be nested: the library's copies and texts recurse, and a file of brackets
/// alone would take the whole stack. More than anything that the program writes has.
constexpr int kMostJsonLevels = 200;
/// Whether brackets outside of strings are open deeper than that, at any place of the text.
bool isTooDeepJson(std::string_view text);
/// Throws Error(where, …) for what is nested deeper than kMostJsonLevels.
void requireShallowJson(std::string_view text, const SourceLocation& where);
/// The text as an object; none for any other, as a line that was torn. Throws Error(where, …) for a
/// key that stands twice in one object, and as requireShallowJson().
std::optional<Json> jsonObjectIn(std::string_view text, const SourceLocation& where);
/// The same; throws Error(where, …) for any other text, too.
Json parseJsonObject(std::string_view text, const SourceLocation& where);

/// Throws Error(where, …) for a member that is missing or of another kind: "'/gl/vendor' is number;
/// expected text". `prefix` stands before the places.
void requireMembers(const Json& object, std::span<const JsonMember> members,
                    const SourceLocation& where, const std::string& prefix = "");
/// … of each of the list or object at `place`, where it is there.
void requireEach(const Json& object, const char* place, std::span<const JsonMember> members,
                 const SourceLocation& where, const std::string& prefix = "");
/// … of the list at `place`, whose rows are lists of values of these kinds.
void requireRows(const Json& object, const char* place, std::span<const JsonKind> columns,
                 const SourceLocation& where);

}  // namespace gfxrepro
