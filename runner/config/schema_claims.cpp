// The keys of claims: what all have, and what each type has.
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

Json pairOfNumbers() {
    return tupleOf(number(), 2);
}

/// "25%", or 0.25.
Json fraction() {
    return anyOf({{{"type", "string"}, {"pattern", R"(^\s*[0-9.eE+-]+\s*%$)"}},
                  {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}});
}

SchemaKey over(const char* key, const char* doc) {
    return {key, "row axis | column", "required", doc, text()};
}

SchemaKey between(const char* doc) {
    return {"between", "[low, high]", "none", doc, pairOfNumbers()};
}

SchemaKey within(const char* doc) {
    return {"within", "25% | fraction", "required", doc, fraction()};
}

SchemaSection common() {
    return {"claim",
            "claims.ID.",
            "Every claim has these, and exactly one of the keys in the tables below with what "
            "belongs to it; a, b and c are expressions over columns. Where columns are numbers, a "
            "number alone is a column, and within an expression '8' in quotes is.",
            {{"says", "line", "required", "the claim in the paper's sense", text()},
             {"at", "{row axis: value | [values]}", "all rows", "rows that are read", pairs()},
             {"across", "row axis", "none",
              "a, b are its labels instead of columns; those become the row axis `column`", text()},
             {"statistic", "name", "the first", "of cells with several", choice(kStatistics)},
             {"device", "any | gpu", "any", "where it must hold", choice({"any", "gpu"})},
             {"profile", "quick | full | paper", "all", "the only profile it is judged in",
              choice(kProfiles)},
             {"origin", "document | derived | ours | definition | calibrated", "ours",
              "a statement of the document; read off its numbers; our aim; true by construction; "
              "or of an input fitted to it. A document's table needs it",
              choice(kOrigins)},
             {"bound_from", "print | text | ours", "none",
              "where the number that it requires comes from; print: it is a printed value, or two "
              "numbers about one, at most its half and its double, and met by all, unless it is an "
              "aim of ours. A document's "
              "table needs it",
              choice(kBoundSources)},
             {"kind", "algorithmic | architectural | absolute", "none",
              "of a claim about time: counts of work decide; a GPU's units do; or times as such, "
              "at the printed parameters. The last two are judged on a GPU only",
              choice(kTimeKinds)},
             {"because", "known | [known]", "none",
              "where it is known not to hold, and why, one for each device, profile and kind of "
              "scenes, what is of more behind what is of less; another verdict than the known is "
              "news, but for ambiguous; where ambiguous is known, failing is",
              oneOrMore(refTo("because"))}},
            false};
}

SchemaSection because() {
    return {
        "because",
        "claims.ID.because.",
        "",
        {{"verdict", "fails | ambiguous | unmeasured", "required", "what it comes to",
          choice(kKnownVerdicts)},
         {"reason", "line", "required",
          "the cause, in a sentence or two that a reader of the document understands", text()},
         {"shown_by", "PAGE.md#ANCHOR", "none",
          "the place in results/findings that has the numbers which prove it", text()},
         {"device", "software | gpu", "any", "on this class of devices", choice(kDeviceClasses)},
         {"profile", "quick | full | paper", "any", "in this profile", choice(kProfiles)},
         {"scenes", "files | generated", "any",
          "where all scenes were made of files, or none, as where a real model is not at hand",
          choice(kSceneClasses)}},
        false};
}

/// The first key names the type.
SchemaSection kind(SchemaKey first, std::vector<SchemaKey> further, Json conditions = nullptr) {
    first.absent = "required";
    SchemaSection section{"claim." + first.name, "claims.ID.", "", {first}, false};
    for (SchemaKey& key : further) section.keys.push_back(std::move(key));
    section.conditions = std::move(conditions);
    return section;
}

}  // namespace

std::vector<SchemaSection> claimSections() {
    return {
        common(),
        because(),
        kind({"order", "a < b < c", "", "in this order", text()}, {}),
        kind({"ratio", "a / b", "", "the ratio lies within bounds", text()},
             {{"at_least", "number", "none", "lower bound", number()},
              {"more_than", "number", "none", "lower bound, itself excluded", number()},
              {"at_most", "number", "none", "upper bound", number()},
              {"less_than", "number", "none", "upper bound, itself excluded", number()},
              between("instead of two bounds")},
             needsOneOf({{"at_least"}, {"more_than"}, {"at_most"}, {"less_than"}, {"between"}})),
        kind({"trend", "a", "", "grows or falls, or as a power", text()},
             {over("over", "along which"),
              {"exponent", "[low, high]", "none", "of the fitted power", pairOfNumbers()},
              {"direction", "increasing | decreasing", "none", "which way",
               choice({"increasing", "decreasing"})},
              {"strictly", "true | false", "false", "no two equal; with direction", boolean()}},
             needsOneOf({{"exponent"}, {"direction"}})),
        kind({"independent", "a | [a, b]", "", "does not depend on something", oneOrMore(text())},
             {over("of", "on which"), within("how far it may vary")}),
        kind({"bound", "a", "", "every value lies within bounds", text()},
             {{"above", "number", "none", "lower bound, itself included", number()},
              {"more_than", "number", "none", "lower bound, itself excluded", number()},
              {"below", "number", "none", "upper bound, itself included", number()},
              {"less_than", "number", "none", "upper bound, itself excluded", number()}},
             needsOneOf({{"above"}, {"more_than"}, {"below"}, {"less_than"}})),
        kind({"exact", "a", "", "is exactly so", text()},
             {{"equals", "number | printed", "required", "what it is",
               anyOf({number(), choice({"printed"})})}}),
        kind({"tolerance", "a", "", "is the printed value", text()},
             {within("how far from the printed value")}),
        kind({"crossover", "[a, b]", "", "the two change places", tupleOf(text(), 2)},
             {over("over", "along which"),
              {"between", "[low, high]", "required", "where", pairOfNumbers()}}),
        kind(
            {"same_mean", "a", "",
             "noisy pictures have the expectation of their truth; a column of the metric "
             "same_mean_p",
             text()},
            {{"false_alarms", "1% | fraction", "required",
              "how often it may fail where it holds, over all rows together; to 10%", fraction()}}),
    };
}

}  // namespace gfxrepro::config
