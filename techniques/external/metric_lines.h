// What a program says that it measured.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runner/config/program.h"

namespace gfxrepro::external {

struct GivenMetric {
    std::string metric;
    std::string unit;
    std::string pass;
    int frame = 0;
    double value = 0.0;
};

/// The lines of JSON, {"metric": …, "pass": …, "frame": …, "value": …, "unit": …}: "pass" where
/// there are such, "frame" where there are several, `frame` and those that follow it. Throws Error
/// with the number of a line that is none, and for a file that is gone or no plain one (a pipe, a
/// link).
std::vector<GivenMetric> metricsIn(const std::filesystem::path& file, int frame, int count = 1);

/// The number that the pattern finds last in what the program printed, line by line. Throws Error
/// where its group is no number.
std::optional<double> numberIn(std::string_view output, const config::ProgramPattern& pattern);

}  // namespace gfxrepro::external
