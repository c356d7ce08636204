// Tidy tables: named columns of typed values, written as CSV or into a file of SQLite.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace gfxrepro::records {

/// Nothing, or a value with its type.
using FrameValue = std::variant<std::monostate, bool, long long, double, std::string>;

/// Rows are asked for one at a time: of millions of records no second copy is made.
struct Frame {
    std::string name;
    std::vector<std::string> columns;
    std::size_t rowCount = 0;
    std::function<std::vector<FrameValue>(std::size_t)> row;  // as long as `columns`
};

/// RFC 4180 with a header; nothing and not-a-number are empty fields, booleans `true` and `false`.
/// The file is there as a whole or not at all. Throws Error.
void writeFrameCsv(const std::filesystem::path& file, const Frame& frame);

/// Columns of a table that SQLite takes.
inline constexpr std::size_t kMostSqliteColumns = 2000;

/// An index that queries of a file are fast by.
struct FrameIndex {
    std::string frame;
    std::string column;
};

/// A file of SQLite with a table a frame, whose values have the types INTEGER (booleans, too), REAL
/// and TEXT, or are NULL (not-a-number, too); of columns that differ by the case of letters alone
/// the later ones get a number: N, n_2. Written in one transaction, in place of what was there, as
/// a whole or not at all. Throws Error.
void writeSqlite(const std::filesystem::path& file, std::span<const Frame> frames,
                 std::span<const FrameIndex> indices = {});

}  // namespace gfxrepro::records
