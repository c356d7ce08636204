// Of a table that nobody laid out: what compares the values of an axis of words, "÷ A" beside the
// time and the error of A and B, and a sentence on which is less.
#pragma once

#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// An axis whose values are methods, patterns, variants: words, of which there are two or more. The
/// first is what the others are held against. Scenes and truth values are none.
struct Rivals {
    std::string axis;
    std::vector<std::string> values;
    bool isThere() const { return !axis.empty(); }
};
/// The first such axis of the cases.
Rivals rivalsOf(const std::vector<const config::Case*>& cases);

/// Of that column the one that divides it by its value for the first rival.
std::pair<std::string, config::Selection> columnAgainst(const Rivals& rivals,
                                                        const std::string& column,
                                                        const config::Experiment& experiment);

/// Puts before the notes which rivals are faster or slower, nearer to their truth or farther from
/// it, than the first, in how many rows and by how much: by the intervals of those columns, all
/// rows together (metrics::jointChances), a time only beyond the noise of what is divided, and by
/// the CPU time of the process where that was recorded (Table::judgedByProcess). Behind what is
/// told (Table::toldNotes) stands what cannot be. Marks the cells that are not apart. Nothing where
/// a column has no intervals.
void compareRivals(const Rivals& rivals, const std::vector<std::string>& columns, Table& table);

}  // namespace gfxrepro::tables
