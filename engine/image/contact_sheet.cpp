#include "engine/image/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "engine/image/resample.h"

namespace gfxrepro::image {
namespace {

/// A letter and its seven rows from the top, each a digit of base 32 whose highest bit is on the
/// left.
struct Glyph {
    char letter;
    char rows[kLetterHeightPx + 1];
};

constexpr Glyph kGlyphs[] = {
    {' ', "0000000"}, {'#', "0AVAVA0"}, {'%', "OP248J3"}, {'&', "CIK8LID"}, {'\'', "C480000"},
    {'(', "2488842"}, {')', "8422248"}, {'+', "044V440"}, {',', "0000C48"}, {'-', "000E000"},
    {'.', "00000CC"}, {'/', "01248G0"}, {'0', "EHJLPHE"}, {'1', "4C4444E"}, {'2', "EH1248V"},
    {'3', "V2421HE"}, {'4', "26AIV22"}, {'5', "VGU11HE"}, {'6', "68GUHHE"}, {'7', "V124888"},
    {'8', "EHHEHHE"}, {'9', "EHHF12C"}, {':', "0CC0CC0"}, {'=', "00V0V00"}, {'?', "EH12404"},
    {'@', "EH1DLLE"}, {'A', "EHHVHHH"}, {'B', "UHHUHHU"}, {'C', "EHGGGHE"}, {'D', "UHHHHHU"},
    {'E', "VGGUGGV"}, {'F', "VGGUGGG"}, {'G', "EHGNHHF"}, {'H', "HHHVHHH"}, {'I', "E44444E"},
    {'J', "72222IC"}, {'K', "HIKOKIH"}, {'L', "GGGGGGV"}, {'M', "HRLLHHH"}, {'N', "HPLJHHH"},
    {'O', "EHHHHHE"}, {'P', "UHHUGGG"}, {'Q', "EHHHLID"}, {'R', "UHHUKIH"}, {'S', "FGGE11U"},
    {'T', "V444444"}, {'U', "HHHHHHE"}, {'V', "HHHHHA4"}, {'W', "HHHLLLA"}, {'X', "HHA4AHH"},
    {'Y', "HHA4444"}, {'Z', "V1248GV"}, {'[', "E88888E"}, {']', "E22222E"}, {'_', "000000V"},
    {'a', "00E1FHF"}, {'b', "GGMPHHU"}, {'c', "00EGGHE"}, {'d', "11DJHHF"}, {'e', "00EHVGE"},
    {'f', "698S888"}, {'g', "00FHF1E"}, {'h', "GGMPHHH"}, {'i', "40C444E"}, {'j', "20622IC"},
    {'k', "GGIKOKI"}, {'l', "C44444E"}, {'m', "00QLLHH"}, {'n', "00MPHHH"}, {'o', "00EHHHE"},
    {'p', "00UHUGG"}, {'q', "00DJF11"}, {'r', "00MPGGG"}, {'s', "00FGE1U"}, {'t', "88S8896"},
    {'u', "00HHHJD"}, {'v', "00HHHA4"}, {'w', "00HHLLA"}, {'x', "00HA4AH"}, {'y', "00HHF1E"},
    {'z', "00V248V"}, {'~', "008L200"},
};

const Glyph& glyphOf(char letter) {
    const Glyph* unknown = nullptr;
    for (const Glyph& glyph : kGlyphs) {
        if (glyph.letter == letter) return glyph;
        if (glyph.letter == '?') unknown = &glyph;
    }
    return *unknown;
}

int rowBits(char digit) {
    return digit <= '9' ? digit - '0' : digit - 'A' + 10;
}

}  // namespace

void drawText(Image8& image, int leftPx, int topPx, std::string_view text, std::uint8_t value) {
    for (const char letter : text) {
        const Glyph& glyph = glyphOf(letter);
        for (int y = 0; y < kLetterHeightPx; ++y) {
            for (int x = 0; x < kLetterWidthPx - 1; ++x) {
                const bool isSet = (rowBits(glyph.rows[y]) >> (kLetterWidthPx - 2 - x) & 1) != 0;
                const int toX = leftPx + x, toY = topPx + y;
                if (!isSet || toX < 0 || toY < 0 || toX >= image.width() || toY >= image.height())
                    continue;
                for (int c = 0; c < image.channels(); ++c) image.at(toX, toY, c) = value;
            }
        }
        leftPx += kLetterWidthPx;
    }
}

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
