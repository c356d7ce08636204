// What an EXR file says of its pixels: where they lie, and what they mean.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <limits>

#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::image {
namespace {

struct ExrMeaning : FolderTest {
    /// Pixels of the columns and rows of `data`: red is their column, green their row.
    fs::path write(const char* name, const Rectangle& data, const Rectangle& display) const {
        ImageF colour(data.width, data.height, 3);
        for (const auto [y, x] : test::grid(data.height, data.width)) {
            colour.at(x, y, 0) = static_cast<float>(data.left + x);
            colour.at(x, y, 1) = static_cast<float>(data.top + y);
        }
        ExrImage exr;
        exr.add(colour, {"R", "G", "B"}, ExrPixelType::Float);
        exr.left = data.left;
        exr.top = data.top;
        exr.displayWindow = display;
        writeExr(path(name), exr);
        return path(name);
    }

    /// Of 4 × 4 pixels.
    static Imf::Slice sliceOf(std::vector<float>& plane) {
        return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), sizeof(float),
                          4 * sizeof(float));
    }

    /// 4 × 4 like pixels of these channels, under a header of the library's.
    fs::path writeEven(const char* name, Imf::Header header,
                       std::vector<std::pair<const char*, float>> channels) const {
        Imf::FrameBuffer buffer;
        std::vector<std::vector<float>> planes;
        for (const auto& [channel, value] : channels) {
            header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
            planes.emplace_back(16, value);
            buffer.insert(channel, sliceOf(planes.back()));
        }
        Imf::OutputFile file(path(name).c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(4);
        return path(name);
    }

    fs::path path(const char* name) const { return folder.path() / name; }
    std::string errorOf(const char* name) const {
        return errorText([&] { readPicture(path(name)); }, folder.path());
    }
};

TEST_F(ExrMeaning, BothWindowsAreKept) {
    const ExrImage read = readExr(write("a.exr", {-2, 5, 4, 3}, {1, 2, 8, 9}));
    EXPECT_EQ(read.dataWindow(), (Rectangle{-2, 5, 4, 3}));
    EXPECT_EQ(read.shownWindow(), (Rectangle{1, 2, 8, 9}));
    EXPECT_EQ(read.find("R")->at(0, 0), -2.0F);
    EXPECT_EQ(read.find("G")->at(3, 2), 7.0F);
    writeExr(path("b.exr"), read);
    EXPECT_EQ(readExr(path("b.exr")).dataWindow(), read.dataWindow());
    EXPECT_EQ(readExr(path("b.exr")).shownWindow(), read.shownWindow());
}

TEST_F(ExrMeaning, APictureIsWhatTheDisplayWindowShows) {
    const Picture overscan = readPicture(write("a.exr", {-1, -1, 10, 10}, {0, 0, 8, 8}));
    EXPECT_TRUE(overscan.isWhole());
    EXPECT_EQ(overscan.linear.width(), 8);
    EXPECT_EQ(overscan.linear.at(0, 0, 0), 0.0F);
    EXPECT_EQ(overscan.stored.at(7, 7, 1), 7.0F);
    const Picture corner = readPicture(write("b.exr", {6, 7, 4, 4}, {2, 2, 8, 8}));
    EXPECT_EQ(placeOf(corner), "4x3 pixels from (4, 5) of 8x8");
    EXPECT_EQ(corner.linear.at(3, 2, 0), 9.0F);
    EXPECT_EQ(corner.linear.at(3, 2, 1), 9.0F);
    write("c.exr", {8, 8, 4, 4}, {0, 0, 8, 8});
    EXPECT_EQ(errorOf("c.exr"),
              "DIR/c.exr: its pixels, 4x4 from (8, 8), lie outside of its display window, 8x8 from "
              "(0, 0)");
}

TEST_F(ExrMeaning, PicturesAreComparedWhereBothHavePixels) {
    Picture a = readPicture(write("a.exr", {0, 0, 5, 8}, {0, 0, 8, 8}));
    Picture b = readPicture(write("b.exr", {3, 2, 5, 6}, {0, 0, 8, 8}));
    keepCommon(a, b);
    EXPECT_EQ(placeOf(a), "2x6 pixels from (3, 2) of 8x8");
    EXPECT_EQ(a.stored, b.stored);
    EXPECT_EQ(a.linear.at(0, 0, 0), 3.0F);
    Picture first = readPicture(write("c.exr", {0, 0, 4, 4}, {0, 0, 8, 8}));
    Picture second = readPicture(write("d.exr", {4, 4, 4, 4}, {0, 0, 8, 8}));
    EXPECT_EQ(errorText([&] { keepCommon(first, second); }),
              "the images show no place that both have: 4x4 pixels from (0, 0) of 8x8 and 4x4 "
              "pixels from (4, 4) of 8x8");
    Picture other = readPicture(write("e.exr", {0, 0, 4, 4}, {0, 0, 8, 9}));
    EXPECT_EQ(errorText([&] { keepCommon(first, other); }),
              "the images show no place that both have: 4x4 pixels from (0, 0) of 8x8 and 4x4 "
              "pixels from (0, 0) of 8x9");
}

TEST_F(ExrMeaning, OfSeveralPartsNoneIsTaken) {
    std::vector<Imf::Header> headers(2, Imf::Header(4, 4));
    headers[0].setName("depth");
    headers[0].channels().insert("Z", Imf::Channel(Imf::FLOAT));
    headers[1].setName("beauty");
    for (const char* channel : {"R", "G", "B"}) {
        headers[1].channels().insert(channel, Imf::Channel(Imf::FLOAT));
    }
    for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
    {
        Imf::MultiPartOutputFile file(path("parts.exr").c_str(), headers.data(), 2);
        std::vector<float> plane(16, 0.5F);
        for (int part = 0; part < 2; ++part) {
            Imf::FrameBuffer buffer;
            const Imf::ChannelList& channels = file.header(part).channels();
            for (auto i = channels.begin(); i != channels.end(); ++i) {
                buffer.insert(i.name(), sliceOf(plane));
            }
            Imf::OutputPart output(file, part);
            output.setFrameBuffer(buffer);
            output.writePixels(4);
        }
    }
    EXPECT_EQ(errorOf("parts.exr"),
              "DIR/parts.exr: has 2 parts: 'depth' with Z, 'beauty' with B, G, R; one is allowed, "
              "which 'exrmultipart -separate' makes of each");
}

/// Red of Rec. 709 in X, Y, Z, whose white is that of equal energy.
TEST_F(ExrMeaning, ColoursOfOtherPrimariesAreThoseOfRec709) {
    Imf::Header header(4, 4);
    Imf::addChromaticities(header, {{1, 0}, {0, 1}, {0, 0}, {1.0F / 3, 1.0F / 3}});
    const ExrImage exr = readExr(
        writeEven("xyz.exr", header, {{"R", 0.412391F}, {"G", 0.212639F}, {"B", 0.019331F}}));
    EXPECT_EQ(exr.notes, std::vector<std::string>{
                             "R, G, B are converted from its chromaticities to those of Rec. 709"});
    EXPECT_NEAR(exr.find("R")->at(1, 2), 1.0F, 1e-3);
    EXPECT_NEAR(exr.find("G")->at(1, 2), 0.0F, 1e-3);
    EXPECT_NEAR(exr.find("B")->at(1, 2), 0.0F, 1e-3);
    // Those of Rec. 709 itself change no bit.
    Imf::Header plain(4, 4);
    Imf::addChromaticities(plain, {});
    const ExrImage same =
        readExr(writeEven("709.exr", plain, {{"R", 0.1F}, {"G", 0.2F}, {"B", 0.3F}}));
    EXPECT_EQ(same.find("B")->at(0, 0), 0.3F);
    EXPECT_TRUE(same.notes.empty());
    Imf::addChromaticities(header, {{0.3F, 0.3F}, {0.3F, 0.3F}, {0.3F, 0.3F}, {0.3F, 0.3F}});
    writeEven("none.exr", header, {{"R", 0.1F}, {"G", 0.2F}, {"B", 0.3F}});
    EXPECT_TRUE(errorOf("none.exr").starts_with("DIR/none.exr: ")) << errorOf("none.exr");
}

TEST_F(ExrMeaning, GreyHasAlphaToo) {
    const Picture picture =
        readPicture(writeEven("ya.exr", Imf::Header(4, 4), {{"A", 0.5F}, {"Y", 0.25F}}));
    ASSERT_EQ(picture.linear.channels(), 2);
    EXPECT_EQ(picture.linear.at(3, 3, 0), 0.25F);
    EXPECT_EQ(picture.linear.at(3, 3, 1), 0.5F);
    EXPECT_EQ(toSrgb8(withStraightAlpha(picture.linear)).at(0, 0, 0), 188);
    // Depths are multiplied by nothing.
    const auto depths = writeEven("za.exr", Imf::Header(4, 4), {{"A", 0.5F}, {"Z", 9.0F}});
    EXPECT_EQ(readPicture(depths).linear, ImageF(4, 4, 1, 9.0F));
}

/// CIE XYZ, places and parts of a colour: Y is no luminance, and Z no depth.
TEST_F(ExrMeaning, YAndZBesideOthersAreNoPicture) {
    const auto error = [&](std::vector<std::pair<const char*, float>> channels) {
        writeEven("a.exr", Imf::Header(4, 4), std::move(channels));
        return errorOf("a.exr");
    };
    EXPECT_EQ(error({{"X", 0.4F}, {"Y", 0.2F}, {"Z", 0.1F}}),
              "the image has the channels 'X' 'Y' 'Z'; R, G, B or Y or Z are needed");
    EXPECT_EQ(error({{"R", 0.4F}, {"Y", 0.2F}}),
              "the image has the channels 'R' 'Y'; R, G, B or Y or Z are needed");
    EXPECT_EQ(error({{"G", 0.4F}, {"Z", 0.2F}}),
              "the image has the channels 'G' 'Z'; R, G, B or Y or Z are needed");
    EXPECT_EQ(error({{"BY", 0.1F}, {"RY", 0.2F}, {"Y", 0.4F}}),
              "the image has the channels 'BY' 'RY' 'Y'; R, G, B or Y or Z are needed");
    EXPECT_EQ(error({{"Y", 0.4F}, {"Z", 9.0F}}), "no error") << "luminance and depth";
}

TEST_F(ExrMeaning, WholeNumbersThatFloatsRoundAreSaid) {
    const auto notes = [&](std::uint32_t largest) {
        Imf::Header header(4, 4);
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        std::vector<std::uint32_t> ids(16, 7);
        ids[5] = largest;
        Imf::FrameBuffer buffer;
        buffer.insert("id", Imf::Slice(Imf::UINT, reinterpret_cast<char*>(ids.data()),
                                       sizeof(std::uint32_t), 4 * sizeof(std::uint32_t)));
        {
            Imf::OutputFile file(path("id.exr").c_str(), header);
            file.setFrameBuffer(buffer);
            file.writePixels(4);
        }
        return readExr(path("id.exr")).notes;
    };
    EXPECT_EQ(notes(1U << 24), std::vector<std::string>{}) << "a float holds it";
    EXPECT_EQ(
        notes((1U << 24) + 1),
        std::vector<std::string>{
            "channel 'id' holds whole numbers up to 16777217; above 16777216 they are rounded"});
    EXPECT_EQ(
        notes(4'000'000'000U),
        std::vector<std::string>{
            "channel 'id' holds whole numbers up to 4000000000; above 16777216 they are rounded"});
}

TEST_F(ExrMeaning, AttributesThatAreNotUsedAreNamed) {
    Imf::Header header(4, 4, 2.0F);
    header.insert("exposureOfNobody", Imf::FloatAttribute(3.0F));
    const ExrImage exr = readExr(writeEven("a.exr", header, {{"Y", 0.5F}}));
    EXPECT_EQ(exr.notes, std::vector<std::string>{
                             "not used of its attributes: exposureOfNobody, pixelAspectRatio"});
}

TEST_F(ExrMeaning, ChannelsThatAPictureLeavesOutAreNamed) {
    std::vector<std::pair<const char*, float>> channels = {
        {"R", 1.0F}, {"G", 1.0F}, {"B", 1.0F}, {"A", 1.0F}, {"Z", 3.0F}, {"diffuse.R", 0.5F}};
    const auto notes = [&] {
        return readPicture(writeEven("a.exr", Imf::Header(4, 4), channels)).notes;
    };
    using Notes = std::vector<std::string>;
    EXPECT_EQ(notes(), Notes{"left out: the channels Z, diffuse.R"});
    for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) channels.emplace_back(name, 0.0F);
    EXPECT_EQ(notes(), Notes{"left out: the channels Z, a, b, c, d, diffuse.R, e, f and 1 more"});
    channels = {{"Y", 1.0F}, {"A", 1.0F}};
    EXPECT_EQ(notes(), Notes{});
    EXPECT_EQ(readExr(path("a.exr")).notes, Notes{});
}

TEST_F(ExrMeaning, PixelsThatAreNotFiniteAreCounted) {
    ImageF light(3, 1, 3, 0.5F);
    light.at(0, 0, 1) = std::numeric_limits<float>::quiet_NaN();
    light.at(0, 0, 2) = light.at(2, 0, 0) = std::numeric_limits<float>::infinity();
    ExrImage exr;
    exr.add(light, {"R", "G", "B"}, ExrPixelType::Float);
    writeExr(path("a.exr"), exr);
    const Picture picture = readPicture(path("a.exr"));
    const std::vector<std::string> note{
        "pixels that are not finite: 2; NaN is shown black, infinity white"};
    EXPECT_EQ(picture.notes, note);
    const Image8 shown = toSrgb8(picture.linear);
    EXPECT_EQ(shown.at(0, 0, 1), 0);
    EXPECT_EQ(shown.at(2, 0, 0), 255);
    std::string pfm = "PF\n3 1\n-1\n";
    pfm.append(reinterpret_cast<const char*>(light.values().data()), light.values().size_bytes());
    TemporaryFolder folder;
    EXPECT_EQ(readPicture(folder.write("a.pfm", pfm)).notes, note);
}

TEST_F(ExrMeaning, OtherSpacesOfColourAreNamed) {
    const auto notes = [&](const char* name, const char* space) {
        Imf::Header header(4, 4);
        header.insert(name, Imf::StringAttribute(space));
        return readExr(writeEven("a.exr", header, {{"R", 1.0F}, {"G", 1.0F}, {"B", 1.0F}})).notes;
    };
    using Notes = std::vector<std::string>;
    EXPECT_EQ(notes("colorInteropID", "lin_ap1_scene"),
              Notes{"not used of its attributes: colorInteropID ('lin_ap1_scene')"});
    EXPECT_EQ(notes("oiio:ColorSpace", "ACEScg"),
              Notes{"not used of its attributes: oiio:ColorSpace ('ACEScg')"});
    EXPECT_EQ(notes("colorSpace", "sRGB"),
              Notes{"not used of its attributes: colorSpace ('sRGB')"});
    EXPECT_EQ(notes("colorInteropID", "lin_rec709_scene"), Notes{});
    EXPECT_EQ(notes("oiio:ColorSpace", "Linear"), Notes{});
    EXPECT_EQ(notes("software", "ACEScg"), Notes{});
}

/// An orange at half cover: a display shows the colour that is covered, and PNG files hold that.
TEST_F(ExrMeaning, ColoursAreDividedByAlphaForPng) {
    ImageF half(2, 1, 4);
    const float values[] = {0.5F, 0.25F, 0.125F, 0.5F, 0.25F, 0.0F, 0.0F, 0.0F};
    std::copy(std::begin(values), std::end(values), half.values().begin());
    const Image8 shown = toSrgb8(withStraightAlpha(half));
    const std::uint8_t expected[] = {255, 188, 137, 128, 137, 0, 0, 0};
    EXPECT_TRUE(std::equal(std::begin(expected), std::end(expected), shown.values().begin()));
    writePng(path("a.png"), shown);
    const Picture read = readPicture(path("a.png"));
    EXPECT_FLOAT_EQ(read.stored.at(0, 0, 0), 1.0F);
    EXPECT_NEAR(read.linear.at(0, 0, 0), 0.5F, 0.005F);
    EXPECT_NEAR(read.linear.at(0, 0, 1), 0.25F, 0.005F);
    // Grey and alpha likewise.
    ImageF grey(1, 1, 2, 0.25F);
    grey.at(0, 0, 1) = 0.5F;
    EXPECT_EQ(toSrgb8(withStraightAlpha(grey)).at(0, 0, 0), 188);
    EXPECT_EQ(toSrgb8(withStraightAlpha(grey)).at(0, 0, 1), 128);
}

}  // namespace
}  // namespace gfxrepro::image
