
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "engine/image/colour_map.h"
#include "engine/image/exr_io.h"
#include "engine/image/image.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "tests/support/support.h"

namespace gfxrepro::image {
namespace {

template <class T>
Image<T> noise(int width, int height, int channels) {
    Random random(1);
    Image<T> image(width, height, channels);
    for (T& value : image.values()) value = static_cast<T>(random.next());
    return image;
}

TEST(ToSrgb8, FollowsTheCurveAndKeepsAlphaLinear) {
    ImageF linear(2, 1, 4);
    const float values[] = {0.0F, 0.0031308F, 0.5F, 0.5F, 1.0F, 2.0F, -1.0F, 1.5F};
    std::copy(std::begin(values), std::end(values), linear.values().begin());
    const Image8 srgb = toSrgb8(linear);
    const std::uint8_t expected[] = {0, 10, 188, 128, 255, 255, 0, 255};
    EXPECT_TRUE(std::equal(std::begin(expected), std::end(expected), srgb.values().begin()));
}

TEST(ToSrgb8, MakesNotANumberBlack) {
    ImageF linear(1, 1, 1, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(toSrgb8(linear).at(0, 0), 0);
}

/// By the curve itself, of floats all over, and of all about where a value goes over to the next.
TEST(ToSrgb8, RoundsEachFloatAsTheCurveDoes) {
    std::vector<float> values;
    const auto add = [&](std::uint32_t bits) { values.push_back(std::bit_cast<float>(bits)); };
    const auto one = std::bit_cast<std::uint32_t>(1.0F);
    for (std::uint32_t bits = 0; bits <= one; bits += 1013) add(bits);
    for (int level = 0; level < 255; ++level) {
        const auto next =
            std::bit_cast<std::uint32_t>(linearOf((static_cast<float>(level) + 0.5F) / 255.0F));
        for (std::uint32_t bits = next - 200; bits <= next + 200; ++bits) add(bits);
    }
    ImageF linear(static_cast<int>(values.size()), 1, 1);
    std::copy(values.begin(), values.end(), linear.values().begin());
    const Image8 srgb = toSrgb8(linear);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto expected = static_cast<std::uint8_t>(srgbOf(values[i]) * 255.0F + 0.5F);
        ASSERT_EQ(srgb.values()[i], expected) << values[i];
    }
}

using Png = FolderTest;

TEST_F(Png, KeepsEightBitsOfEveryChannelCount) {
    for (int channels = 1; channels <= 4; ++channels) {
        const Image8 image = noise<std::uint8_t>(13, 7, channels);
        writePng(folder.path() / "a.png", image);
        EXPECT_EQ(readPng8(folder.path() / "a.png"), image);
        const std::string encoded = encodePng(image);
        EXPECT_EQ(decodePng8(std::as_bytes(std::span(encoded)), "memory"), image);
    }
}

TEST_F(Png, KeepsSixteenBits) {
    const Image16 image = noise<std::uint16_t>(5, 9, 3);
    writePng(folder.path() / "a.png", image);
    EXPECT_EQ(readPng16(folder.path() / "a.png"), image);
    EXPECT_EQ(errorText([&] { readPng8(folder.path() / "a.png"); }, folder.path()),
              "DIR/a.png: 16 bits a channel; at most 8 are allowed");
}

TEST_F(Png, WidensEightBits) {
    writePng(folder.path() / "a.png", Image8(1, 1, 1, 0xAB));
    EXPECT_EQ(readPng16(folder.path() / "a.png").at(0, 0), 0xABAB);
}

TEST_F(Png, RefusesWhatIsNoPng) {
    const auto path = folder.write("a.png", "not a picture");
    EXPECT_EQ(errorText([&] { readPng8(path); }, folder.path()), "DIR/a.png: not a PNG file");
    EXPECT_EQ(errorText([&] { readPng8(folder.path() / "none.png"); }, folder.path()),
              "cannot read DIR/none.png: No such file or directory");
}

TEST_F(Png, RefusesTruncatedFiles) {
    const std::string whole = encodePng(noise<std::uint8_t>(16, 16, 3));
    for (std::size_t size = 8; size < whole.size(); size += 7) {
        const auto path = folder.write("a.png", whole.substr(0, size));
        EXPECT_TRUE(errorText([&] { readPng8(path); }, folder.path())
                        .starts_with("DIR/a.png: the file ends early in "))
            << size;
    }
    const auto error = [&](std::size_t size) {
        const auto path = folder.write("a.png", whole.substr(0, size));
        return errorText([&] { readPng8(path); }, folder.path());
    };
    EXPECT_EQ(error(40),
              "DIR/a.png: the file ends early in the head of a chunk: bytes needed from byte 33 "
              "on: 8, found: 7");
    EXPECT_EQ(
        error(20),
        "DIR/a.png: the file ends early in chunk IHDR: bytes needed from byte 16 on: 13, found: 4");
}

TEST_F(Png, RefusesHeadersThatDeclareTooMuch) {
    // An IHDR of 30000 x 30000 grey pixels with its right checksum, and nothing else.
    const std::string header("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x75\x30\0\0\x75\x30\x08\0\0\0\0",
                             29);
    const std::string rest("\x43\x4c\xa7\x66\0\0\0\0IDAT", 12);
    const auto path = folder.write("a.png", header + rest);
    EXPECT_EQ(errorText([&] { readPng8(path); }, folder.path()),
              "DIR/a.png: the header declares 30000 x 30000 pixels of 4 bytes, too many for a file "
              "of 41 bytes");
}

TEST_F(Png, EvenPicturesThatARunWritesAreRead) {
    const auto path = folder.path() / "black.png";
    writePng(path, Image8(8192, 8192, 1));  // 256 MiB as RGBA
    const std::uintmax_t bytes = fs::file_size(path);
    EXPECT_LT(bytes, (std::uintmax_t{256} << 20) / 500);
    EXPECT_EQ(readPng8(path).width(), 8192);
    // A texture of somebody's may be no such file, and a picture no larger than 16,384².
    EXPECT_EQ(errorText([&] { decodePng8(MappedFile(path).bytes(), "t.png"); }),
              "t.png: the header declares 8192 x 8192 pixels of 4 bytes, too many for a file of " +
                  std::to_string(bytes) + " bytes");
    EXPECT_EQ(errorText([&] { PngRows(path, kMaxSidePx); }, folder.path()),
              "DIR/black.png: the header declares 8192 x 8192 pixels of 4 bytes, too many for a "
              "file of " +
                  std::to_string(bytes) + " bytes");
    EXPECT_EQ(PngRows(path, kMaxSidePx, ImageUse::Picture).width(), 8192);
    checkDeclaredSize(16384, 16384, 4, 260'000, "a", kMaxSidePx, ImageUse::Picture);
    EXPECT_NE(errorText([] {
                  checkDeclaredSize(16384, 16384, 4, 250'000, "a", kMaxSidePx, ImageUse::Picture);
              }),
              "");
    EXPECT_NE(errorText([] {
                  checkDeclaredSize(16384, 16385, 4, 900'000, "a", kMaxSidePx, ImageUse::Picture);
              }),
              "");
}

TEST_F(Png, RefusesTinyFilesThatFillTheMemory) {
    // 20000 x 20000 grey pixels in a file of a thousandth of their bytes, as of an even picture.
    std::string content("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x4e\x20\0\0\x4e\x20\x08\0\0\0\0", 29);
    content += std::string("\xc6\x1b\x19\xe5\0\0\0\0IDAT", 12);
    content.resize(1 << 20);
    const auto path = folder.write("a.png", content);
    EXPECT_EQ(errorText([&] { readPng8(path); }, folder.path()),
              "DIR/a.png: the header declares 20000 x 20000 pixels of 4 bytes, too many for a file "
              "of 1048576 bytes");
}

TEST_F(Png, RefusesImagesThatPngCannotHold) {
    EXPECT_EQ(errorText([&] { writePng(folder.path() / "a.png", Image8(1, 1, 5)); }, folder.path()),
              "cannot write DIR/a.png: 5 channels; PNG has 1 to 4");
    EXPECT_EQ(errorText([&] { encodePng(Image8(1, 1, 5)); }),
              "cannot encode a PNG: 5 channels; PNG has 1 to 4");
}

ExrImage exrNoise() {
    Random random(2);
    ImageF colour(17, 11, 4);
    for (float& value : colour.values()) value = random.uniform(-100.0F, 100.0F);
    colour.at(0, 0) = std::numeric_limits<float>::infinity();
    colour.at(1, 0) = std::bit_cast<float>(0x7FC12345U);  // a not-a-number with a payload
    colour.at(2, 0) = 1e-40F;                             // below the normal range
    ExrImage exr;
    exr.add(colour, {"R", "G", "B", "A"}, ExrPixelType::Float);
    exr.attributes["command"] = "gfxrepro run smoke";
    return exr;
}

using Exr = FolderTest;

TEST_F(Exr, KeepsTheBitsOfFloatsAndTheAttributes) {
    const ExrImage written = exrNoise();
    writeExr(folder.path() / "a.exr", written);
    const ExrImage read = readExr(folder.path() / "a.exr");
    EXPECT_EQ(read.attributes, written.attributes);
    ASSERT_EQ(read.channels.size(), 4U);
    for (const ExrImage::Channel& channel : written.channels) {
        const ImageF* values = read.find(channel.name);
        ASSERT_NE(values, nullptr);
        EXPECT_EQ(0, std::memcmp(values->values().data(), channel.values.values().data(),
                                 values->values().size_bytes()));
    }
    EXPECT_EQ(read.find("Z"), nullptr);
    EXPECT_EQ(read.colour().channels(), 4);
    EXPECT_EQ(read.colour().at(5, 3, 2), written.colour().at(5, 3, 2));
}

TEST_F(Exr, KeepsWholeNumbersAndMatrices) {
    ImageF ids(3, 2, 1);
    const float values[] = {0.0F, 1.0F, 65537.0F, 16777215.0F, 16777216.0F, 7.0F};
    std::copy(std::begin(values), std::end(values), ids.values().begin());
    ExrImage written;
    written.add(ids, {"id"}, ExrPixelType::Uint);
    std::array<float, 16>& matrix = written.matrices["worldToCamera"];
    for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i] = 0.1F * static_cast<float>(i);
    writeExr(folder.path() / "a.exr", written);
    const ExrImage read = readExr(folder.path() / "a.exr");
    EXPECT_EQ(read.matrices, written.matrices);
    ASSERT_EQ(read.channels.size(), 1U);
    EXPECT_EQ(read.channels[0].type, ExrPixelType::Uint);
    EXPECT_EQ(read.channels[0].values, ids);
}

TEST_F(Exr, RefusesWhatIsNoWholeNumber) {
    for (const auto& [value, text] :
         {std::pair(0.5F, "0.500000"), std::pair(-1.0F, "-1.000000"),
          std::pair(16777218.0F, "16777218.000000"), std::pair(std::nanf(""), "nan")}) {
        ExrImage image;
        image.add(ImageF(2, 1, 1, value), {"id"}, ExrPixelType::Uint);
        EXPECT_EQ(errorText([&] { writeExr(folder.path() / "a.exr", image); }, folder.path()),
                  std::string("cannot write DIR/a.exr: channel 'id' holds ") + text +
                      "; whole numbers from 0 to 16777216 are allowed");
    }
}

TEST_F(Exr, RefusesAttributesThatDoNotEndWhereTheirTypeDoes) {
    writeExr(folder.path() / "a.exr", exrNoise());
    const std::string good = readFile(folder.path() / "a.exr");
    const auto errorOf = [&](const std::string& attribute, const std::string& type, char size) {
        const std::string start = attribute + '\0' + type + '\0';
        const std::size_t at = good.find(start);
        EXPECT_NE(at, std::string::npos);
        std::string broken = good;
        broken[at + start.size()] = size;
        return errorText([&] { readExr(folder.write("b.exr", broken)); }, folder.path());
    };
    EXPECT_EQ(errorOf("compression", "compression", 2),
              "DIR/b.exr: attribute 'compression' has 2 bytes, which no 'compression' has");
    EXPECT_EQ(errorOf("channels", "chlist", 72),  // 4 · 18 and the zero: 73
              "DIR/b.exr: attribute 'channels' has 72 bytes, which no 'chlist' has");
    EXPECT_EQ(errorOf("dataWindow", "box2i", 17),
              "DIR/b.exr: attribute 'dataWindow' has 17 bytes, which no 'box2i' has");
}

TEST_F(Exr, RoundsHalvesToNearest) {
    ImageF image(4, 1, 1);
    image.at(0, 0) = 1.0F + 0x1p-11F;      // a tie: to even, down
    image.at(1, 0) = 1.0F + 3 * 0x1p-11F;  // a tie: to even, up
    image.at(2, 0) = 65504.0F;             // the largest half
    image.at(3, 0) = 1e6F;                 // beyond
    ExrImage exr;
    exr.add(image, {"Y"});
    writeExr(folder.path() / "a.exr", exr);
    const ExrImage read = readExr(folder.path() / "a.exr");
    EXPECT_EQ(read.channels[0].type, ExrPixelType::Half);
    const ImageF values = read.colour();
    EXPECT_EQ(values.at(0, 0), 1.0F);
    EXPECT_EQ(values.at(1, 0), 1.0F + 0x1p-9F);
    EXPECT_EQ(values.at(2, 0), 65504.0F);
    EXPECT_EQ(values.at(3, 0), std::numeric_limits<float>::infinity());
}

TEST_F(Exr, RefusesImagesWithoutColour) {
    ExrImage exr;
    exr.add(ImageF(1, 1, 1), {"id"});
    EXPECT_EQ(errorText([&] { exr.colour(); }),
              "the image has the channels 'id'; R, G, B or Y or Z are needed");
}

TEST_F(Exr, RefusesWhatAFileCannotHold) {
    const auto path = folder.path() / "a.exr";
    ExrImage exr;
    EXPECT_EQ(errorText([&] { writeExr(path, exr); }, folder.path()),
              "cannot write DIR/a.exr: the image has no pixels");
    exr.add(ImageF(2, 2, 1), {"R"});
    exr.add(ImageF(3, 2, 1), {"G"});
    EXPECT_EQ(errorText([&] { writeExr(path, exr); }, folder.path()),
              "cannot write DIR/a.exr: channel 'G' differs in size from the first");
    exr.channels[1] = exr.channels[0];
    EXPECT_EQ(errorText([&] { writeExr(path, exr); }, folder.path()),
              "cannot write DIR/a.exr: channel 'R' is there twice");
}

TEST_F(Exr, RefusesBrokenFiles) {
    const auto path = folder.write("a.exr", "no picture");
    EXPECT_EQ(errorText([&] { readExr(path); }, folder.path()), "DIR/a.exr: not an OpenEXR file");
    writeExr(path, exrNoise());
    const std::string whole = readFile(path);
    for (std::size_t size = 8; size < whole.size(); size += 31) {
        folder.write("a.exr", whole.substr(0, size));
        EXPECT_EQ(errorText([&] { readExr(path); }, folder.path()).rfind("DIR/a.exr: ", 0), 0U)
            << size;
    }
    folder.write("a.exr", whole.substr(0, 11));
    EXPECT_EQ(
        errorText([&] { readExr(path); }, folder.path()),
        "DIR/a.exr: the file ends early in its header: bytes needed from byte 11 on: 1, found: 0");
}

TEST_F(Exr, RefusesHeadersThatDeclareTooMuch) {
    writeExr(folder.path() / "a.exr", exrNoise());
    std::string content = readFile(folder.path() / "a.exr");
    const std::string key("dataWindow\0box2i\0\x10\0\0\0", 21);
    const std::size_t window = content.find(key);
    ASSERT_NE(window, std::string::npos);
    content.replace(window + key.size() + 8, 8, std::string("\xff\x74\0\0\xff\x74\0\0", 8));
    const auto path = folder.write("a.exr", content);
    EXPECT_EQ(
        errorText([&] { readExr(path); }, folder.path()),
        "DIR/a.exr: the header declares 29952 x 29952 pixels of 16 bytes, too many for a file of " +
            std::to_string(content.size()) + " bytes");
}

TEST_F(Exr, ReadsRealFiles) {
    for (const char* name : {"BrightRings", "BrightRingsNanInf", "Garden", "PeriodicPattern",
                             "RgbRampsDiagonal", "WideColorGamut", "t01"}) {
        const auto path = test::asset(std::string("exr/") + name + ".exr");
        if (!path) GTEST_SKIP() << "the asset exr/" << name << ".exr is missing";
        const ImageF colour = readExr(*path).colour();
        EXPECT_GT(colour.width(), 100) << name;
        double sum = 0.0;
        for (const float value : colour.values()) sum += std::isfinite(value) ? value : 0.0F;
        EXPECT_GT(sum, 0.0) << name;
    }
}

using Colour = std::array<std::uint8_t, 3>;

/// Entries of matplotlib 3.6.3 that are no control colours: magma's 8th, 101st, 200th and 247th,
/// coolwarm's second and 32nd of 33.
TEST(ColourMap, FollowsThePublishedTables) {
    const auto expectNear = [](const Colour& a, const Colour& b, int tolerance) {
        for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(std::abs(a[c] - b[c]), tolerance);
    };
    expectNear(colourOf(ColourMap::Magma, 8.0F / 255.0F), {3, 3, 18}, 3);
    expectNear(colourOf(ColourMap::Magma, 101.0F / 255.0F), {139, 41, 129}, 3);
    expectNear(colourOf(ColourMap::Magma, 200.0F / 255.0F), {253, 152, 105}, 3);
    expectNear(colourOf(ColourMap::Magma, 247.0F / 255.0F), {252, 238, 176}, 3);
    expectNear(colourOf(ColourMap::CoolWarm, 1.0F / 32.0F), {68, 90, 204}, 2);
    expectNear(colourOf(ColourMap::CoolWarm, 31.0F / 32.0F), {192, 40, 47}, 8);
}

TEST(ColourMap, EndsMiddleAndBeyond) {
    EXPECT_EQ(colourOf(ColourMap::Magma, 0.0F), (Colour{0, 0, 4}));
    EXPECT_EQ(colourOf(ColourMap::Magma, 1.0F), (Colour{252, 253, 191}));
    EXPECT_EQ(colourOf(ColourMap::Magma, -7.0F), colourOf(ColourMap::Magma, 0.0F));
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(colourOf(ColourMap::Magma, infinity), colourOf(ColourMap::Magma, 1.0F));
    EXPECT_EQ(colourOf(ColourMap::CoolWarm, 0.5F), (Colour{221, 221, 221}));
    EXPECT_EQ(colourOf(ColourMap::CoolWarm, std::nanf("")), (Colour{0, 255, 0}));
}

/// The order of magnitudes survives in print: magma's lightness only grows.
TEST(ColourMap, MagmaGrowsLighter) {
    double last = -1.0;
    for (int i = 0; i <= 64; ++i) {
        const Colour c = colourOf(ColourMap::Magma, static_cast<float>(i) / 64.0F);
        const double luma = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        EXPECT_GT(luma, last) << i;
        last = luma;
    }
}

TEST(ColourMap, ShowsARange) {
    ImageF depths(3, 1, 1);
    depths.at(0, 0) = 2.0F;
    depths.at(1, 0) = 3.0F;
    depths.at(2, 0) = 4.0F;
    const Image8 picture = coloured(depths, ColourMap::CoolWarm, 2.0F, 4.0F);
    EXPECT_EQ(picture.at(0, 0, 2), 192);
    EXPECT_EQ(picture.at(1, 0, 0), 221);
    EXPECT_EQ(picture.at(2, 0, 0), 180);
    // From high to low: the other way round.
    EXPECT_EQ(coloured(depths, ColourMap::CoolWarm, 4.0F, 2.0F).at(0, 0, 0), 180);
}

TEST(ColourMap, RefusesWhatHasNoRange) {
    EXPECT_EQ(errorText([] { coloured(ImageF(2, 2, 3), ColourMap::Magma, 0, 1); }),
              "a colour map shows 1 channel, found 3");
    EXPECT_EQ(errorText([] { coloured(ImageF(2, 2, 1), ColourMap::Magma, 1, 1); }),
              "a colour map needs two finite ends that differ, found 1 and 1");
    EXPECT_EQ(errorText([] { coloured(ImageF(2, 2, 1), ColourMap::Magma, 0, std::nanf("")); }),
              "a colour map needs two finite ends that differ, found 0 and nan");
}

ImageF one(std::initializer_list<float> values) {
    ImageF image(1, 1, static_cast<int>(values.size()));
    std::copy(values.begin(), values.end(), image.values().begin());
    return image;
}

TEST(ToneMap, KnownAnswers) {
    // Two stops up: 0.25 is 1. ACES at 1: 0.9216 / 1.3688.
    EXPECT_NEAR(toneMapped(one({0.25F}), 2.0F, ToneMap::Aces).at(0, 0), 0.6732905, 1e-6);
    EXPECT_EQ(toneMapped(one({0.25F}), 1.0F, ToneMap::None).at(0, 0), 0.5F);
    EXPECT_EQ(toneMapped(one({0.25F}), 3.0F, ToneMap::None).at(0, 0), 1.0F);
}

TEST(ToneMap, ExtremesAndAlpha) {
    for (const ToneMap map : {ToneMap::None, ToneMap::Aces}) {
        EXPECT_EQ(toneMapped(one({-5.0F}), 0.0F, map).at(0, 0), 0.0F);
        EXPECT_EQ(toneMapped(one({0.0F}), 4.0F, map).at(0, 0), 0.0F);
    }
    for (const float most :
         {std::numeric_limits<float>::max(), std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(toneMapped(one({most}), 4.0F, ToneMap::Aces).at(0, 0), 1.0F);
        EXPECT_EQ(toneMapped(one({most}), 4.0F, ToneMap::None).at(0, 0), 1.0F);
    }
    EXPECT_EQ(toneMapped(one({std::nanf("")}), 0.0F, ToneMap::None).at(0, 0), 0.0F);
    EXPECT_EQ(toneMapped(one({1.0F, 1.0F, 1.0F, 7.0F}), 3.0F, ToneMap::Aces).at(0, 0, 3), 7.0F);
}

}  // namespace

}  // namespace gfxrepro::image
