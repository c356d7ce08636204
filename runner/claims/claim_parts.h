// What a claim asks, taken apart: which operands, as which quantity, within which range.
#pragma once

#include <string>
#include <vector>

#include "runner/claims/claim_quantity.h"
#include "runner/claims/claim_times.h"
#include "runner/config/experiment.h"

namespace gfxrepro::claims {

/// One quantity of a claim. Most claims have one; a trend may ask for a direction and an exponent,
/// an independence is asked of each operand.
struct ClaimPart {
    std::vector<std::size_t> operands;  // of the claim
    Quantity quantity;
    Requirement requirement;
    std::string measuredName;  // "smallest step": before the measured value; may be empty
    bool needsX = false;       // numeric abscissa
    bool needsExpected = false;
    std::size_t minRows = 1;
    Contrasts onTimes = {};  // what is judged instead where the operands are times
};

std::vector<ClaimPart> partsOf(const config::ClaimSpec& claim);

}  // namespace gfxrepro::claims
