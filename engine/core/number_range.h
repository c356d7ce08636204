// The numbers that a key or a parameter may have.
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace gfxrepro {

/// The reader takes these (numberIn, checks.h), its message names them, and so does the schema.
struct NumberRange {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    bool isLeastExcluded = false;
    bool isMostExcluded = false;
    bool isWhole = false;

    bool has(double value) const {
        return (isLeastExcluded ? value > least : value >= least) &&
               (isMostExcluded ? value < most : value <= most);
    }
    /// "1 … 1000", "above 0, at most 1000000 pixels", "at least 0", "".
    std::string text(std::string_view unit = "") const;
};

}  // namespace gfxrepro
