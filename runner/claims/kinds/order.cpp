// order: a < b < c, of columns; [n=1, n=2], of the rows with these values of an axis.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"
#include "runner/claims/kinds/operands.h"

namespace gfxrepro::claims {

namespace {

struct OrderKeys {
    GivenKey order;
};
const KeyTable<OrderKeys>& orderTable() {
    static const KeyTable<OrderKeys> table = kindTable<OrderKeys>(
        {{&OrderKeys::order, "order", "a < b < c | [AXIS=VALUE, …] | [values]", "required",
          "in this order: of columns, or of the rows with these values of an axis, column by "
          "column, which implies `across`; words that one swept axis alone has need no AXIS=",
          types::anyOf({types::text(), types::listOf(types::text(), 2)})}});
    return table;
}

/// The axis and the value of "light_ratio=0.25".
std::pair<std::string, std::string> valueIn(const Node& item, const std::string& what) {
    const std::string& text = lineOf(item, what);
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals >= text.size() - 1)
        throwNotAllowed(item, what, "AXIS=VALUE, or words that one swept axis alone has");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

std::optional<std::string> axisOf(const Node& operands, const std::string& what) {
    std::optional<std::string> axis;
    for (const Node& item : operands.isSequence() ? operands.items() : Node::Sequence()) {
        const std::string own = valueIn(item, what).first;
        if (axis.value_or(own) != own) {
            throw Error(item.location(), fmt::format("{}: '{}' and '{}' are two axes; allowed: "
                                                     "values of one",
                                                     what, *axis, own));
        }
        axis = own;
    }
    return axis;
}

/// Values in the place of columns read as if they were compared as such: "0.25 < 4".
void refuseValues(const ClaimKeys& keys, const GivenKey& order, const ClaimSpec& claim) {
    const std::vector<std::string> sides =
        sidesOf(lineOf(*order, order.in(keys.what)), "<", keys.columns);
    for (const auto& [axis, values] : keys.rowValues) {
        std::string list;
        const bool areValues = std::ranges::all_of(sides, [&](const std::string& side) {
            list += fmt::format("{}{}={}", list.empty() ? "" : ", ", axis, side);
            const bool isColumn = std::ranges::find(keys.columns, side) != keys.columns.end();
            return isColumn == claim.across.has_value() &&
                   std::ranges::any_of(values, [&](const Node& value) {
                       return value.isScalar() && value.text() == side;
                   });
        });
        if (areValues && claim.across.value_or(axis) == axis) {
            keys.refuse(order, "[" + list + "]");
        }
    }
}

void readOrder(const ClaimKeys& keys, const OrderKeys& given, ClaimSpec& claim) {
    const GivenKey& order = given.order;
    if (order->isSequence()) {
        for (const Node& item : order->items()) {
            keys.addOperands(item, {valueIn(item, keys.what).second}, claim);
        }
    } else {
        refuseValues(keys, order, claim);
        keys.readSides(order, "<", claim);
    }
    if (claim.operands.size() < 2) {
        keys.refuse(order, "a < b < … | [AXIS=VALUE, AXIS=VALUE, …]");
    }
}

/// The smallest relative difference of neighbours over the rows.
double smallestGap(const GroupPoint& group) {
    double smallest = kInfinity;
    for (std::size_t i = 1; i < group.operands.size(); ++i) {
        for (std::size_t row = 0; row < group.operands[i].size(); ++row) {
            smallest = lesser(
                smallest, relativeDifference(group.operands[i - 1][row], group.operands[i][row]));
        }
    }
    return smallest;
}

/// The gap of each pair of neighbours.
Contrasts neighbourGaps(const Requirement& requirement) {
    return [requirement](const GroupPoint& group) {
        std::vector<Contrast> contrasts;
        for (std::size_t i = 1; i < group.operands.size(); ++i) {
            const GroupNumber gap = [i](const GroupPoint& all) {
                return smallestGap({{all.operands[i - 1], all.operands[i]}, {}});
            };
            contrasts.push_back(asItself("gap", gap, requirement, Scale::Linear)(group)[0]);
        }
        return contrasts;
    };
}

std::vector<ClaimPart> orderParts(const ClaimSpec& claim) {
    ClaimPart part{{}, smallestGap, {}, "smallest gap"};
    for (std::size_t i = 0; i < claim.operands.size(); ++i) part.operands.push_back(i);
    part.requirement.low = 0.0;
    part.requirement.isLowExcluded = true;
    part.requirement.isPercent = true;
    part.requirement.text =
        (claim.across ? *claim.across + ": " : std::string()) + joined(claim.operands, " < ");
    part.onTimes = neighbourGaps(part.requirement);
    return {part};
}

}  // namespace

Kind order() {
    Kind kind{orderTable().section(), readBy<orderTable, readOrder>, orderParts};
    kind.boundedForm = "'ratio: b / a' of two of them, or 'ratio: AXIS=b / AXIS=a', with a bound";
    kind.valuesForm = "[AXIS=VALUE, …]";
    kind.axisOf = axisOf;
    return kind;
}

}  // namespace gfxrepro::claims
