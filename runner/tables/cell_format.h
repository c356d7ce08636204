// How a cell is written: text with statistics in braces, "{mean:.2f}/{max:.0f}".
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/metrics/statistics.h"

namespace gfxrepro::tables {

class CellFormat {
  public:
    /// A placeholder is {statistic} or {statistic:spec} with a format spec of std::format for
    /// numbers; {{ and }} are braces. Throws Error at `where` for an unknown statistic, a bad spec,
    /// an open brace, or no placeholder at all.
    CellFormat(std::string_view text, const SourceLocation& where);

    struct Placeholder {
        std::string name;
        metrics::Statistic statistic;
        std::string spec;
    };
    const std::vector<Placeholder>& placeholders() const { return placeholders_; }

    /// `values` lies beside the placeholders.
    std::string format(std::span<const double> values) const;
    /// The one number that stands at a placeholder.
    std::string formatOne(std::size_t placeholder, double value) const;
    /// The numbers of a text that was written this way, beside the placeholders; empty where there
    /// is none ("16MB"). Digits may be grouped by commas.
    std::vector<std::optional<double>> parse(std::string_view text) const;

  private:
    std::vector<Placeholder> placeholders_;
    std::vector<std::string> literals_;  // before, between and after them
};

}  // namespace gfxrepro::tables
