// Verdicts by name, and which of two is the worse.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "engine/core/text.h"
#include "runner/claims/claims.h"

namespace gfxrepro::claims {

Verdict verdictFromName(std::string_view name) {
    std::vector<std::string> names;
    for (const Verdict verdict : {Verdict::Holds, Verdict::Fails, Verdict::Ambiguous,
                                  Verdict::NotApplicable, Verdict::Unmeasured}) {
        if (verdictName(verdict) == name) return verdict;
        names.emplace_back(verdictName(verdict));
    }
    throw Error(fmt::format("'{}' is no verdict ({})", name, joined(names)));
}

std::string_view verdictName(Verdict verdict) {
    switch (verdict) {
        case Verdict::Holds:
            return "holds";
        case Verdict::Fails:
            return "fails";
        case Verdict::Ambiguous:
            return "ambiguous";
        case Verdict::NotApplicable:
            return "not-applicable";
        case Verdict::Unmeasured:
            return "unmeasured";
    }
    return "";
}

int severity(Verdict verdict) {
    switch (verdict) {
        case Verdict::Holds:
            return 0;
        case Verdict::NotApplicable:
            return 1;
        case Verdict::Ambiguous:
            return 2;
        case Verdict::Unmeasured:
            return 3;
        case Verdict::Fails:
            return 4;
    }
    return 4;
}

}  // namespace gfxrepro::claims
