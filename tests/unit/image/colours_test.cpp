// What files say of their colours and of how they are held, and what of it is said to be left out.

#include <stb/stb_image_write.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/files.h"
#include "engine/image/formats.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "tests/support/support.h"

namespace gfxrepro::image {
namespace {

using Lines = std::vector<std::string>;

std::string bigWord(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFF);
    return bytes;
}

std::string bigWords(const std::vector<std::uint32_t>& values) {
    std::string bytes;
    for (const std::uint32_t value : values) bytes += bigWord(value);
    return bytes;
}

/// PNG's checksum.
std::uint32_t crcOf(const std::string& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1U ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

/// As zlib holds it, not compressed.
std::string stored(const std::string& bytes) {
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) {
        a = (a + static_cast<unsigned char>(c)) % 65521;
        b = (b + a) % 65521;
    }
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::string result("\x78\x01\x01", 3);
    for (const std::uint32_t length : {size, ~size}) {
        result += static_cast<char>(length & 0xFF);
        result += static_cast<char>(length >> 8 & 0xFF);
    }
    return result + bytes + bigWord(b << 16 | a);
}

std::string fixed(double value) {
    return bigWord(static_cast<std::uint32_t>(static_cast<std::int32_t>(value * 65536.0)));
}

const std::string kZeros(4, '\0');
const std::string kSrgbCurve = "para" + kZeros + bigWord(3U << 16) + fixed(2.4) + fixed(1 / 1.055) +
                               fixed(0.055 / 1.055) + fixed(1 / 12.92) + fixed(0.04045);
/// The value to the power of this.
std::string powerCurve(double exponent) {
    const auto byte = static_cast<std::uint32_t>(exponent * 256.0);
    return "curv" + kZeros + bigWord(1) + bigWord(byte << 16);
}
using Primaries = std::vector<double>;  // X, Y, Z of red, green, blue
const Primaries kSrgbPrimaries{0.4361, 0.2225, 0.0139, 0.3851, 0.7169,
                               0.0971, 0.1431, 0.0606, 0.7141};
const Primaries kDisplayP3{0.5151, 0.2412, -0.0011, 0.2920, 0.6922, 0.0419, 0.1571, 0.0666, 0.7841};

/// A profile (ICC) that calls itself sRGB, with these tags beside its name.
std::string profileWith(std::vector<std::pair<std::string, std::string>> tags) {
    tags.insert(tags.begin(), {"desc", "desc" + kZeros + bigWord(18) + "sRGB IEC61966-2.1" +
                                           std::string(7, '\0')});
    std::string table = bigWord(static_cast<std::uint32_t>(tags.size())), contents;
    for (const auto& [name, content] : tags) {
        table +=
            name + bigWord(static_cast<std::uint32_t>(132 + 12 * tags.size() + contents.size()));
        table += bigWord(static_cast<std::uint32_t>(content.size()));
        contents += content;
    }
    std::string profile(128, '\0');
    profile.replace(0, 4,
                    bigWord(static_cast<std::uint32_t>(128 + table.size() + contents.size())));
    profile.replace(8, 4, bigWord(0x02100000));
    profile.replace(12, 12, "mntrRGB XYZ ");
    profile.replace(36, 4, "acsp");
    profile.replace(68, 12, bigWords({0xF6D6, 0x10000, 0xD32D}));
    return profile + table + contents;
}

std::string profileOf(const std::string& curve, const Primaries& primaries = kSrgbPrimaries) {
    std::vector<std::pair<std::string, std::string>> tags;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string letter(1, "rgb"[c]);
        std::string xyz = "XYZ " + kZeros;
        for (std::size_t i = 0; i < 3; ++i) xyz += fixed(primaries[3 * c + i]);
        tags.emplace_back(letter + "XYZ", xyz);
        tags.emplace_back(letter + "TRC", curve);
    }
    return profileWith(std::move(tags));
}

/// Whatever they call themselves.
TEST(ColourProfiles, AreComparedByTheirPrimariesAndCurves) {
    const auto isSrgb = [](const std::string& profile, bool isLinear = false) {
        return isProfileOfSrgb(std::as_bytes(std::span(profile)), isLinear);
    };
    EXPECT_TRUE(isSrgb(profileOf(kSrgbCurve)));
    EXPECT_FALSE(isSrgb(profileOf(kSrgbCurve), true));
    EXPECT_FALSE(isSrgb(profileOf(kSrgbCurve, kDisplayP3)));
    EXPECT_FALSE(isSrgb(profileOf(powerCurve(2.2)))) << "0.0083 off at 0.8";
    EXPECT_FALSE(isSrgb(profileOf(powerCurve(1.0))));
    EXPECT_TRUE(isSrgb(profileOf(powerCurve(1.0)), true));
    EXPECT_TRUE(isSrgb(profileOf("curv" + kZeros + kZeros), true)) << "no curve";
    std::string samples = "curv" + kZeros + bigWord(256);
    for (int i = 0; i < 256; ++i) {
        samples += bigWord(static_cast<std::uint32_t>(
                               65535.0F * linearOf(static_cast<float>(i) / 255.0F) + 0.5F))
                       .substr(2);
    }
    EXPECT_TRUE(isSrgb(profileOf(samples)));
    EXPECT_FALSE(isSrgb(profileOf(samples.substr(0, 200)))) << "cut";
    EXPECT_TRUE(isSrgb(profileWith({{"kTRC", kSrgbCurve}}))) << "grey";
    EXPECT_FALSE(isSrgb(profileWith({{"kTRC", powerCurve(1.8)}})));
    EXPECT_FALSE(isSrgb(profileWith({}))) << "a name alone";
    EXPECT_FALSE(isSrgb(profileWith({{"A2B0", "mft2"}, {"kTRC", kSrgbCurve}}))) << "a table";
}

struct ColoursOfFiles : FolderTest {
    using Chunks = std::vector<std::pair<std::string, std::string>>;

    /// One row of these values, with chunks before its palette.
    Picture png(const Image8& image, const Chunks& chunks) const {
        std::string file = encodePng(image);
        std::size_t at = 33;  // behind the signature and the header
        for (const auto& [name, content] : chunks) {
            const std::string chunk = bigWord(static_cast<std::uint32_t>(content.size())) + name +
                                      content + bigWord(crcOf(name + content));
            file.insert(at, chunk);
            at += chunk.size();
        }
        return readPicture(folder.write("a.png", file));
    }
    static Image8 row(const std::vector<std::uint8_t>& values, int channels) {
        Image8 image(static_cast<int>(values.size()) / channels, 1, channels);
        std::copy(values.begin(), values.end(), image.values().begin());
        return image;
    }

    const std::pair<std::string, std::string> gammaOf1_{"gAMA", bigWord(100000)};
    const std::pair<std::string, std::string> displayP3_{
        "cHRM", bigWords({31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000})};
    const Lines wide_{"left out: its pixels are 2 times as wide as high"};
    const Lines converted_{"its values are converted from a gamma of 1 to sRGB"};
};

TEST_F(ColoursOfFiles, GammaOfPng) {
    const Picture plain = png(row({51, 102, 255}, 3), {{"gAMA", bigWord(45455)}});
    EXPECT_EQ(plain.stored.at(0, 0, 0), 51.0F / 255.0F);
    EXPECT_EQ(plain.bits, 8);
    EXPECT_EQ(plain.notes, Lines{});
    const Picture light = png(row({51, 102, 255}, 3), {gammaOf1_});
    EXPECT_FALSE(light.isLinear);
    EXPECT_EQ(light.bits, 16);
    EXPECT_NEAR(light.linear.at(0, 0, 0), 0.2F, 1e-5F);
    EXPECT_NEAR(light.linear.at(0, 0, 1), 0.4F, 1e-5F);
    EXPECT_NEAR(light.linear.at(0, 0, 2), 1.0F, 1e-6F);
    EXPECT_NEAR(light.stored.at(0, 0, 0), srgbOf(0.2F), 1e-6F);
    EXPECT_EQ(light.notes, converted_);
    // Alpha is no light; grey has gamma, too.
    const Picture grey = png(row({51, 51}, 2), {{"gAMA", bigWord(50000)}});
    EXPECT_NEAR(grey.stored.at(0, 0, 0), srgbOf(0.04F), 1e-6F);
    EXPECT_EQ(grey.stored.at(0, 0, 1), 0.2F);
    EXPECT_EQ(png(row({9}, 1), {{"gAMA", bigWord(0)}}).notes, Lines{"left out: its gamma of 0"});
}

TEST_F(ColoursOfFiles, PrimariesOfPng) {
    const Picture same =
        png(row({9, 99, 200}, 3),
            {{"cHRM", bigWords({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000})}});
    EXPECT_EQ(same.stored.at(0, 0, 2), 200.0F / 255.0F);
    EXPECT_EQ(same.notes, Lines{});
    const Picture wide = png(row({128, 51, 51, 90, 90, 90, 255, 0, 0}, 3), {gammaOf1_, displayP3_});
    // Display P3 to sRGB: 1.2249 −0.2247 0 | −0.0420 1.0419 0 | −0.0197 −0.0786 1.0979
    EXPECT_NEAR(wide.linear.at(0, 0, 0), 0.5699F, 1e-3F);
    EXPECT_NEAR(wide.linear.at(0, 0, 1), 0.1873F, 1e-3F);
    EXPECT_NEAR(wide.linear.at(0, 0, 2), 0.1940F, 1e-3F);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(wide.linear.at(1, 0, c), 90.0F / 255.0F, 1e-4F);
    EXPECT_NEAR(wide.linear.at(2, 0, 0), 1.0F, 1e-6F);
    EXPECT_EQ(wide.linear.at(2, 0, 1), 0.0F);
    EXPECT_EQ(
        wide.notes,
        (Lines{converted_[0], "R, G, B are converted from its chromaticities to those of Rec. 709",
               "pixels of colours beyond Rec. 709, which are cut: 1"}));
}

TEST_F(ColoursOfFiles, PrecedenceOfPng) {
    const Image8 image = row({51, 102, 255}, 3);
    const auto profileChunk = [](const std::string& profile) {
        return std::pair<std::string, std::string>(
            "iCCP", "a name" + std::string(2, '\0') + stored(profile));
    };
    const auto first = [&](const Chunks& chunks) { return png(image, chunks).linear.at(0, 0, 0); };
    const float asSrgb = linearOf(0.2F);
    EXPECT_EQ(first({gammaOf1_, displayP3_, {"sRGB", std::string(1, '\0')}}), asSrgb);
    EXPECT_EQ(first({gammaOf1_, profileChunk(profileOf(kSrgbCurve))}), asSrgb);
    EXPECT_EQ(first({gammaOf1_, {"cICP", std::string("\1\x0d\0\1", 4)}}), asSrgb);
    // What the values are beside a profile that is not read is in gAMA.
    const Picture other = png(image, {gammaOf1_, profileChunk(profileOf(kSrgbCurve, kDisplayP3))});
    EXPECT_NEAR(other.linear.at(0, 0, 0), 0.2F, 1e-5F);
    EXPECT_EQ(other.notes, (Lines{"left out: its colour profile", converted_[0]}));
    EXPECT_EQ(png(image, {profileChunk(profileOf(powerCurve(1.0)))}).notes,
              Lines{"left out: its colour profile"});
    EXPECT_EQ(png(image, {{"cICP", std::string("\x09\x10\0\1", 4)}}).notes,
              Lines{"left out: its colour space (chunk cICP)"});
    EXPECT_EQ(png(image, {{"acTL", bigWords({2, 0})}}).notes,
              Lines{"left out: all but its first frame"});
}

TEST_F(ColoursOfFiles, NumbersThatAPaletteHasNotAreSaid) {
    std::string file = encodePng(row({0, 1, 5, 1}, 1));
    file[25] = 3;  // its kind of colours
    file.replace(29, 4, bigWord(crcOf(file.substr(12, 17))));
    const std::string colours = std::string("PLTE\xFF\0\0\0\xFF\0", 10);
    file.insert(33, bigWord(6) + colours + bigWord(crcOf(colours)));
    const Picture picture = readPicture(folder.write("a.png", file));
    EXPECT_EQ(picture.stored.at(0, 0, 0), 1.0F);
    EXPECT_EQ(picture.stored.at(2, 0, 0), 0.0F);
    EXPECT_EQ(picture.stored.at(3, 0, 1), 1.0F);
    EXPECT_EQ(picture.notes,
              Lines{"pixels of colours that its palette has not: 1; they are black"});
    file[45] = '\x7F';  // a broken one
    EXPECT_THROW(readPicture(folder.write("a.png", file)), Error);
}

TEST_F(ColoursOfFiles, GreyResponseOfTiffIsSaid) {
    const auto word = [](std::uint32_t value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 255U);
        return text;
    };
    std::string directory;
    std::uint16_t count = 0;
    const auto add = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t values,
                         std::uint32_t value) {
        directory += word(tag, 2) + word(type, 2) + word(values, 4) + word(value, 4);
        ++count;
    };
    const std::uint32_t curveAt = 8 + 2 + 9 * 12 + 4, pixelAt = curveAt + 512;
    add(256, 3, 1, 1);          // width
    add(257, 3, 1, 1);          // height
    add(258, 3, 1, 8);          // bits
    add(259, 3, 1, 1);          // not compressed
    add(262, 3, 1, 1);          // 0 is black
    add(273, 4, 1, pixelAt);    // where its rows are
    add(279, 4, 1, 1);          // how long they are
    add(281, 3, 1, 100);        // the largest value there is: statistics
    add(291, 3, 256, curveAt);  // densities
    const std::string file = "II*" + std::string(1, '\0') + word(8, 4) + word(count, 2) +
                             directory + word(0, 4) + std::string(512, '\1') + "\x33";
    const Picture picture = readPicture(folder.write("a.tif", file));
    EXPECT_EQ(picture.stored.at(0, 0), 0.2F);
    EXPECT_EQ(picture.notes, Lines{"left out: its grey response curve"});
}

TEST_F(ColoursOfFiles, PngIsTurnedAsItsExifSays) {
    const std::string exif("II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0\3\0\0\0\0\0\0\0", 26);
    EXPECT_EQ(png(row({1, 2, 3}, 1), {{"eXIf", exif}}).stored.at(0, 0), 3.0F / 255.0F);
}

TEST_F(ColoursOfFiles, ProfilesOfJpegAndTiff) {
    const std::string jpeg = folder.path() / "a.jpg", tiff = folder.path() / "a.tif";
    const std::array<std::uint8_t, 3> pixel{10, 20, 30};
    stbi_write_jpg(jpeg.c_str(), 1, 1, 3, pixel.data(), 100);
    const auto notesOfJpeg = [&](const std::string& profile) {
        const std::string segment = "ICC_PROFILE" + std::string("\0\1\1", 3) + profile;
        std::string file = readFile(jpeg);
        file.insert(2, "\xFF\xE2" +
                           bigWord(static_cast<std::uint32_t>(segment.size()) + 2).substr(2) +
                           segment);
        return readPicture(folder.write("b.jpg", file)).notes;
    };
    EXPECT_EQ(notesOfJpeg(profileOf(kSrgbCurve)), Lines{});
    EXPECT_EQ(notesOfJpeg(profileOf(kSrgbCurve, kDisplayP3)),
              Lines{"left out: its colour profile"});
    const std::vector<std::uint16_t> curve(256, 0);
    const auto notesOfTiff = [&](const std::string& profile, const std::vector<float>& primaries,
                                 bool hasCurve = false, float down = 72.0F) {
        TIFF* file = TIFFOpen(tiff.c_str(), "w");
        TIFFSetField(file, TIFFTAG_IMAGEWIDTH, 1);
        TIFFSetField(file, TIFFTAG_IMAGELENGTH, 1);
        TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 3);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
        TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        if (!profile.empty()) {
            TIFFSetField(file, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()),
                         profile.data());
        }
        if (!primaries.empty()) {
            TIFFSetField(file, TIFFTAG_PRIMARYCHROMATICITIES, primaries.data());
        }
        if (hasCurve) {
            TIFFSetField(file, TIFFTAG_TRANSFERFUNCTION, curve.data(), curve.data(), curve.data());
        }
        TIFFSetField(file, TIFFTAG_XRESOLUTION, 72.0F);
        TIFFSetField(file, TIFFTAG_YRESOLUTION, down);
        std::array<std::uint8_t, 3> row = pixel;
        TIFFWriteScanline(file, row.data(), 0, 0);
        TIFFClose(file);
        return readPicture(tiff).notes;
    };
    EXPECT_EQ(notesOfTiff("", {}), Lines{});
    EXPECT_EQ(notesOfTiff(profileOf(kSrgbCurve), {}), Lines{});
    EXPECT_EQ(notesOfTiff(profileOf(kSrgbCurve, kDisplayP3), {}),
              Lines{"left out: its colour profile"});
    EXPECT_EQ(notesOfTiff("", {0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F}), Lines{});
    EXPECT_EQ(notesOfTiff("", {0.68F, 0.32F, 0.265F, 0.69F, 0.15F, 0.06F}),
              Lines{"left out: its chromaticities"});
    EXPECT_EQ(notesOfTiff("", {}, true), Lines{"left out: its transfer function"});
    EXPECT_EQ(notesOfTiff("", {}, false, 144.0F), wide_);
}

/// Twice as wide as high, and squares.
TEST_F(ColoursOfFiles, PixelsThatAreNoSquares) {
    const std::string metre(1, '\1');
    EXPECT_EQ(png(row({9}, 1), {{"pHYs", bigWords({2000, 1000}) + metre}}).notes,
              Lines{"left out: its pixels are 0.5 times as wide as high"});
    EXPECT_EQ(png(row({9}, 1), {{"pHYs", bigWords({2000, 4000}) + metre}}).notes, wide_);
    EXPECT_EQ(png(row({9}, 1), {{"pHYs", bigWords({2834, 2835}) + metre}}).notes, Lines{});
    const std::string jpeg = folder.path() / "a.jpg";
    const std::array<std::uint8_t, 1> pixel{10};
    stbi_write_jpg(jpeg.c_str(), 1, 1, 1, pixel.data(), 100);
    std::string file = readFile(jpeg);
    ASSERT_EQ(file.substr(6, 4), "JFIF");
    EXPECT_EQ(readPicture(jpeg).notes, Lines{});
    file.replace(14, 4, std::string("\0\1\0\2", 4));
    EXPECT_EQ(readPicture(folder.write("b.jpg", file)).notes, wide_);
}

TEST_F(ColoursOfFiles, GammaOfHdrAndTga) {
    const std::string pixel("\x80\x80\x80\x81", 4);
    const auto notesOfHdr = [&](const std::string& line) {
        return readPicture(folder.write("a.hdr", "#?RADIANCE\n" + line + "\n\n-Y 1 +X 1\n" + pixel))
            .notes;
    };
    EXPECT_EQ(notesOfHdr("VIEW= -vp 0 0 0"), Lines{});
    EXPECT_EQ(notesOfHdr("GAMMA=1.0"), Lines{});
    EXPECT_EQ(notesOfHdr("GAMMA=2.2"), Lines{"left out: GAMMA=2.2"});
    EXPECT_EQ(notesOfHdr("PIXASPECT=2"), Lines{"left out: PIXASPECT=2"});
    std::string tga("\0\0\3\0\0\0\0\0\0\0\0\0\1\0\1\0\x08\0\x7F", 19);
    std::string area(495, '\0');
    area[478] = 22, area[480] = 10;
    area[474] = 2, area[476] = 1;
    const auto footer = [](char at) {
        return std::string(1, at) + std::string(7, '\0') + "TRUEVISION-XFILE." + '\0';
    };
    EXPECT_EQ(readPicture(folder.write("a.tga", tga + footer(0))).notes, Lines{});
    EXPECT_EQ(readPicture(folder.write("a.tga", tga + area + footer(19))).notes,
              (Lines{"left out: its gamma", wide_[0]}));
}

}  // namespace
}  // namespace gfxrepro::image
