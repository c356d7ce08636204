// The uncertainty of a share that was counted once.
#pragma once

#include <map>
#include <string_view>

#include "runner/config/outputs.h"
#include "runner/tables/sampling.h"

namespace gfxrepro::tables {

/// A percentage is recorded with how many samples it is a share of in the metric of the same name
/// and this ending: redundant_pct and redundant_pct_of (technique::Recorder::share()).
using config::kShareOf;

/// What else the share could be in truth: as many draws as metrics' quantiles need from its
/// posterior under Jeffreys' prior, Beta(k + ½, n − k + ½), which has an interval for shares of 0
/// and 100 % too (Brown, Cai and DasGupta 2001, "Interval estimation for a binomial proportion").
/// `count` is n, `name` says whose share it is: another name, independent draws; the same name, the
/// same ones. The samples of an image are taken as independent; where neighbours are alike, they
/// tell less than their number.
std::map<int, double> shareDraws(double percent, double count, std::string_view name);

/// Gives a percentage times `scale`, counted once, its draws and their interval.
void boundByDraws(Summary& share, double scale, double count, std::string_view name);

/// From the 2.5th to the 97.5th percentile.
metrics::Interval drawsInterval(std::vector<double> draws);

}  // namespace gfxrepro::tables
