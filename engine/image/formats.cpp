#include "engine/image/formats.h"

#include <fmt/format.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/foreign_text.h"
#include "engine/core/text.h"
#include "engine/image/exr_io.h"

namespace gfxrepro::image {

using namespace std::string_view_literals;
using Part = std::span<const std::byte>;

namespace {

/// The bytes of a file, from the front on.
class Bytes {
  public:
    Bytes(std::span<const std::byte> bytes, const std::string& name)
        : rest_(bytes), size_(bytes.size()), name_(name) {}

    [[noreturn]] void fail(const std::string& why) const { throw Error(name_ + ": " + why); }

    /// Names what is read next, for messages.
    void begin(std::string part) { part_ = std::move(part); }
    void require(std::size_t count) const {
        if (count <= rest_.size()) return;
        fail(endsEarly(part_, size_ - rest_.size(), count, rest_.size()));
    }
    std::span<const std::byte> rest() const { return rest_; }
    std::span<const std::byte> take(std::size_t count) {
        require(count);
        const auto taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }
    int byte() { return std::to_integer<int>(take(1)[0]); }
    int littleWord() {
        const int low = byte();
        return low + 256 * byte();
    }
    /// Up to the end of the line, without it.
    std::string line() {
        std::string text;
        for (int c = byte(); c != '\n'; c = byte()) text += static_cast<char>(c);
        if (text.ends_with('\r')) text.pop_back();
        return text;
    }
    /// Between blanks, behind comments of '#'; one blank behind it is taken, too.
    std::string word() {
        skipBlanks();
        std::string text;
        do {
            const int c = byte();
            isReturn_ = c == '\r';
            if (isBlank(c)) return text;
            text += static_cast<char>(c);
        } while (!rest_.empty());
        return text;
    }
    /// Of text: bits need no blanks between them.
    int bit() {
        skipBlanks();
        const int value = byte() - '0';
        if (value != 0 && value != 1) fail("a bit is neither 0 nor 1");
        return value;
    }
    /// Blanks, and comments of '#' up to their lines' ends.
    void skipBlanks() {
        while (!rest_.empty()) {
            const int c = std::to_integer<int>(rest_[0]);
            if (c != '#' && !isBlank(c)) return;
            do take(1);
            while (c == '#' && !rest_.empty() && rest_[0] != std::byte{'\n'} &&
                   rest_[0] != std::byte{'\r'});
        }
    }
    int number() {
        const std::string text = word();
        const auto value = parsedNumber<int>(text);
        if (!value || *value < 0) fail("has '" + text + "' where a number is allowed");
        return *value;
    }
    /// Of a line that ends in blanks, and has nothing but these bytes behind it.
    void skipLineEnd(std::size_t count) {
        const std::size_t more = rest_.size() - std::min(count, rest_.size());
        const bool isEnd = more == 1 || (more == 2 && isBlank(std::to_integer<int>(rest_[0])));
        if (isEnd && rest_[more - 1] == std::byte{'\n'}) take(more);
    }
    /// All that is behind the last word, whose blank may be the two characters of a line's end.
    std::span<const std::byte> raster(std::size_t count) {
        if (isReturn_ && rest_.size() > count && rest_[0] == std::byte{'\n'}) take(1);
        return take(count);
    }
    void checkSize(int width, int height, std::size_t pixelBytes) const {
        checkDeclaredSize(width, height, pixelBytes, size_, name_, kMaxSidePx, ImageUse::Picture);
    }

  private:
    static bool isBlank(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    std::span<const std::byte> rest_;
    std::size_t size_;
    const std::string& name_;
    std::string part_ = "its header";
    bool isReturn_ = false;  // the blank behind the last word
};

float unitOf(std::byte value) {
    return static_cast<float>(std::to_integer<int>(value)) / 255.0F;
}

/// Without the stuffed bytes (FF 00) that some programs leave between a scan and the next marker:
/// stb takes them for a marker.
std::vector<std::byte> withoutStuffedEnds(std::span<const std::byte> bytes) {
    std::vector<std::byte> kept;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const auto at = [&](std::size_t ahead) {
            return i + ahead < bytes.size() ? std::to_integer<int>(bytes[i + ahead]) : -1;
        };
        const bool isRestart = at(3) >= 0xD0 && at(3) <= 0xD7;
        const bool isMarker = at(2) == 0xFF && at(3) > 0 && at(3) < 0xFF && !isRestart;
        if (at(0) == 0xFF && at(1) == 0 && isMarker) {
            ++i;
        } else {
            kept.push_back(bytes[i]);
        }
    }
    return kept;
}

constexpr int kScan = 0xDA;

/// What follows `name` in each segment of a JPEG file with this marker that begins with it, up to
/// the first scan.
std::vector<Part> segmentsOf(Part bytes, int marker, std::string_view name) {
    std::vector<Part> found;
    for (std::size_t at = 2; at + 4 <= bytes.size() && bytes[at] == std::byte{0xFF};) {
        const auto kind = std::to_integer<int>(bytes[at + 1]);
        const std::size_t length = numberAt(bytes, at + 2, 2, false);
        const Part segment = bytes.subspan(at + 4).first(
            std::min(bytes.size() - at - 4, std::max<std::size_t>(length, 2) - 2));
        if (kind == marker && textOf(segment).starts_with(name)) {
            found.push_back(segment.subspan(name.size()));
        }
        if (kind == kScan) break;
        at += kind == 0xFF ? 1 : 2 + length;  // a marker may stand behind several
    }
    return found;
}

/// What stands behind the end of a JPEG file's picture; nothing where it has no end.
std::optional<Part> behindJpeg(Part bytes) {
    const std::vector<Part> scan = segmentsOf(bytes, kScan, "");
    const auto from = scan.empty() ? 0 : static_cast<std::size_t>(scan[0].data() - bytes.data());
    const std::size_t end = textOf(bytes).find("\xFF\xD9", from);
    if (end == std::string_view::npos) return std::nullopt;
    return bytes.subspan(end + 2);
}

/// Of four inks, which printers have, stb makes colours by the Adobe marker alone, and by a
/// formula.
void requireNoInks(Part bytes, const std::string& name) {
    for (const int frame : {0xC0, 0xC1, 0xC2}) {
        for (const Part head : segmentsOf(bytes, frame, "")) {
            if (numberAt(head, 5, 1, false) != 4) continue;
            throw Error(name + ": its colours are four inks (CMYK); grey and RGB are allowed");
        }
    }
}

}  // namespace

std::string endsEarly(std::string_view part, std::uint64_t from, std::uint64_t needed,
                      std::uint64_t found) {
    return fmt::format("the file ends early{}{}: bytes needed from byte {} on: {}, found: {}",
                       part.empty() ? "" : " in ", part, from, needed, found);
}

void flipRows(ImageF& image) {
    for (int y = 0; y < image.height() / 2; ++y) {
        std::ranges::swap_ranges(image.row(y), image.row(image.height() - 1 - y));
    }
}

Image8 decodeByStb(std::span<const std::byte> bytes, const std::string& name, ImageUse use) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw Error(name + ": an image of more than 2 GiB");
    }
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const auto size = static_cast<int>(bytes.size());
    int width = 0;
    int height = 0;
    int channels = 0;
    const bool isJpeg = textOf(bytes).starts_with("\xFF\xD8");
    if (isJpeg) requireNoInks(bytes, name);
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
        throw Error(name + ": " + stbi_failure_reason());
    }
    checkDeclaredSize(width, height, 4, bytes.size(), name, kMaxSidePx, use);
    // stb fills up what is not there.
    if (isJpeg && !behindJpeg(bytes)) {
        throw Error(
            fmt::format("{}: the file ends early in its pixels: its {} bytes have no end "
                        "of the picture (FF D9)",
                        name, bytes.size()));
    }
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, channels), stbi_image_free);
    if (pixels == nullptr) {
        const std::string reason = stbi_failure_reason();
        if (reason == "unknown marker") {
            const std::vector<std::byte> mended = withoutStuffedEnds(bytes);
            if (mended.size() < bytes.size()) return decodeByStb(mended, name, use);
        }
        throw Error(name + ": " + reason);
    }
    Image8 image(width, height, channels);
    std::copy_n(pixels.get(), image.values().size(), image.values().begin());
    return image;
}

std::vector<std::string> notesOfJpeg(std::span<const std::byte> bytes) {
    // Behind the name are the part's number and their count; the description is in the first.
    const std::vector<Part> profile = segmentsOf(bytes, 0xE2, "ICC_PROFILE\0"sv);
    if (profile.empty() || profile[0].size() < 2) return {};
    if (isProfileOfSrgb(profile[0].subspan(2), false)) return {};
    return {kProfileLeftOut};
}

Decoded decodeJpeg(std::span<const std::byte> bytes, const std::string& name) {
    const Image8 image = decodeByStb(bytes, name, ImageUse::Picture);
    Decoded result{ImageF(image.width(), image.height(), image.channels())};
    std::ranges::transform(image.values(), result.values.values().begin(),
                           [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; });
    const std::vector<Part> exif = segmentsOf(bytes, 0xE1, "Exif\0\0"sv);
    if (!exif.empty()) result.values = turnedAsExif(result.values, exif[0]);
    result.notes = notesOfJpeg(bytes);
    const std::vector<Part> jfif = segmentsOf(bytes, 0xE0, "JFIF\0"sv);
    if (!jfif.empty() && jfif[0].size() >= 7) {  // version, unit, and of both directions
        noteAspect(static_cast<double>(numberAt(jfif[0], 3, 2, false)),
                   static_cast<double>(numberAt(jfif[0], 5, 2, false)), result.notes);
    }
    noteBehind(behindJpeg(bytes).value_or(Part()), result.notes);
    return result;
}

namespace {

Decoded floatsOfPfm(Bytes& file, int channels) {
    const int width = file.number(), height = file.number();
    const std::string text = file.word();
    const std::optional<double> scale = parsedNumber<double>(text);
    if (!scale || std::abs(*scale) != 1.0) {
        file.fail("its scale is " + text + "; 1 or -1 are allowed, as readers differ in others");
    }
    file.checkSize(width, height, static_cast<std::size_t>(channels) * sizeof(float));
    Decoded result{ImageF(width, height, channels), true};
    const auto values = result.values.values();
    file.begin("its pixels");
    file.skipLineEnd(values.size_bytes());
    std::memcpy(values.data(), file.raster(values.size_bytes()).data(), values.size_bytes());
    if ((*scale > 0.0) != (std::endian::native == std::endian::big)) {
        for (float& value : values) {
            value = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
        }
    }
    flipRows(result.values);
    noteBehind(file.rest(), result.notes);
    return result;
}

}  // namespace

Decoded decodeNetpbm(std::span<const std::byte> bytes, const std::string& name) {
    Bytes file(bytes, name);
    const std::string kind = file.word();
    if (kind == "PF" || kind == "Pf") return floatsOfPfm(file, kind == "PF" ? 3 : 1);
    const int number = kind.size() == 2 && kind[0] == 'P' ? kind[1] - '0' : 0;
    if (number < 1 || number > 6) {
        file.fail("a file of kind " + kind + "; P1 to P6, Pf and PF are read");
    }
    const bool isText = number <= 3, isBits = number % 3 == 1;  // 1 is black
    const int channels = number % 3 == 0 ? 3 : 1;
    const int width = file.number(), height = file.number(), most = isBits ? 1 : file.number();
    if (most < 1 || most > 65535) {
        file.fail(fmt::format("its largest value is {}; 1 to 65535 are allowed", most));
    }
    file.checkSize(width, height, static_cast<std::size_t>(channels) * sizeof(float));
    Decoded result{ImageF(width, height, channels), false, most < 256 ? 8 : 16};
    const auto values = result.values.values();
    file.begin("its pixels");
    const std::size_t valueBytes = most < 256 ? 1 : 2;
    const std::size_t rowBytes = (static_cast<std::size_t>(width) + 7) / 8;  // of bits
    const Part raster = isText   ? Part()
                        : isBits ? file.raster(rowBytes * static_cast<std::size_t>(height))
                                 : file.raster(values.size() * valueBytes);
    for (std::size_t i = 0; i < values.size(); ++i) {
        int value = 0;
        if (isText) {
            value = isBits ? file.bit() : file.number();
        } else if (isBits) {
            const std::size_t x = i % static_cast<std::size_t>(width);
            const std::size_t row = i / static_cast<std::size_t>(width);
            value = std::to_integer<int>(raster[row * rowBytes + x / 8]) >> (7 - x % 8) & 1;
        } else {
            value = static_cast<int>(numberAt(raster, i * valueBytes, valueBytes, false));
        }
        if (value > most) file.fail(fmt::format("holds {}, its largest value is {}", value, most));
        values[i] = static_cast<float>(isBits ? 1 - value : value) / static_cast<float>(most);
    }
    if (!file.rest().empty() && file.rest()[0] == std::byte{'P'}) {
        file.fail("has several pictures; one is allowed");
    }
    noteBehind(file.rest(), result.notes);
    return result;
}

namespace {

/// What the lines of the header multiply the values of each channel by.
std::array<float, 3> factorsOfHdr(Bytes& file, std::vector<std::string>& notes) {
    std::array<float, 3> factors{1.0F, 1.0F, 1.0F};
    const auto numbersOf = [&](const std::string& line, std::size_t count) {
        std::vector<float> numbers;
        for (const std::string& word : split(line.substr(line.find('=') + 1), ' ')) {
            const auto number = parsedNumber<float>(trimmed(word));
            if (number && std::isfinite(*number)) numbers.push_back(*number);
        }
        if (numbers.size() != count) file.fail("its header has '" + line + "'");
        return numbers;
    };
    for (std::string line = file.line(); !line.empty(); line = file.line()) {
        // What is indented is of a picture that this one was made of.
        const std::size_t end = line.find('=');
        const std::string_view key =
            end == line.npos || line.starts_with(' ') || line.starts_with('\t')
                ? std::string_view()
                : trimmed(std::string_view(line).substr(0, end));
        if (key == "FORMAT" && trimmed(line.substr(end + 1)) != "32-bit_rle_rgbe") {
            file.fail(line + " is not read; 32-bit_rle_rgbe is");
        }
        const bool isExposure = key == "EXPOSURE";
        if (isExposure || key == "COLORCORR") {
            const auto numbers = numbersOf(line, isExposure ? 1 : 3);
            for (std::size_t c = 0; c < 3; ++c) {
                factors[c] *= numbers[isExposure ? 0 : c];
                if (!(factors[c] > 0.0F)) file.fail("its header has '" + line + "'");
            }
        }
        if ((key == "PIXASPECT" || key == "GAMMA") && numbersOf(line, 1)[0] != 1.0F) {
            notes.push_back("left out: " + line);
        }
        if (key == "PRIMARIES") {
            // Radiance's own, whose white is that of equal energy, everybody takes for sRGB's.
            // Zeros are none: so write programs that do not know them.
            const auto numbers = numbersOf(line, 8);
            if (std::ranges::count(numbers, 0.0F) == 8) continue;
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                if (std::abs(numbers[i] - kRec709[i]) > 0.03F) {
                    file.fail(line + ": other primaries than those of Rec. 709");
                }
            }
        }
    }
    return factors;
}

using Rgbe = std::array<int, 4>;

/// A row whose four channels lie one behind the other.
void readPlanes(Bytes& file, std::vector<Rgbe>& row) {
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t x = 0; x < row.size();) {
            const int code = file.byte();
            const std::size_t count = static_cast<std::size_t>(code > 128 ? code - 128 : code);
            if (count == 0 || count > row.size() - x) file.fail("a run is longer than its row");
            const int run = code > 128 ? file.byte() : 0;
            for (std::size_t i = 0; i < count; ++i) {
                row[x++][c] = code > 128 ? run : file.byte();
            }
        }
    }
}

/// A row of pixels; (1, 1, 1, n) repeats the one before.
void readPixels(Bytes& file, std::vector<Rgbe>& row, Rgbe pixel) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1 && x > 0) {
            const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
            if (count > row.size() - x) file.fail("a run is longer than its row");
            for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
            shift = std::min(shift + 8, 24);
        } else {
            row[x++] = pixel;
            shift = 0;
        }
        if (x == row.size()) return;
        for (int& value : pixel) value = file.byte();
    }
}

}  // namespace

Decoded decodeHdr(std::span<const std::byte> bytes, const std::string& name) {
    Bytes file(bytes, name);
    file.line();  // "#?RADIANCE"
    std::vector<std::string> notes;
    const std::array<float, 3> factors = factorsOfHdr(file, notes);
    const std::string size = file.line();
    const std::vector<std::string> words = split(trimmed(size), ' ');
    const bool isUsual = words.size() == 4 && words[0] == "-Y" && words[2] == "+X";
    const int height = isUsual ? parsedNumber<int>(words[1]).value_or(0) : 0;
    const int width = isUsual ? parsedNumber<int>(words[3]).value_or(0) : 0;
    if (height <= 0 || width <= 0) {
        file.fail("its size is '" + size + "'; allowed: -Y height +X width, rows from the top");
    }
    checkDeclaredSize(width, height, 3 * sizeof(float), bytes.size(), name, kMaxSidePx,
                      ImageUse::Picture);
    Decoded result{ImageF(width, height, 3), true};
    result.notes = std::move(notes);
    std::vector<Rgbe> row(static_cast<std::size_t>(width));
    for (int y = 0; y < result.values.height(); ++y) {
        Rgbe first{};
        file.begin(fmt::format("row {} of {}", y + 1, height));
        for (int& value : first) value = file.byte();
        if (first[0] == 2 && first[1] == 2 && first[2] * 256 + first[3] == width && width >= 8) {
            readPlanes(file, row);
        } else {
            readPixels(file, row, first);
        }
        for (std::size_t x = 0; x < row.size(); ++x) {
            const float step = row[x][3] == 0 ? 0.0F : std::ldexp(1.0F, row[x][3] - 136);
            for (std::size_t c = 0; c < 3; ++c) {
                result.values.row(y)[3 * x + c] = static_cast<float>(row[x][c]) * step / factors[c];
            }
        }
    }
    noteBehind(file.rest(), result.notes);
    return result;
}

namespace {

/// The end of a file of TGA 2.0; empty of others.
Part footerOfTga(Part bytes) {
    const Part footer = bytes.last(std::min<std::size_t>(bytes.size(), 26));
    const bool isThere = footer.size() == 26 && textOf(footer).substr(8, 16) == "TRUEVISION-XFILE";
    return isThere ? footer : Part();
}

/// Its extension area; empty where there is none.
Part extensionOfTga(Part bytes) {
    constexpr std::size_t kArea = 495;
    const std::size_t area = numberAt(footerOfTga(bytes), 0, 4, true);
    if (area == 0 || area > bytes.size() || bytes.size() - area < kArea) return {};
    return bytes.subspan(area, kArea);
}

/// Whether it says a gamma other than 1.
bool saysGamma(Part extension) {
    const std::size_t above = numberAt(extension, 478, 2, true);
    const std::size_t below = numberAt(extension, 480, 2, true);
    return below != 0 && above != below;
}

/// Its type of attributes: up to 2 there is no alpha, 3 is straight, 4 multiplied into the colours.
int attributesOf(Part extension) {
    return extension.empty() ? 3 : std::to_integer<int>(extension.back());
}

/// Of sRGB, as in TIFF files.
void divideByAlpha(std::span<float> values) {
    for (std::size_t i = 0; i < values.size(); i += 4) {
        for (float& value : values.subspan(i, 3)) {
            if (values[i + 3] > 0.0F) value = std::min(1.0F, value / values[i + 3]);
        }
    }
}

}  // namespace

Decoded decodeTga(std::span<const std::byte> bytes, const std::string& name) {
    Bytes file(bytes, name);
    const auto idBytes = static_cast<std::size_t>(file.byte());
    const int hasPalette = file.byte(), type = file.byte();
    const int firstEntry = file.littleWord(), entryCount = file.littleWord();
    const int entryBits = file.byte();
    file.take(4);  // where a screen has the picture
    const int width = file.littleWord(), height = file.littleWord();
    const int bits = file.byte(), flags = file.byte();
    const bool isGrey = type % 8 == 3, isIndexed = type % 8 == 1, isEncoded = type > 8;
    const int colourBits = isIndexed ? entryBits : bits;
    const bool isColour = type % 8 <= 2 && (colourBits == 24 || colourBits == 32) &&
                          (!isIndexed || (bits == 8 && hasPalette == 1));
    if (type > 11 || !(isGrey ? bits == 8 : isColour) || hasPalette > 1 || (flags & 0xD0) != 0) {
        file.fail(fmt::format(
            "a TGA file of type {}, {} bits{} and flags {:#x}; grey of 8, RGB of 24 and RGBA of 32 "
            "bits, or 8 of a palette of such, columns from the left, are read",
            type, bits, isIndexed ? fmt::format(" of a palette of {}", entryBits) : "", flags));
    }
    file.begin("its name");
    file.take(idBytes);
    file.begin("its palette");
    const std::size_t entryBytes = static_cast<std::size_t>(entryBits + 7) / 8;
    // One of true colours is advice for a screen.
    const Part palette =
        hasPalette == 1 ? file.take(static_cast<std::size_t>(entryCount) * entryBytes) : Part();
    const std::size_t pixelBytes = static_cast<std::size_t>(bits) / 8;
    const Part extension = extensionOfTga(bytes);
    const int attributes = attributesOf(extension);
    const bool hasAlpha = colourBits == 32 && (flags & 15) == 8 && attributes > 2;
    file.checkSize(width, height, 4 * sizeof(float));
    file.begin("its pixels");
    Decoded result{ImageF(width, height, isGrey ? 1 : hasAlpha ? 4 : 3)};
    const auto channels = static_cast<std::size_t>(result.values.channels());
    const auto values = result.values.values();
    if (!isEncoded) file.require(values.size() / channels * pixelBytes);
    std::byte least{0xFF}, most{0};  // of bytes that may be alpha
    const auto nextPixel = [&] {
        const Part pixel = file.take(pixelBytes);
        if (!isIndexed) return pixel;
        const int index = std::to_integer<int>(pixel[0]), entry = index - firstEntry;
        if (entry < 0 || entry >= entryCount) {
            file.fail(fmt::format("a pixel of colour {}; its palette has {} … {}", index,
                                  firstEntry, firstEntry + entryCount - 1));
        }
        return palette.subspan(static_cast<std::size_t>(entry) * entryBytes, entryBytes);
    };
    for (std::size_t i = 0; i < values.size();) {
        const int code = isEncoded ? file.byte() : 0;
        const auto count = static_cast<std::size_t>(code % 128 + 1);
        Part pixel = nextPixel();
        for (std::size_t k = 0; k < count; ++k) {
            if (i == values.size()) file.fail("a run is longer than the picture");
            if (k > 0 && code < 128) pixel = nextPixel();
            least = std::min(least, pixel.back());
            most = std::max(most, pixel.back());
            for (std::size_t c = 0; c < channels; ++c) {  // blue, green, red, alpha
                values[i++] = unitOf(pixel[channels == 1 || c == 3 ? c : 2 - c]);
            }
        }
    }
    if (hasAlpha && attributes == 4) divideByAlpha(values);
    if (colourBits == 32 && !hasAlpha && least < most) {
        result.notes.emplace_back("left out: its pixels' fourth byte, which it calls no alpha");
    }
    if ((flags & 0x20) == 0) flipRows(result.values);
    if (saysGamma(extension)) result.notes.emplace_back("left out: its gamma");
    noteAspect(static_cast<double>(numberAt(extension, 476, 2, true)),
               static_cast<double>(numberAt(extension, 474, 2, true)), result.notes);
    if (footerOfTga(bytes).empty()) noteBehind(file.rest(), result.notes);
    return result;
}

}  // namespace gfxrepro::image
