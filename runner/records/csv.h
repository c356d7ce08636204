// CSV as RFC 4180 has it: fields with commas, quotes or line ends are quoted, quotes doubled.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/descriptor.h"
#include "engine/core/error.h"

namespace gfxrepro::records {

/// Writes one row onto the end of a text: fields in turn, then end().
class CsvRow {
  public:
    explicit CsvRow(std::string& out) : out_(out) {}

    /// What a spreadsheet would run as a formula ("=1+1", "@x", "-x") gets an apostrophe before it,
    /// by which that takes it for text; CsvReader takes one off again.
    CsvRow& text(std::string_view field);
    CsvRow& integer(long long field);
    /// The shortest text that reads back as the same number; not-a-number becomes an empty field.
    CsvRow& number(double field);
    void end() { out_ += '\n'; }

  private:
    void separate();

    std::string& out_;
    bool isFirst_ = true;
};

/// The shortest decimal text that reads back as `value`.
std::string shortestText(double value);

/// Reads row after row. A last row without its newline (or within an open quote) was torn by a
/// crash; it is not read as a row.
class CsvReader {
  public:
    /// More rows, and columns of one, are refused: a file may be anybody's, and a row may take many
    /// times its bytes in memory.
    static constexpr std::size_t kMostRows = 4'000'000;
    static constexpr std::size_t kMostColumns = 4096;

    /// `text` must outlive the reader; `fileName` stands in messages.
    CsvReader(std::string_view text, const std::string& fileName, std::size_t mostRows = kMostRows);

    /// Fills `fields` with the next row. False at the end: then `fields` holds what there is of a
    /// torn row. Throws Error with file and line for a quote inside of a field, and beyond the
    /// most rows and columns.
    bool next(std::vector<std::string>& fields);
    /// Where the row that was read last begins, and one past its end in bytes.
    SourceLocation location() const { return {fileName_, rowLine_, 0}; }
    std::size_t rowEnd() const { return rowEnd_; }
    /// After a torn row: `text` begins with it, and has more of it.
    void goOn(std::string_view text);

  private:
    void readField(std::string& field);

    std::string_view text_;
    FileName fileName_;
    std::size_t mostRows_;
    std::size_t rowCount_ = 0;
    std::size_t at_ = 0;
    std::size_t begin_ = 0;  // of text_, behind which rows end
    std::size_t rowEnd_ = 0;
    int line_ = 1;
    int rowLine_ = 0;
};

/// Reads a file row after row as CsvReader does, and holds a part of it at a time.
class CsvFile {
  public:
    /// Throws Error("cannot read PATH: reason").
    CsvFile(const std::filesystem::path& path, std::size_t mostRows);

    bool next(std::vector<std::string>& fields);
    SourceLocation location() const { return reader_.location(); }
    std::size_t rowEnd() const { return reader_.rowEnd(); }

  private:
    /// False at the end.
    bool readMore();

    std::filesystem::path path_;
    Descriptor file_;
    std::string part_;  // from the row that is read next on
    std::size_t partBegin_ = 0;
    CsvReader reader_;
};

}  // namespace gfxrepro::records
