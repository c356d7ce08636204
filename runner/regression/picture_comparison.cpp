#include "runner/regression/picture_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "engine/core/text.h"
#include "engine/image/exr_io.h"
#include "engine/image/image.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "engine/metrics/error_map.h"
#include "engine/metrics/flip.h"
#include "runner/records/images.h"

namespace gfxrepro::regression {

namespace fs = std::filesystem;
using image::ImageF;

namespace {

/// A picture as it is stored, channel by channel, and what FLIP looks at.
struct Picture {
    std::map<std::string, ImageF> channels;
    ImageF colours;  // linear, 3 channels
    int width = 0;
    int height = 0;
};

Picture readPicture(const PictureFiles& files, bool isExr) {
    Picture picture;
    if (isExr) {
        image::ExrImage exr = image::readExr(files.exr);
        picture.colours = image::rgbOf(exr.colour());
        for (auto& channel : exr.channels) {
            picture.channels.emplace(channel.name, std::move(channel.values));
        }
    } else {
        image::Picture png = image::readPicture(files.png);
        picture.colours = image::rgbOf(png.linear);
        picture.channels.emplace(fmt::format("{} channels", png.stored.channels()),
                                 std::move(png.stored));
    }
    picture.width = picture.colours.width();
    picture.height = picture.colours.height();
    return picture;
}

std::string channelNames(const Picture& picture) {
    std::vector<std::string> names;
    for (const auto& [name, values] : picture.channels) names.push_back(name);
    return joined(names);
}

bool areEqual(float a, float b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

/// Why the two cannot be subtracted; empty when they can.
std::string whyNotComparable(const Picture& before, const Picture& after) {
    if (before.width != after.width || before.height != after.height) {
        return fmt::format("{} × {} pixels before, {} × {} after", before.width, before.height,
                           after.width, after.height);
    }
    const std::string names = channelNames(before), namesAfter = channelNames(after);
    if (names != namesAfter) {
        return fmt::format("the channels {} before, {} after", names, namesAfter);
    }
    for (const auto& [name, image] : before.channels) {
        const auto values = image.values();
        const auto others = after.channels.at(name).values();
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (areEqual(values[i], others[i])) continue;
            if (std::isfinite(values[i]) && std::isfinite(others[i])) continue;
            return fmt::format("channel {} has a value of {} before, {} after", name, values[i],
                               others[i]);
        }
    }
    return "";
}

double largestDifference(const Picture& before, const Picture& after) {
    double largest = 0.0;
    for (const auto& [name, image] : before.channels) {
        const auto values = image.values();
        const auto others = after.channels.at(name).values();
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (areEqual(values[i], others[i])) continue;
            largest =
                std::max(largest, std::abs(static_cast<double>(values[i]) - double{others[i]}));
        }
    }
    return largest;
}

/// Values that are not finite, but the same in both, are no difference.
ImageF withoutInfinities(ImageF image) {
    for (float& value : image.values()) {
        if (!std::isfinite(value)) value = 0.0F;
    }
    return image;
}

ImageF flipMapOf(ImageF before, ImageF after) {
    metrics::requireFlipSize(before);
    const ImageF a = withoutInfinities(std::move(before)), b = withoutInfinities(std::move(after));
    const bool isHdr = metrics::exceedsDisplay(a) || metrics::exceedsDisplay(b);
    return isHdr ? metrics::hdrFlipMap(a, b) : metrics::flipMap(a, b);
}

/// "pictures/sweep-mock/0123456789ab-flat": as the picture lies below images/, in plain letters.
std::string evidenceName(const fs::path& runFile) {
    std::string name = runFile.stem().string();
    for (fs::path folder = runFile.parent_path();
         folder.has_filename() && folder.filename() != "images"; folder = folder.parent_path()) {
        name = folder.filename().string() + '/' + name;
    }
    std::ranges::replace_if(
        name,
        [](unsigned char c) {
            return std::isalnum(c) == 0 &&
                   std::string_view("/-_.").find(static_cast<char>(c)) == std::string_view::npos;
        },
        '_');
    return "pictures/" + name;
}

/// Keeps both pictures beside the comparison.
void keep(const PictureFiles& files, const fs::path& target, const char* side) {
    for (const fs::path* file : {&files.exr, &files.png}) {
        if (file->empty()) continue;
        fs::path place = target;
        place += side + file->extension().string();
        fs::create_directories(place.parent_path());
        fs::copy_file(*file, place, fs::copy_options::overwrite_existing);
    }
}

struct Pair {
    SeriesKey key;
    PictureFiles before, after;
};

/// By the headers; of one that does not tell, the most.
std::int64_t pixelsOf(const Pair& pair) {
    std::int64_t most = 0;
    for (const PictureFiles* files : {&pair.before, &pair.after}) {
        try {
            const image::PngRows rows(files->png, image::kMaxSidePx, image::ImageUse::Picture);
            most = std::max(most, std::int64_t{rows.width()} * rows.height());
        } catch (const Error&) {
            return std::numeric_limits<std::int64_t>::max();
        }
    }
    return most;
}

/// What the two pictures are to each other, and the map of their differences.
Difference compareOne(const Pair& pair, bool isOneBuild, std::optional<ImageF>& map) {
    Difference result{.key = pair.key, .verdict = SeriesVerdict::Changed};
    try {
        const bool isExr = !pair.before.exr.empty() && !pair.after.exr.empty();
        Picture before = readPicture(pair.before, isExr);
        Picture after = readPicture(pair.after, isExr);
        result.reason = whyNotComparable(before, after);
        if (!result.reason.empty()) return result;
        result.picture = PictureError{0.0, largestDifference(before, after)};
        if (result.picture->largest > 0.0) {
            before.channels.clear();
            after.channels.clear();
            map = flipMapOf(std::move(before.colours), std::move(after.colours));
            result.picture->flip = metrics::meanOfFlip(*map);
        }
    } catch (const Error& error) {
        result.reason = error.what();
        return result;
    }
    const auto& [flip, largest] = *result.picture;
    const double mostFlip = isOneBuild ? 0.0 : kPictureFlip;
    const double mostDifference = isOneBuild ? 0.0 : kPictureDifference;
    if (flip <= mostFlip && largest <= mostDifference) {
        result.verdict = SeriesVerdict::Same;
    } else {
        result.reason =
            fmt::format("FLIP {:.3g} ({:.3g} allowed), largest difference {:.3g} ({:.3g} allowed)",
                        flip, mostFlip, largest, mostDifference);
    }
    return result;
}

Difference compareAndKeep(const Pair& pair, const PictureRules& rules) {
    std::optional<ImageF> map;
    Difference result = compareOne(pair, rules.isOneBuild, map);
    if (result.verdict == SeriesVerdict::Same) return result;
    if (result.picture && (pair.before.isDrawn || pair.after.isDrawn)) {
        result.verdict = SeriesVerdict::CannotTell;
        result.reason +=
            "; processes of one side made other pictures, too, and no seed is declared";
    } else if (result.picture && pair.before.isOnce && pair.after.isOnce) {
        result.verdict = SeriesVerdict::CannotTell;
        result.reason += fmt::format("; {}", kOnce);
    }
    result.evidence = evidenceName(pair.after.png.empty() ? pair.after.exr : pair.after.png);
    const fs::path target = rules.folder / result.evidence;
    keep(pair.before, target, "-before");
    keep(pair.after, target, "-after");
    if (map) image::writePng(target.string() + "-flip.png", metrics::flipPicture(*map));
    return result;
}

/// The keys, with the place of their files among all.
SeriesMap numbered(const PictureMap& pictures, std::vector<PictureFiles>& files) {
    SeriesMap keys;
    for (const auto& [key, own] : pictures) {
        keys[key] = {static_cast<double>(files.size())};
        files.push_back(own);
    }
    return keys;
}

Difference onlyOneSide(const SeriesKey& key, SeriesVerdict verdict, const char* reason) {
    return {.key = key, .verdict = verdict, .reason = reason};
}

}  // namespace

PictureMap picturesOf(const fs::path& runDir, const std::vector<records::Record>& records,
                      const CaseParams& params, const std::set<std::string>& unseeded) {
    std::map<std::string, SeriesKey> cases;
    std::set<std::string> again;  // of several processes
    for (const records::Record& record : records) {
        if (record.process > 0) again.insert(record.caseId);
        cases.try_emplace(record.caseId, keyOf(record, params, kPictureMetric));
    }
    const std::vector<records::ImageEntry> entries = records::readImages(runDir);
    std::map<std::string, std::set<int>> frames;
    std::set<std::tuple<std::string, int, std::string>> drawn;
    for (const records::ImageEntry& entry : entries) {
        frames[entry.caseId].insert(entry.frame);
        if (!entry.hasOthers || !unseeded.contains(entry.caseId)) continue;
        drawn.emplace(entry.caseId, entry.frame, entry.name);
    }
    PictureMap pictures;
    for (const records::ImageEntry& entry : entries) {
        const auto found = cases.find(entry.caseId);
        if (found == cases.end()) continue;
        const auto file = [&](const std::string& name) {
            std::error_code isAbsent;
            const fs::path path = runDir / name;
            return !name.empty() && fs::is_regular_file(path, isAbsent) ? path : fs::path();
        };
        // What the same program made once, as its truth, would be another if it were made again.
        const std::string& drawnName = entry.truthOf.empty() ? entry.name : entry.truthOf;
        const PictureFiles files{file(entry.exr), file(entry.png),
                                 drawn.contains({entry.caseId, entry.frame, drawnName}),
                                 unseeded.contains(entry.caseId) && !again.contains(entry.caseId)};
        if (files.exr.empty() && files.png.empty()) continue;
        SeriesKey key = found->second;
        key.pass = frames[entry.caseId].size() == 1
                       ? entry.name
                       : fmt::format("{}, frame {}", entry.name, entry.frame);
        pictures[key] = files;
    }
    return pictures;
}

std::vector<Difference> comparePictures(const PictureMap& before, const PictureMap& after,
                                        const PictureRules& rules) {
    std::vector<PictureFiles> files;
    SeriesMap keysBefore = numbered(before, files), keysAfter = numbered(after, files);
    matchParams(keysBefore, keysAfter);
    const auto filesOf = [&](const Series& place) {
        return files[static_cast<std::size_t>(place.front())];
    };
    std::vector<Pair> pairs;
    std::vector<Difference> differences;
    for (const auto& [key, place] : keysBefore) {
        const auto other = keysAfter.find(key);
        if (other == keysAfter.end()) {
            differences.push_back(onlyOneSide(key, SeriesVerdict::Lost, "recorded before only"));
        } else {
            pairs.push_back({key, filesOf(place), filesOf(other->second)});
        }
    }
    for (const auto& [key, place] : keysAfter) {
        if (!keysBefore.contains(key)) {
            differences.push_back(onlyOneSide(key, SeriesVerdict::Missing, "recorded after only"));
        }
    }
    std::vector<Difference> compared(pairs.size());
    metrics::forEachPicture(
        pairs.size(), [&](std::size_t i) { return pixelsOf(pairs[i]); },
        [&](std::size_t i) { compared[i] = compareAndKeep(pairs[i], rules); });
    std::ranges::move(compared, std::back_inserter(differences));
    std::ranges::sort(differences, {}, &Difference::key);
    return differences;
}

}  // namespace gfxrepro::regression
