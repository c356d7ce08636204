// ratio: a / b, of columns; m=a / m=b, of the rows with these values of an axis.
#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"
#include "runner/claims/kinds/operands.h"

namespace gfxrepro::claims {

namespace {

struct RatioKeys : GivenBounds {
    GivenKey ratio;
};
const KeyTable<RatioKeys>& ratioTable() {
    static const KeyTable<RatioKeys> table = boundedTable<RatioKeys>(
        {{&RatioKeys::ratio, "ratio", "a / b | AXIS=VALUE / AXIS=VALUE", "required",
          "the ratio lies within bounds: of columns, or of the rows with these values of an axis, "
          "which implies `across`",
          types::text()}});
    return table;
}

/// The axis and the value of "method=slices"; empty of a comparison and of everything else.
std::pair<std::string, std::string> valueOn(std::string_view side) {
    const std::size_t equals = side.find('=');
    const bool isOne = equals != side.npos && equals > 0 && equals + 1 < side.size() &&
                       side.find_first_of("=<>!", equals + 1) == side.npos &&
                       side.find_first_of("<>! '\"[(") > equals;
    if (!isOne) return {};
    return {std::string(side.substr(0, equals)), std::string(side.substr(equals + 1))};
}

std::optional<std::string> axisOfRatio(const Node& operands, const std::string& what) {
    const std::vector<std::string> sides = sidesOf(lineOf(operands, what), " / ", {});
    if (sides.size() != 2) return std::nullopt;
    const std::string axis = valueOn(sides[0]).first;
    if (axis.empty() || valueOn(sides[1]).first != axis) return std::nullopt;
    return axis;
}

void readRatio(const ClaimKeys& keys, const RatioKeys& given, ClaimSpec& claim) {
    const GivenKey& ratio = given.ratio;
    if (axisOfRatio(*ratio, keys.what)) {
        for (const std::string& side : sidesOf(ratio->text(), " / ", {})) {
            keys.addOperands(*ratio, {valueOn(side).second}, claim);
        }
    } else {
        keys.readSides(ratio, " / ", claim);
    }
    if (claim.operands.size() != 2) keys.refuse(ratio, "a / b");
    keys.readBounds(given, claim);
}

std::vector<ClaimPart> ratioParts(const ClaimSpec& claim) {
    const auto ratio = [](const GroupPoint& group) {
        return ratioOf(group.operands[0][0], group.operands[1][0]);
    };
    return {{{0, 1}, ratio, rangeOf(claim, joined(claim.operands, " / "))}};
}

}  // namespace

Kind ratio() {
    Kind kind{ratioTable().section(), readBy<ratioTable, readRatio>, ratioParts,
              Kind::Compares::Operands, Scale::Logarithmic};
    kind.valuesForm = "AXIS=VALUE / AXIS=VALUE";
    kind.axisOf = axisOfRatio;
    return kind;
}

}  // namespace gfxrepro::claims
