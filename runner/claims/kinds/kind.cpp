#include "runner/claims/kinds/kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/metrics/alike.h"
#include "runner/claims/kinds/operands.h"

namespace gfxrepro::claims {

using namespace types;
using Texts = std::vector<std::string>;

// The kinds, each in a file of its name: to add one, its name in both lists.
Kind order(), ratio(), trend(), independent(), bound(), exact(), tolerance(), crossover(),
    sameMean();

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {order(), ratio(),     trend(),     independent(), bound(),
                                          exact(), tolerance(), crossover(), sameMean()};
    return all;
}

std::vector<ClaimPart> partsOf(const ClaimSpec& claim) {
    std::vector<ClaimPart> parts = claim.kind->parts(claim);
    for (ClaimPart& part : parts) {
        if (part.onTimes) continue;
        part.onTimes =
            asItself(part.measuredName, part.quantity, part.requirement, claim.kind->scale);
    }
    return parts;
}

// Keys

namespace {

/// The fractions of a share: beyond 1 the sign of a percentage is likely forgotten (fractionOf).
NumberRange asFraction(NumberRange range) {
    range.most = std::min(range.most, 1.0);
    return range;
}

}  // namespace

const Node* Kind::find(const Node& claim, std::string_view key) const {
    GFXREPRO_ASSERT(std::ranges::find(section.keys, key, &SchemaKey::name) != section.keys.end());
    return claim.find(key);
}

const Node* ClaimKeys::find(std::string_view key) const {
    return kind.find(node, key);
}

const Node& ClaimKeys::require(std::string_view key) const {
    const Node* value = find(key);
    if (!value) throw Error(where, fmt::format("{} needs '{}'", what, key));
    return *value;
}

void ClaimKeys::requirePrinted() const {
    if (!hasPrinted) throw Error(where, what + " needs printed values");
}

void ClaimKeys::refuse(const Node& value, std::string_view key, std::string_view allowed) const {
    throwNotAllowed(value, key.empty() ? what : fmt::format("{}: {}", what, key), allowed);
}

void ClaimKeys::fail(const Node& at, const std::string& text) const {
    throw Error(at.location(), what + ": " + text);
}

void ClaimKeys::readOne(ClaimSpec& claim) const {
    addOperands(operands, {lineOf(operands, what)}, claim);
}

void ClaimKeys::readList(ClaimSpec& claim) const {
    const bool isList = operands.isSequence();
    for (const Node& item : isList ? operands.items() : Node::Sequence{operands}) {
        addOperands(item, {lineOf(item, what)}, claim);
    }
    if (claim.operands.empty()) refuse(operands, "", "a column, or a list");
}

void ClaimKeys::readSides(std::string_view separator, ClaimSpec& claim) const {
    const std::string& text = lineOf(operands, what + ": " + claim.kind->name());
    addOperands(operands, sidesOf(text, separator, columns), claim);
}

std::string acrossHint(const std::string& value, const std::string& axis) {
    return fmt::format("; '{0}' is a value of row axis '{1}': add 'across: {1}'", value, axis);
}

/// What to write where one of the texts is the value of a row axis; else empty.
std::string ClaimKeys::acrossHint(const Texts& texts) const {
    for (const auto& [axis, values] : rowValues) {
        if (std::ranges::find(rowAxes, axis) == rowAxes.end() || axis == kColumnAxis) continue;
        for (const Node& value : values) {
            if (!value.isScalar() || std::ranges::find(texts, value.text()) == texts.end())
                continue;
            return claims::acrossHint(value.text(), axis);
        }
    }
    return "";
}

/// The columns that an operand names must be there, as far as they are known.
void ClaimKeys::addOperands(const Node& at, const Texts& texts, ClaimSpec& claim) const {
    for (const std::string& operand : texts) {
        if (operand.empty()) refuse(at, "", "an expression over columns");
        for (const OperandPiece& piece : operandPieces(operand, columns)) {
            if (piece.text == "[") {
                fail(at, fmt::format("'{}' reads a row by its name; allowed: a column of the "
                                     "layout that does, 'NAME: {{of: \"{}\"}}', or rows held "
                                     "against each other, 'ratio: AXIS=a / AXIS=b, of: COLUMN'",
                                     operand, operand));
            }
            const bool isKnown = hasAllColumns || (piece.isFunction && !columns.empty());
            if (piece.problem.empty() || !isKnown) continue;
            fail(at, piece.problem + acrossHint({operand, std::string(piece.text)}));
        }
        if (std::ranges::find(claim.operands, operand) != claim.operands.end()) {
            throw Error(at.location(), fmt::format("{} compares '{}' with itself", what, operand));
        }
        claim.operands.push_back(operand);
    }
}

/// How many rows there are along a row axis, or in all where it is a column; at least, where the
/// values of an axis are not known.
std::size_t ClaimKeys::rowsAlong(const std::string& over, const ClaimSpec& claim) const {
    const bool isAxis = std::ranges::find(rowAxes, over) != rowAxes.end();
    std::size_t rows = 1;
    for (const std::string& axis : rowAxes) {
        if (isAxis && axis != over) continue;
        const auto known = rowValues.find(axis);
        if (known == rowValues.end()) return 2;
        const auto at = std::ranges::find(claim.at, axis, &decltype(claim.at)::value_type::first);
        rows *=
            static_cast<std::size_t>(std::ranges::count_if(known->second, [&](const Node& value) {
                return at == claim.at.end() || matchesAny(value, Node::sequence(at->second));
            }));
    }
    return rows;
}

void ClaimKeys::readOver(std::string_view key, ClaimSpec& claim) const {
    const Node& over = require(key);
    const std::string& name = lineOf(over, fmt::format("{}: {}", what, key));
    Texts known = rowAxes;
    known.insert(known.end(), columns.begin(), columns.end());
    if (hasAllColumns && std::ranges::find(known, name) == known.end()) {
        const std::vector<OperandPiece> pieces = operandPieces(name, known);
        const bool isExpression =
            pieces.size() > 1 && std::ranges::any_of(pieces, [](const OperandPiece& piece) {
                return piece.column.has_value();
            });
        if (!isExpression) {
            fail(over, fmt::format("'{}' is neither a row axis nor a column{}", name,
                                   suggestion(name, known)));
        }
        for (const OperandPiece& piece : pieces) {
            if (!piece.problem.empty()) fail(over, piece.problem);
        }
    }
    if (rowsAlong(name, claim) < 2) {
        fail(over, fmt::format("there is one row along '{}'; allowed: two or more", name));
    }
    claim.over = name;
}

void ClaimKeys::readBounds(ClaimSpec& claim, const char* other) const {
    // True for the second key, which excludes the bound itself.
    const auto readBound = [&](const char* including, const char* excluding, auto& bound) {
        const Node *included = find(including), *excluded = find(excluding);
        if (included && excluded) {
            fail(*excluded, fmt::format("'{}' and '{}'; one is allowed", including, excluding));
        }
        const Node* value = included ? included : excluded;
        if (value) {
            bound =
                numberIn(*value, {}, fmt::format("{}: {}", what, included ? including : excluding));
        }
        if (claim.low && claim.high && *claim.low > *claim.high) {
            fail(*value, "the lower bound exceeds the upper");
        }
        return excluded != nullptr;
    };
    claim.isLowExcluded = readBound("at_least", "more_than", claim.low);
    claim.isHighExcluded = readBound("at_most", "less_than", claim.high);
    if (!claim.hasBound() && !(other && find(other))) {
        throw Error(where,
                    fmt::format("{} needs at_least, more_than, at_most{}{}", what,
                                other ? ", less_than or " : " or less_than", other ? other : ""));
    }
    // Bounds of which one excludes itself leave nothing where they are one number.
    const bool isOpen = claim.isLowExcluded || claim.isHighExcluded;
    if (!isOpen || !claim.low || !claim.high || *claim.low < *claim.high) return;
    const char* key = claim.isHighExcluded ? "less_than" : "more_than";
    refuse(*find(key), key, "bounds with a number between them");
}

double ClaimKeys::readShare(std::string_view key, const NumberRange& range) const {
    const Node& share = require(key);
    const std::optional<double> fraction = fractionOf(share);
    if (fraction && range.has(*fraction)) return *fraction;
    refuse(share, key, "a percentage as 25%, or a fraction, " + asFraction(range).text());
}

// Their schema

SchemaSection sectionOf(SchemaKey first, std::vector<SchemaKey> further, Json conditions) {
    first.absent = "required";
    SchemaSection section{"claim." + first.name, "claims.ID.", "", false};
    section.keys.push_back(first);
    for (SchemaKey& key : further) section.keys.push_back(std::move(key));
    section.conditions = std::move(conditions);
    return section;
}

SchemaKey overKey(const char* key, const char* doc) {
    return {key, "row axis | column | expression", "required", doc, text()};
}

SchemaKey shareKey(const char* key, const NumberRange& range, const char* doc) {
    const NumberRange fraction = asFraction(range);
    return {
        key, "25% | fraction, " + fraction.text(), "required", doc,
        anyOf({{{"type", "string"}, {"pattern", R"(^\s*[0-9.eE+-]+\s*%$)"}}, number(fraction)})};
}

SchemaSection boundedSection(SchemaKey first, std::vector<SchemaKey> further, const char* other) {
    further.push_back(numberKey("at_least", {}, "none", "lower bound"));
    further.push_back(numberKey("more_than", {}, "none", "lower bound, itself excluded"));
    further.push_back(numberKey("at_most", {}, "none", "upper bound"));
    further.push_back(numberKey("less_than", {}, "none", "upper bound, itself excluded"));
    Json conditions = needsOneOf({{"at_least"}, {"more_than"}, {"at_most"}, {"less_than"}});
    if (other) conditions["anyOf"].push_back({{"required", Json::array({other})}});
    return sectionOf(std::move(first), std::move(further), std::move(conditions));
}

// Ranges

Requirement rangeOf(const ClaimSpec& claim, const std::string& name, bool isPercent) {
    Requirement requirement;
    requirement.low = claim.low.value_or(-kInfinity);
    requirement.high = claim.high.value_or(kInfinity);
    requirement.isLowExcluded = claim.isLowExcluded;
    requirement.isHighExcluded = claim.isHighExcluded;
    requirement.isPercent = isPercent;
    requirement.text = name + " " + rangeText(requirement);
    return requirement;
}

std::string quantityText(double value, const Requirement& requirement) {
    if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
    return requirement.isPercent ? fmt::format("{:.4g} %", value * 100.0)
                                 : fmt::format("{:.4g}", value);
}

std::string rangeText(const Requirement& requirement) {
    const std::string low = quantityText(requirement.low, requirement);
    const std::string high = quantityText(requirement.high, requirement);
    if (std::isinf(requirement.high)) return (requirement.isLowExcluded ? "> " : "≥ ") + low;
    if (std::isinf(requirement.low)) return (requirement.isHighExcluded ? "< " : "≤ ") + high;
    return fmt::format("in {}{}, {}{}", requirement.isLowExcluded ? '(' : '[', low, high,
                       requirement.isHighExcluded ? ')' : ']');
}

double distanceToBound(double value, const Requirement& requirement) {
    return std::min(std::abs(value - requirement.low), std::abs(requirement.high - value));
}

Contrasts asItself(std::string name, GroupNumber quantity, Requirement requirement, Scale scale) {
    Contrast contrast{std::move(name), std::move(quantity), std::move(requirement), scale};
    if (scale == Scale::Linear) {
        contrast.distance = [range = contrast.requirement](const GroupPoint&, double value) {
            return distanceToBound(value, range);
        };
    }
    if (scale == Scale::Ranks) contrast.distance = [](const auto&, double) { return kInfinity; };
    return [contrast](const GroupPoint&) { return std::vector<Contrast>{contrast}; };
}

// Arithmetic

double relativeDifference(double left, double right) {
    if (metrics::areAlike(left, right)) return 0.0;
    if (std::isinf(left) || std::isinf(right)) return left < right ? 1.0 : -1.0;
    return (right - left) / std::max(std::abs(left), std::abs(right));
}

double ratioOf(double left, double right) {
    const double ratio = left / right;
    return !std::isnan(ratio) && metrics::areAlike(left, right) ? 1.0 : ratio;
}

double lesser(double a, double b) {
    return std::isnan(a) || b > a ? a : b;
}

double greater(double a, double b) {
    return std::isnan(a) || b < a ? a : b;
}

bool arePositive(const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double value) { return value > 0.0; });
}

std::vector<std::size_t> rowsByX(const GroupPoint& group) {
    std::vector<std::size_t> order(group.x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return group.x[a] < group.x[b]; });
    return order;
}

}  // namespace gfxrepro::claims
