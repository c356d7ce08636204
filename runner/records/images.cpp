#include "runner/records/images.h"

#include <charconv>
#include <map>
#include <tuple>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/records/csv.h"

namespace gfxrepro::records {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kImagesHeader = "case,table,frame,name,png,exr,title,truth_of";

fs::path indexOf(const fs::path& runDir) {
    return runDir / "images" / "index.csv";
}

void requireHeader(const SourceLocation& where, const std::vector<std::string>& header) {
    const std::string found = joined(header, ",");
    if (found == kImagesHeader) return;
    throw Error(where, "expected the columns " + std::string(kImagesHeader) + ", found " + found);
}

ImageEntry entryFromFields(const SourceLocation& where, const std::vector<std::string>& fields) {
    constexpr std::size_t kColumns = 8;
    if (fields.size() != kColumns) {
        throw Error(where, "expected " + std::to_string(kColumns) + " columns, found " +
                               std::to_string(fields.size()));
    }
    ImageEntry entry{fields[0], fields[1], 0,         fields[3],
                     fields[4], fields[5], fields[6], fields[7]};
    const char* end = fields[2].data() + fields[2].size();
    const auto [stop, error] = std::from_chars(fields[2].data(), end, entry.frame);
    if (error != std::errc() || stop != end) {
        throw Error(where, "column 'frame': expected an integer, found '" + fields[2] + "'");
    }
    return entry;
}

/// A merge copies what is named to the same place below its own folder.
void requireInside(const SourceLocation& where, const std::string& file) {
    const fs::path plain = fs::path(file).lexically_normal();
    if (file.empty() || (plain == fs::path(file) && *plain.begin() == "images")) return;
    throw Error(where, "'" + file + "' is no file of the run, below images/");
}

}  // namespace

ImageWriter::ImageWriter(const fs::path& runDir) : index_(indexOf(runDir)) {
    if (!fs::exists(index_)) return;
    file_.emplace(index_);
    const MappedFile file(index_);
    CsvReader reader(file.text(), index_.string());
    std::vector<std::string> fields;
    while (reader.next(fields)) {
    }
    file_->cut(reader.rowEnd());
    if (reader.rowEnd() == 0) writeHeader();
}

void ImageWriter::writeHeader() {
    file_->append(std::string(kImagesHeader) + '\n');
}

void ImageWriter::append(const std::vector<ImageEntry>& images) {
    requireOurs();
    if (images.empty()) return;
    if (!file_) {
        fs::create_directories(index_.parent_path());
        file_.emplace(index_);
        writeHeader();
    }
    std::string text;
    for (const ImageEntry& image : images) {
        CsvRow row(text);
        row.text(image.caseId).text(image.table).integer(image.frame).text(image.name);
        row.text(image.png).text(image.exr).text(image.title).text(image.truthOf).end();
    }
    file_->append(text);
}

void ImageWriter::requireOurs() const {
    if (file_) return file_->requireOurs();
    std::error_code unknown;
    if (!fs::exists(index_, unknown)) return;
    throw Error(index_.string() +
                ": was made by another while a run had no images; nothing more is measured into "
                "its folder");
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
    requireHeader(reader.location(), fields);
    while (reader.next(fields)) {
        ImageEntry entry = entryFromFields(reader.location(), fields);
        for (const std::string* file : {&entry.png, &entry.exr}) {
            requireInside(reader.location(), *file);
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

}  // namespace gfxrepro::records
