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

/// Which of `names` the key has; none without it.
std::optional<std::size_t> choiceIn(const Node& map, const char* key, const std::string& what,
                                    std::span<const std::string_view> names) {
    const Node* node = map.find(key);
    if (!node) return std::nullopt;
    return choiceOf(*node, names, what + ": " + key);
}

std::optional<std::string> nameIn(const Node& map, const char* key, const std::string& what,
                                  std::span<const std::string_view> names) {
    const auto choice = choiceIn(map, key, what, names);
    return choice ? std::optional<std::string>(names[*choice]) : std::nullopt;
}

/// The keys of an entry of `because`.
const std::vector<ReadKey<ClaimSpec::Known>>& knownKeys() {
    using K = ClaimSpec::Known;
    using Text = const std::string&;
    static const auto named = [](const Node& node, std::span<const std::string_view> names,
                                 Text what) {
        return std::string(names[choiceOf(node, names, what)]);
    };
    static const std::vector<ReadKey<K>> all = {
        {choiceKey("verdict", kKnownVerdicts, "required", "what it comes to"),
         [](K& known, const Node& node, Text what) {
             known.verdict = named(node, kKnownVerdicts, what);
         }},
        {{"reason", "line", "required",
          "the cause, in a sentence or two that a reader of the document understands", text()},
         [](K& known, const Node& node, Text what) { known.reason = lineOf(node, what); }},
        {{"shown_by", "PAGE.md#ANCHOR", "none",
          "the place in results/findings that has the numbers which prove it", text()},
         [](K& known, const Node& node, Text what) { known.shownBy = lineOf(node, what); }},
        {choiceKey("device", kDeviceClasses, "any", "on this class of devices"),
         [](K& known, const Node& node, Text what) {
             known.device = named(node, kDeviceClasses, what);
         }},
        {choiceKey("profile", kProfiles, "any", "in this profile"),
         [](K& known, const Node& node, Text what) {
             known.profile = named(node, kProfiles, what);
         }},
        {choiceKey(
             "scenes", kSceneClasses, "any",
             "where all scenes were made of files, or none, as where a real model is not at hand"),
         [](K& known, const Node& node, Text what) {
             known.scenes = named(node, kSceneClasses, what);
         }}};
    return all;
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
        const std::string& name = claim_.kind->name();
        Names allowed = keysOf("claim");
        for (std::string& key : claim_.kind->section.keyNames()) allowed.push_back(std::move(key));
        requireBounds(allowed);
        requireKeys(node_, what_, allowed);
        readCommon();
        if (const Node* at = node_.find("at")) readAt(*at);
        const bool isItsOwn = contains(claim_.kind->section.keyNames(), "of");
        if (const Node* of = node_.find("of"); of && !isItsOwn) readOf(*of);
        claim_.keys = node_;
        claim_.kind->read(
            {node_, *node_.find(name), names_.rowAxes, names_.rowValues, names_.columns,
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

    /// Says what to write for a bound of another name, or of a kind that has none.
    void requireBounds(const Names& allowed) const {
        static const std::pair<const char*, const char*> kWords[] = {
            {"at_least", "at_least"},   {"more_than", "more_than"}, {"at_most", "at_most"},
            {"less_than", "less_than"}, {"above", "more_than"},     {"below", "less_than"},
            {"min", "at_least"},        {"max", "at_most"}};
        static const std::pair<const char*, const char*> kInstead[] = {
            {"order", "by how much is a ratio's: 'ratio: b / a' with at_least"},
            {"exact", "'equals'; or 'bound' with at_least and at_most"},
            {"same_mean", "'false_alarms'"},
            {"independent", "'at_most'"},
            {"tolerance", "'at_most'"}};
        if (const Node* exponent = node_.find("exponent")) {
            std::vector<std::string> bounds;
            if (exponent->isMap()) {
                for (const auto& [bound, value] : exponent->entries())
                    bounds.push_back(fmt::format("{}: {}", bound, value.toFlowText()));
            }
            throw Error(
                node_.keyLocation("exponent"),
                fmt::format("{}: unknown key 'exponent' of '{}'; allowed: its bounds beside "
                            "'trend', as {}",
                            what_, claim_.kind->name(),
                            bounds.empty() ? "at_most: -0.5" : joined(bounds)));
        }
        for (const auto& [word, bound] : kWords) {
            if (!node_.find(word) || contains(allowed, word)) continue;
            std::string instead = fmt::format("'{}'", bound);
            for (const auto& [kind, text] : kInstead) {
                if (kind == claim_.kind->name()) instead = text;
            }
            throw Error(node_.keyLocation(word),
                        fmt::format("{}: unknown key '{}' of '{}'; allowed: {}", what_, word,
                                    claim_.kind->name(), instead));
        }
    }

    void readCommon() {
        const Node* says = node_.find("says");
        if (!says) throw Error(claim_.location, what_ + " needs 'says'");
        claim_.text = lineOf(*says, what_ + ": says");
        claim_.profile = nameIn(node_, "profile", what_, kProfiles);
        if (const Node* same = node_.find("same_as")) {
            claim_.sameAs = lineOf(*same, what_ + ": same_as");
            const std::size_t blank = claim_.sameAs.find(' ');
            if (blank == std::string::npos ||
                claim_.sameAs.find(' ', blank + 1) < std::string::npos) {
                throwNotAllowed(*same, what_ + ": same_as", "TABLE CLAIM");
            }
        }
        const std::string& name = claim_.kind->name();
        const Node& operands = *node_.find(name);
        const auto axis =
            claim_.kind->axisOf ? claim_.kind->axisOf(operands, what_ + ": " + name) : std::nullopt;
        const Node* across = node_.find("across");
        if (axis && across) {
            throw Error(across->location(),
                        fmt::format("{}: across, and {} names its axis", what_, name));
        }
        if (axis) readAcross(Node::scalar(*axis, operands.location(), true), "axis of " + name);
        if (across) readAcross(*across, "across");
    }

    void readAt(const Node& at) {
        if (at.isMap() && at.find(kColumnAxis)) {
            throw Error(
                at.keyLocation(kColumnAxis),
                what_ + ": at: 'column' is no axis of the rows; columns are chosen by 'of'");
        }
        TableNames rows = names_;
        std::erase(rows.rowAxes, kColumnAxis);
        claim_.at = readRowFilter(at, what_ + ": at", rows);
    }

    void readOf(const Node& of) {
        if (!claim_.across) {
            throw Error(node_.keyLocation("of"),
                        fmt::format("{}: 'of' is of a claim that compares rows; allowed: with "
                                    "[AXIS=VALUE, …] or across: {}",
                                    what_, joined(names_.rowAxes, " | ")));
        }
        claim_.at.emplace_back(kColumnAxis,
                               readFilterValues(of, what_ + ": of", kColumnAxis, names_));
    }

    /// From here on the axis and the columns have changed places.
    void readAcross(const Node& node, const std::string& key) {
        const std::string axis = lineOf(node, what_ + ": " + key);
        const auto found = std::ranges::find(names_.rowAxes, axis);
        if (found == names_.rowAxes.end()) {
            throwNotAllowed(node, what_ + ": " + key, joined(names_.rowAxes, " | "));
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
        const auto origin = choiceIn(node_, "origin", what_, kOrigins);
        claim_.origin = origin         ? static_cast<Origin>(*origin)
                        : isOfDocument ? Origin::Document
                                       : Origin::Ours;
        const Node* source = node_.find("bound_from");
        if (source && !claim_.hasBound()) {
            throw Error(source->location(),
                        what_ + ": bound_from, and there is no number in what it requires");
        }
        if (isOfDocument && claim_.hasBound()) claim_.boundFrom = BoundSource::Ours;
        if (const auto from = choiceIn(node_, "bound_from", what_, kBoundSources)) {
            claim_.boundFrom = static_cast<BoundSource>(*from);
        }
        if (const auto kind = choiceIn(node_, "kind", what_, kTimeKinds)) {
            claim_.timeKind = static_cast<TimeKind>(*kind);
        }
        const Node* because = node_.find("because");
        if (!because) return;
        const Node::Sequence entries =
            because->isSequence() ? because->items() : Node::Sequence{*because};
        for (const Node& entry : entries) {
            readKeys(knownKeys(), entry, what_ + ": because", claim_.because.emplace_back());
        }
        requireApart(claim_.because, entries, what_ + ": because");
    }

    const Node& node_;
    TableNames names_;
    bool hasPrinted_;
    std::string what_;
    ClaimSpec claim_;
};

SchemaSection common() {
    return {
        "claim",
        "claims.ID.",
        fmt::format(
            "Every claim has these, and exactly one of the keys in the tables below with what "
            "belongs to it; a, b and c are expressions over columns ('gfxrepro describe TABLE' "
            "lists them), with + - * / ^, comparisons, which are 1 or 0, and the functions {}. "
            "Where columns are numbers, a number alone is a column, and within an expression '8' "
            "in quotes is.",
            fmt::join(claims::kFunctions, ", ")),
        {{"says", "line", "required", "the claim in the paper's sense", text()},
         {"at", "{row axis: value | [values]}", "all rows", "rows that are read", pairs()},
         {"across", "row axis", "none",
          "a, b are its values instead of columns: so rows are compared, column by column", text()},
         {"of", "column | [columns]", "all columns",
          "of a claim that compares rows, but independent: the columns that are read",
          oneOrMore(text())},
         choiceKey("profile", kProfiles, "all", "the only profile it is judged in"),
         choiceKey(
             "origin", kOrigins, "document, in a sweep ours",
             "a statement of the document; read off its numbers; our aim; true by construction; "
             "of an input fitted to it; or a statement that there is such a thing at all, which "
             "can hardly fail. Only the first is counted"),
         {"same_as", "TABLE CLAIM", "none",
          "another claim, of this table or another, that says the same truth: where both have one "
          "verdict, one is counted",
          text()},
         choiceKey(
             "bound_from", kBoundSources, "ours, in a sweep none",
             "where the number that it requires comes from; print: it is a printed value, or two "
             "numbers about one, at most its half and its double, and met by all, unless it is an "
             "aim of ours"),
         choiceKey("kind", kTimeKinds, "absolute; in a sweep algorithmic; or required",
                   "of a claim about time: counts of work decide; a GPU's units do; or times as "
                   "such, at the printed parameters, as where one is held against a number, which "
                   "need not say so. The last two are judged on a GPU only"),
         {"because", "known | [known]", "none",
          "where it is known not to hold, and why, one for each device, profile and kind of "
          "scenes, what is of more behind what is of less; another verdict than the known is "
          "news, but for ambiguous; where ambiguous is known, failing is",
          oneOrMore(refTo("because"))}},
        false};
}

}  // namespace

std::vector<SchemaSection> claimSections() {
    std::vector<SchemaSection> sections = {common(),
                                           sectionOf("because", "claims.ID.because.", knownKeys())};
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
