#include "runner/report/records.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/csv.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kHeader =
    "schema,case,table,technique,method,scene,params,frame,repeat,process,lane,pass,metric,unit,"
    "value,status,message";
constexpr std::size_t kColumnCount = 17;

constexpr std::array<std::string_view, 10> kStatusNames = {
    "ok",  "ambiguous", "flaky",       "unsupported", "timeout",
    "oom", "crash",     "device-lost", "missing",     "error"};

std::optional<Status> findStatus(std::string_view name) {
    const auto found = std::find(kStatusNames.begin(), kStatusNames.end(), name);
    if (found == kStatusNames.end()) return std::nullopt;
    return static_cast<Status>(found - kStatusNames.begin());
}

std::string statusNames() {
    return joined(std::vector<std::string>(kStatusNames.begin(), kStatusNames.end()));
}

[[noreturn]] void failWriting(const fs::path& path, int reason) {
    throw Error("cannot write " + path.string() + ": " + std::strerror(reason));
}

void appendRow(std::string& out, const Record& record) {
    CsvRow row(out);
    row.integer(Record::kSchema).text(record.caseId).text(record.table).text(record.technique);
    row.text(record.method).text(record.scene).text(record.params);
    row.integer(record.frame).integer(record.repeat).integer(record.process);
    row.text(record.lane).text(record.pass).text(record.metric).text(record.unit);
    row.number(record.value).text(statusName(record.status)).text(record.message).end();
}

int integerField(const SourceLocation& where, std::string_view column, const std::string& text) {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) {
        throw Error(where, "column '" + std::string(column) + "': expected an integer, found '" +
                               text + "'");
    }
    return value;
}

double numberField(const SourceLocation& where, const std::string& text) {
    if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) {
        throw Error(where, "column 'value': expected a number or nothing, found '" + text + "'");
    }
    return value;
}

Record recordFromFields(const SourceLocation& where, std::vector<std::string>& fields) {
    if (fields.size() != kColumnCount) {
        throw Error(where, "expected " + std::to_string(kColumnCount) + " columns, found " +
                               std::to_string(fields.size()));
    }
    if (const int schema = integerField(where, "schema", fields[0]); schema != Record::kSchema) {
        throw Error(where, "expected records of schema " + std::to_string(Record::kSchema) +
                               ", found " + std::to_string(schema));
    }
    Record record;
    record.caseId = std::move(fields[1]);
    record.table = std::move(fields[2]);
    record.technique = std::move(fields[3]);
    record.method = std::move(fields[4]);
    record.scene = std::move(fields[5]);
    record.params = std::move(fields[6]);
    record.frame = integerField(where, "frame", fields[7]);
    record.repeat = integerField(where, "repeat", fields[8]);
    record.process = integerField(where, "process", fields[9]);
    if (record.process < 0) {
        throw Error(where, "column 'process': expected 0 or more, found '" + fields[9] + "'");
    }
    record.lane = std::move(fields[10]);
    record.pass = std::move(fields[11]);
    record.metric = std::move(fields[12]);
    record.unit = std::move(fields[13]);
    record.value = numberField(where, fields[14]);
    const auto status = findStatus(fields[15]);
    if (!status) {
        throw Error(where,
                    "column 'status': found '" + fields[15] + "'; allowed: " + statusNames());
    }
    record.status = *status;
    record.message = std::move(fields[16]);
    return record;
}

void checkHeader(const fs::path& path, std::string_view text) {
    const std::string_view first = text.substr(0, text.find('\n'));
    if (first != kHeader) {
        throw Error({path.string(), 1, 0}, "expected the header '" + std::string(kHeader) +
                                               "', found '" + std::string(first.substr(0, 200)) +
                                               "'");
    }
}

/// The whole cases of a file, and where they end. Before a torn row the other rows of its case are
/// left out too: a crash in the middle of a case's write leaves some.
struct WholeCases {
    std::vector<Record> records;
    std::size_t endBytes = 0;
};
WholeCases readWholeCases(const fs::path& path, std::string_view text) {
    checkHeader(path, text);
    CsvReader reader(text, path.string());
    std::vector<std::string> fields;
    std::vector<std::size_t> ends;  // of the header and of each record
    WholeCases result;
    while (reader.next(fields)) {
        ends.push_back(reader.rowEnd());
        if (ends.size() > 1) {
            result.records.push_back(recordFromFields(reader.location(), fields));
        }
    }
    const bool isTorn = reader.rowEnd() < text.size();
    const std::string tornCase = fields.size() > 1 ? fields[1] : "";  // perhaps not all of it
    if (isTorn && !result.records.empty()) {
        const std::string last = result.records.back().caseId;
        while (last.starts_with(tornCase) && !result.records.empty() &&
               result.records.back().caseId == last) {
            result.records.pop_back();
        }
    }
    if (!ends.empty()) result.endBytes = ends[result.records.size()];
    return result;
}

}  // namespace

std::string_view statusName(Status status) {
    return kStatusNames[static_cast<std::size_t>(status)];
}

Status statusFromName(std::string_view name) {
    if (const auto status = findStatus(name)) return *status;
    throw Error("unknown status '" + std::string(name) + "'; allowed: " + statusNames());
}

RecordWriter::RecordWriter(const fs::path& path) : path_(path) {
    if (path.has_parent_path()) fs::create_directories(path.parent_path());
    fd_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (fd_ < 0) failWriting(path, errno);
    try {
        const std::string header = std::string(kHeader) + '\n';
        const MappedFile file(path);
        const bool isNew = header != file.text() && header.starts_with(file.text());
        const std::size_t length = isNew ? 0 : readWholeCases(path, file.text()).endBytes;
        if (::ftruncate(fd_, static_cast<off_t>(length)) != 0) failWriting(path, errno);
        if (isNew) writeBlock(header);
    } catch (...) {
        ::close(fd_);
        throw;
    }
}

RecordWriter::~RecordWriter() {
    if (fd_ >= 0) ::close(fd_);
}

void RecordWriter::append(const std::vector<Record>& rows) {
    std::string block;
    for (const Record& row : rows) appendRow(block, row);
    if (!block.empty()) writeBlock(block);
}

void RecordWriter::writeBlock(std::string_view block) {
    const off_t before = ::lseek(fd_, 0, SEEK_END);
    ssize_t written = 0;
    do {
        written = ::write(fd_, block.data(), block.size());
    } while (written < 0 && errno == EINTR);
    if (written != static_cast<ssize_t>(block.size())) {
        // A full disk takes a part of the block: give it back, so that no half case stays.
        const int reason = written < 0 ? errno : ENOSPC;
        if (::ftruncate(fd_, before) != 0) failWriting(path_, errno);
        failWriting(path_, reason);
    }
    if (::fdatasync(fd_) != 0) failWriting(path_, errno);
}

std::vector<Record> readRecords(const fs::path& path) {
    const MappedFile file(path);
    return readWholeCases(path, file.text()).records;
}

}  // namespace gfxrepro::report
