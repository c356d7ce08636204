#include "runner/report/gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/image/exr_io.h"
#include "engine/image/image.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "engine/image/srgb.h"
#include "engine/metrics/error_map.h"
#include "engine/metrics/flip.h"
#include "runner/report/markup.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

std::string encodedAddress(const fs::path& path) {
    std::string address;
    for (const char c : path.generic_string()) {
        const auto byte = static_cast<unsigned char>(c);
        const bool isPlain =
            std::isalnum(byte) != 0 || std::string_view("/-_.~").find(c) != std::string_view::npos;
        address += isPlain ? std::string(1, c) : fmt::format("%{:02X}", byte);
    }
    return address;
}

std::vector<image::Image8> lightLayers(const image::ImageF& picture) {
    constexpr int kMost = 4;  // half floats end at 2^16
    const image::ImageF colours = image::rgbOf(image::withStraightAlpha(picture));
    std::vector<image::Image8> layers;
    float white = 1.0F;
    const auto isBrighter = [&](float value) { return value > white; };
    while (layers.size() < kMost && std::ranges::any_of(colours.values(), isBrighter)) {
        const float next = std::ldexp(white, kLayerStops);
        image::ImageF layer(colours.width(), colours.height(), 3);
        std::ranges::transform(colours.values(), layer.values().begin(), [&](float value) {
            return isBrighter(value) ? value / next : 0.0F;
        });
        layers.push_back(image::toSrgb8(layer));
        white = next;
    }
    return layers;
}

namespace {

/// Whether `made` is there and no older than what it is made from.
bool isCurrent(const fs::path& made, const fs::path& source) {
    std::error_code isAbsent;
    const auto madeAt = fs::last_write_time(made, isAbsent);
    return !isAbsent && madeAt >= fs::last_write_time(source);
}

void makeFolderOf(const fs::path& file) {
    std::error_code failure;
    fs::create_directories(file.parent_path(), failure);
    if (failure) {
        throw Error("cannot create " + file.parent_path().string() + ": " + failure.message());
    }
}

/// The linear values of what a PNG shows, 3 channels.
image::ImageF displayed(const image::Image8& png) {
    static const std::array<float, 256> kDecoded = image::srgbDecoding();
    image::ImageF linear(png.width(), png.height(), 3);
    for (int y = 0; y < png.height(); ++y) {
        for (int x = 0; x < png.width(); ++x) {
            for (int c = 0; c < 3; ++c) {
                linear.at(x, y, c) = kDecoded[png.at(x, y, png.channels() < 3 ? 0 : c)];
            }
        }
    }
    return linear;
}

/// "images/a/b.png" → "<folder>/a/b<suffix>.png".
fs::path besides(const std::string& png, const fs::path& folder, const std::string& suffix) {
    const fs::path place = fs::path(png).lexically_relative("images");
    return folder / place.parent_path() / (place.stem().string() + suffix + ".png");
}

using ImageKey = std::tuple<std::string, int, std::string>;  // case, frame, name

/// What an <img> of the page takes for a file.
std::string addressOf(const fs::path& file, const GalleryPlace& place) {
    if (place.embedding != GalleryPlace::Embedding::None) {
        std::string png = readFile(file);
        if (place.embedding == GalleryPlace::Embedding::Reduced) {
            std::string smaller = image::encodePng(image::readPng8(file));
            if (smaller.size() < png.size()) png = std::move(smaller);
        }
        return "data:image/png;base64," + base64(png);
    }
    const fs::path folder = fs::absolute(place.page).parent_path();
    return encodedAddress(fs::relative(fs::absolute(file), folder));
}

/// The file of a picture whose longer side is at most that, made in `folder` if it is not there;
/// `file`, which holds `image`, where it is no longer.
fs::path reducedFile(const fs::path& file, const image::Image8& image, int longestPx,
                     const fs::path& made) {
    const int longerPx = std::max(image.width(), image.height());
    if (longerPx <= longestPx) return file;
    if (!isCurrent(made, file)) {
        makeFolderOf(made);
        image::writePng(made,
                        image::resizedTo(image, std::max(1, longestPx * image.width() / longerPx)));
    }
    return made;
}

/// One run's images on their way into a page.
class Gallery {
  public:
    Gallery(const GalleryPlace& place, std::vector<records::ImageEntry> entries)
        : place_(place), runDir_(place.runDir), entries_(std::move(entries)) {
        for (const records::ImageEntry& entry : entries_) {
            if (!entry.truthOf.empty()) {
                truths_.try_emplace({entry.caseId, entry.frame, entry.truthOf}, entry);
            }
            frames_[{entry.caseId, entry.name}].insert(entry.frame);
        }
    }

    const std::vector<records::ImageEntry>& entries() const { return entries_; }

    /// Width and height, by its header.
    std::pair<int, int> sizeOf(const records::ImageEntry& entry) const {
        const image::PngRows rows(runDir_ / entry.png, image::kMaxSidePx, image::ImageUse::Picture);
        return {rows.width(), rows.height()};
    }
    std::int64_t pixelsOf(const records::ImageEntry& entry) const {
        const auto [width, height] = sizeOf(entry);
        return std::int64_t{width} * height;
    }

    /// To be decoded for a thumbnail, and compared.
    bool isTooLarge(const records::ImageEntry& entry) const {
        return pixelsOf(entry) > metrics::kMaxFlipPixels;
    }

    const records::ImageEntry* truthOf(const records::ImageEntry& entry) const {
        const auto truth = truths_.find({entry.caseId, entry.frame, entry.name});
        return truth == truths_.end() ? nullptr : &truth->second;
    }

    /// What it is, not yet how it is shown. `content` is the digest of its file.
    void describe(const records::ImageEntry& entry, const std::string& content, Shot& shot) const {
        shot.table = entry.table;
        shot.caseId = entry.caseId;
        shot.caseTitle = entry.title;
        shot.name = nameOf(entry);
        shot.baseName = entry.name;
        shot.frame = entry.frame;
        shot.png = entry.png;
        shot.content = entry.truthOf.empty() ? "" : content;
        const records::ImageEntry* truth = isTooLarge(entry) ? nullptr : truthOf(entry);
        shot.truth = truth ? nameOf(*truth) : "";
    }

    /// `known` is the truth of the picture before, if it is of one content with this one's.
    Shot shotOf(const records::ImageEntry& entry, const std::string& content,
                std::optional<metrics::FlipReference>& known) const {
        const fs::path file = runDir_ / entry.png;
        Shot shot;
        describe(entry, content, shot);
        shot.bytes = fs::file_size(file);
        std::tie(shot.width, shot.height) = sizeOf(entry);
        if (isTooLarge(entry)) {
            shot.thumbnail = addressOf(file, place_);
            return shot;
        }
        const image::Image8 picture = image::readPng8(file);
        const fs::path thumbnail = shownFile(file, picture, besides(entry.png, "thumbnails", ""));
        shot.thumbnail = addressOf(thumbnail, place_);
        if (thumbnail != file && place_.embedding == Embedding::None) {
            shot.full = addressOf(file, place_);
        } else if (thumbnail != file) {
            const image::PngRows rows(thumbnail, image::kMaxSidePx, image::ImageUse::Picture);
            std::tie(shot.width, shot.height) = std::pair{rows.width(), rows.height()};
        }
        shot.isClipped = std::ranges::find(picture.values(), 255) != picture.values().end();
        takeLight(entry, shot);
        if (const auto* truth = truthOf(entry)) compare(entry, picture, *truth, known, shot);
        return shot;
    }

    /// Its own, of what its PNG has lost.
    void takeLight(const records::ImageEntry& entry, Shot& shot) const {
        shot.light.clear();
        std::error_code isAbsent;
        const fs::path exr = runDir_ / entry.exr;
        if (!shot.isClipped || entry.exr.empty() || !fs::is_regular_file(exr, isAbsent)) return;
        image::ImageF light;
        try {
            light = image::readExr(exr).colour();
        } catch (const Error&) {
            return;  // it was damaged since, or holds no colours
        }
        if (std::pair{light.width(), light.height()} != sizeOf(entry)) return;
        for (const image::Image8& layer : lightLayers(light)) {
            const std::string suffix = fmt::format("-light-{}", shot.light.size() + 1);
            const fs::path made = place_.madeDir / besides(entry.png, "thumbnails", suffix);
            makeFolderOf(made);
            image::writePng(
                made, layer.width() > shot.width ? image::resizedTo(layer, shot.width) : layer);
            shot.light.push_back(addressOf(made, place_));
        }
    }

  private:
    using Embedding = GalleryPlace::Embedding;

    fs::path shownFile(const fs::path& file, const image::Image8& image,
                       const fs::path& made) const {
        if (place_.embedding == Embedding::Whole) return file;
        const bool isReduced = place_.embedding == Embedding::Reduced;
        return reducedFile(file, image, isReduced ? place_.reducedPx : kShownPx,
                           place_.madeDir / made);
    }

    /// A frame is named only where there are several of the picture.
    std::string nameOf(const records::ImageEntry& entry) const {
        if (frames_.at({entry.caseId, entry.name}).size() == 1) return entry.name;
        return fmt::format("{}, frame {}", entry.name, entry.frame);
    }

    void compare(const records::ImageEntry& entry, const image::Image8& picture,
                 const records::ImageEntry& truth, std::optional<metrics::FlipReference>& known,
                 Shot& shot) const {
        if (sizeOf(truth) != sizeOf(entry)) return;
        if (!known) known.emplace(displayed(image::readPng8(runDir_ / truth.png)));
        const image::ImageF map = known->mapOf(displayed(picture));
        const auto values = map.values();
        shot.flipMean =
            std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
        const fs::path made = place_.madeDir / besides(entry.png, "thumbnails", "-flip");
        const image::Image8 shown = metrics::flipPicture(map);
        if (!isCurrent(made, runDir_ / entry.png)) {
            makeFolderOf(made);
            image::writePng(made, shown);
        }
        // Beside the page the viewer opens what is shown: a map as large as its pictures.
        const bool isReduced = place_.embedding == Embedding::Reduced;
        const fs::path reduced = besides(entry.png, "thumbnails", "-flip-reduced");
        shot.flip = addressOf(isReduced ? shownFile(made, shown, reduced) : made, place_);
    }

    GalleryPlace place_;
    fs::path runDir_;
    std::vector<records::ImageEntry> entries_;
    std::map<ImageKey, records::ImageEntry> truths_;  // by the image that they are the truth of
    std::map<std::pair<std::string, std::string>, std::set<int>> frames_;  // of case and picture
};

bool isReadable(const fs::path& png) {
    try {
        image::readPng8(png);
        return true;
    } catch (const Error&) {
        return false;
    }
}

/// The pictures that can be shown, and the digest of each one's file. Not of these is one that is
/// no longer as it was written and no PNG: as of a missing one, that is all there is to say of it
/// (run::noteChangedImages).
std::pair<std::vector<records::ImageEntry>, std::vector<std::string>> picturesOf(
    const fs::path& runDir) {
    std::vector<records::ImageEntry> entries = records::readImages(runDir);
    std::vector<std::string> contents(entries.size());
    metrics::forEachPicture(
        entries.size(), [](std::size_t) { return std::int64_t{0}; },
        [&](std::size_t i) {
            const fs::path file = runDir / entries[i].png;
            std::error_code isAbsent;
            if (entries[i].png.empty() || !fs::is_regular_file(file, isAbsent)) return;
            const std::string content = sha256OfFile(file), &written = entries[i].pngSha256;
            if (written.empty() || content == written || isReadable(file)) contents[i] = content;
        });
    std::pair<std::vector<records::ImageEntry>, std::vector<std::string>> shown;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (contents[i].empty()) continue;
        shown.first.push_back(std::move(entries[i]));
        shown.second.push_back(std::move(contents[i]));
    }
    return shown;
}

}  // namespace

int reducedPxOf(std::span<const fs::path> runDirs, std::uintmax_t mostBytes) {
    // By the header of each: what a file has of bytes goes by its pixels.
    struct Picture {
        double bytes;
        int longerPx;
    };
    std::vector<Picture> pictures;
    for (const fs::path& runDir : runDirs) {
        const auto shown = picturesOf(runDir);
        for (const records::ImageEntry& entry : shown.first) {
            const fs::path file = runDir / entry.png;
            const image::PngRows rows(file, image::kMaxSidePx, image::ImageUse::Picture);
            pictures.push_back(
                {static_cast<double>(fs::file_size(file)), std::max(rows.width(), rows.height())});
        }
    }
    constexpr double kMapsAndText =
        2.0;  // error maps are as large as their pictures, base64 a third
    for (const int longestPx : kReducedPx) {
        double bytes = 0.0;
        for (const Picture& picture : pictures) {
            const double share = std::min(1.0, static_cast<double>(longestPx) / picture.longerPx);
            bytes += kMapsAndText * picture.bytes * share * share;
        }
        if (bytes <= static_cast<double>(mostBytes)) return longestPx;
    }
    return kReducedPx.back();
}

namespace {

/// Pictures that are shown alike: of one content, as their truths are. Those of one truth are in
/// one group.
std::vector<std::vector<std::vector<std::size_t>>> groupsOf(
    const Gallery& gallery, const std::vector<std::string>& contents) {
    std::map<std::string, std::string> contentOf;  // of a file
    for (std::size_t i = 0; i < contents.size(); ++i) {
        contentOf[gallery.entries()[i].png] = contents[i];
    }
    std::map<std::string, std::map<std::string, std::vector<std::size_t>>> alike;  // by truth
    for (std::size_t i = 0; i < contents.size(); ++i) {
        const records::ImageEntry* truth = gallery.truthOf(gallery.entries()[i]);
        // Without a truth each content is a group of its own.
        alike[truth ? contentOf.at(truth->png) : contents[i] + " alone"][contents[i]].push_back(i);
    }
    std::vector<std::vector<std::vector<std::size_t>>> groups;
    for (auto& [truth, pictures] : alike) {
        groups.emplace_back();
        for (auto& [content, places] : pictures) groups.back().push_back(std::move(places));
    }
    return groups;
}

}  // namespace

std::vector<Shot> gatherShots(const GalleryPlace& place, const PicturesDone& progress) {
    auto pictures = picturesOf(place.runDir);
    const Gallery gallery(place, std::move(pictures.first));
    const std::vector<records::ImageEntry>& entries = gallery.entries();
    const std::vector<std::string>& contents = pictures.second;
    const std::vector<std::vector<std::vector<std::size_t>>> groups = groupsOf(gallery, contents);
    std::vector<Shot> shots(entries.size());
    std::mutex mutex;
    std::size_t done = 0;
    const auto take = [&](const std::vector<std::size_t>& alike,
                          std::optional<metrics::FlipReference>& known) {
        const std::size_t first = alike.front();
        shots[first] = gallery.shotOf(entries[first], contents[first], known);
        for (const std::size_t i : alike) {
            if (i == first) continue;
            shots[i] = shots[first];
            gallery.describe(entries[i], contents[i], shots[i]);
            gallery.takeLight(entries[i], shots[i]);
        }
        if (!progress) return;
        const std::scoped_lock lock(mutex);
        for (std::size_t i = 0; i < alike.size(); ++i) progress(++done, shots.size());
    };
    metrics::forEachPicture(
        groups.size(),
        [&](std::size_t g) { return gallery.pixelsOf(entries[groups[g].front().front()]); },
        [&](std::size_t g) {
            std::optional<metrics::FlipReference> known;
            for (const std::vector<std::size_t>& alike : groups[g]) take(alike, known);
        });
    return shots;
}

std::string smallPicture(const Shot& shot, const GalleryPlace& place) {
    if (std::int64_t{shot.width} * shot.height > metrics::kMaxFlipPixels) return shot.thumbnail;
    const fs::path file = place.runDir / shot.png;
    const fs::path made = place.madeDir / besides(shot.png, "thumbnails", "-small");
    const bool isReduced = place.embedding == GalleryPlace::Embedding::Reduced;
    const int longestPx = isReduced ? std::min(kSmallPx, place.reducedPx) : kSmallPx;
    return addressOf(reducedFile(file, image::readPng8(file), longestPx, made), place);
}

}  // namespace gfxrepro::report
