// A claim as a config says it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/node.h"

namespace gfxrepro::claims {

struct Kind;

enum class Verdict { Holds, Fails, Ambiguous, NotApplicable, Unmeasured };

/// What a claim calls the axis of the columns when it compares rows (`across`).
inline constexpr const char* kColumnAxis = "column";

/// An entry of `claims:` — typed, not code. Operands are arithmetic expressions over column names
/// ("a + b").
struct ClaimSpec {
    /// Whose claim it is: a statement of the document; read off its printed numbers; an aim of
    /// ours; true by construction (a self-test); of an input that was fitted to it; or a statement
    /// of the document that there is such a thing at all, which can hardly fail.
    enum class Origin { Document, Derived, Ours, Definition, Calibrated, Existence };
    /// Where the number in its bound comes from.
    enum class BoundSource { Print, Text, Ours };
    /// Of a claim about time: what decides it. Algorithmic: counts of work, on any device.
    /// Architectural: units, caches and buses of a GPU, judged only there. Absolute: times as
    /// such, judged on a GPU at the printed parameters.
    enum class TimeKind { Algorithmic, Architectural, Absolute };
    /// `because:` a verdict other than `holds` that is known, where, and its proven cause.
    struct Known {
        std::string verdict;                 // "fails", "ambiguous", …
        std::optional<std::string> device;   // "software" | "gpu"; none: on any
        std::optional<std::string> profile;  // none: in any
        std::optional<std::string> scenes;   // "files" | "generated"; none: of any
        std::string reason;                  // in a sentence or two, for a reader of the document
        std::string shownBy = {};            // the numbers and runs that prove it; perhaps empty
    };
    std::string id;
    std::string text;            // `says:` the claim in the paper's sense, one line
    const Kind* kind = nullptr;  // one of kinds(), in kind.h
    std::vector<std::string> operands;
    std::optional<std::string> over;  // a row axis or a column: along which, or of which
    /// What is required of the ratio, the exponent, the spread (as a fraction), …
    std::optional<double> low, high;
    bool isLowExcluded = false;   // more_than
    bool isHighExcluded = false;  // less_than
    Node keys = Node::map({});    // as they are written, for what its kind alone has
    /// Rows that are read: axis = one of these values. A claim must hold in every group of rows
    /// that agree on all row axes but `over`.
    std::vector<std::pair<std::string, std::vector<Node>>> at;
    /// A row axis whose labels the operands name instead of columns; the columns become the row
    /// axis `column` (kColumnAxis). So rows are compared with rows, a column at a time.
    std::optional<std::string> across;
    std::optional<std::string> profile;  // only in this one
    std::string sameAs;                  // "TABLE CLAIM", which says the same truth; or empty
    Origin origin = Origin::Ours;
    std::optional<BoundSource> boundFrom;
    /// None: it reads no time, or is absolute as it holds one against a number (claims::timeKind).
    std::optional<TimeKind> timeKind;
    std::vector<Known> because;
    SourceLocation location;

    /// Whether the document states it, its numbers do, or it says that there is such a thing.
    bool isReadOffDocument() const {
        return origin == Origin::Document || origin == Origin::Derived ||
               origin == Origin::Existence;
    }
    /// Whether a number stands in what it requires: then the number has a source.
    bool hasBound() const { return low || high; }
};

}  // namespace gfxrepro::claims
