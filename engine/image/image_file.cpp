#include "engine/image/image_file.h"

#include <algorithm>
#include <string>
#include <vector>

#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"

namespace gfxrepro::image {

bool isExrFile(const std::filesystem::path& path) {
    const std::string extension = path.extension();
    if (extension == ".exr" || extension == ".png") return extension == ".exr";
    throw UsageError(path.string() + ": is neither .exr nor .png");
}

ImageF readStored(const std::filesystem::path& path) {
    if (isExrFile(path)) return readExr(path).colour();
    PngRows stored(path, kMaxSidePx, ImageUse::Picture);
    ImageF result(stored.width(), stored.height(), stored.channels());
    std::vector<std::uint16_t> row(result.row(0).size());
    for (int y = 0; y < result.height(); ++y) {
        stored.read(row.data());
        std::ranges::transform(row, result.row(y).begin(), [](std::uint16_t value) {
            return static_cast<float>(value) / 65535.0F;
        });
    }
    return result;
}

ImageF readLinear(const std::filesystem::path& path) {
    ImageF image = readStored(path);
    if (isExrFile(path)) return image;
    const auto channels = static_cast<std::size_t>(image.channels());
    const std::size_t colours = channels % 2 == 0 ? channels - 1 : channels;  // the rest is alpha
    for (std::size_t i = 0; i < image.values().size(); ++i) {
        if (i % channels < colours) image.values()[i] = linearOf(image.values()[i]);
    }
    return image;
}

}  // namespace gfxrepro::image
