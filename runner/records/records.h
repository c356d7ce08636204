// Measurements in long form, and how cases ended: one row a number, append-only, readable by any
// data frame library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/output_files.h"

namespace gfxrepro::records {

inline constexpr int kMostProcesses = 1'000'000;  // of a case: config::readMeasure

/// Of a records.csv, its header among them: what a million units have at 63 rows each. More are
/// neither written nor read.
inline constexpr std::size_t kMostRecords = 64'000'000;
inline constexpr std::uintmax_t kMostRecordBytes = std::uintmax_t{16} << 30;

/// A file of a run that takes no more: it would not be read again.
class FullError : public Error {
    using Error::Error;
};

/// How a case ended. `ok` rows carry values; the others one row a case with the message.
enum class Status {
    Ok,
    Ambiguous,
    Flaky,
    Unsupported,
    Timeout,
    Oom,
    Crash,
    DeviceLost,
    Missing,
    Error
};
std::string_view statusName(Status status);
/// Throws Error for a name that is none.
Status statusFromName(std::string_view name);

/// Frame and repeat of what belongs to the whole case (its scene, its set-up, its memory). Of a
/// metric and pass that frames have values of, too, these are no part.
inline constexpr int kSetup = -1;

/// A row of records.csv. Columns in this order, schema version first; the last one, `rows`, says
/// how many rows the row's unit (its case in its process) has. With which parameters the case was
/// measured is in the plan.
struct Record {
    static constexpr int kSchema = 3;

    std::string caseId;
    std::string table;  // "zju2005/2.1"
    std::string technique;
    std::string method;
    std::string scene;
    int frame = 0;     // or kSetup
    int repeat = 0;    // or kSetup
    int process = 0;   // from 0
    std::string lane;  // "timing" | "quality"
    std::string pass;  // the paper's step; empty for whole-case metrics
    std::string metric;
    std::string unit;
    /// Not-a-number for failed cases, written as an empty field; +∞ ("inf") of equal pictures.
    double value = 0.0;
    Status status = Status::Ok;
    std::string message;
    bool operator==(const Record&) const = default;
};

/// Appends whole units: the rows of a case in a process reach the disk together, or not at all.
class RecordWriter {
  public:
    /// Creates the file with its header, or opens it for appending after cutting off a last unit
    /// that is not whole. It never has more than `mostRows` rows, its header among them.
    explicit RecordWriter(const std::filesystem::path& path, std::size_t mostRows = kMostRecords);
    /// Throws FullError where the file would have too many rows or bytes with these.
    void requireRoom(const std::vector<Record>& rows) const;
    /// One write, then flushed to the disk; of a unit, all rows. Throws Error, leaving the file as
    /// it was; also as requireRoom() and requireOurs().
    void append(const std::vector<Record>& rows);

    /// As AppendedFile's.
    void requireOurs() const { file_.requireOurs(); }

  private:
    std::filesystem::path path_;
    AppendedFile file_;
    std::size_t mostRows_;
    std::size_t rowCount_ = 0;
};

/// Writes a whole records.csv in the place of one that may be there: all of it or nothing. Throws
/// Error, and FullError for what would not be read.
void writeRecords(const std::filesystem::path& path, const std::vector<Record>& rows);

/// Reads records.csv, row by row. A header or a last unit whose write was cut, be it at a line's
/// end, is left out. Throws Error with file and line for any other unit without all of its rows,
/// for a malformed row, and for a value (case, process, frame, repeat, pass, metric) that is there
/// twice.
std::vector<Record> readRecords(const std::filesystem::path& path);

/// How a case ended over all its processes.
struct CaseEnd {
    enum class Outcome { Measured, Skipped, Failed };
    std::string table;  // "zju2005/2.1"
    std::string title;  // "zju2005/2.1 scene=models/duck"
    Outcome outcome = Outcome::Measured;
    std::string text = {};  // of the others: "crash: SIGSEGV", "not run"
    double seconds = 0.0;   // that its processes took, together
};

}  // namespace gfxrepro::records
