// The images of a run as the pages use them: inside the file or beside it, with their error maps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/report/images.h"

namespace gfxrepro::html {

/// One image: what an <img> shows of it, and what the viewer opens.
struct Shot {
    std::string table;
    std::string caseId;
    std::string caseTitle;
    std::string name;  // "result"; with its frame where there are several
    std::string thumbnail;
    std::string full;   // empty: the thumbnail is the image itself
    std::string truth;  // name of the shot that this one is compared with; empty: none
    std::string flip;   // FLIP map against the truth, as `full`; empty: none
    double flipMean = 0.0;
    int width = 0;
    int height = 0;
};

/// The images of a run, for a page at `file`. Makes below `madeDir` what is not there yet: FLIP
/// maps of those that have a truth of their size (images/…-flip.png, judged as displayed),
/// thumbnails where images are not embedded. Throws Error for an image that is no PNG.
std::vector<Shot> gatherShots(const std::filesystem::path& runDir,
                              const std::filesystem::path& madeDir,
                              const std::filesystem::path& file, bool embeds);

}  // namespace gfxrepro::html
