#include "runner/report/images.h"

#include <fcntl.h>
#include <unistd.h>
#include <charconv>
#include <map>
#include <tuple>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/report/csv.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kHeader = "case,table,frame,name,png,exr,title";
constexpr std::size_t kColumnCount = 7;

fs::path indexOf(const fs::path& runDir) {
    return runDir / "images" / "index.csv";
}

ImageEntry entryFromFields(const SourceLocation& where, const std::vector<std::string>& fields) {
    if (fields.size() != kColumnCount) {
        throw Error(where, "expected " + std::to_string(kColumnCount) + " columns, found " +
                               std::to_string(fields.size()));
    }
    ImageEntry entry{fields[0], fields[1], 0, fields[3], fields[4], fields[5], fields[6]};
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

}  // namespace

void appendImages(const fs::path& runDir, const std::vector<ImageEntry>& images) {
    if (images.empty()) return;
    std::string text = wholeRows(indexOf(runDir));
    for (const ImageEntry& image : images) {
        CsvRow row(text);
        row.text(image.caseId).text(image.table).integer(image.frame).text(image.name);
        row.text(image.png).text(image.exr).text(image.title).end();
    }
    writeFileAtomic(indexOf(runDir), text);
}

std::vector<ImageEntry> readImages(const fs::path& runDir) {
    const fs::path index = indexOf(runDir);
    if (!fs::exists(index)) return {};
    const std::string text = readFile(index);
    CsvReader reader(text, index.string());
    std::vector<std::string> fields;
    std::vector<ImageEntry> images;
    std::map<std::tuple<std::string, int, std::string>, std::size_t> indices;
    reader.next(fields);  // the header
    while (reader.next(fields)) {
        ImageEntry entry = entryFromFields(reader.location(), fields);
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
