// `gfxrepro image …` on files that the tests write.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "engine/core/text.h"
#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "engine/metrics/flip.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"
#include "tests/support/grid.h"

namespace gfxrepro::test {
namespace {

using image::ExrImage;
using image::Image8;
using image::ImageF;

struct ImageCommands : FolderTest {
    std::string at(const char* name) const { return (folder.path() / name).string(); }

    /// 16 × 12, a step between two colours at column 8, with depth, normals, ids and attributes.
    ExrImage gbuffer(float bright) const {
        ImageF colour(16, 12, 3, 0.25F), depth(16, 12, 1), normal(16, 12, 3), id(16, 12, 1);
        for (int y = 0; y < 12; ++y) {
            for (int x = 8; x < 16; ++x) {
                for (int c = 0; c < 3; ++c) colour.at(x, y, c) = bright;
                depth.at(x, y) = static_cast<float>(x);
                normal.at(x, y, 1) = 1.0F;
                id.at(x, y) = 70000.0F;
            }
        }
        ExrImage exr;
        exr.add(colour, {"R", "G", "B"});
        exr.add(depth, {"Z"}, image::ExrPixelType::Float);
        exr.add(normal, {"N.X", "N.Y", "N.Z"});
        exr.add(id, {"id"}, image::ExrPixelType::Uint);
        exr.attributes["case"] = "0123456789ab";
        // x' = x / 16, y' = y / 12 of points (x, y, ·, 1): pixels of the whole image.
        exr.matrices["worldToNDC"] = {1.0F / 16, 0, 0, 0, 0, 1.0F / 12, 0, 0,
                                      0,         0, 1, 0, 0, 0,         0, 1};
        return exr;
    }
    std::string write(const char* name, const ExrImage& exr) const {
        image::writeExr(folder.path() / name, exr);
        return at(name);
    }
    std::string write(const char* name, const Image8& image) const {
        image::writePng(folder.path() / name, image);
        return at(name);
    }
    std::string out(const std::vector<std::string>& arguments,
                    const std::vector<std::string>& more = {}) const {
        const ProcessResult result = gfxrepro(arguments, more);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_EQ(withoutLayers(result.err), "");
        return result.out;
    }
    /// Standard error of a call that must end well, with the folder's path as DIR.
    std::string said(const std::vector<std::string>& arguments) const {
        return saidWith(0, arguments);
    }
    /// The same of one that must end with exit code 2.
    std::string refusal(const std::vector<std::string>& arguments) const {
        return saidWith(2, arguments);
    }
    std::string saidWith(int exitCode, const std::vector<std::string>& arguments) const {
        const ProcessResult result = endedWith(exitCode, gfxrepro(arguments));
        if (exitCode != 0) EXPECT_EQ(result.out, "");
        return errorText([&] { throw Error(result.err); }, folder.path());
    }
    /// A text without the lines that gbuffer() has other channels than colours.
    static std::string withoutLayers(const std::string& text) {
        std::string rest;
        for (const std::string& line : split(text, '\n')) {
            if (!line.ends_with(kLayers)) rest += (rest.empty() ? "" : "\n") + line;
        }
        return rest;
    }
    static constexpr const char* kLayers = ": left out: the channels N.X, N.Y, N.Z, Z, id";
};

/// From the technique through the worker and the runner into the files.
TEST_F(ImageCommands, ImagesOfARunSayWhatMadeThem) {
    const std::string config = writeMockConfig(folder, "params: {number: 7}\n").string();
    const std::string run = at("a run");
    const ProcessResult result =
        gfxrepro({"run", config, "--device", "software", "--quiet", "--out", run});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const std::vector<records::ImageEntry> images = records::readImages(run);
    ASSERT_EQ(images.size(), 2U);
    EXPECT_EQ(images[0].name, "flat");
    EXPECT_EQ(images[0].truthOf, "");
    EXPECT_EQ(images[1].name, "truth");
    EXPECT_EQ(images[1].truthOf, "flat");
    const auto attributes = image::readExr(fs::path(run) / images[1].exr).attributes;
    EXPECT_EQ(attributes.at("command"),
              "gfxrepro run " + config + " --device software --quiet --out '" + run + "'");
    EXPECT_EQ(attributes.at("case"), images[1].caseId);
    EXPECT_EQ(attributes.at("technique"), "mock");
    EXPECT_EQ(nlohmann::json::parse(attributes.at("params")).at("number"), 7);
    EXPECT_FALSE(attributes.at("commit").empty());
}

TEST_F(ImageCommands, DiffPrintsTheMetrics) {
    const ExrImage a = gbuffer(0.75F), b = gbuffer(0.5F);
    const std::string first = write("a.exr", a), second = write("b.exr", b);
    // Half of the pixels are 0.25 off: MSE 1/32, PSNR 10·log10(32).
    const std::vector<std::string> diff{"image", "diff", first, second};
    EXPECT_EQ(said(diff), fmt::format("DIR/a.exr{0}\nDIR/b.exr{0}\n", kLayers));
    const std::string text = out(diff);
    EXPECT_THAT(text, HasSubstr("mse 0.03125\npsnr_db 15.0515\nssim 0."));
    EXPECT_THAT(text, HasSubstr("\nflip 0."));
    EXPECT_THAT(text, HasSubstr("\nmax 0.25\n"));
    const auto json =
        nlohmann::json::parse(out({"image", "diff", first, second, "--json", "--metric", "flip"}));
    ASSERT_EQ(json.size(), 1U);
    EXPECT_DOUBLE_EQ(json.at("flip"), metrics::flip(a.colour(), b.colour()));
    // Equal images: infinite, which JSON has no number for.
    EXPECT_EQ(out({"image", "diff", first, first, "--metric", "psnr,max", "--json"}),
              "{\n  \"psnr_db\": null,\n  \"max\": 0.0\n}\n");
}

TEST_F(ImageCommands, DiffTakesHdrFlipAboveOne) {
    const ExrImage a = gbuffer(6.0F), b = gbuffer(2.0F);
    const std::string first = write("a.exr", a), second = write("b.exr", b);
    const auto valueOf = [&](const std::vector<std::string>& more, const char* name) {
        const std::string json = out({"image", "diff", first, second, "--json"}, more);
        return nlohmann::json::parse(json).at(name).get<double>();
    };
    EXPECT_DOUBLE_EQ(valueOf({}, "hdr_flip"), metrics::hdrFlip(a.colour(), b.colour()));
    EXPECT_DOUBLE_EQ(valueOf({"--flip", "ldr"}, "flip"), metrics::flip(a.colour(), b.colour()));
}

TEST_F(ImageCommands, DiffWritesMaps) {
    const std::string first = write("a.exr", gbuffer(0.75F)),
                      second = write("b.exr", gbuffer(0.5F));
    out({"image", "diff", first, second, "--out", at("e.png"), "--gain", "2"});
    const Image8 absolute = image::readPng8(at("e.png"));
    EXPECT_EQ(absolute.at(0, 0, 0), 0);
    EXPECT_EQ(absolute.at(15, 11, 2), 128);  // 2 · 0.25 of 255, rounded
    out({"image", "diff", first, second, "--out", at("e.png"), "--map", "signed", "--gain", "4"});
    const Image8 isDark = image::readPng8(at("e.png"));
    EXPECT_EQ(isDark.at(0, 0, 0), 221);   // equal: grey
    EXPECT_EQ(isDark.at(15, 0, 0), 180);  // the test is too dark: red
    out({"image", "diff", first, second, "--out", at("e.exr"), "--map", "signed"});
    EXPECT_EQ(image::readExr(at("e.exr")).colour().at(15, 0, 1), 0.25F);
    out({"image", "diff", first, second, "--out", at("e.exr"), "--map", "flip"});
    EXPECT_GT(image::readExr(at("e.exr")).find("Y")->at(8, 5), 0.1F);
}

TEST_F(ImageCommands, DiffOfSmallImagesHasNoSimilarity) {
    Image8 a(4, 4, 3, 100), b(4, 4, 3, 151);
    const std::string first = write("a.png", a), second = write("b.png", b);
    // PNG values count as they are stored: 51 of 255.
    const std::string text = out({"image", "diff", first, second});
    EXPECT_EQ(text.substr(0, text.find("flip")), "mse 0.04\npsnr_db 13.9794\n");
    EXPECT_EQ(refusal({"image", "diff", first, second, "--metric", "ssim"}),
              "gfxrepro: structural similarity needs images of at least 11x11 pixels, found 4x4 "
              "with 3 channels\n");
}

TEST_F(ImageCommands, DiffRefuses) {
    const std::string exr = write("a.exr", gbuffer(1.0F)), png = write("b.png", Image8(4, 4, 3));
    EXPECT_EQ(withoutLayers(refusal({"image", "diff", exr, png})),
              "gfxrepro: image diff: DIR/a.exr and DIR/b.png are of different kinds: one is "
              "linear, as EXR files are, the other sRGB, as PNG files are\n");
    EXPECT_EQ(
        refusal({"image", "diff", png, write("c.png", Image8(5, 4, 3))}),
        "gfxrepro: the images differ in shape: 4x4 with 3 channels and 5x4 with 3 channels\n");
    EXPECT_EQ(refusal({"image", "diff", png, png, "--out", at("x.jpg")}),
              "gfxrepro: DIR/x.jpg: is neither .exr nor .png\n");
}

TEST_F(ImageCommands, ConvertExposesColours) {
    const std::string in = write("a.exr", gbuffer(0.5F));
    out({"image", "convert", in, "--out", at("a.png"), "--exposure", "1"});
    EXPECT_EQ(image::readPng8(at("a.png")).at(15, 0, 0), 255);
    EXPECT_EQ(image::readPng8(at("a.png")).at(0, 0, 0), 188);  // 0.5
}

TEST_F(ImageCommands, ConvertKeepsWhatAnExrHas) {
    const ExrImage a = gbuffer(0.5F);
    const std::string in = write("a.exr", a);
    out({"image", "convert", in, "--out", at("b.exr"), "--exposure", "-1"});
    const ExrImage b = image::readExr(at("b.exr"));
    EXPECT_EQ(b.attributes, a.attributes);
    EXPECT_EQ(b.matrices, a.matrices);
    EXPECT_EQ(b.channels.size(), a.channels.size());
    EXPECT_EQ(b.find("R")->at(15, 0), 0.25F);
    EXPECT_EQ(*b.find("id"), *a.find("id"));
    // There and back.
    out({"image", "convert", in, "--out", at("a.png")});
    out({"image", "convert", at("a.png"), "--out", at("c.exr")});
    EXPECT_NEAR(image::readExr(at("c.exr")).colour().at(15, 0, 1), 0.5F, 0.003F);
}

TEST_F(ImageCommands, ConvertKeepsBitsAndWhatAlphaHides) {
    Image8 hidden(1, 1, 4, 0);
    hidden.at(0, 0, 1) = 7;
    out({"image", "convert", write("a.png", hidden), "--out", at("b.png")});
    EXPECT_EQ(image::readPng8(at("b.png")), hidden);
    image::Image16 fine(2, 1, 1);
    fine.at(0, 0) = 0x1234;
    fine.at(1, 0) = 0x1235;
    image::writePng(at("c.png"), fine);
    out({"image", "convert", at("c.png"), "--out", at("d.png")});
    EXPECT_EQ(image::readPng16(at("d.png")), fine);
    out({"image", "convert", at("c.png"), "--out", at("e.png"), "--exposure", "1"});
    EXPECT_EQ(image::PngRows(at("e.png"), 100).bitDepth(), 8) << "what is shown has 8 bits";
}

TEST_F(ImageCommands, CropKeepsChannelsAndWhereTheyAre) {
    const ExrImage a = gbuffer(0.5F);
    out({"image", "crop", write("a.exr", a), "--out", at("b.exr"), "6", "3", "4", "2", "--scale",
         "3"});
    const ExrImage b = image::readExr(at("b.exr"));
    ASSERT_EQ(b.width(), 12);
    ASSERT_EQ(b.height(), 6);
    EXPECT_EQ(b.channels.size(), a.channels.size());
    EXPECT_EQ(b.find("id")->at(5, 0), 0.0F);
    EXPECT_EQ(b.find("id")->at(6, 5), 70000.0F);
    EXPECT_EQ(b.attributes, a.attributes);
    // The point (8, 4) is the middle of the part, (6, 3) its upper left corner.
    const std::array<float, 16>& ndc = b.matrices.at("worldToNDC");
    EXPECT_NEAR(8.0F * ndc[0] + ndc[12], 0.5F, 1e-6);
    EXPECT_NEAR(4.0F * ndc[5] + ndc[13], 0.5F, 1e-6);
    EXPECT_NEAR(6.0F * ndc[0] + ndc[12], 0.0F, 1e-6);
}

TEST_F(ImageCommands, CropCountsFromTheCornerOfWhatIsShown) {
    ImageF ramp(4, 4, 1);
    for (const auto [y, x] : test::grid(4, 4)) ramp.at(x, y) = static_cast<float>(4 * y + x);
    ExrImage exr;
    exr.add(ramp, {"Y"}, image::ExrPixelType::Float);
    exr.displayWindow = image::Rectangle{1, 2, 2, 2};  // of its columns and rows
    out({"image", "crop", write("a.exr", exr), "--out", at("b.exr"), "1", "0", "1", "2"});
    const ImageF part = image::readExr(at("b.exr")).colour();
    EXPECT_EQ(part.at(0, 0), 10.0F);
    EXPECT_EQ(part.at(0, 1), 14.0F);
}

TEST_F(ImageCommands, ConvertToExrKeepsItsNumbers) {
    const float value = 100000.5F;  // more than a half holds
    std::string pfm = "Pf\n1 1\n-1.0\n";
    pfm.append(reinterpret_cast<const char*>(&value), sizeof(value));
    out({"image", "convert", folder.write("a.pfm", pfm), "--out", at("a.exr")});
    EXPECT_EQ(image::readExr(at("a.exr")).colour().at(0, 0), value);
    ExrImage bright;
    bright.add(ImageF(1, 1, 1, 60000.0F), {"Y"});
    out({"image", "convert", write("b.exr", bright), "--out", at("c.exr"), "--exposure", "3"});
    EXPECT_EQ(image::readExr(at("c.exr")).colour().at(0, 0), 8.0F * 60000.0F);
}

TEST_F(ImageCommands, CropOfPngAndRefusals) {
    Image8 image(5, 4, 3);
    image.at(4, 3, 1) = 9;
    const std::string in = write("a.png", image);
    out({"image", "crop", in, "--out", at("b.png"), "4", "3", "1", "1", "--scale", "2"});
    const Image8 corner = image::readPng8(at("b.png"));
    EXPECT_EQ(corner.width(), 2);
    EXPECT_EQ(corner.at(1, 1, 1), 9);
    EXPECT_EQ(refusal({"image", "crop", in, "--out", at("b.png"), "3", "0", "3", "2"}),
              "gfxrepro: 3x2 pixels from (3, 0) are no part of an image of 5x4\n");
    EXPECT_EQ(
        refusal({"image", "crop", in, "--out", at("b.png"), "0", "0", "2", "2", "--scale", "0"}),
        "gfxrepro: 2x2 pixels from (0, 0) cannot be magnified 0 times; 1 to 16384 times are "
        "allowed\n");
    EXPECT_EQ(refusal({"image", "crop", in, "--out", at("b.exr"), "0", "0", "2", "2"}),
              "gfxrepro: image crop: DIR/a.png and DIR/b.exr are of different kinds; 'image "
              "convert' makes one of the other\n");
}

TEST_F(ImageCommands, ContactSheetPutsImagesInOrder) {
    const std::string red = write("r.png", [] {
        Image8 image(10, 20, 3);
        for (std::size_t i = 0; i < image.values().size(); i += 3) image.values()[i] = 200;
        return image;
    }());
    const std::string grey = write("g.png", Image8(30, 30, 1, 50));
    const std::string exr = write("e.exr", gbuffer(1.0F));
    std::string text = out({"image", "contact-sheet", "--out", at("s.png"), red, grey, exr,
                            "--columns", "2", "--width", "40"});
    for (std::size_t found; (found = text.find(folder.path().string())) != std::string::npos;) {
        text.replace(found, folder.path().string().size(), "DIR");
    }
    EXPECT_EQ(text,
              "row 1 column 1  DIR/r.png\nrow 1 column 2  DIR/g.png\nrow 2 column 1  DIR/e.exr\n");
    const Image8 sheet = image::readPng8(at("s.png"));
    EXPECT_EQ(sheet.width(), 2 * 40 + 3 * 8);
    constexpr int kCaption = 10;
    EXPECT_EQ(sheet.height(), 80 + 30 + 2 * kCaption + 3 * 8);
    EXPECT_EQ(sheet.at(8, kCaption + 87, 0), 200);
    EXPECT_EQ(sheet.at(56 + 20, kCaption + 8 + 20, 2), 50);
    EXPECT_EQ(sheet.at(56 + 20, kCaption + 8 + 60, 2), 96);  // below the lower one of a row
    // The right half of the EXR file.
    EXPECT_EQ(sheet.at(8 + 39, 2 * kCaption + 96 + 29, 1), 255);
    EXPECT_EQ(sheet.at(8 + 1, 8 + 5, 1), 255) << "of the dots before its name's end";
    ImageF part(2, 1, 1, std::numeric_limits<float>::quiet_NaN());
    ExrImage odd;
    odd.add(part, {"Y"}, image::ExrPixelType::Float);
    odd.displayWindow = {0, 0, 4, 4};
    EXPECT_EQ(said({"image", "contact-sheet", "--out", at("s.png"), write("n.exr", odd)}),
              "DIR/n.exr: pixels that are not finite: 2; NaN is shown black, infinity "
              "white\nDIR/n.exr: 2x1 pixels from (0, 0) of 4x4\n");
    EXPECT_EQ(refusal({"image", "contact-sheet", "--out", at("s.exr"), red}),
              "gfxrepro: DIR/s.exr: a contact sheet is a .png\n");
}

TEST_F(ImageCommands, NothingIsWrittenOverWhatIsRead) {
    const std::string a = write("a.png", Image8(4, 4, 1, 50));
    const std::string b = write("b.png", Image8(4, 4, 1, 60));
    const std::string same =
        "gfxrepro: --out DIR/a.png is the input DIR/a.png; allowed: another file\n";
    EXPECT_EQ(refusal({"image", "contact-sheet", b, a, "--out", a}), same);
    EXPECT_EQ(refusal({"image", "convert", a, "--out", a}), same);
    EXPECT_EQ(refusal({"image", "crop", a, "0", "0", "1", "1", "--out", a}), same);
    EXPECT_EQ(refusal({"image", "diff", a, b, "--out", a}), same);
    EXPECT_EQ(refusal({"image", "diff", b, a, "--out", a}), same);
    EXPECT_EQ(image::readPng8(a).at(0, 0), 50);
    const std::string model = folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(refusal({"scene", model, "--export", model}),
              "gfxrepro: --export DIR/m.obj is the input DIR/m.obj; allowed: another file\n");
}

/// A part of the picture, from (left, top) on, as a renderer leaves it that draws a region.
TEST_F(ImageCommands, PartsOfAPictureKeepTheirPlace) {
    const auto partOf = [&](const char* name, int left, int top) {
        ExrImage part;
        part.add(ImageF(8, 6, 3, 0.25F), {"R", "G", "B"});
        part.left = left;
        part.top = top;
        part.displayWindow = {0, 0, 16, 12};
        return write(name, part);
    };
    const std::string whole = write("a.exr", gbuffer(0.5F)), first = partOf("b.exr", 0, 0),
                      last = partOf("c.exr", 8, 6);
    EXPECT_EQ(refusal({"image", "diff", first, last}),
              "gfxrepro: the images show no place that both have: 8x6 pixels from (0, 0) of 16x12 "
              "and 8x6 pixels from (8, 6) of 16x12\n");
    for (const auto& [part, psnr, place] :
         {std::tuple(first, "psnr_db inf\n", "(0, 0)"), {last, "psnr_db 12.0412\n", "(8, 6)"}}) {
        const ProcessResult result = gfxrepro({"image", "diff", whole, part, "--metric", "psnr"});
        EXPECT_EQ(result.out, psnr);
        EXPECT_EQ(withoutLayers(result.err),
                  std::string("compared are 8x6 pixels from ") + place + " of 16x12\n");
    }
    EXPECT_THAT(out({"image", "info", last}),
                HasSubstr("data window 8x6 from (8, 6), display window 16x12 from (0, 0)\n"));
    out({"image", "convert", last, "--out", at("d.exr")});
    EXPECT_EQ(image::readExr(at("d.exr")).dataWindow(), (image::Rectangle{8, 6, 8, 6}));
}

TEST_F(ImageCommands, InfoNamesChannelsAndAttributes) {
    EXPECT_EQ(out({"image", "info", write("a.exr", gbuffer(0.5F))}),
              "exr 16x12\n"
              "data window 16x12 from (0, 0), display window 16x12 from (0, 0)\n"
              "channel B          half  0.25 to 0.5, mean 0.375\n"
              "channel G          half  0.25 to 0.5, mean 0.375\n"
              "channel N.X        half  0 to 0, mean 0\n"
              "channel N.Y        half  0 to 1, mean 0.5\n"
              "channel N.Z        half  0 to 0, mean 0\n"
              "channel R          half  0.25 to 0.5, mean 0.375\n"
              "channel Z          float 0 to 15, mean 5.75\n"
              "channel id         uint  0 to 70000, mean 35000\n"
              "case: 0123456789ab\n"
              "worldToNDC: 0.0625 0 0 0 0 0.0833333 0 0 0 0 1 0 0 0 0 1\n");
    EXPECT_EQ(out({"image", "info", write("b.png", Image8(4, 5, 1))}),
              "png 4x5, 1 channel, sRGB\n");
}

}  // namespace
}  // namespace gfxrepro::test
