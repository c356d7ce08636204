#include "runner/report/images.h"

#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <tuple>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/csv.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kHeader = "case,table,frame,name,png,exr,title,truth_of";
/// Of runs before truths were named.
constexpr std::string_view kOldHeader = "case,table,frame,name,png,exr,title";

fs::path indexOf(const fs::path& runDir) {
    return runDir / "images" / "index.csv";
}

/// How many columns the rows under a header have.
std::size_t columnCount(const SourceLocation& where, const std::vector<std::string>& header) {
    const std::string found = joined(header, ",");
    if (found != kHeader && found != kOldHeader) {
        throw Error(where, "expected the columns " + std::string(kHeader) + ", found " + found);
    }
    return header.size();
}

ImageEntry entryFromFields(const SourceLocation& where, std::size_t columns,
                           const std::vector<std::string>& fields) {
    if (fields.size() != columns) {
        throw Error(where, "expected " + std::to_string(columns) + " columns, found " +
                               std::to_string(fields.size()));
    }
    ImageEntry entry{fields[0], fields[1], 0, fields[3], fields[4], fields[5], fields[6]};
    if (columns > 7) entry.truthOf = fields[7];
    const char* end = fields[2].data() + fields[2].size();
    const auto [stop, error] = std::from_chars(fields[2].data(), end, entry.frame);
    if (error != std::errc() || stop != end) {
        throw Error(where, "column 'frame': expected an integer, found '" + fields[2] + "'");
    }
    return entry;
}

/// The list without a torn last line.
std::string wholeRows(const fs::path& index) {
    if (!fs::exists(index)) return std::string(kHeader) + '\n';
    std::string text = readFile(index);
    CsvReader reader(text, index.string());
    std::vector<std::string> fields;
    while (reader.next(fields)) {
    }
    text.resize(reader.rowEnd());
    return text;
}

[[noreturn]] void failWriting(const fs::path& index, int reason) {
    throw Error("cannot write " + index.string() + ": " + std::strerror(reason));
}

/// Adds `rows` to a list that ends with a whole line; false, with nothing done, when it does not.
/// A list is not written anew for each case: that would take longer with every case of a run.
bool appendToWhole(const fs::path& index, std::string_view rows) {
    const int fd = ::open(index.c_str(), O_RDWR | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) return false;
    const off_t before = ::lseek(fd, 0, SEEK_END);
    char last = 0;
    if (before <= 0 || ::pread(fd, &last, 1, before - 1) != 1 || last != '\n') {
        ::close(fd);
        return false;
    }
    errno = 0;
    const ssize_t written = ::write(fd, rows.data(), rows.size());
    int reason = errno;
    bool isDone = written == static_cast<ssize_t>(rows.size());
    if (!isDone) {  // a full disk takes a part: give it back
        if (reason == 0) reason = ENOSPC;
        if (::ftruncate(fd, before) != 0) reason = errno;
    } else if (::fdatasync(fd) != 0) {
        reason = errno;
        isDone = false;
    }
    ::close(fd);
    if (!isDone) failWriting(index, reason);
    return true;
}

/// The list may be anybody's: it names files of the run, below images/.
void requireInside(const SourceLocation& where, const fs::path& runDir, const std::string& file) {
    if (file.empty()) return;
    const fs::path plain = fs::path(file).lexically_normal();
    const bool isBelow = plain.is_relative() && plain.begin() != plain.end() &&
                         *plain.begin() == "images" && plain == fs::path(file);
    const auto isLink = [&](fs::path path) {
        for (; !path.empty(); path = path.parent_path()) {
            if (fs::is_symlink(runDir / path)) return true;
        }
        return false;
    };
    if (isBelow && !isLink(plain)) return;
    throw Error(where, "'" + file + "' is no file of the run, below images/ and without a link");
}

}  // namespace

void appendImages(const fs::path& runDir, const std::vector<ImageEntry>& images) {
    if (images.empty()) return;
    std::string text;
    for (const ImageEntry& image : images) {
        CsvRow row(text);
        row.text(image.caseId).text(image.table).integer(image.frame).text(image.name);
        row.text(image.png).text(image.exr).text(image.title).text(image.truthOf).end();
    }
    const fs::path index = indexOf(runDir);
    if (!appendToWhole(index, text)) writeFileAtomic(index, wholeRows(index) + text);
}

std::vector<ImageEntry> readImages(const fs::path& runDir) {
    const fs::path index = indexOf(runDir);
    if (!fs::exists(index)) return {};
    const std::string text = readFile(index);
    CsvReader reader(text, index.string());
    std::vector<std::string> fields;
    std::vector<ImageEntry> images;
    std::map<std::tuple<std::string, int, std::string>, std::size_t> indices;
    if (!reader.next(fields)) return {};
    const std::size_t columns = columnCount(reader.location(), fields);
    while (reader.next(fields)) {
        ImageEntry entry = entryFromFields(reader.location(), columns, fields);
        for (const std::string* file : {&entry.png, &entry.exr}) {
            requireInside(reader.location(), runDir, *file);
        }
        const auto [found, isNew] =
            indices.try_emplace({entry.caseId, entry.frame, entry.name}, images.size());
        if (isNew) {
            images.push_back(std::move(entry));
        } else {
            images[found->second] = std::move(entry);
        }
    }
    return images;
}

}  // namespace gfxrepro::report
