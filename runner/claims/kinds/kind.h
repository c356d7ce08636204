// What a kind of claim is: each is one file of this folder, and its name in kind.cpp.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/key_schema.h"
#include "engine/core/node.h"
#include "engine/metrics/statistics.h"
#include "runner/claims/kinds/claim.h"

namespace gfxrepro::claims {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What a claim reads of a group of rows: each operand on each row, the abscissa, what is expected.
template <class Value>
struct GroupOf {
    std::vector<std::vector<Value>> operands;  // [operand][row]
    std::vector<Value> x;                      // [row]; empty without an abscissa
};
using GroupPoint = GroupOf<double>;

/// The number that is made of a group. A measured value may be +∞: the PSNR of equal pictures. It
/// is larger than any other, equal to itself, and ∞ − ∞ or ∞ ÷ ∞ is not a number: a quantity that
/// needs one is unmeasured.
using GroupNumber = std::function<double(const GroupPoint&)>;

/// The range that the quantity must lie in.
struct Requirement {
    double low = -kInfinity;
    double high = kInfinity;
    bool isLowExcluded = false;
    bool isHighExcluded = false;
    std::string absence = {};  // what is infinite is not there, and fails: what to say then
    bool isOfCounts = false;   // of what was counted, not of what it stands for
    std::string text = {};     // "exponent in [0.3, 1.2]"
    bool isPercent = false;    // shown ×100 with a percent sign
};

struct Decision {
    Verdict verdict;
    std::string why = {};  // of an ambiguous one; empty: the interval tells
};

/// On which scale rounds scatter evenly, where many rows are looked at together
/// (metrics::jointChances): a ratio of two equally noisy times is as likely 1.1 as 1 / 1.1.
/// Logarithmic where all values are positive, else linear. Ranks: on none that is known; only on
/// which side of a bound a round lies counts.
enum class Scale { Linear, Logarithmic, Ranks };

/// One comparison of times.
struct Contrast {
    std::string name;  // "exponent": before the measured value; may be empty
    GroupNumber quantity;
    Requirement requirement;
    Scale scale = Scale::Logarithmic;
    /// By which share times would have to differ for the quantity to reach its bound: what is
    /// compared with the noise of what is read. Absent: as a quantity that is a ratio or a time.
    std::function<double(const GroupPoint&, double quantity)> distance = {};
    /// By the interval of the quantity over rounds and the noise of what is read. Absent: as it
    /// lies within the requirement, nearer to a bound than the noise ambiguous.
    std::function<Decision(const metrics::Interval&, double noise)> decide = {};
    bool isBeside = false;  // of what the claim asks for: told only where it is worse
};
/// The contrasts of a group with these values.
using Contrasts = std::function<std::vector<Contrast>(const GroupPoint&)>;

/// One quantity of a claim. Most claims have one; a trend may ask for a direction and an exponent,
/// an independence is asked of each operand.
struct ClaimPart {
    std::vector<std::size_t> operands;  // of the claim
    GroupNumber quantity;
    Requirement requirement;
    std::string measuredName = {};  // "smallest step": before the measured value; may be empty
    bool needsX = false;            // numeric abscissa
    bool needsExpected = false;     // a further operand: what was printed, or is given
    std::size_t minRows = 1;
    /// Judged instead where the operands vary, times or random numbers; absent: the quantity.
    Contrasts onTimes = {};
    bool isOfSeeds = false;  // what it reads is a test of several seeds itself
};

/// What to write where a column's place has the value of a row axis: "; 'a' is a value of …".
std::string acrossHint(const std::string& value, const std::string& axis);

/// The bounds of a claim.
struct GivenBounds {
    GivenKey atLeast, moreThan, atMost, lessThan;
};

/// The keys of a claim, as its kind reads them. What is wrong is an Error at its place.
struct ClaimKeys {
    const Node& node;
    const std::vector<std::string>& rowAxes;
    const std::map<std::string, std::vector<Node>>& rowValues;  // of those that are known
    const std::vector<std::string>& columns;
    bool hasAllColumns;  // false: further columns may exist
    bool hasPrinted;
    const std::string& what;  // begins the messages: "claim 'C'"
    const SourceLocation& where;

    void requirePrinted() const;
    /// "claim 'C': KEY is VALUE; allowed: …".
    [[noreturn]] void refuse(const GivenKey& key, std::string_view allowed) const;
    /// "claim 'C': TEXT".
    [[noreturn]] void fail(const Node& at, const std::string& text) const;

    /// The operand; those of a list; those between separators.
    void readOne(const GivenKey& key, ClaimSpec& claim) const;
    void readList(const GivenKey& key, ClaimSpec& claim) const;
    void readSides(const GivenKey& key, std::string_view separator, ClaimSpec& claim) const;
    /// The row axis, column or expression over both.
    void readOver(const GivenKey& key, ClaimSpec& claim) const;
    /// Either lower, and either upper one: one of all, unless the `other` key is there.
    void readBounds(const GivenBounds& given, ClaimSpec& claim,
                    const GivenKey* other = nullptr) const;
    double readShare(const GivenKey& key, const NumberRange& range) const;
    std::size_t rowsAlong(const std::string& over, const ClaimSpec& claim) const;
    std::string acrossHint(const std::vector<std::string>& texts) const;
    void addOperands(const Node& at, const std::vector<std::string>& texts, ClaimSpec& claim) const;
};

/// What `check` knows of how a claim will be measured.
struct Sampling {
    std::size_t rows = 0;
    int frames = 1;  // output.frames
    /// The fewest pictures of a truth that has several, 0 where none has; absent: a technique takes
    /// them.
    std::optional<int> truthFrames = std::nullopt;
};

struct Kind {
    /// What with what: operands with each other, an operand's values along the rows, or a value
    /// with a number, which asks for a time as such.
    enum class Compares { Operands, Rows, Values };

    SchemaSection section;  // of its table; the first of the keys names it
    void (*read)(const ClaimKeys& keys, ClaimSpec& claim) = nullptr;
    std::vector<ClaimPart> (*parts)(const ClaimSpec& claim) = nullptr;
    Compares compares = Compares::Operands;
    /// Of its quantity, where that is of times. Ratios and times scatter on a logarithmic one; of
    /// where curves cross none is known.
    Scale scale = Scale::Linear;
    bool isOfAllRows = false;      // judged once, not in each group of rows
    std::string_view metric = {};  // the only one that its operand may be; empty: any
    /// "; it is of …", of a column that is not there; empty of any that is not the kind's matter.
    std::string_view (*hintOn)(std::string_view column) = nullptr;
    /// What `check` refuses, to follow the claim's name; empty where nothing is wrong.
    std::string (*refused)(const ClaimSpec& claim, const Sampling& sampling) = nullptr;
    const char* boundedForm = nullptr;  // of one without bounds: which other one has them
    const char* valuesForm = nullptr;   // how operands name values of an axis, where they may
    /// The row axis whose values the operands name, which implies `across`; `what` begins messages.
    std::optional<std::string> (*axisOf)(const Node& operands, const std::string& what) = nullptr;

    const std::string& name() const { return section.keys.front().name; }
};

/// All of them, in the order in which people are told of them.
const std::vector<Kind>& kinds();
std::vector<ClaimPart> partsOf(const ClaimSpec& claim);

// What kinds share.

/// The keys of what is read along rows, and of an upper bound, which may be a share.
inline constexpr const char *kOver = "over", *kAtMost = "at_most";

const std::vector<KeyTable<GivenBounds>::Key>& boundKeys();
/// One of these keys is needed.
Json needsOne(const std::vector<std::string>& names);
SchemaKey overKey(const char* key, const char* doc);
/// "25%", or 0.25. A percentage may be beyond 100 where the range has no end.
SchemaKey shareKey(const char* key, const NumberRange& range, const char* doc);

template <class Given>
using Keys = std::vector<typename KeyTable<Given>::Key>;

/// The first key names the kind. With `conditions`: which keys go together.
template <class Given>
KeyTable<Given> kindTable(const Keys<Given>& keys, Json conditions = nullptr) {
    const std::string name = "claim." + keys.front().declared.name;
    return {{name, "claims.ID.", "", false, nullptr, std::move(conditions)}, keys};
}

/// With bounds, of which one, or the `other` key, is needed.
template <class Given>
KeyTable<Given> boundedTable(Keys<Given> keys, GivenKey Given::*other = nullptr) {
    std::vector<std::string> enough;
    for (const auto& [place, key] : boundKeys()) {
        keys.emplace_back(place, key);
        enough.push_back(key.name);
    }
    for (const auto& [place, key] : keys) {
        if (other && place == other) enough.push_back(key.name);
    }
    return kindTable<Given>(keys, needsOne(enough));
}

/// Reads a claim of the kind with that table, of which every required key is there.
template <auto table, auto read>
void readBy(const ClaimKeys& keys, ClaimSpec& claim) {
    const auto given = table().find(keys.node);
    table().require(given, keys.where, keys.what);
    read(keys, given, claim);
}

/// The bounds of the claim, as "NAME in [0.3, 1.2]".
Requirement rangeOf(const ClaimSpec& claim, const std::string& name, bool isPercent = false);
/// "in [0.3, 1.2]", "≥ 10", "≤ 25 %".
std::string rangeText(const Requirement& requirement);
/// "0.4123", "41.23 %".
std::string quantityText(double value, const Requirement& requirement);
/// From a value to the nearer bound.
double distanceToBound(double value, const Requirement& requirement);
/// Whatever the quantity is: itself, on a scale.
Contrasts asItself(std::string name, GroupNumber quantity, Requirement requirement, Scale scale);

/// (right − left) / max(|right|, |left|), 0 of such as differ by rounding; ±1 where one of the two
/// is infinite.
double relativeDifference(double left, double right);
/// left / right, 1 of such as differ by rounding; of zeros and infinities not a number.
double ratioOf(double left, double right);
/// The smaller, the larger one; not-a-number when either is.
double lesser(double a, double b);
double greater(double a, double b);
bool arePositive(const std::vector<double>& values);
/// The rows in ascending x.
std::vector<std::size_t> rowsByX(const GroupPoint& group);

}  // namespace gfxrepro::claims
