// Pictures of programs in other formats than EXR and PNG.
#include <fmt/format.h>

#include <stb/stb_image_write.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/files.h"
#include "engine/image/formats.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "tests/support/cut_tiff.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::image {
namespace {

struct Formats : FolderTest {
    static constexpr int kWidth = 11, kHeight = 5;

    /// Of every pixel and channel another one.
    static std::vector<std::uint8_t> values(int channels) {
        std::vector<std::uint8_t> result(static_cast<std::size_t>(kWidth * kHeight * channels));
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] = static_cast<std::uint8_t>(i * 37 + i / 7);
        }
        return result;
    }
    static std::vector<float> light() {
        std::vector<float> result(kWidth * kHeight * 3);
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] =
                0.01F * static_cast<float>(1 + i % 50) * std::exp2(static_cast<float>(i % 9));
        }
        return result;
    }
    std::string path(const char* name) const { return folder.path() / name; }
    std::string errorOf(const std::string& name, const std::string& content) const {
        return errorText([&] { readPicture(folder.write(name, content)); }, folder.path());
    }
    template <class T>
    static std::string bytesOf(const std::vector<T>& numbers) {
        return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
    }
    /// The picture is that of values(): sRGB, its rows from the top.
    void expectValues(const char* name, int channels, int tolerance = 0) const {
        const Picture picture = readPicture(path(name));
        EXPECT_FALSE(picture.isLinear) << name;
        EXPECT_EQ(picture.width, kWidth) << name;
        EXPECT_EQ(picture.height, kHeight) << name;
        ASSERT_EQ(picture.stored.channels(), channels) << name;
        const auto expected = values(channels);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(255.0F * picture.stored.values()[i], static_cast<float>(expected[i]),
                        static_cast<float>(tolerance) + 1e-3F)
                << name << " " << i;
        }
        if (channels == 3) {
            EXPECT_EQ(picture.linear.at(2, 1, 1), linearOf(picture.stored.at(2, 1, 1)));
        }
    }
};

TEST_F(Formats, PortableAnymapsAreSrgb) {
    folder.write("a.ppm", "P6\n# by hand\n11 5\n255\n" + bytesOf(values(3)));
    expectValues("a.ppm", 3);
    folder.write("a.pgm", "P5 11 5 255\n" + bytesOf(values(1)));
    expectValues("a.pgm", 1);
    const Picture deep =
        readPicture(folder.write("b.ppm", std::string("P6 1 1 1000\n\x03\xe8\x01\xf4\0\0", 18)));
    EXPECT_EQ(deep.bits, 16);
    EXPECT_EQ(deep.stored.at(0, 0, 0), 1.0F);
    EXPECT_EQ(deep.stored.at(0, 0, 1), 0.5F);
    // Lines that end in two characters, before a picture that begins with the second.
    folder.write("d.ppm", "P6\r\n11 5\r\n255\r\n" + bytesOf(values(3)));
    expectValues("d.ppm", 3);
    const Picture one = readPicture(folder.write("e.pgm", "P5 1 1 255\r\n"));
    EXPECT_EQ(std::lround(255.0F * one.stored.at(0, 0)), '\n');
    EXPECT_EQ(
        errorOf("c.ppm", "P6 2 1 255\nabcde"),
        "DIR/c.ppm: the file ends early in its pixels: bytes needed from byte 11 on: 6, found: 5");
    EXPECT_EQ(errorOf("c.ppm", "P6 x 1 255\nabc"), "DIR/c.ppm: has 'x' where a number is allowed");
    EXPECT_EQ(errorOf("c.ppm", "P5 1 1 100\nz"), "DIR/c.ppm: holds 122, its largest value is 100");
    EXPECT_EQ(errorOf("c.ppm", "P5 1 1 0\nz"),
              "DIR/c.ppm: its largest value is 0; 1 to 65535 are allowed");
    EXPECT_EQ(errorOf("c.ppm", "P5 1 1 255\nzP5 1 1 255\nz"),
              "DIR/c.ppm: has several pictures; one is allowed");
    EXPECT_EQ(errorOf("c.ppm", "P5 30000 30000 255\n"),
              "DIR/c.ppm: the header declares 30000 x 30000 pixels of 4 bytes, too many for a file "
              "of 19 bytes");
}

TEST_F(Formats, PortableAnymapsMayBeText) {
    for (const int channels : {1, 3}) {
        std::string text = channels == 1 ? "P2 #\n11 5\n255" : "P3\r\n11 5\r\n255\r\n";
        for (const std::uint8_t value : values(channels)) text += '\n' + std::to_string(value);
        folder.write("a.pnm", text);  // no blank behind the last
        expectValues("a.pnm", channels);
    }
    const Picture deep = readPicture(folder.write("b.ppm", "P3 1 1 1000\n1000 500 # half\n0\n"));
    EXPECT_EQ(deep.bits, 16);
    EXPECT_EQ(deep.stored.at(0, 0, 1), 0.5F);
    // 1 is black; a row of bits ends with its byte.
    for (const std::string& bits : {std::string("P1\n9 2\n100000001\n0 0 0 0 0 0 0 0 1"),
                                    std::string("P4 9 2\n\x80\x80\0\x80", 11)}) {
        const Picture mask = readPicture(folder.write("a.pbm", bits));
        ASSERT_EQ(mask.width, 9);
        for (int x = 0; x < 9; ++x) {
            EXPECT_EQ(mask.stored.at(x, 0), x % 8 == 0 ? 0.0F : 1.0F) << x;
            EXPECT_EQ(mask.stored.at(x, 1), x == 8 ? 0.0F : 1.0F) << x;
        }
    }
    const Picture zeros = readPicture(folder.write("a.pgm", "P2 01 1 0100\n050\n"));
    EXPECT_EQ(zeros.stored.at(0, 0), 0.5F);
    EXPECT_EQ(
        errorOf("c.ppm", "P3 1 1 255\n1 2"),
        "DIR/c.ppm: the file ends early in its pixels: bytes needed from byte 14 on: 1, found: 0");
    EXPECT_EQ(errorOf("c.ppm", "P3 1 1 255\n1 2 256"),
              "DIR/c.ppm: holds 256, its largest value is 255");
    EXPECT_EQ(errorOf("c.ppm", "P2 1 1 255\n-1"), "DIR/c.ppm: has '-1' where a number is allowed");
    EXPECT_EQ(errorOf("c.pbm", "P1 1 1 2"), "DIR/c.pbm: a bit is neither 0 nor 1");
    EXPECT_EQ(errorOf("c.pnm", "P7\nWIDTH 1\n"),
              "DIR/c.pnm: a file of kind P7; P1 to P6, Pf and PF are read");
}

TEST_F(Formats, PortableFloatMapsAreLinear) {
    const std::vector<float> rows = {1.5F, -2.0F, 0.25F, 4.0F, 0.0F, 1e-5F,
                                     7.0F, 8.0F,  9.0F,  1.0F, 2.0F, 3.0F};
    const Picture picture = readPicture(folder.write("a.pfm", "PF\n2 2\n-1.0\n" + bytesOf(rows)));
    EXPECT_TRUE(picture.isLinear);
    EXPECT_EQ(picture.linear.at(0, 1, 0), 1.5F);  // the last row comes first
    EXPECT_EQ(picture.stored.at(1, 0, 2), 3.0F);
    const Picture windows =
        readPicture(folder.write("w.pfm", "PF\r\n2 2\r\n-1.0\r\n" + bytesOf(rows)));
    EXPECT_EQ(windows.linear, picture.linear);
    for (const char* end : {" \n", " \r\n", "  \n", "\t\n"}) {
        const Picture blanks =
            readPicture(folder.write("w.pfm", std::string("PF\n2 2\n-1.0") + end + bytesOf(rows)));
        EXPECT_EQ(blanks.linear, picture.linear) << end;
        EXPECT_TRUE(blanks.notes.empty()) << end;
    }
    std::string swapped = bytesOf(std::vector<float>{1.5F, 2.5F});
    for (std::size_t i = 0; i < swapped.size(); i += 4) std::reverse(&swapped[i], &swapped[i] + 4);
    EXPECT_EQ(readPicture(folder.write("b.pfm", "Pf\n2 1\n1\n" + swapped)).linear.at(1, 0), 2.5F);
    EXPECT_EQ(errorOf("c.pfm", "Pf\n1 1\n-2\nabcd"),
              "DIR/c.pfm: its scale is -2; 1 or -1 are allowed, as readers differ in others");
    EXPECT_EQ(
        errorOf("c.pfm", "Pf\n1 1\n-1\nabc"),
        "DIR/c.pfm: the file ends early in its pixels: bytes needed from byte 10 on: 4, found: 3");
}

TEST_F(Formats, WhatStandsBehindAPictureIsSaid) {
    std::string tga(18, '\0');
    tga[2] = 3;
    tga[12] = tga[14] = 1;
    tga[16] = 8;
    const std::string png = encodePng(Image8(1, 1, 1));
    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
    for (const std::string& picture :
         {std::string("P5 1 1 255\nz"), std::string("P2 1 1 255\n9\n"),
          std::string("Pf\n1 1\n-1\n\0\0\0\0", 14), tga + 'z', hdr, png}) {
        const auto notesOf = [&](const std::string& behind) {
            return readPicture(folder.write("a.tga", picture + behind)).notes;
        };
        EXPECT_EQ(notesOf(std::string("\r\n\0\0", 4)), std::vector<std::string>{}) << picture;
        EXPECT_EQ(notesOf("\nabc"), std::vector<std::string>{"left out: 4 bytes behind its end"})
            << picture;
        EXPECT_EQ(notesOf("z"), std::vector<std::string>{"left out: 1 byte behind its end"});
    }
}

TEST_F(Formats, RadiancesPicturesAreLinear) {
    const std::vector<float> colours = light();
    ASSERT_NE(stbi_write_hdr(path("a.hdr").c_str(), kWidth, kHeight, 3, colours.data()), 0);
    const Picture picture = readPicture(path("a.hdr"));
    EXPECT_TRUE(picture.isLinear);
    ASSERT_EQ(picture.linear.values().size(), colours.size());
    for (std::size_t i = 0; i < colours.size(); i += 3) {
        const float most = std::max({colours[i], colours[i + 1], colours[i + 2]});
        for (std::size_t c = i; c < i + 3; ++c) {
            EXPECT_NEAR(picture.linear.values()[c], colours[c], most / 128.0F) << c;
        }
    }
    // Of fewer than 8 columns the pixels lie one behind the other; (1, 1, 1, n) repeats one.
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";
    const std::string pixels = "\n-Y 1 +X 4\n\x80\x40\x20\x81\x01\x01\x01\x02\x80\x80\x80\x80";
    const Picture small = readPicture(folder.write("b.hdr", head + pixels));
    EXPECT_EQ(small.linear.at(2, 0, 0), 1.0F);
    EXPECT_EQ(small.linear.at(2, 0, 2), 0.25F);
    EXPECT_EQ(small.linear.at(3, 0, 1), 0.5F);
    // What the header multiplied by is divided out again.
    const Picture exposed = readPicture(
        folder.write("c.hdr", head + "EXPOSURE=2\nEXPOSURE= 4\nCOLORCORR=1 2 1\n" + pixels));
    EXPECT_EQ(exposed.linear.at(2, 0, 0), 0.125F);
    EXPECT_EQ(exposed.linear.at(3, 0, 1), 0.03125F);
    // Blanks stand around '=', too. An indented line is of a picture that this one was made of.
    const Picture spaced = readPicture(
        folder.write("c.hdr",
                     "#?RADIANCE\nFORMAT = 32-bit_rle_rgbe\nEXPOSURE = 2.0\nEXPOSURE\t=\t4\n"
                     "\tEXPOSURE=8\nGAMMA = 2.2\n" +
                         pixels));
    EXPECT_EQ(spaced.linear.at(2, 0, 0), 0.125F);
    EXPECT_EQ(spaced.notes, std::vector<std::string>{"left out: GAMMA = 2.2"});
    const Picture zeros = readPicture(folder.write(
        "c.hdr", head + "EXPOSURE=02\n\n-Y 01 +X 04" + pixels.substr(pixels.find("+X 4") + 4)));
    EXPECT_EQ(zeros.linear.at(3, 0, 1), 0.25F);
    EXPECT_EQ(errorOf("d.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 4\n"),
              "DIR/d.hdr: FORMAT=32-bit_rle_xyze is not read; 32-bit_rle_rgbe is");
    EXPECT_EQ(errorOf("d.hdr", head + "EXPOSURE=0\n" + pixels),
              "DIR/d.hdr: its header has 'EXPOSURE=0'");
    const std::string noPrimaries = head + "PRIMARIES=0 0 0 0 0 0 0 0\n" + pixels;
    EXPECT_EQ(readPicture(folder.write("c.hdr", noPrimaries)).linear, small.linear);
    EXPECT_EQ(errorOf("d.hdr", head + "PRIMARIES=1 0 0 1 0 0 .33 .33\n" + pixels),
              "DIR/d.hdr: PRIMARIES=1 0 0 1 0 0 .33 .33: other primaries than those of Rec. 709");
    EXPECT_EQ(errorOf("d.hdr", head + "\n+Y 1 +X 4\n"),
              "DIR/d.hdr: its size is '+Y 1 +X 4'; allowed: -Y height +X width, rows from the top");
    const std::string whole = readFile(path("a.hdr"));
    for (std::size_t size = 2; size < whole.size(); size += 9) {
        EXPECT_TRUE(errorOf("d.hdr", whole.substr(0, size))
                        .starts_with("DIR/d.hdr: the file ends early in "))
            << size;
    }
    EXPECT_EQ(
        errorOf("d.hdr", "#?RADIANCE"),
        "DIR/d.hdr: the file ends early in its header: bytes needed from byte 10 on: 1, found: 0");
    EXPECT_EQ(
        errorOf("d.hdr", "#?RADIANCE\n\n-Y 2 +X 1\n" + std::string(6, '\2')),
        "DIR/d.hdr: the file ends early in row 2 of 2: bytes needed from byte 28 on: 1, found: 0");
}

TEST_F(Formats, TargaIsSrgb) {
    for (const int isEncoded : {0, 1}) {
        stbi_write_tga_with_rle = isEncoded;
        for (const int channels : {1, 3, 4}) {
            stbi_write_tga(path("a.tga").c_str(), kWidth, kHeight, channels,
                           values(channels).data());
            expectValues("a.tga", channels);
        }
        const std::string whole = readFile(path("a.tga"));
        EXPECT_TRUE(errorOf("b.tga", whole.substr(0, whole.size() / 2))
                        .starts_with("DIR/b.tga: the file ends early in its pixels: bytes needed"));
    }
    std::string head(18, '\0');
    head[2] = 1;
    head[16] = 8;
    EXPECT_EQ(
        errorOf("b.tga", head),
        "DIR/b.tga: a TGA file of type 1, 8 bits of a palette of 0 and flags 0x0; grey of 8, RGB "
        "of 24 and RGBA of 32 bits, or 8 of a palette of such, columns from the left, are read");
}

TEST_F(Formats, TargasPaletteHasItsColours) {
    const auto fileOf = [](int type, int bits, const std::string& rest) {
        std::string head("\0\1\0\2\0\2\0\x18\0\0\0\0\2\0\1\0\0\x20", 18);
        head[2] = static_cast<char>(type);
        head[16] = static_cast<char>(bits);
        return head + "\x14\x28\x64\x1E\x32\x6E" + rest;  // blue, green, red: of colours 2 and 3
    };
    const auto valuesOf = [&](const std::string& file) {
        const ImageF stored = readPicture(folder.write("a.tga", file)).stored;
        return std::vector<float>(stored.values().begin(), stored.values().end());
    };
    const auto pixels = [](const std::vector<int>& bytes) {
        std::vector<float> values;
        for (const int byte : bytes) values.push_back(static_cast<float>(byte) / 255.0F);
        return values;
    };
    EXPECT_EQ(valuesOf(fileOf(1, 8, "\3\2")), pixels({110, 50, 30, 100, 40, 20}));
    EXPECT_EQ(valuesOf(fileOf(9, 8, "\x81\3")), pixels({110, 50, 30, 110, 50, 30}));
    // Beside true colours it is advice for a screen.
    EXPECT_EQ(valuesOf(fileOf(2, 24, "\1\2\3\4\5\6")), pixels({3, 2, 1, 6, 5, 4}));
    EXPECT_EQ(errorOf("b.tga", fileOf(1, 8, "\3\4")),
              "DIR/b.tga: a pixel of colour 4; its palette has 2 … 3");
    EXPECT_EQ(errorOf("b.tga", fileOf(1, 8, "\1\3")),
              "DIR/b.tga: a pixel of colour 1; its palette has 2 … 3");
}

/// A row of two pixels of 32 bits.
TEST_F(Formats, TargasFourthByteIsSaidWhereItIsNoAlpha) {
    const auto fileOf = [](char flags, const std::string& pixels) {
        std::string head(18, '\0');
        head[2] = 2;
        head[12] = 2;
        head[14] = 1;
        head[16] = 32;
        head[17] = flags;
        return head + pixels;
    };
    const auto notesOf = [&](char flags, const std::string& pixels) {
        return readPicture(folder.write("a.tga", fileOf(flags, pixels))).notes;
    };
    const std::vector<std::string> none;
    EXPECT_EQ(
        notesOf(0x20, "\1\2\3\4\5\6\7\x8"),
        std::vector<std::string>{"left out: its pixels' fourth byte, which it calls no alpha"});
    EXPECT_EQ(notesOf(0x20, "\1\2\3\4\5\6\7\4"), none) << "the same in each";
    EXPECT_EQ(notesOf(0x28, "\1\2\3\4\5\6\7\x8"), none) << "alpha";
    EXPECT_EQ(
        errorOf("b.tga", fileOf(0x20, "\1\2\3\4\5")),
        "DIR/b.tga: the file ends early in its pixels: bytes needed from byte 18 on: 8, found: 5");
}

/// One pixel: blue, green, red, alpha of 20, 40, 100, 128.
TEST_F(Formats, TargasExtensionSaysWhatItsAlphaIs) {
    const auto valuesOf = [&](int kind) {
        std::string file(18, '\0');
        file[2] = 2;
        file[12] = file[14] = 1;
        file[16] = 32;
        file[17] = 0x28;
        file += "\x14\x28\x64\x80";
        std::string extension(495, '\0');
        extension.back() = static_cast<char>(kind);
        file += extension + std::string("\x16\0\0\0\0\0\0\0TRUEVISION-XFILE.\0", 26);
        const ImageF values = readPicture(folder.write("a.tga", file)).stored;
        return std::vector<float>(values.values().begin(), values.values().end());
    };
    const auto part = [](float value) { return value / 255.0F; };
    const std::vector<float> colours{part(100), part(40), part(20)};
    for (const int kind : {0, 1, 2}) EXPECT_EQ(valuesOf(kind), colours) << kind;
    EXPECT_EQ(valuesOf(3), (std::vector<float>{part(100), part(40), part(20), part(128)}));
    const std::vector<float> divided = valuesOf(4);
    ASSERT_EQ(divided.size(), 4U);
    EXPECT_FLOAT_EQ(divided[0], 100.0F / 128.0F);
    EXPECT_FLOAT_EQ(divided[2], 20.0F / 128.0F);
    EXPECT_FLOAT_EQ(divided[3], 128.0F / 255.0F);
}

TEST_F(Formats, JpegIsSrgb) {
    std::vector<std::uint8_t> even(kWidth * kHeight * 3, 100);
    stbi_write_jpg(path("a.jpg").c_str(), kWidth, kHeight, 3, even.data(), 100);
    const Picture picture = readPicture(path("a.jpg"));
    EXPECT_FALSE(picture.isLinear);
    ASSERT_EQ(picture.stored.channels(), 3);
    EXPECT_NEAR(255.0F * picture.stored.at(3, 2, 1), 100.0F, 1.5F);
    const std::string whole = readFile(path("a.jpg"));
    const auto cut = [](const char* name, const std::string& file) {
        return fmt::format(
            "{}: the file ends early in its pixels: its {} bytes have no end of the picture (FF "
            "D9)",
            name, file.size() - 3);
    };
    EXPECT_EQ(errorOf("b.jpg", whole.substr(0, whole.size() - 3)), cut("DIR/b.jpg", whole));
    EXPECT_EQ(errorText([&] {
                  decodeByStb(std::as_bytes(std::span(whole).first(whole.size() - 3)), "a");
              }),
              cut("a", whole));
    // Phones put more pictures behind the first.
    EXPECT_EQ(readPicture(folder.write("b.jpg", whole + std::string(9, '\0'))).notes,
              std::vector<std::string>{});
    const Picture first = readPicture(folder.write("b.jpg", whole + whole.substr(0, 99)));
    EXPECT_EQ(first.stored, picture.stored);
    EXPECT_EQ(first.notes, std::vector<std::string>{"left out: 99 bytes behind its end"});
    // Markers may stand behind further FF; the end of a thumbnail within a segment is none.
    std::string filled = whole;
    filled.insert(2, "\xFF\xFF\xFE\0\4\xFF\xD9", 7);
    EXPECT_EQ(readPicture(folder.write("b.jpg", filled)).stored, picture.stored);
    EXPECT_EQ(errorOf("b.jpg", filled.substr(0, filled.size() - 3)), cut("DIR/b.jpg", filled));
    // By what it is, not by its name.
    EXPECT_EQ(readPicture(folder.write("c.png", whole)).stored, picture.stored);
}

/// Of the frame's header: its marker, how many bits, and how many components.
TEST_F(Formats, JpegOfOtherCodingBitsOrComponentsIsRefused) {
    std::vector<std::uint8_t> even(kWidth * kHeight * 3, 100);
    stbi_write_jpg(path("a.jpg").c_str(), kWidth, kHeight, 3, even.data(), 100);
    const std::string whole = readFile(path("a.jpg"));
    const std::size_t frame = whole.find("\xFF\xC0");
    ASSERT_NE(frame, std::string::npos);
    const auto error = [&](char marker, char bits, char components) {
        std::string file = whole;
        file[frame + 1] = marker;
        file[frame + 4] = bits;
        file[frame + 9] = components;
        return errorOf("b.jpg", file);
    };
    EXPECT_EQ(error('\xC0', 8, 4),
              "DIR/b.jpg: its colours are four inks (CMYK); grey and RGB are allowed");
    for (const char marker : {'\xC1', '\xC3', '\xC6', '\xC9', '\xCB'}) {
        EXPECT_NE(error(marker, marker == '\xC1' ? 12 : 8, 3), "no error") << int{marker};
    }
    EXPECT_NE(errorOf("b.jpg", whole.substr(0, frame)), "no error");
}

/// A picture whose corner from the left and the top is dark, the one beside it (by a column) grey,
/// after turning; stored as the Orientation says.
TEST_F(Formats, JpegIsTurnedAsItsExifSays) {
    constexpr int kSide = 8;  // a block, which the compression keeps apart
    const auto storedAs = [&](int orientation, bool isLittle) {
        const bool isTransposed = orientation >= 5;
        const int width = isTransposed ? 2 * kSide : 3 * kSide;
        const int height = isTransposed ? 3 * kSide : 2 * kSide;
        std::vector<std::uint8_t> even(static_cast<std::size_t>(width * height), 250);
        const auto fill = [&](int column, int row, std::uint8_t value) {  // of 3 × 2 as it is seen
            const auto isIn = [&](std::initializer_list<int> all) {
                return std::ranges::find(all, orientation) != all.end();
            };
            const bool isFromRight = isIn({2, 3, 6, 7}), isFromBottom = isIn({3, 4, 7, 8});
            int u = isFromRight ? 2 - column : column, v = isFromBottom ? 1 - row : row;
            if (isTransposed) std::swap(u, v);
            for (const auto [y, x] : test::grid(kSide, kSide)) {
                even[static_cast<std::size_t>((v * kSide + y) * width + u * kSide + x)] = value;
            }
        };
        fill(0, 0, 5);
        fill(1, 0, 128);
        stbi_write_jpg(path("turned.jpg").c_str(), width, height, 1, even.data(), 100);
        const std::string plain = readFile(path("turned.jpg"));
        const char value = static_cast<char>(orientation);
        std::string exif(
            "\xff\xe1\0\x22"
            "Exif\0\0",
            10);
        exif += isLittle ? std::string("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 18) +
                               value + std::string(7, '\0')
                         : std::string("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 19) +
                               value + std::string(6, '\0');
        return readPicture(folder.write("exif.jpg", plain.substr(0, 2) + exif + plain.substr(2)))
            .stored;
    };
    for (int orientation = 1; orientation <= 8; ++orientation) {
        const ImageF seen = storedAs(orientation, orientation % 2 == 0);
        ASSERT_EQ(seen.width(), 3 * kSide) << orientation;
        ASSERT_EQ(seen.height(), 2 * kSide) << orientation;
        EXPECT_LT(seen.at(4, 4, 0), 0.1F) << orientation;
        EXPECT_NEAR(seen.at(12, 4, 0), 0.5F, 0.05F) << orientation;
        EXPECT_GT(seen.at(20, 12, 0), 0.9F) << orientation;
    }
}

/// How a TIFF file is laid out; what is not said is as in most.
struct Layout {
    int channels = 3;
    int bits = 8;
    int isFloat = 0;
    int isTiled = 0;
    int planes = PLANARCONFIG_CONTIG;
    int orientation = ORIENTATION_TOPLEFT;
    int alpha = EXTRASAMPLE_UNASSALPHA;
    int colours = PHOTOMETRIC_RGB;
    int pages = 1;
};

/// `valueOf(i)` of the value at that place, of width × height × channels.
template <class T, class ValueOf>
void writeTiff(const std::string& path, int width, int height, const Layout& layout,
               ValueOf&& valueOf) {
    TIFF* file = TIFFOpen(path.c_str(), "w");
    ASSERT_NE(file, nullptr);
    for (int page = 0; page < layout.pages; ++page) {
        TIFFSetField(file, TIFFTAG_IMAGEWIDTH, width);
        TIFFSetField(file, TIFFTAG_IMAGELENGTH, height);
        TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, layout.bits);
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, layout.channels);
        TIFFSetField(file, TIFFTAG_SAMPLEFORMAT,
                     layout.isFloat ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC,
                     layout.channels < 3 ? PHOTOMETRIC_MINISBLACK : layout.colours);
        TIFFSetField(file, TIFFTAG_PLANARCONFIG, layout.planes);
        TIFFSetField(file, TIFFTAG_ORIENTATION, layout.orientation);
        const auto kind = static_cast<std::uint16_t>(layout.alpha);
        if (layout.channels % 2 == 0) TIFFSetField(file, TIFFTAG_EXTRASAMPLES, 1, &kind);
        const int side = layout.isTiled ? 16 : 0;
        if (side > 0) {
            TIFFSetField(file, TIFFTAG_TILEWIDTH, side);
            TIFFSetField(file, TIFFTAG_TILELENGTH, side);
        }
        const bool isSeparate = layout.planes == PLANARCONFIG_SEPARATE;
        const int stored = isSeparate ? 1 : layout.channels;
        for (int plane = 0; plane < (isSeparate ? layout.channels : 1); ++plane) {
            const int rows = side > 0 ? side : 1, columns = side > 0 ? side : width;
            for (int top = 0; top < height; top += rows) {
                for (int left = 0; left < width; left += columns) {
                    std::vector<T> values(static_cast<std::size_t>(rows * columns * stored));
                    for (int i = 0; i < static_cast<int>(values.size()); ++i) {
                        const int x = left + i / stored % columns, y = top + i / stored / columns;
                        if (x >= width || y >= height) continue;
                        values[static_cast<std::size_t>(i)] = valueOf(
                            (y * width + x) * layout.channels + (isSeparate ? plane : i % stored));
                    }
                    if (side > 0) {
                        TIFFWriteTile(file, values.data(), static_cast<std::uint32_t>(left),
                                      static_cast<std::uint32_t>(top), 0,
                                      static_cast<std::uint16_t>(plane));
                    } else {
                        TIFFWriteScanline(file, values.data(), static_cast<std::uint32_t>(top),
                                          static_cast<std::uint16_t>(plane));
                    }
                }
            }
        }
        TIFFWriteDirectory(file);
    }
    TIFFClose(file);
}

TEST_F(Formats, TiffOfWholeNumbersIsSrgb) {
    for (const int isTiled : {0, 1}) {
        for (const int planes : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
            for (const int channels : {1, 2, 3, 4}) {
                const auto expected = values(channels);
                writeTiff<std::uint8_t>(
                    path("a.tif"), kWidth, kHeight,
                    {.channels = channels, .isTiled = isTiled, .planes = planes},
                    [&](int i) { return expected[static_cast<std::size_t>(i)]; });
                expectValues("a.tif", channels);
            }
        }
    }
    writeTiff<std::uint16_t>(path("b.tif"), 2, 1, {.bits = 16},
                             [](int i) { return static_cast<std::uint16_t>(13107 * i); });
    const Picture deep = readPicture(path("b.tif"));
    EXPECT_EQ(deep.bits, 16);
    EXPECT_FLOAT_EQ(deep.stored.at(1, 0, 0), 0.6F);
    // Multiplied by alpha, which sRGB is not here.
    writeTiff<std::uint8_t>(path("c.tif"), 1, 1, {.channels = 4, .alpha = EXTRASAMPLE_ASSOCALPHA},
                            [](int i) { return static_cast<std::uint8_t>(i == 3 ? 102 : 51); });
    EXPECT_FLOAT_EQ(readPicture(path("c.tif")).stored.at(0, 0, 0), 0.5F);
    EXPECT_EQ(readPicture(path("c.tif")).notes, std::vector<std::string>{});
    writeTiff<std::uint8_t>(path("d.tif"), 1, 1, {.channels = 4, .alpha = EXTRASAMPLE_UNSPECIFIED},
                            [](int) { return std::uint8_t{51}; });
    EXPECT_EQ(readPicture(path("d.tif")).stored.at(0, 0, 0), 0.2F);
    EXPECT_EQ(readPicture(path("d.tif")).notes,
              std::vector<std::string>{
                  "its channel 4, of which it says no kind, is taken as straight alpha"});
}

TEST_F(Formats, TiffOfFloatsIsLinear) {
    writeTiff<float>(path("a.tif"), 2, 2,
                     {.bits = 32, .isFloat = 1, .orientation = ORIENTATION_BOTLEFT},
                     [](int i) { return 0.5F * static_cast<float>(i); });
    const Picture picture = readPicture(path("a.tif"));
    EXPECT_TRUE(picture.isLinear);
    EXPECT_EQ(picture.linear.at(1, 1, 2), 2.5F);
    EXPECT_EQ(picture.linear.at(1, 0, 2), 5.5F);
    writeTiff<std::uint16_t>(path("b.tif"), 1, 1, {.channels = 1, .bits = 16, .isFloat = 1},
                             [](int) { return std::uint16_t{0x4200}; });
    EXPECT_EQ(readPicture(path("b.tif")).linear.at(0, 0), 3.0F);
    writeTiff<float>(path("c.tif"), 1, 1, {.channels = 4, .bits = 32, .isFloat = 1},
                     [](int i) { return i == 3 ? 0.25F : 2.0F; });
    EXPECT_EQ(readPicture(path("c.tif")).linear.at(0, 0, 0), 0.5F);
}

TEST_F(Formats, OtherTiffFilesAreRefused) {
    const auto refusalOf = [&](const Layout& layout) {
        writeTiff<std::uint32_t>(path("a.tif"), 2, 2, layout, [](int) { return 0U; });
        return errorText([&] { readPicture(path("a.tif")); }, folder.path());
    };
    EXPECT_EQ(refusalOf({.bits = 32}),
              "DIR/a.tif: 3 × 32 bits a pixel (sample format 1, photometric 2); allowed: grey or "
              "RGB, with or without alpha, of 8 or 16 bits or 16 or 32 bit floats");
    for (const int bits : {1, 2, 4, 12}) {
        EXPECT_EQ(refusalOf({.channels = 1, .bits = bits}),
                  fmt::format(
                      "DIR/a.tif: 1 × {} bits a pixel (sample format 1, photometric 1); allowed: "
                      "grey or RGB, with or without alpha, of 8 or 16 bits or 16 or 32 bit floats",
                      bits));
    }
    EXPECT_EQ(refusalOf({.bits = 32, .isFloat = 1, .orientation = ORIENTATION_RIGHTTOP}),
              "DIR/a.tif: orientation 6; allowed: 1 (from the top) and 4 (from the bottom)");
    EXPECT_EQ(refusalOf({.bits = 32, .isFloat = 1, .pages = 3}),
              "DIR/a.tif: has 3 pages; one is allowed");
    EXPECT_EQ(refusalOf({.bits = 32, .isFloat = 1}), "no error");
    const std::string whole = readFile(path("a.tif"));
    for (std::size_t size = 4; size < whole.size(); size += 11) {
        EXPECT_TRUE(errorOf("b.tif", whole.substr(0, size)).starts_with("DIR/b.tif: ")) << size;
    }
    EXPECT_EQ(
        errorOf("b.tif", test::cutTiff()),
        "DIR/b.tif: the file ends early in strip 0: bytes needed from byte 122 on: 4, found: 3");
}

TEST_F(Formats, WhatIsNoneNamesThoseThatAreRead) {
    EXPECT_EQ(errorOf("a.gif", "GIF89a"),
              "DIR/a.gif: no picture of a format that is read; allowed: .exr, .png, .pfm, .hdr, "
              ".pbm, .pgm, .ppm, .pnm, .tga, .tif, .tiff, .jpg, .jpeg");
    EXPECT_EQ(errorOf("a.png", "GIF89a"), "DIR/a.png: not a PNG file");
    EXPECT_EQ(errorOf("a.tif", ""), "DIR/a.tif: Cannot read TIFF header");
    EXPECT_EQ(errorText([&] { readPicture(path("none.ppm")); }, folder.path()),
              "cannot read DIR/none.ppm: No such file or directory");
    EXPECT_TRUE(hasReadEnding("a.b.tif"));
    EXPECT_TRUE(hasReadEnding("{frame}.jpeg"));
    EXPECT_FALSE(hasReadEnding("a.ti"));
    EXPECT_FALSE(hasReadEnding("a.gif"));
    EXPECT_FALSE(hasReadEnding("a"));
}

}  // namespace
}  // namespace gfxrepro::image
