#include "engine/image/png_io.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/foreign_text.h"
#include "engine/image/formats.h"

namespace gfxrepro::image {
namespace {

constexpr bool kSwapBytes = std::endian::native == std::endian::little;  // PNG is big-endian
// Of 1 … 9: a run writes hundreds of images, and waits for each; a file that carries images is
// sent.
constexpr int kZlibLevel = 2, kSentZlibLevel = 9;

/// libpng reports an error by this callback, which must not return.
[[noreturn]] void keepMessageAndJump(png_structp png, png_const_charp message) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

/// Runs libpng calls and turns libpng's longjmp into an Error. `step` and what it calls hold
/// nothing with a destructor, as a jump would skip it.
template <class Step>
void guarded(png_structp png, const std::string& place, const std::string& message, Step&& step) {
    if (setjmp(png_jmpbuf(png)) != 0) throw Error(place + ": " + message);
    step();
}

class Reader {
  public:
    /// Reads the header. It delegates so that the destructor runs when that throws.
    Reader(std::span<const std::byte> bytes, const std::string& name, ImageUse use)
        : Reader(bytes.first(std::min(bytes.size(), kSignatureBytes)), name, Unread{}) {
        rest_ = bytes;
        sizeBytes_ = bytes.size();
        png_set_read_fn(png_, this, take);
        readHeader(bytes.size(), kMaxSidePx, use);
    }
    /// The same of a file, which is read as far as its rows are.
    Reader(std::ifstream& file, std::size_t fileBytes, const std::string& name,
           std::int64_t maxSidePx, ImageUse use)
        : Reader(signatureOf(file), name, Unread{}) {
        png_set_read_fn(png_, &file, takeOfFile);
        readHeader(fileBytes, maxSidePx, use);
    }
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    int bitDepth() const { return png_get_bit_depth(png_, info_); }
    int width() const { return static_cast<int>(png_get_image_width(png_, info_)); }
    int height() const { return static_cast<int>(png_get_image_height(png_, info_)); }
    int channels() const { return png_get_channels(png_, info_); }
    bool isInterlaced() const { return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE; }
    /// Of chunk iCCP; empty where there is none.
    std::span<const std::byte> profile() const {
        png_charp name = nullptr;
        png_bytep bytes = nullptr;
        png_uint_32 size = 0;
        int method = 0;
        if (png_get_iCCP(png_, info_, &name, &method, &bytes, &size) == 0) return {};
        return std::as_bytes(std::span(bytes, size));
    }

    /// How many pixels have a number that the palette does not; in the place of expandTo().
    std::size_t pixelsBeyondPalette() {
        png_colorp palette = nullptr;
        int colours = 0;
        if (png_get_PLTE(png_, info_, &palette, &colours) == 0 || colours >= 1 << bitDepth() ||
            png_get_color_type(png_, info_) != PNG_COLOR_TYPE_PALETTE) {
            return 0;
        }
        guarded(png_, name_, message_, [this] {
            png_set_packing(png_);
            png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        });
        const Image8 numbers = image<std::uint8_t>();
        return static_cast<std::size_t>(std::ranges::count_if(
            numbers.values(), [colours](std::uint8_t number) { return number >= colours; }));
    }

    /// Rows come as T, palettes, low depths and transparent colours expanded.
    template <class T>
    void expandTo() {
        guarded(png_, name_, message_, [this] {
            png_set_expand(png_);
            if (sizeof(T) == 2) {
                png_set_expand_16(png_);
                if (kSwapBytes) png_set_swap(png_);
            }
            png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        });
    }

    /// All rows, after expandTo<T>().
    template <class T>
    Image<T> image() {
        Image<T> image(width(), height(), channels());
        std::vector<png_bytep> rows(static_cast<std::size_t>(image.height()));
        for (int y = 0; y < image.height(); ++y) {
            rows[static_cast<std::size_t>(y)] = reinterpret_cast<png_bytep>(image.row(y).data());
        }
        GFXREPRO_ASSERT_EQ(png_get_rowbytes(png_, info_), image.row(0).size_bytes());
        guarded(png_, name_, message_, [this, &rows] {
            png_read_image(png_, rows.data());
            png_read_end(png_, nullptr);
        });
        return image;
    }

    template <class T>
    Image<T> decoded() {
        expandTo<T>();
        return image<T>();
    }

    /// The next row, after expandTo<T>() of its T; with the last one, what follows it.
    void readRow(void* values, bool isLast) {
        guarded(png_, name_, message_, [&] {
            png_read_row(png_, static_cast<png_bytep>(values), nullptr);
            if (isLast) png_read_end(png_, nullptr);
        });
    }

  private:
    static constexpr std::size_t kSignatureBytes = 8;
    using Signature = std::array<std::byte, kSignatureBytes>;
    struct Unread {};
    Reader(std::span<const std::byte> signature, const std::string& name, Unread) : name_(name) {
        if (signature.size() < kSignatureBytes ||
            png_sig_cmp(reinterpret_cast<png_const_bytep>(signature.data()), 0, kSignatureBytes) !=
                0) {
            throw Error(name + ": not a PNG file");
        }
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message_, keepMessageAndJump,
                                      ignoreWarning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw Error(name + ": libpng cannot be started");
        }
    }

    static Signature signatureOf(std::ifstream& file) {
        Signature signature{};
        file.read(reinterpret_cast<char*>(signature.data()), kSignatureBytes);
        file.clear();
        file.seekg(0);
        return signature;
    }

    void readHeader(std::size_t fileBytes, std::int64_t maxSidePx, ImageUse use) {
        guarded(png_, name_, message_, [this] { png_read_info(png_, info_); });
        checkDeclaredSize(png_get_image_width(png_, info_), png_get_image_height(png_, info_),
                          decodedBytesPerPixel(), fileBytes, name_, maxSidePx, use);
    }

    /// libpng jumps out of this: nothing is left that would have to be destroyed.
    [[noreturn]] static void failEarly(png_structp png, std::size_t from, std::size_t needed,
                                       std::size_t found) {
        const png_uint_32 state = png_get_io_state(png) & PNG_IO_MASK_LOC;
        const png_uint_32 kind = png_get_io_chunk_type(png);
        char part[] = "chunk IDAT";
        for (int i = 0; i < 4; ++i) part[6 + i] = static_cast<char>(kind >> (24 - 8 * i));
        const bool isInChunk = state == PNG_IO_CHUNK_DATA || state == PNG_IO_CHUNK_CRC;
        auto& message = *static_cast<std::string*>(png_get_error_ptr(png));
        message = endsEarly(isInChunk ? part : "the head of a chunk", from, needed, found);
        png_error(png, message.c_str());
    }

    static void takeOfFile(png_structp png, png_bytep to, std::size_t count) {
        auto& file = *static_cast<std::ifstream*>(png_get_io_ptr(png));
        file.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count));
        const auto found = static_cast<std::size_t>(file.gcount());
        if (found == count) return;
        file.clear();
        failEarly(png, static_cast<std::size_t>(file.tellg()) - found, count, found);
    }

    static void take(png_structp png, png_bytep to, std::size_t count) {
        auto& reader = *static_cast<Reader*>(png_get_io_ptr(png));
        std::span<const std::byte>& rest = reader.rest_;
        if (count > rest.size()) {
            failEarly(png, reader.sizeBytes_ - rest.size(), count, rest.size());
        }
        std::memcpy(to, rest.data(), count);
        rest = rest.subspan(count);
    }

    /// At most: with the alpha that a transparent colour may add.
    std::size_t decodedBytesPerPixel() const {
        return bitDepth() == 16 ? 4 * sizeof(std::uint16_t) : 4;
    }

    std::span<const std::byte> rest_;
    std::size_t sizeBytes_ = 0;
    std::string name_;
    std::string message_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

class Writer {
  public:
    explicit Writer(int zlibLevel = kZlibLevel) {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message_, keepMessageAndJump,
                                       ignoreWarning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_write_struct(&png_, &info_);
            throw Error("libpng cannot be started");
        }
        png_set_write_fn(png_, &encoded_, append, nullptr);
        png_set_compression_level(png_, zlibLevel);
    }
    ~Writer() { png_destroy_write_struct(&png_, &info_); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /// `place` begins the message of an Error.
    template <class T>
    std::string encoded(const Image<T>& image, const std::string& place) {
        constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                        PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
        if (image.channels() > 4) {
            throw Error(place + ": " + std::to_string(image.channels()) +
                        " channels; PNG has 1 to 4");
        }
        const std::size_t rowValues =
            static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.channels());
        guarded(png_, place, message_, [&] {
            png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.width()),
                         static_cast<png_uint_32>(image.height()), 8 * sizeof(T),
                         kColourTypes[image.channels() - 1], PNG_INTERLACE_NONE,
                         PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
            png_write_info(png_, info_);
            if (sizeof(T) == 2 && kSwapBytes) png_set_swap(png_);
            for (std::size_t y = 0; y < static_cast<std::size_t>(image.height()); ++y) {
                png_write_row(
                    png_, reinterpret_cast<png_const_bytep>(image.values().data() + y * rowValues));
            }
            png_write_end(png_, info_);
        });
        return std::move(encoded_);
    }

  private:
    static void append(png_structp png, png_bytep from, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(png))
            ->append(reinterpret_cast<const char*>(from), count);
    }

    std::string encoded_;
    std::string message_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

Image8 decoded8(std::span<const std::byte> bytes, const std::string& name, ImageUse use) {
    Reader reader(bytes, name, use);
    if (reader.bitDepth() == 16) throw Error(name + ": 16 bits a channel; at most 8 are allowed");
    return reader.decoded<std::uint8_t>();
}

template <class T>
void writeEncoded(const std::filesystem::path& path, const Image<T>& image) {
    writeFileAtomic(path, Writer().encoded(image, "cannot write " + path.string()));
}

/// What each kind of chunk holds, up to the last; of several of a kind the first.
std::map<std::string, std::span<const std::byte>> chunksOf(std::span<const std::byte> bytes) {
    constexpr std::size_t kSignature = 8, kHead = 8, kChecksum = 4;
    std::map<std::string, std::span<const std::byte>> chunks;
    for (std::size_t at = kSignature; at + kHead + kChecksum <= bytes.size();) {
        const std::size_t length = numberAt(bytes, at, 4, false);
        if (length > bytes.size() - at - kHead - kChecksum) break;
        chunks.try_emplace({reinterpret_cast<const char*>(&bytes[at + 4]), 4},
                           bytes.subspan(at + kHead, length));
        if (chunks.contains("IEND")) break;
        at += kHead + length + kChecksum;
    }
    return chunks;
}

}  // namespace

PngPhysics pngPhysics(std::span<const std::byte> bytes) {
    const auto chunks = chunksOf(bytes);
    PngPhysics said;
    said.hasValues = chunks.contains("pCAL");
    const auto exif = chunks.find("eXIf");
    said.isTurned = exif != chunks.end() && orientationOf(exif->second) != 1;
    const auto size = chunks.find("sCAL");
    said.hasSize = size != chunks.end();
    if (!said.hasSize || size->second.empty()) return said;
    const std::string_view text = textOf(size->second);  // 1: metres; a number, a 0, a number
    const std::size_t end = std::min(text.find('\0'), text.size() - 1);
    const auto x = parsedNumber<float>(text.substr(1, std::max<std::size_t>(end, 1) - 1));
    const auto y = parsedNumber<float>(text.substr(end + 1));
    const auto isLength = [](const std::optional<float>& side) {
        return side && *side > 0.0F && std::isfinite(*side);
    };
    if (text[0] == 1 && isLength(x) && isLength(y)) said.pixelM = {*x, *y};
    return said;
}

PngColours pngColours(std::span<const std::byte> bytes, const std::string& name) {
    constexpr std::size_t kSrgbGamma = 45455;
    constexpr std::array kSrgbCode{std::byte{1}, std::byte{13}, std::byte{0}, std::byte{1}};
    constexpr double kStep = 1e-5, kTolerance = 1e-3;
    const auto chunks = chunksOf(bytes);
    const auto has = [&](const char* chunk, std::size_t size) {
        const auto found = chunks.find(chunk);
        return found != chunks.end() && found->second.size() == size;
    };
    PngColours colours;
    if (const auto exif = chunks.find("eXIf"); exif != chunks.end()) colours.exif = exif->second;
    if (has("pHYs", 9)) {
        noteAspect(static_cast<double>(numberAt(chunks.at("pHYs"), 0, 4, false)),
                   static_cast<double>(numberAt(chunks.at("pHYs"), 4, 4, false)),
                   colours.notesOfFile);
    }
    if (const auto end = chunks.find("IEND"); end != chunks.end()) {
        constexpr std::size_t kChecksum = 4;
        const auto behind = static_cast<std::size_t>(end->second.data() - bytes.data()) + kChecksum;
        noteBehind(bytes.subspan(behind + end->second.size()), colours.notesOfFile);
    }
    if (chunks.contains("PLTE")) {
        colours.beyondPalette = Reader(bytes, name, ImageUse::Picture).pixelsBeyondPalette();
    }
    if (chunks.contains("acTL")) colours.notes.emplace_back("left out: all but its first frame");
    if (has("cICP", 4)) {
        if (std::ranges::equal(chunks.at("cICP"), kSrgbCode)) return colours;
        colours.notes.emplace_back("left out: its colour space (chunk cICP)");
    } else if (chunks.contains("iCCP")) {
        if (isProfileOfSrgb(Reader(bytes, name, ImageUse::Picture).profile(), false)) {
            return colours;
        }
        colours.notes.emplace_back(kProfileLeftOut);
    }
    if (chunks.contains("sRGB")) return colours;
    if (has("gAMA", 4)) {
        const std::size_t gamma = numberAt(chunks.at("gAMA"), 0, 4, false);
        if (gamma == 0) colours.notes.emplace_back("left out: its gamma of 0");
        if (gamma < kSrgbGamma - 5 || gamma > kSrgbGamma + 5)
            colours.gamma = static_cast<double>(gamma) * kStep;
    }
    if (has("cHRM", 8 * sizeof(std::uint32_t))) {
        Chromaticities given{};  // the file has the white first
        bool isRec709 = true;
        for (std::size_t i = 0; i < given.size(); ++i) {
            given[i] =
                static_cast<float>(kStep * static_cast<double>(numberAt(
                                               chunks.at("cHRM"), 4 * ((i + 2) % 8), 4, false)));
            isRec709 = isRec709 && std::abs(given[i] - kRec709[i]) < kTolerance;
        }
        if (!isRec709) colours.primaries = given;
    }
    return colours;
}

Image8 decodePng8(std::span<const std::byte> bytes, const std::string& name) {
    return decoded8(bytes, name, ImageUse::Texture);
}

Image8 readPng8(const std::filesystem::path& path) {
    return decoded8(MappedFile(path).bytes(), path.string(), ImageUse::Picture);
}

Image16 readPng16(const std::filesystem::path& path) {
    const MappedFile file(path);
    return Reader(file.bytes(), path.string(), ImageUse::Picture).decoded<std::uint16_t>();
}

class PngRows::Decoder {
  public:
    Decoder(const std::filesystem::path& path, std::int64_t maxSidePx, ImageUse use)
        : file_(opened(path)),
          reader_(file_, std::filesystem::file_size(path), path.string(), maxSidePx, use),
          bitDepth_(reader_.bitDepth()) {
        reader_.expandTo<std::uint16_t>();
    }

    const Reader& reader() const { return reader_; }
    int bitDepth() const { return bitDepth_; }

    void read(std::uint16_t* values) {
        GFXREPRO_ASSERT(row_ < reader_.height());
        if (!reader_.isInterlaced()) {
            reader_.readRow(values, row_ + 1 == reader_.height());
        } else {
            if (row_ == 0) whole_ = reader_.image<std::uint16_t>();
            const auto row = whole_->row(row_);
            std::copy(row.begin(), row.end(), values);
        }
        ++row_;
    }

  private:
    static std::ifstream opened(const std::filesystem::path& path) {
        std::error_code isAbsent;
        const auto status = std::filesystem::status(path, isAbsent);
        if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
            throw Error("cannot read " + path.string() + ": a folder, a pipe or a device");
        }
        std::ifstream file(path, std::ios::binary);
        if (!file) throw Error("cannot read " + path.string() + ": " + std::strerror(errno));
        return file;
    }

    std::ifstream file_;
    Reader reader_;
    int bitDepth_;  // of the file: expanded, all are 16
    std::optional<Image16> whole_;
    int row_ = 0;
};

PngRows::PngRows(const std::filesystem::path& path, std::int64_t maxSidePx, ImageUse use)
    : decoder_(std::make_unique<Decoder>(path, maxSidePx, use)) {}
PngRows::~PngRows() = default;
PngRows::PngRows(PngRows&&) noexcept = default;

int PngRows::width() const {
    return decoder_->reader().width();
}
int PngRows::height() const {
    return decoder_->reader().height();
}
int PngRows::channels() const {
    return decoder_->reader().channels();
}
int PngRows::bitDepth() const {
    return decoder_->bitDepth();
}
bool PngRows::isInterlaced() const {
    return decoder_->reader().isInterlaced();
}
void PngRows::read(std::uint16_t* values) {
    decoder_->read(values);
}

void writePng(const std::filesystem::path& path, const Image8& image) {
    writeEncoded(path, image);
}

void writePng(const std::filesystem::path& path, const Image16& image) {
    writeEncoded(path, image);
}

std::string encodePng(const Image8& image) {
    return Writer(kSentZlibLevel).encoded(image, "cannot encode a PNG");
}

}  // namespace gfxrepro::image
