#include <fmt/core.h>

#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "runner/cli/commands.h"
#include "runner/cli/image_commands.h"

namespace gfxrepro::cli {

int imageCrop(const ImageCropOptions& options) {
    const bool isExr = image::isExrFile(options.in);
    if (image::isExrFile(options.out) != isExr) {
        throw UsageError(
            fmt::format("image crop: {} and {} are of different kinds; 'image "
                        "convert' makes one of the other",
                        options.in, options.out));
    }
    requireNoInput(options.out, {&options.in, 1});
    const image::Rectangle part{options.left, options.top, options.width, options.height};
    if (isExr) {
        image::writeExr(options.out,
                        image::cropped(image::readExr(options.in), part, options.scale));
    } else {
        image::writePng(options.out,
                        image::cropped(image::readPng8(options.in), part, options.scale));
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
