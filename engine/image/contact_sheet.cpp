#include "engine/image/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/image/limits.h"
#include "engine/image/resample.h"
#include "engine/image/text.h"

namespace gfxrepro::image {

namespace {

constexpr std::uint8_t kGround = 96, kInk = 255;
constexpr int kBelowCaptionPx = 3;

/// Three channels; alpha is laid over the ground.
void paste(const Image8& image, int left, int top, Image8& sheet) {
    const bool isGrey = image.channels() < 3;
    const bool hasAlpha = image.channels() % 2 == 0;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const int alpha = hasAlpha ? image.at(x, y, image.channels() - 1) : 255;
            for (int c = 0; c < 3; ++c) {
                const int value = image.at(x, y, isGrey ? 0 : c);
                sheet.at(left + x, top + y, c) =
                    static_cast<std::uint8_t>((alpha * value + (255 - alpha) * kGround) / 255);
            }
        }
    }
}

/// The end of a caption that is wider than its cell.
std::string fitting(const std::string& caption, int widthPx) {
    const auto most = static_cast<std::size_t>(widthPx / kLetterWidthPx);
    if (caption.size() <= most) return caption;
    const std::string dots(std::min<std::size_t>(most, 2), '.');
    return dots + caption.substr(caption.size() - (most - dots.size()));
}

}  // namespace

Image8 contactSheet(std::span<const Image8> images, const SheetLayout& layout,
                    std::span<const std::string> captions) {
    if (images.empty()) throw Error("a contact sheet needs an image");
    if (layout.columns < 1 || layout.cellWidthPx < 1 || layout.gapPx < 0) {
        throw Error(fmt::format("a contact sheet of {} columns of {} pixels has no size",
                                layout.columns, layout.cellWidthPx));
    }
    const auto columns = std::min(static_cast<std::size_t>(layout.columns), images.size());
    const int captionPx = captions.empty() ? 0 : kLetterHeightPx + kBelowCaptionPx;
    std::vector<std::int64_t> rowHeights;
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (images[i].empty()) throw Error(fmt::format("image {} is empty", i + 1));
        if (i % columns == 0) rowHeights.push_back(0);
        rowHeights.back() =
            std::max(rowHeights.back(), captionPx + heightAt(images[i], layout.cellWidthPx));
    }
    const std::int64_t pitch = std::int64_t{layout.cellWidthPx} + layout.gapPx;
    const std::int64_t width = static_cast<std::int64_t>(columns) * pitch + layout.gapPx;
    std::int64_t height = layout.gapPx;
    for (const std::int64_t rowHeight : rowHeights) height += rowHeight + layout.gapPx;
    if (width > kMaxSidePx || height > kMaxSidePx) {
        throw Error(fmt::format("the sheet would have {}x{} pixels; {} a side are allowed", width,
                                height, kMaxSidePx));
    }
    Image8 sheet(static_cast<int>(width), static_cast<int>(height), 3, kGround);
    std::int64_t top = layout.gapPx;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const auto column = static_cast<std::int64_t>(i % columns);
        if (i > 0 && column == 0) top += rowHeights[i / columns - 1] + layout.gapPx;
        const auto left = static_cast<int>(layout.gapPx + column * pitch);
        if (!captions.empty()) {
            drawText(sheet, left, static_cast<int>(top), fitting(captions[i], layout.cellWidthPx),
                     kInk);
        }
        paste(resizedTo(images[i], layout.cellWidthPx), left, static_cast<int>(top) + captionPx,
              sheet);
    }
    return sheet;
}

}  // namespace gfxrepro::image
