// OpenEXR files: named channels, half or float, with text attributes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runner/image/image.h"

namespace gfxrepro::image {

enum class ExrPixelType { Half, Float };

/// Channels of one size, each with its EXR name ("R", "depth.Z", "id"). Values are linear.
struct ExrImage {
    struct Channel {
        std::string name;
        ExrPixelType type = ExrPixelType::Half;
        ImageF values;  // one channel
    };
    std::vector<Channel> channels;
    std::map<std::string, std::string> attributes;  // text metadata: camera, command, case

    int width() const { return channels.empty() ? 0 : channels.front().values.width(); }
    int height() const { return channels.empty() ? 0 : channels.front().values.height(); }
    /// Null when there is no such channel.
    const ImageF* find(const std::string& name) const;
    /// Adds image channel by channel under `names` ("R","G","B", …).
    void add(const ImageF& image, const std::vector<std::string>& names,
             ExrPixelType type = ExrPixelType::Half);
    /// R, G, B (and A where it is there) as one image; a file with a single channel Y or Z gives 1
    /// channel. Throws Error when neither is there.
    ImageF colour() const;
};

/// Scanline or tiled, any compression that OpenEXR reads, level 0 of the first part. Unsigned
/// integer channels are read as float. Throws Error with the path and the library's reason; memory
/// is bounded as in png_io.h.
ExrImage readExr(const std::filesystem::path& path);
/// ZIP-compressed scanlines, written atomically.
void writeExr(const std::filesystem::path& path, const ExrImage& image);

}  // namespace gfxrepro::image
