#include <algorithm>

#include "engine/image/contact_sheet.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/image_commands.h"

namespace gfxrepro::cli {

int imageSheet(const ImageSheetOptions& options) {
    if (image::isExrFile(options.out)) {
        throw UsageError(options.out + ": a contact sheet is a .png");
    }
    requireNoInput(options.out, options.files);
    std::vector<image::Image8> images;
    for (const std::string& file : options.files) {
        images.push_back(image::isExrFile(file) ? image::toSrgb8(image::readLinear(file))
                                                : image::readPng8(file));
    }
    image::SheetLayout layout;
    layout.columns = options.columns;
    layout.cellWidthPx = options.widthPx;
    image::writePng(options.out, image::contactSheet(images, layout, options.files));
    const auto columns = std::min(static_cast<std::size_t>(options.columns), options.files.size());
    for (std::size_t i = 0; i < options.files.size(); ++i) {
        say("row {} column {}  {}\n", i / columns + 1, i % columns + 1, options.files[i]);
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
