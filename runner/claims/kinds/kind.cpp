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

// The kinds, each in a file of its name: to add one, a line.
// clang-format off
#define GFXREPRO_KINDS \
    order(),           \
    ratio(),           \
    trend(),           \
    independent(),     \
    bound(),           \
    exact(),           \
    tolerance(),       \
    crossover(),       \
    sameMean()
// clang-format on
Kind GFXREPRO_KINDS;

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {GFXREPRO_KINDS};
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

void ClaimKeys::requirePrinted() const {
    if (!hasPrinted) throw Error(where, what + " needs printed values");
}

void ClaimKeys::refuse(const GivenKey& key, std::string_view allowed) const {
    throwNotAllowed(*key, key.in(what), allowed);
}

void ClaimKeys::fail(const Node& at, const std::string& text) const {
    throw Error(at.location(), what + ": " + text);
}

void ClaimKeys::readOne(const GivenKey& key, ClaimSpec& claim) const {
    addOperands(*key, {lineOf(*key, what)}, claim);
}

void ClaimKeys::readList(const GivenKey& key, ClaimSpec& claim) const {
    for (const Node& item : key->isSequence() ? key->items() : Node::Sequence{*key}) {
        addOperands(item, {lineOf(item, what)}, claim);
    }
    if (claim.operands.empty()) throwNotAllowed(*key, what, "a column, or a list");
}

void ClaimKeys::readSides(const GivenKey& key, std::string_view separator, ClaimSpec& claim) const {
    addOperands(*key, sidesOf(lineOf(*key, key.in(what)), separator, columns), claim);
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
        if (operand.empty()) throwNotAllowed(at, what, "an expression over columns");
        for (const OperandPiece& piece : operandPieces(operand, columns)) {
            if (piece.text == "[") {
                Texts forms;
                for (const Kind& kind : kinds()) {
                    if (kind.valuesForm) forms.push_back(kind.name() + ": " + kind.valuesForm);
                }
                fail(at, fmt::format("'{0}' reads a row by its name; allowed: a column of the "
                                     "layout that does, 'NAME: {{of: \"{0}\"}}', or rows held "
                                     "against each other, '{1}'",
                                     operand, fmt::join(forms, "' or '")));
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

void ClaimKeys::readOver(const GivenKey& key, ClaimSpec& claim) const {
    const Node& over = *key;
    const std::string& name = lineOf(over, key.in(what));
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

void ClaimKeys::readBounds(const GivenBounds& given, ClaimSpec& claim,
                           const GivenKey* other) const {
    // True for the second key, which excludes the bound itself.
    const auto readBound = [&](const GivenKey& included, const GivenKey& excluded, auto& bound) {
        if (included && excluded) {
            fail(*excluded,
                 fmt::format("'{}' and '{}'; one is allowed", included.name(), excluded.name()));
        }
        const GivenKey& key = included ? included : excluded;
        if (key) bound = key.number(what);
        if (claim.low && claim.high && *claim.low > *claim.high) {
            fail(*key, "the lower bound exceeds the upper");
        }
        return excluded != nullptr;
    };
    claim.isLowExcluded = readBound(given.atLeast, given.moreThan, claim.low);
    claim.isHighExcluded = readBound(given.atMost, given.lessThan, claim.high);
    if (!claim.hasBound() && !(other && *other)) {
        Texts names;
        for (const auto& [place, key] : boundKeys()) names.push_back(key.name);
        if (other) names.push_back(other->name());
        const std::string last = names.back();
        names.pop_back();
        throw Error(where, fmt::format("{} needs {} or {}", what, joined(names), last));
    }
    // Bounds of which one excludes itself leave nothing where they are one number.
    const bool isOpen = claim.isLowExcluded || claim.isHighExcluded;
    if (!isOpen || !claim.low || !claim.high || *claim.low < *claim.high) return;
    refuse(claim.isHighExcluded ? given.lessThan : given.moreThan,
           "bounds with a number between them");
}

double ClaimKeys::readShare(const GivenKey& key, const NumberRange& range) const {
    const std::optional<double> fraction = fractionOf(*key);
    if (fraction && range.has(*fraction)) return *fraction;
    refuse(key, "a percentage as 25%, or a fraction, " + asFraction(range).text());
}

// Their schema

SchemaKey overKey(const char* key, const char* doc) {
    return {key, "row axis | column | expression", "required", doc, text()};
}

SchemaKey shareKey(const char* key, const NumberRange& range, const char* doc) {
    const NumberRange fraction = asFraction(range);
    return {
        key, "25% | fraction, " + fraction.text(), "required", doc,
        anyOf({{{"type", "string"}, {"pattern", R"(^\s*[0-9.eE+-]+\s*%$)"}}, number(fraction)})};
}

const std::vector<KeyTable<GivenBounds>::Key>& boundKeys() {
    static const std::vector<KeyTable<GivenBounds>::Key> keys = {
        {&GivenBounds::atLeast, numberKey("at_least", {}, "none", "lower bound")},
        {&GivenBounds::moreThan,
         numberKey("more_than", {}, "none", "lower bound, itself excluded")},
        {&GivenBounds::atMost, numberKey(kAtMost, {}, "none", "upper bound")},
        {&GivenBounds::lessThan,
         numberKey("less_than", {}, "none", "upper bound, itself excluded")}};
    return keys;
}

Json needsOne(const std::vector<std::string>& names) {
    Json one = Json::array();
    for (const std::string& name : names) one.push_back({{"required", Json::array({name})}});
    return {{"anyOf", std::move(one)}};
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
