// A CSV file of numbers that were measured elsewhere, read and checked.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "runner/records/records.h"

namespace gfxrepro::outcome {

/// What is imported. The file has a number a row: columns `metric` and `value`, perhaps `unit`,
/// `pass`, `frame`, `repeat`, `process`, `lane`, `status`, `message`, or in the place of `process`
/// the `seed` of random numbers (without column `frame` a number that has none beside others that
/// have, and is no time, is the set-up's); every other column is a parameter of the case, or
/// `experiment`, `technique`, `scene`. With `metrics` it has a column for each of these instead of
/// `metric`, `value` and `unit`.
struct ImportFiles {
    std::filesystem::path file;
    std::vector<std::pair<std::string, std::string>> metrics = {};  // column, unit
    bool isSeedSwept = false;    // `seed` is an axis of the config, and so a parameter
    bool isSeedLeftOut = false;  // of some cases, by `when` of its sweep
};

/// The cells of a case that are not empty, by column, in the order of the columns.
struct ImportedCase {
    std::vector<std::pair<std::string, std::string>> cells;
    SourceLocation where;   // the row that has it first
    bool hasSeeds = false;  // its processes are of one seed each

    /// The cell of that column, or "".
    std::string cell(std::string_view column) const;
};

/// A record without what belongs to its case: id, table, technique, method, scene.
struct ImportedRow {
    std::size_t caseIndex = 0;
    records::Record record;
    int line = 0;
    bool hasSeed = false, hasFrame = false;
};

struct ImportedNumbers {
    std::vector<std::string> columns;  // of the cases
    std::vector<ImportedCase> cases;   // in the order of the file
    std::vector<ImportedRow> rows;
};

/// Throws Error with file and line, what was found and what is allowed: for a column that is
/// missing, there twice or of no use, a row of another length, a number that is none, a unit that
/// changes, a value that is there twice, and text that is not UTF-8.
ImportedNumbers readImport(const ImportFiles& files);

}  // namespace gfxrepro::outcome
