// From the measurements of a cell to its value and the bounds: the median over processes and its
// interval are made here, and nowhere else.
#pragma once

#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "engine/metrics/statistics.h"

namespace gfxrepro::tables {

/// What the bounds beside a value are. An interval holds, with 95 %, the value that ever more
/// processes would come to. A range is what the few measurements happened to be, min … max, and
/// promises nothing.
enum class Bounds { None, Range, Interval };
/// "", "range", "95 % interval".
std::string_view boundsName(Bounds bounds);

/// One statistic of a cell.
struct Summary {
    double value = 0.0;
    Bounds bounds = Bounds::None;
    metrics::Interval interval;    // by `bounds`; of none the value itself
    std::map<int, double> rounds;  // the statistic in each process that has all units
    bool areDraws = false;         // instead, what a share could be in truth (shareDraws)
    /// It is of the values of processes, one each, that is not their median: without bounds and
    /// rounds, as what is rare may move it by any amount.
    bool isOverProcesses = false;
    /// Of rounded values: within so much of them the true ones lie. Its bounds are of the rounded.
    double halfStep = 0.0;
};

/// The measurements of one cell: of each process (by its number), of each unit (a frame of a case),
/// its repeats. A process need not have every unit.
struct Samples {
    std::map<int, std::map<int, std::vector<double>>> processes;
};

/// In each process the statistic over units, each reduced to the median of its repeats; with a
/// single unit, over the repeats themselves. Of several processes their median; but of processes
/// with one value each, which differ, mean, min, max, stddev, p95 and p99 are those of these values
/// (Summary::isOverProcesses). A sum, a count and a rate of one value are of that.
///
/// The unit of uncertainty is the process: repeats within one share its memory layout, its hour
/// and its neighbours, and tell nothing of those (Kalibera and Jones 2013, "Rigorous benchmarking
/// in reasonable time"). With metrics::kFewestForInterval processes or more the bounds are
/// metrics::medianInterval() of them; with fewer their range; with one process the range of what
/// each repeat alone would give. Frames are given, not drawn: a camera path is what it is.
Summary summarize(const Samples& samples, metrics::Statistic statistic);

/// Of values in each round: their median, with bounds as summarize() gives them; of draws
/// (shareDraws) the value as it is. Without rounds the value as it is, without bounds.
Summary summaryOf(double value, std::map<int, double> rounds, bool areDraws);

/// Half the least step between the values of all series where these are rounded, so that their
/// steps are no finer than their noise: in one of them, at least, some are equal and others are
/// not. Else 0: what is alike in all rounds of each series is known. A hair less than half, as two
/// values a step apart were rounded to different ones.
double halfStepOf(std::span<const std::map<int, double>* const> series);

/// What else a share that was counted once could be in truth: as many draws as metrics' quantiles
/// need from its posterior under Jeffreys' prior, Beta(k + ½, n − k + ½), which has an interval for
/// shares of 0 and 100 % too (Brown, Cai and DasGupta 2001, "Interval estimation for a binomial
/// proportion"). `count` is n, `name` says whose share it is: another name, independent draws; the
/// same name, the same ones. The samples of an image are taken as independent; where neighbours are
/// alike, they tell less than their number.
std::map<int, double> shareDraws(double percent, double count, std::string_view name);

/// Gives a percentage times `scale`, counted once, its draws and their interval.
void boundByDraws(Summary& share, double scale, double count, std::string_view name);

/// From the 2.5th to the 97.5th percentile.
metrics::Interval drawsInterval(std::vector<double> draws);

}  // namespace gfxrepro::tables
