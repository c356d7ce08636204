#include "runner/records/images.h"

#include <charconv>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "runner/records/records.h"

namespace gfxrepro::records {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kImagesHeader =
    "case,table,frame,name,png,exr,title,truth_of,png_sha256,exr_sha256";

fs::path indexOf(const fs::path& runDir) {
    return runDir / "images" / "index.csv";
}

void requireHeader(const SourceLocation& where, const std::vector<std::string>& header) {
    const std::string found = joined(header, ",");
    if (found == kImagesHeader) return;
    throw Error(where, "expected the columns " + std::string(kImagesHeader) + ", found " + found);
}

ImageEntry entryFromFields(const SourceLocation& where, const std::vector<std::string>& fields) {
    constexpr std::size_t kColumns = 10;
    if (fields.size() != kColumns) {
        throw Error(where, "expected " + std::to_string(kColumns) + " columns, found " +
                               std::to_string(fields.size()));
    }
    ImageEntry entry{fields[0], fields[1], 0,         fields[3], fields[4],
                     fields[5], fields[6], fields[7], fields[8], fields[9]};
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

/// As the list has them.
std::string rowsOf(const std::vector<ImageEntry>& images) {
    std::string text;
    for (const ImageEntry& image : images) {
        CsvRow row(text);
        row.text(image.caseId).text(image.table).integer(image.frame).text(image.name);
        row.text(image.png).text(image.exr).text(image.title).text(image.truthOf);
        row.text(image.pngSha256).text(image.exrSha256).end();
    }
    return text;
}

}  // namespace

ImageWriter::ImageWriter(const fs::path& runDir, std::size_t mostRows)
    : index_(indexOf(runDir)), mostRows_(mostRows) {
    if (!fs::exists(index_)) return;
    file_.emplace(index_);
    CsvFile file(index_, CsvReader::kMostRows);
    std::vector<std::string> fields;
    for (rowCount_ = 0; file.next(fields);) ++rowCount_;
    file_->cut(file.rowEnd());
    if (file.rowEnd() == 0) writeHeader();
}

void ImageWriter::writeHeader() {
    file_->append(std::string(kImagesHeader) + '\n');
    rowCount_ = 1;
}

void ImageWriter::requireRoom(const std::vector<ImageEntry>& images) const {
    const std::size_t rows = rowCount_ + images.size();
    const std::uintmax_t bytes = (file_ ? file_->sizeBytes() : 0) + rowsOf(images).size();
    if (rows <= mostRows_ && bytes <= kMostIndexBytes) return;
    throw FullError(index_.string() + ": would have " + std::to_string(rows) + " rows and " +
                    std::to_string(bytes) + " bytes; at most " + std::to_string(mostRows_) +
                    " rows and " + std::to_string(kMostIndexBytes) +
                    " bytes are read. Measure the rest in a run of its own (--only, --shard)");
}

void ImageWriter::append(const std::vector<ImageEntry>& images) {
    requireOurs();
    if (images.empty()) return;
    requireRoom(images);
    if (!file_) {
        makeFolder(index_.parent_path());
        file_.emplace(index_);
        writeHeader();
    }
    file_->append(rowsOf(images));
    rowCount_ += images.size();
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
    CsvFile reader(index, CsvReader::kMostRows);
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
            ImageEntry& last = images[found->second];
            const auto digest = [](const ImageEntry& one) {
                return one.exrSha256.empty() ? one.pngSha256 : one.exrSha256;
            };
            entry.hasOthers = last.hasOthers || digest(last) != digest(entry);
            last = std::move(entry);
        }
    }
    return images;
}

std::vector<std::string> changedImages(const fs::path& runDir,
                                       const std::set<std::string>& others) {
    std::set<std::string> seen;
    std::vector<std::string> changed;
    for (const ImageEntry& image : readImages(runDir)) {
        if (others.contains(image.caseId)) continue;
        for (const auto& [file, sha256] :
             {std::pair(image.png, image.pngSha256), std::pair(image.exr, image.exrSha256)}) {
            if (file.empty() || !seen.insert(file).second) continue;
            if (!fs::exists(runDir / file)) {
                changed.push_back(file + " is missing");
            } else if (!sha256.empty() && sha256OfFile(runDir / file) != sha256) {
                changed.push_back(file + " was changed");
            }
        }
    }
    return changed;
}

}  // namespace gfxrepro::records
