// The list of a run's images: images/index.csv, one row an image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/core/output_files.h"
#include "runner/records/csv.h"

namespace gfxrepro::records {

/// Columns case,table,frame,name,png,exr,title,truth_of,png_sha256,exr_sha256 in this order. Paths
/// are relative to the run folder: "images/zju2005-2.1/<case>-<name>.png".
struct ImageEntry {
    std::string caseId;
    std::string table;  // "zju2005/2.1"
    int frame = 0;
    std::string name;   // "surface"
    std::string png;    // empty when there is none
    std::string exr;    // empty when there is none
    std::string title;  // the case's title: "zju2005/2.1 scene=models/duck"
    /// The name of the image, of the same case and frame, that this one is the truth of; or empty.
    std::string truthOf = {};
    std::string pngSha256 = {};  // of what was written, by which a later change is seen
    std::string exrSha256 = {};
    /// Not of the list: another process of the run made another one. readImages() finds it.
    bool hasOthers = false;

    bool operator==(const ImageEntry&) const = default;
};

/// Appends to `runDir`/images/index.csv, which is made with its header at the first image.
class ImageWriter {
  public:
    /// Cuts off a torn last line. The list never has more than `mostRows` rows. Throws Error.
    explicit ImageWriter(const std::filesystem::path& runDir,
                         std::size_t mostRows = CsvReader::kMostRows);
    /// Throws FullError where the list would have too many rows or bytes with these.
    void requireRoom(const std::vector<ImageEntry>& images) const;
    /// Throws Error, leaving the list as it was; also as requireRoom() and requireOurs().
    void append(const std::vector<ImageEntry>& images);
    /// Throws Error where the list is not what was written: somebody made, removed, replaced or
    /// changed it.
    void requireOurs() const;

  private:
    void writeHeader();

    std::filesystem::path index_;
    std::size_t mostRows_;
    std::size_t rowCount_ = 1;          // with the header
    std::optional<AppendedFile> file_;  // none before the first image
};

/// The images of a run, in the order in which they were made; none when there is no list. Of two
/// entries of one case, frame and name the last counts (a case that was run again). A torn last
/// line is passed over; other malformed rows are an Error with file and line.
std::vector<ImageEntry> readImages(const std::filesystem::path& runDir);

/// The files of a run's images that are not as they were written, but for those of `others`, by id:
/// "images/a/b.png was changed", "… is missing"; each once.
std::vector<std::string> changedImages(const std::filesystem::path& runDir,
                                       const std::set<std::string>& others = {});

/// Of images/index.csv; a larger one is neither written nor read.
inline constexpr std::uintmax_t kMostIndexBytes = std::uintmax_t{4} << 30;

}  // namespace gfxrepro::records
