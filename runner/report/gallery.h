// The images of a run as the pages use them: inside the file or beside it, with their error maps.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "runner/records/images.h"

namespace gfxrepro::report {

/// The longer side of the pictures on a page, and of those of the overview.
inline constexpr int kShownPx = 512;
inline constexpr int kSmallPx = 320;

/// How the pictures of a run come onto a page.
struct GalleryPlace {
    enum class Embedding {
        None,    // files beside the page; what is longer than kShownPx is shown by a thumbnail
        Whole,   // inside the page
        Reduced  // inside the page, those longer than reducedPx as their thumbnails alone
    };
    std::filesystem::path runDir;
    std::filesystem::path madeDir;  // for FLIP maps and thumbnails
    std::filesystem::path page;     // the file
    Embedding embedding = Embedding::None;
    int reducedPx = kShownPx;  // of Reduced: the longer side at most
};

/// A path as a link: its parts may hold what an address may not.
std::string encodedAddress(const std::filesystem::path& path);

/// One image: what an <img> shows of it, and what the viewer opens.
struct Shot {
    std::string table;
    std::string caseId;
    std::string caseTitle;
    std::string name;      // "result"; with its frame where there are several
    std::string baseName;  // without it
    int frame = 0;
    std::string png;  // below the run's folder
    std::string thumbnail;
    std::string full;        // empty: the thumbnail is the image itself
    std::string truth;       // name of the shot that this one is compared with; empty: none
    std::string content;     // of a truth: the same text for the same picture; empty: no truth
    std::string flip;        // FLIP map against the truth, as `thumbnail`; empty: none
    double flipMean = 0.0;   // what was recorded of it
    std::string errors;      // all that was, for people: "FLIP 0.0123 · RMSE 0.004"
    bool isClipped = false;  // a channel of the PNG is as bright as it can be
    std::vector<std::string> light;  // lightLayers() of its EXR, of the size that the viewer opens
    std::uintmax_t bytes = 0;        // of the PNG
    int width = 0;                   // of what the viewer opens
    int height = 0;

    bool isTruth() const { return !content.empty(); }
};

/// What a PNG cannot show of a picture: its light above white. Each layer is 2^kLayerStops darker
/// than the one before, of which the PNG is the first, and black in a channel where that one tells;
/// none where no value is above 1.
inline constexpr int kLayerStops = 4;
std::vector<image::Image8> lightLayers(const image::ImageF& picture);

/// To how many pixels a side the pictures of runs inside of one file are reduced: the largest of
/// these of which they are likely to stay below `mostBytes` with their error maps, else the least.
inline constexpr std::array kReducedPx = {kShownPx, kSmallPx, 192, 128};
int reducedPxOf(std::span<const std::filesystem::path> runDirs, std::uintmax_t mostBytes);

/// Told after each picture how many of how many are done; never by two threads at once.
using PicturesDone = std::function<void(std::size_t done, std::size_t all)>;

/// The images of a run. Makes below `madeDir` what is not there yet: FLIP maps of those that have a
/// truth of their size (thumbnails/…-flip.png, judged as displayed), and thumbnails; of pictures
/// that are alike, as their truths are, one for all. Throws Error for an image that is no PNG
/// and was written so; one that was damaged since is as one that is missing.
std::vector<Shot> gatherShots(const GalleryPlace& place, const PicturesDone& progress = {});

/// A shot's picture for the overview, as `thumbnail`; made if it is not there.
std::string smallPicture(const Shot& shot, const GalleryPlace& place);

}  // namespace gfxrepro::report
