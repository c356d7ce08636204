// `claims:` — what all of them have. What each kind has is in runner/claims/kinds.
#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"
#include "runner/claims/kinds/operands.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;
using Names = std::vector<std::string>;
using Origin = ClaimSpec::Origin;
using BoundSource = ClaimSpec::BoundSource;
using TimeKind = ClaimSpec::TimeKind;

struct CommonKeys {
    GivenKey says, at, across, of, profile, origin, sameAs, boundFrom, kind, because;
};
const KeyTable<CommonKeys>& commonTable() {
    using C = CommonKeys;
    static const KeyTable<C> table{
        {"claim", "claims.ID.",
         fmt::format(
             "Every claim has these, and exactly one of the keys in the tables below with what "
             "belongs to it; a, b and c are expressions over columns ('gfxrepro describe TABLE' "
             "lists them), with + - * / ^, comparisons, which are 1 or 0, and the functions {}. "
             "Where columns are numbers, a number alone is a column, and within an expression '8' "
             "in quotes is.",
             fmt::join(claims::kFunctions, ", ")),
         false},
        {{&C::says, "says", "line", "required", "the claim in the paper's sense", text()},
         {&C::at, "at", "{row axis: value | [values]}", "all rows", "rows that are read", pairs()},
         {&C::across, "across", "row axis", "none",
          "a, b are its values instead of columns: so rows are compared, column by column", text()},
         {&C::of, "of", "column | [columns]", "all columns",
          "of a claim that compares rows: the columns that are read", oneOrMore(text())},
         {&C::profile, choiceKey("profile", kProfiles, "all", "the only profile it is judged in")},
         {&C::origin,
          choiceKey(
              "origin", kOrigins, "document, in a sweep ours",
              "a statement of the document; read off its numbers; our aim; true by construction; "
              "of an input fitted to it; or a statement that there is such a thing at all, which "
              "can hardly fail. Only the first is counted")},
         {&C::sameAs, "same_as", "TABLE CLAIM", "none",
          "another claim, of this table or another, that says the same truth or reads its number "
          "otherwise: beside it this one is not counted where it holds or has the same verdict",
          text()},
         {&C::boundFrom,
          choiceKey(
              "bound_from", kBoundSources, "ours, in a sweep none",
              "where the number that it requires comes from; print: it is a printed value, or two "
              "numbers about one, at most its half and its double, and met by all, unless it is an "
              "aim of ours")},
         {&C::kind,
          choiceKey("kind", kTimeKinds, "absolute; in a sweep algorithmic; or required",
                    "of a claim about time: counts of work decide; a GPU's units do; or times as "
                    "such, at the printed parameters, as where one is held against a number, which "
                    "need not say so. The last two are judged on a GPU only")},
         {&C::because, "because", "known | [known]", "none",
          "where it is known not to hold, and why, one for each device, profile and kind of "
          "scenes, what is of more behind what is of less; another verdict than the known is "
          "news, but for ambiguous; where ambiguous is known, failing is",
          oneOrMore(refTo("because"))}}};
    return table;
}

struct KnownKeys {
    GivenKey verdict, reason, shownBy, device, profile, scenes;
};
const KeyTable<KnownKeys>& knownTable() {
    using K = KnownKeys;
    static const KeyTable<K> table{
        {"because", "claims.ID.because.", "", false},
        {{&K::verdict, choiceKey("verdict", kKnownVerdicts, "required", "what it comes to")},
         {&K::reason, "reason", "line", "required",
          "the cause, in a sentence or two that a reader of the document understands", text()},
         {&K::shownBy, "shown_by", "PAGE.md#ANCHOR", "none",
          "the place in results/findings that has the numbers which prove it", text()},
         {&K::device, choiceKey("device", kDeviceClasses, "any", "on this class of devices")},
         {&K::profile, choiceKey("profile", kProfiles, "any", "in this profile")},
         {&K::scenes, choiceKey("scenes", kSceneClasses, "any",
                                "where all scenes were made of files, or none, as where a real "
                                "model is not at hand")}}};
    return table;
}

/// Which of those that may stand there it is; none where nothing does.
std::optional<std::size_t> choiceIn(const GivenKey& key, const std::string& owner) {
    return key ? std::optional(key.choice(owner)) : std::nullopt;
}

std::optional<std::string> nameIn(const GivenKey& key, const std::string& owner) {
    return choiceIn(key, owner) ? std::optional(key->text()) : std::nullopt;
}

/// An entry of `because`; `what` begins the messages.
ClaimSpec::Known readKnown(const Node& entry, const std::string& what) {
    const KnownKeys given = knownTable().read(entry, what);
    return {*nameIn(given.verdict, what),
            nameIn(given.device, what),
            nameIn(given.profile, what),
            nameIn(given.scenes, what),
            lineOf(*given.reason, given.reason.in(what)),
            optionalLine(given.shownBy, what)};
}

std::string knownPlace(const ClaimSpec::Known& known) {
    return known.device.value_or("any device") + ", " + known.profile.value_or("any profile") +
           (known.scenes ? ", scenes: " + *known.scenes : "");
}

/// The first that is of a device, profile and kind of scenes is taken: a later one may be of more,
/// never of what an earlier one has.
void requireApart(const std::vector<ClaimSpec::Known>& known, const Node::Sequence& entries,
                  const std::string& what) {
    using Place = std::array<std::optional<std::string>, 3>;
    const auto place = [](const ClaimSpec::Known& one) {
        return Place{one.device, one.profile, one.scenes};
    };
    for (std::size_t later = 1; later < known.size(); ++later) {
        for (std::size_t i = 0; i < later; ++i) {
            const ClaimSpec::Known &one = known[i], &other = known[later];
            const Place narrow = place(one), wide = place(other);
            bool areApart = false, isWithin = true;
            for (std::size_t k = 0; k < narrow.size(); ++k) {
                areApart |= narrow[k] && wide[k] && narrow[k] != wide[k];
                isWithin &= !wide[k] || narrow[k] == wide[k];
            }
            if (areApart || (isWithin && narrow != wide)) continue;
            throw Error(entries[later].location(),
                        what + " is of " + knownPlace(other) + ", and an earlier one of " +
                            knownPlace(one) +
                            "; allowed: one for each device, profile and kind of "
                            "scenes, what is of more behind what is of less");
        }
    }
}

/// Reads one claim. `what_` begins the messages: "claim 'V1'".
class ClaimParser {
  public:
    ClaimParser(std::string id, const Node& node, const SourceLocation& where,
                const TableNames& names, bool hasPrinted)
        : node_(node), names_(names), hasPrinted_(hasPrinted), what_("claim '" + id + "'") {
        claim_.id = std::move(id);
        claim_.location = where;
    }

    ClaimSpec read(bool isOfDocument) {
        claim_.kind = &kindOf();
        const Names own = claim_.kind->section.keyNames();
        Names allowed = commonTable().names();
        allowed.insert(allowed.end(), own.begin(), own.end());
        refuseBounds(own);
        requireKeys(node_, what_, allowed);
        given_ = commonTable().find(node_);
        commonTable().require(given_, claim_.location, what_);
        readCommon();
        if (given_.at) readAt();
        if (given_.of && !contains(own, given_.of.name())) readOf();
        claim_.keys = node_;
        claim_.kind->read({node_, names_.rowAxes, names_.rowValues, names_.columns,
                           names_.hasAllColumns, hasPrinted_, what_, claim_.location},
                          claim_);
        readProvenance(isOfDocument);
        return std::move(claim_);
    }

  private:
    const claims::Kind& kindOf() const {
        if (!node_.isMap()) throwNotAllowed(node_, what_, "a map");
        const claims::Kind* found = nullptr;
        Names names;
        for (const claims::Kind& kind : claims::kinds()) {
            names.push_back(kind.name());
            if (!node_.find(kind.name())) continue;
            if (found) {
                throw Error(node_.keyLocation(kind.name()),
                            fmt::format("{} is of two types, '{}' and '{}'", what_, found->name(),
                                        kind.name()));
            }
            found = &kind;
        }
        if (found) return *found;
        throw Error(claim_.location, what_ + " has no type; allowed: " + joined(names));
    }

    void refuseBounds(const Names& own) const {
        for (const auto& [place, key] : claims::boundKeys()) {
            const bool isRefused = claim_.kind->boundedForm && !contains(own, key.name);
            if (!isRefused || !node_.find(key.name)) continue;
            throw Error(node_.keyLocation(key.name),
                        fmt::format("{}: '{}' has no '{}'; allowed: {}", what_, claim_.kind->name(),
                                    key.name, claim_.kind->boundedForm));
        }
    }

    void readCommon() {
        claim_.text = lineOf(*given_.says, given_.says.in(what_));
        claim_.profile = nameIn(given_.profile, what_);
        if (const GivenKey& same = given_.sameAs) {
            claim_.sameAs = lineOf(*same, same.in(what_));
            const std::size_t blank = claim_.sameAs.find(' ');
            if (blank == std::string::npos ||
                claim_.sameAs.find(' ', blank + 1) < std::string::npos) {
                throwNotAllowed(*same, same.in(what_), "TABLE CLAIM");
            }
        }
        const std::string& name = claim_.kind->name();
        const Node& operands = *node_.find(name);
        const auto axis =
            claim_.kind->axisOf ? claim_.kind->axisOf(operands, what_ + ": " + name) : std::nullopt;
        const GivenKey& across = given_.across;
        if (axis && across) {
            throw Error(across->location(),
                        fmt::format("{}, and {} names its axis", across.in(what_), name));
        }
        if (axis) {
            readAcross(Node::scalar(*axis, operands.location(), true), what_ + ": axis of " + name);
        }
        if (across) readAcross(*across, across.in(what_));
    }

    void readAt() {
        const GivenKey& at = given_.at;
        if (at->isMap() && at->find(kColumnAxis)) {
            throw Error(at->keyLocation(kColumnAxis),
                        fmt::format("{}: '{}' is no axis of the rows; columns are chosen by '{}'",
                                    at.in(what_), kColumnAxis, given_.of.name()));
        }
        TableNames rows = names_;
        std::erase(rows.rowAxes, kColumnAxis);
        claim_.at = readRowFilter(*at, at.in(what_), rows);
    }

    /// " (pat=SOBOL)" where the claim has SOBOL in the place of a column; else empty.
    std::string exampleOfValue() const {
        const Node& operands = *node_.find(claim_.kind->name());
        for (const std::string& side : claims::sidesOf(operands.toFlowText(), " / ", {})) {
            for (const auto& [axis, values] : names_.rowValues) {
                const auto isSide = [&](const Node& value) {
                    return value.isScalar() && value.text() == side;
                };
                if (std::ranges::any_of(values, isSide)) return fmt::format(" ({}={})", axis, side);
            }
        }
        return "";
    }

    void readOf() {
        const GivenKey &of = given_.of, &across = given_.across;
        if (!claim_.across) {
            const char* form = claim_.kind->valuesForm;
            const std::string with =
                form ? fmt::format("with {}{} or ", form, exampleOfValue()) : "";
            throw Error(
                node_.keyLocation(of.name()),
                fmt::format("{}: '{}' is of a claim that compares rows; allowed: {}{}: {}", what_,
                            of.name(), with, across.name(), joined(names_.rowAxes, " | ")));
        }
        claim_.at.emplace_back(kColumnAxis,
                               readFilterValues(*of, of.in(what_), kColumnAxis, names_));
    }

    /// From here on the axis and the columns have changed places.
    void readAcross(const Node& node, const std::string& what) {
        const std::string axis = lineOf(node, what);
        const auto found = std::ranges::find(names_.rowAxes, axis);
        if (found == names_.rowAxes.end()) {
            throwNotAllowed(node, what,
                            names_.rowAxes.empty() ? "an axis of 'sweep', or of 'layout: {rows}'"
                                                   : joined(names_.rowAxes, " | "));
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

    void readProvenance(bool isOfDocument) {
        const auto origin = choiceIn(given_.origin, what_);
        claim_.origin = origin         ? static_cast<Origin>(*origin)
                        : isOfDocument ? Origin::Document
                                       : Origin::Ours;
        if (given_.boundFrom && !claim_.hasBound()) {
            throw Error(
                given_.boundFrom->location(),
                given_.boundFrom.in(what_) + ", and there is no number in what it requires");
        }
        if (isOfDocument && claim_.hasBound()) claim_.boundFrom = BoundSource::Ours;
        if (const auto from = choiceIn(given_.boundFrom, what_)) {
            claim_.boundFrom = static_cast<BoundSource>(*from);
        }
        if (const auto kind = choiceIn(given_.kind, what_)) {
            claim_.timeKind = static_cast<TimeKind>(*kind);
        }
        const GivenKey& because = given_.because;
        if (!because) return;
        const Node::Sequence entries =
            because->isSequence() ? because->items() : Node::Sequence{*because};
        for (const Node& entry : entries) {
            claim_.because.push_back(readKnown(entry, because.in(what_)));
        }
        requireApart(claim_.because, entries, because.in(what_));
    }

    const Node& node_;
    TableNames names_;
    bool hasPrinted_;
    std::string what_;
    CommonKeys given_ = {};
    ClaimSpec claim_;
};

}  // namespace

std::vector<SchemaSection> claimSections() {
    std::vector<SchemaSection> sections = {commonTable().section(), knownTable().section()};
    for (const claims::Kind& kind : claims::kinds()) sections.push_back(kind.section);
    return sections;
}

std::string_view originName(Origin origin) {
    return kOrigins[static_cast<std::size_t>(origin)];
}

std::string_view boundSourceName(BoundSource source) {
    return kBoundSources[static_cast<std::size_t>(source)];
}

std::string_view timeKindName(TimeKind kind) {
    return kTimeKinds[static_cast<std::size_t>(kind)];
}

std::vector<ClaimSpec> readClaims(const Node& node, const TableNames& names, bool hasPrinted,
                                  bool isOfDocument) {
    if (!node.isMap()) throwNotAllowed(node, "claims", "a map {id: claim}");
    std::vector<ClaimSpec> claims;
    for (const auto& [id, claim] : node.entries()) {
        ClaimParser parser(id, claim, node.keyLocation(id), names, hasPrinted);
        claims.push_back(parser.read(isOfDocument));
    }
    return claims;
}

}  // namespace gfxrepro::config
