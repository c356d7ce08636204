// What readers of a file's sections share.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/node.h"
#include "engine/core/number_range.h"

namespace gfxrepro {

/// Throws Error at the first key of `map` that is not among `allowed`, with the nearest; `what`
/// begins the message ("layout"). Throws too when `map` is no map. `noun`: what a key is.
void requireKeys(const Node& map, std::string_view what, std::span<const std::string> allowed,
                 std::string_view noun = "key");

/// Throws Error "WHAT is VALUE; allowed: ALLOWED" at the value's place.
[[noreturn]] void throwNotAllowed(const Node& value, std::string_view what,
                                  std::string_view allowed);

/// `text` of one line that is not empty. Throws Error for another.
const std::string& lineOf(const Node& node, std::string_view what);

/// The number that `node` is. Throws Error "WHAT is VALUE; allowed: RANGE" for another one, and
/// "…; allowed: a number, RANGE" for what is none.
double numberIn(const Node& node, const NumberRange& range, std::string_view what,
                std::string_view unit = "");
/// Throws Error "WHAT is VALUE; allowed: true | false" for another.
bool flagOf(const Node& node, std::string_view what);
/// The place of the name that `node` is among `names`. Throws Error "WHAT is VALUE; allowed: a | b"
/// for another.
std::size_t choiceOf(const Node& node, std::span<const std::string> names, std::string_view what);

/// A share, as a percentage ("25%", "25 %") or a fraction; none for another text, and for a
/// fraction beyond 1, where the sign is likely forgotten.
std::optional<double> fractionOf(const Node& node);

/// Equal when the contents are (1.0 and 1, x and 'x'): a key for sets.
std::string contentKey(const Node& node);

/// Whether `value` equals `pattern`, or one of its items when it is a list.
bool matchesAny(const Node& value, const Node& pattern);

}  // namespace gfxrepro
