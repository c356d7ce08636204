// The pictures that a program leaves, and how far they are from their truth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "runner/technique/technique.h"

namespace gfxrepro::external {

struct Picture {
    image::ImageF linear;  // 1, 3 or 4 channels
    image::ImageF stored;  // of a PNG file sRGB, as it is compared; of an EXR file the same
    bool isPng = false;
};

/// A link is followed. Throws Error, beginning with `what`, where the file is not there, cannot be
/// read to its end, has a value that is not finite or, if that is not 0, another size.
Picture readPicture(const std::filesystem::path& file, const std::string& what,
                    glm::ivec2 sizePx = {0, 0});

/// The tiles (metrics::tileMeans) of pictures of several seeds.
using Samples = std::vector<std::vector<double>>;

/// What recordErrors() and recordSameMean() record.
config::Outputs errorOutputs();
/// Under pass `name`. Throws Error where the two are not of one kind, size and number of channels.
void recordErrors(const Picture& picture, const Picture& truth, const std::string& name,
                  technique::Recorder& recorder);
/// Under pass `name`, whether pictures and truths, independent of each other, have one expectation
/// (metrics::testMeans). Throws Error where several are the same picture: then nothing is random.
void recordSameMean(const Samples& pictures, const Samples& truths, const std::string& name,
                    technique::Recorder& recorder);

}  // namespace gfxrepro::external
