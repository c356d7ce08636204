// The recorded pictures of two runs, held against each other.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runner/records/records.h"
#include "runner/regression/comparison.h"

namespace gfxrepro::regression {

/// The files of a picture; empty where there is none. One of the two is there.
struct PictureFiles {
    std::filesystem::path exr;
    std::filesystem::path png;
    /// Processes of one run made several, and no seed says why: it tells nothing of a change.
    bool isDrawn = false;
    /// One process made it, and no seed is declared: whether another would make another is not
    /// known.
    bool isOnce = false;
};
/// By case, as its records name it, and picture: "flat", "flat, frame 3" where there are several.
using PictureMap = std::map<SeriesKey, PictureFiles>;

/// The pictures of a run that are listed and there; `unseeded` are the cases of programs that
/// declare no seed, by id. Throws Error as readImages().
PictureMap picturesOf(const std::filesystem::path& runDir,
                      const std::vector<records::Record>& records, const CaseParams& params,
                      const std::set<std::string>& unseeded = {});

/// How far apart the pictures of a case may be that two builds have recorded.
inline constexpr double kPictureFlip =
    1e-3;  // mean FLIP: a thousandth of the pixels is wholly another
inline constexpr double kPictureDifference = 0.1;  // of any value; white is 1

struct PictureRules {
    /// Both sides are of one program: then pictures are equal.
    bool isOneBuild = false;
    /// Where `pictures/` is made, with what changed.
    std::filesystem::path folder;
};

/// Same or Changed for each picture that both sides have, after matchParams; Lost for those that
/// only `before` has, and Missing for those of `after`. Changed is what lies beyond FLIP's or the
/// largest difference's tolerance, and what cannot be subtracted: a picture that cannot be read, is
/// of another size or other channels, or holds a value that is not finite (where both are not the
/// same). What is Changed by these, and drawn anew in each process, is CannotTell; so is what one
/// process a side made, where no seed is declared. Values of EXR
/// files are compared, those of PNG files where a side has no other.
std::vector<Difference> comparePictures(const PictureMap& before, const PictureMap& after,
                                        const PictureRules& rules);

}  // namespace gfxrepro::regression
