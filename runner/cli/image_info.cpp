#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/image_commands.h"

namespace gfxrepro::cli {

namespace {

const char* nameOf(image::ExrPixelType type) {
    switch (type) {
        case image::ExrPixelType::Half:
            return "half";
        case image::ExrPixelType::Float:
            return "float";
        case image::ExrPixelType::Uint:
            break;
    }
    return "uint";
}

void printChannel(const image::ExrImage::Channel& channel) {
    double sum = 0.0;
    float low = std::numeric_limits<float>::infinity(), high = -low;
    std::size_t finite = 0;
    for (const float value : channel.values.values()) {
        if (!std::isfinite(value)) continue;
        ++finite;
        sum += double{value};
        low = std::min(low, value);
        high = std::max(high, value);
    }
    say("channel {:<10} {:<5}", channel.name, nameOf(channel.type));
    if (finite > 0) {
        say(" {:g} to {:g}, mean {:g}", low, high, sum / static_cast<double>(finite));
    }
    if (const std::size_t others = channel.values.values().size() - finite; others > 0) {
        say(" ({} not finite)", others);
    }
    say("\n");
}

}  // namespace

int imageInfo(const std::string& file) {
    if (!image::isExrFile(file)) {
        const image::ImageF image = image::readStored(file);
        say("png {}x{}, {} {}\n", image.width(), image.height(), image.channels(),
            image.channels() == 1 ? "channel" : "channels");
        return kExitOk;
    }
    const image::ExrImage exr = image::readExr(file);
    say("exr {}x{}\n", exr.width(), exr.height());
    for (const image::ExrImage::Channel& channel : exr.channels) printChannel(channel);
    for (const auto& [name, text] : exr.attributes) say("{}: {}\n", name, text);
    for (const auto& [name, matrix] : exr.matrices) {
        say("{}: {}\n", name, fmt::format("{:.6g}", fmt::join(matrix, " ")));
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
