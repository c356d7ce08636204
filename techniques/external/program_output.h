// What a program leaves: what it says that it measured, and pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/image_file.h"
#include "runner/config/external_program.h"
#include "runner/technique/technique.h"

namespace gfxrepro::external {

struct GivenMetric {
    std::string metric;
    std::string unit;
    std::string pass;
    int frame = 0;
    double value = 0.0;
};

/// The begin of what a program wrote, for a message.
std::string shown(std::string_view line);
/// Without what sets colours on a terminal.
std::string withoutColours(std::string_view text);

/// The lines of JSON, {"metric": …, "pass": …, "frame": …, "value": …, "unit": …}: "pass" where
/// there are such, "frame" where there are several, `frame` and those that follow it. Throws Error
/// with the number of a line that is none, and for a file that is gone or no plain one (a pipe, a
/// link).
std::vector<GivenMetric> metricsIn(const std::filesystem::path& file, int frame, int count = 1);

/// The number that the pattern finds last in what the program printed, line by line, scaled. Throws
/// Error where its group is no number or a part of one, as 1.5 of 1.5e-03 and 12 of 12,5, and where
/// a line is too long for it.
std::optional<double> numberIn(std::string_view printed, const config::ProgramPattern& pattern);

using image::Picture;

/// A link is followed. Throws Error, beginning with `what`, where the file is not there, cannot be
/// read to its end, has a value that is not finite or, if that is not 0, is of another whole.
Picture readPicture(const std::filesystem::path& file, const std::string& what,
                    glm::ivec2 sizePx = {0, 0});

/// The tiles (metrics::tileMeans) of pictures of several seeds.
using Samples = std::vector<std::vector<double>>;

/// What the runner takes of pictures, and what recordSameMean() records.
config::Outputs errorOutputs();
/// Throws Error where one of a picture and its truth is an EXR file and the other a PNG.
void requireOneKind(const Picture& picture, const Picture& truth, const std::string& name);
/// Under pass `name`, whether pictures and truths, independent of each other, have one expectation
/// (metrics::testMeans). Throws Error where several are the same picture: then nothing is random.
void recordSameMean(const Samples& pictures, const Samples& truths, const std::string& name,
                    technique::Recorder& recorder);
/// And where they differ, which way: a picture beside them, of whose tiles they are.
void recordDifferences(const Samples& pictures, const Samples& truths, const image::ImageF& picture,
                       const std::string& name, technique::Recorder& recorder);

}  // namespace gfxrepro::external
