#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/claim_operands.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using Names = std::vector<std::string>;
using Type = ClaimSpec::Type;

/// Reads one claim. `what_` begins the messages: "claim 'V1'".
class ClaimParser {
  public:
    ClaimParser(std::string id, const Node& node, const SourceLocation& where,
                const TableNames& names, bool hasPrinted)
        : node_(node), names_(names), hasPrinted_(hasPrinted), what_("claim '" + id + "'") {
        claim_.id = std::move(id);
        claim_.location = where;
    }

    ClaimSpec read() {
        const Kind& kind = kindOf();
        Names allowed = keysOf("claim");
        for (std::string& key : keysOf(fmt::format("claim.{}", kind.key))) {
            allowed.push_back(std::move(key));
        }
        requireKeys(node_, what_, allowed);
        claim_.type = kind.type;
        readCommon();
        (this->*kind.readOperands)(*node_.find(kind.key));
        (this->*kind.readRequired)();
        requireRoom();
        readProvenance(node_, what_, claim_);
        return std::move(claim_);
    }

  private:
    /// A kind of claim, and the key that names it; the schema has the keys that say more.
    struct Kind {
        std::string_view key;
        Type type;
        void (ClaimParser::*readOperands)(const Node&);
        void (ClaimParser::*readRequired)();
    };
    static const std::array<Kind, 9> kKinds;

    const Kind& kindOf() const {
        if (!node_.isMap()) throwNotAllowed(node_, what_, "a map");
        const Kind* found = nullptr;
        for (const Kind& kind : kKinds) {
            if (!node_.find(kind.key)) continue;
            if (found) {
                throw Error(
                    node_.keyLocation(kind.key),
                    fmt::format("{} is of two types, '{}' and '{}'", what_, found->key, kind.key));
            }
            found = &kind;
        }
        if (found) return *found;
        Names names;
        for (const Kind& kind : kKinds) names.emplace_back(kind.key);
        throw Error(claim_.location, what_ + " has no type; allowed: " + joined(names));
    }

    const Node& require(std::string_view key) const {
        const Node* value = node_.find(key);
        if (!value) throw Error(claim_.location, what_ + " needs '" + std::string(key) + "'");
        return *value;
    }

    void readCommon() {
        claim_.text = lineOf(require("says"), what_ + ": says");
        if (const Node* statistic = node_.find("statistic")) {
            requireStatistic(*statistic);
            claim_.statistic = statistic->text();
        }
        if (const Node* device = node_.find("device")) {
            const bool isGpu = device->isScalar() && device->text() == "gpu";
            const bool isAny = device->isScalar() && device->text() == "any";
            if (!isGpu && !isAny) throwNotAllowed(*device, what_ + ": device", "any | gpu");
            claim_.device = isGpu ? ClaimSpec::Device::Gpu : ClaimSpec::Device::Any;
        }
        if (const Node* profile = node_.find("profile")) {
            const std::string name = profile->isScalar() ? profile->text() : "";
            if (name != "quick" && name != "full" && name != "paper") {
                throwNotAllowed(*profile, what_ + ": profile", "quick | full | paper");
            }
            claim_.profile = name;
        }
        if (const Node* across = node_.find("across")) readAcross(*across);
        if (const Node* at = node_.find("at"))
            claim_.at = readRowFilter(*at, what_ + ": at", names_);
    }

    /// From here on the axis and the columns have changed places.
    void readAcross(const Node& across) {
        const std::string axis = lineOf(across, what_ + ": across");
        const auto found = std::find(names_.rowAxes.begin(), names_.rowAxes.end(), axis);
        if (found == names_.rowAxes.end()) {
            throwNotAllowed(across, what_ + ": across", joined(names_.rowAxes, " | "));
        }
        claim_.across = axis;
        names_.rowAxes.erase(found);
        names_.rowAxes.emplace_back(kColumnAxis);
        if (names_.hasAllColumns) {
            for (const std::string& label : names_.columns) {
                names_.rowValues[kColumnAxis].push_back(Node::scalar(label, {}, true));
            }
        }
        const auto known = names_.rowValues.find(axis);
        names_.hasAllColumns = known != names_.rowValues.end();
        names_.columns.clear();
        if (!names_.hasAllColumns) return;
        for (const Node& value : known->second) names_.columns.push_back(value.text());
    }

    void readOne(const Node& node) { addOperands(node, {lineOf(node, what_)}); }

    void readOrdered(const Node& node) {
        addOperands(node, sidesOf(lineOf(node, what_ + ": order"), "<", names_.columns));
        if (claim_.operands.size() < 2) throwNotAllowed(node, what_ + ": order", "a < b < …");
    }

    void readSides(const Node& node) {
        addOperands(node, sidesOf(lineOf(node, what_ + ": ratio"), " / ", names_.columns));
        if (claim_.operands.size() != 2) throwNotAllowed(node, what_ + ": ratio", "a / b");
    }

    void readList(const Node& node) {
        for (const Node& item : node.isSequence() ? node.items() : Node::Sequence{node}) {
            addOperands(item, {lineOf(item, what_)});
        }
        if (claim_.operands.empty()) throwNotAllowed(node, what_, "a column, or a list");
    }

    void readTwo(const Node& node) {
        readList(node);
        if (claim_.operands.size() != 2) throwNotAllowed(node, what_ + ": crossover", "[a, b]");
    }

    void addOperands(const Node& node, const Names& texts) {
        for (const std::string& operand : texts) {
            if (operand.empty()) throwNotAllowed(node, what_, "an expression over columns");
            requireColumns(operand, node);
            if (std::ranges::find(claim_.operands, operand) != claim_.operands.end()) {
                throw Error(node.location(),
                            fmt::format("{} compares '{}' with itself", what_, operand));
            }
            claim_.operands.push_back(operand);
        }
    }

    /// The columns that the operand names are there, as far as they are known.
    void requireColumns(const std::string& operand, const Node& node) const {
        if (!names_.hasAllColumns) return;
        for (const OperandPiece& piece : operandPieces(operand, names_.columns)) {
            if (!piece.problem.empty()) throw Error(node.location(), what_ + ": " + piece.problem);
        }
    }

    void readNothing() {}

    void readRatio() {
        readLow("at_least");
        readHigh("at_most");
        readPair("between");
        requireSome("at_least, more_than, at_most, less_than or between");
    }

    void readTrend() {
        readOver("over");
        readPair("exponent");
        readDirection();
    }

    void readIndependence() {
        readOver("of");
        readWithin();
    }

    void readBounds() {
        readLow("above");
        readHigh("below");
        requireSome("above, more_than, below or less_than");
    }

    void readTolerance() {
        requirePrinted();
        readWithin();
    }

    void readCrossing() {
        readOver("over");
        require("between");
        readPair("between");
    }

    /// The bound under one of two keys; true for the second, which excludes the bound itself.
    bool readBound(std::string_view key, std::string_view excluding, std::optional<double>& bound) {
        const Node* included = node_.find(key);
        const Node* excluded = node_.find(excluding);
        if (included && excluded) {
            throw Error(excluded->location(), what_ + ": '" + std::string(key) + "' and '" +
                                                  std::string(excluding) + "'; one is allowed");
        }
        const Node* value = included ? included : excluded;
        if (value) bound = value->asDouble();
        if (claim_.low && claim_.high && *claim_.low > *claim_.high) {
            throw Error(value->location(), what_ + ": the lower bound exceeds the upper");
        }
        return excluded != nullptr;
    }

    void readLow(std::string_view key) {
        claim_.isLowExcluded = readBound(key, "more_than", claim_.low);
    }

    void readHigh(std::string_view key) {
        claim_.isHighExcluded = readBound(key, "less_than", claim_.high);
    }

    void readPair(std::string_view key) {
        const Node* pair = node_.find(key);
        if (!pair) return;
        const std::string what = what_ + ": " + std::string(key);
        if (claim_.low || claim_.high) throw Error(pair->location(), what + " beside other bounds");
        if (!pair->isSequence() || pair->items().size() != 2) {
            throwNotAllowed(*pair, what, "[low, high]");
        }
        claim_.low = pair->items()[0].asDouble();
        claim_.high = pair->items()[1].asDouble();
        if (*claim_.low > *claim_.high) throwNotAllowed(*pair, what, "[low, high], low first");
    }

    /// Bounds of which one excludes itself leave nothing where they are one number.
    void requireRoom() const {
        if (!claim_.isLowExcluded && !claim_.isHighExcluded) return;
        if (!claim_.low || !claim_.high || *claim_.low < *claim_.high) return;
        const Node& bound = *node_.find(claim_.isHighExcluded ? "less_than" : "more_than");
        throwNotAllowed(bound, what_ + ": " + (claim_.isHighExcluded ? "less_than" : "more_than"),
                        "bounds with a number between them");
    }

    void requireSome(const std::string& keys) const {
        if (!claim_.low && !claim_.high) throw Error(claim_.location, what_ + " needs " + keys);
    }

    void readOver(std::string_view key) {
        const Node& over = require(key);
        const std::string& name = lineOf(over, what_ + ": " + std::string(key));
        Names known = names_.rowAxes;
        known.insert(known.end(), names_.columns.begin(), names_.columns.end());
        const bool isKnown = std::find(known.begin(), known.end(), name) != known.end();
        if (!isKnown && names_.hasAllColumns) {
            throw Error(over.location(), what_ + ": '" + name +
                                             "' is neither a row axis nor a column" +
                                             suggestion(name, known));
        }
        claim_.over = name;
    }

    void readDirection() {
        if (const Node* direction = node_.find("direction")) {
            const std::string name = direction->isScalar() ? direction->text() : "";
            claim_.direction = name == "increasing" ? 1 : name == "decreasing" ? -1 : 0;
            if (claim_.direction == 0) {
                throwNotAllowed(*direction, what_ + ": direction", "increasing | decreasing");
            }
        }
        if (const Node* strictly = node_.find("strictly")) {
            claim_.isStrict = strictly->asBool();
            if (claim_.direction == 0) {
                throw Error(strictly->location(), what_ + ": strictly needs 'direction'");
            }
        }
        if (claim_.direction == 0) requireSome("exponent or direction");
    }

    void readWithin() {
        const Node& within = require("within");
        claim_.high = fractionOf(within);
        if (!claim_.high || *claim_.high < 0.0) {
            throwNotAllowed(within, what_ + ": within", "a percentage as 25%, or a fraction 0 … 1");
        }
    }

    void readFalseAlarms() {
        constexpr double kMost = 0.1;  // more would call a coin a test
        const Node& rate = require("false_alarms");
        claim_.low = fractionOf(rate);
        if (!claim_.low || *claim_.low <= 0.0 || *claim_.low > kMost) {
            throwNotAllowed(rate, what_ + ": false_alarms",
                            "a percentage as 1%, or a fraction, above 0 and to 10%");
        }
    }

    void readEquals() {
        const Node& equals = require("equals");
        if (equals.isScalar() && equals.text() == "printed") {
            requirePrinted();
            return;
        }
        if (!equals.tryDouble())
            throwNotAllowed(equals, what_ + ": equals", "a number, or printed");
        claim_.low = claim_.high = equals.tryDouble();
    }

    void requirePrinted() const {
        if (!hasPrinted_) throw Error(claim_.location, what_ + " needs printed values");
    }

    const Node& node_;
    TableNames names_;
    bool hasPrinted_;
    std::string what_;
    ClaimSpec claim_;
};

using Parser = ClaimParser;
const std::array<Parser::Kind, 9> Parser::kKinds = {{
    {"order", Type::Order, &Parser::readOrdered, &Parser::readNothing},
    {"ratio", Type::Ratio, &Parser::readSides, &Parser::readRatio},
    {"trend", Type::Trend, &Parser::readOne, &Parser::readTrend},
    {"independent", Type::Independent, &Parser::readList, &Parser::readIndependence},
    {"bound", Type::Bound, &Parser::readOne, &Parser::readBounds},
    {"exact", Type::Exact, &Parser::readOne, &Parser::readEquals},
    {"tolerance", Type::Tolerance, &Parser::readOne, &Parser::readTolerance},
    {"crossover", Type::Crossover, &Parser::readTwo, &Parser::readCrossing},
    {"same_mean", Type::SameMean, &Parser::readOne, &Parser::readFalseAlarms},
}};

}  // namespace

std::vector<ClaimSpec> readClaims(const Node& node, const TableNames& names, bool hasPrinted) {
    if (!node.isMap()) throwNotAllowed(node, "claims", "a map {id: claim}");
    std::vector<ClaimSpec> claims;
    for (const auto& [id, claim] : node.entries()) {
        claims.push_back(ClaimParser(id, claim, node.keyLocation(id), names, hasPrinted).read());
    }
    return claims;
}

}  // namespace gfxrepro::config
