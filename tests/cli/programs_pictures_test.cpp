// Pictures that programs leave: which part of a picture they are, and in which format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.h"
#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using image::ImageF;
using testing::HasSubstr;

class PicturesOfPrograms : public testing::Test {
  protected:
    /// Runs a config whose program leaves the file `made`, of which `truth` is the truth.
    ProcessResult run(const std::string& made, const std::string& truth) const {
        const std::string ending = std::filesystem::path(made).extension();
        const std::string config = folder.write(
            "mine.yaml",
            "sweep_of: mine\ntitle: Mine\noutput: {width: 16, height: 12}\n"
            "program:\n  command: cp {here}/" +
                made + " {out}/result" + ending + "\n  env: {SIZE: \"{width} {height}\"}\n" +
                "  images: {result: {file: result" + ending + ", truth: \"{here}/" + truth +
                "\"}}\n");
        std::filesystem::remove_all(dir);
        return gfxrepro({"run", config, "--out", dir, "--quiet"});
    }

    TemporaryFolder folder;
    std::string dir = folder.path() / "run";
};

TEST_F(PicturesOfPrograms, APartOfThePictureIsHeldAgainstThatPartOfItsTruth) {
    const auto write = [&](const char* name, const image::Rectangle& data, int width) {
        ImageF colour(data.width, data.height, 3);
        for (int y = 0; y < data.height; ++y) {
            for (int x = 0; x < data.width; ++x) {
                colour.at(x, y, 0) = 0.01F * static_cast<float>(data.left + x);
                colour.at(x, y, 1) = 0.01F * static_cast<float>(data.top + y);
            }
        }
        image::ExrImage exr;
        exr.add(colour, {"R", "G", "B"}, image::ExrPixelType::Float);
        exr.left = data.left;
        exr.top = data.top;
        exr.displayWindow = {0, 0, width, 12};
        image::writeExr(folder.path() / name, exr);
    };
    write("whole.exr", {0, 0, 16, 12}, 16);
    write("part.exr", {5, 3, 4, 6}, 16);
    write("other.exr", {12, 3, 4, 6}, 16);
    write("wide.exr", {5, 3, 4, 6}, 17);
    ASSERT_EQ(run("part.exr", "whole.exr").exitCode, 0);
    EXPECT_EQ(rowsOf(dir, "mse").at(0).value, 0.0);
    const auto images = records::readImages(dir);
    ASSERT_EQ(images.size(), 2U);
    const ImageF truth = image::readPicture(dir + "/" + images[1].exr).linear;
    EXPECT_EQ(truth.width(), 4);
    EXPECT_NEAR(truth.at(0, 0, 0), 0.05F, 1e-4);
    EXPECT_EQ(run("part.exr", "other.exr").exitCode, 4);
    EXPECT_THAT(readFile(dir + "/records.csv"),
                HasSubstr("image 'result' and its truth: the images show no place that both have: "
                          "4x6 pixels from (5, 3) of 16x12 and 4x6 pixels from (12, 3) of 16x12"));
    EXPECT_EQ(run("wide.exr", "whole.exr").exitCode, 4);
    EXPECT_THAT(readFile(dir + "/records.csv"),
                HasSubstr("image 'result': has 17 × 12 pixels; 16 × 12 were asked for"));
}

TEST_F(PicturesOfPrograms, OtherFormatsAreReadAsTheirKind) {
    const ImageF light(16, 12, 3, 0.25F);
    image::ExrImage exr;
    exr.add(light, {"R", "G", "B"}, image::ExrPixelType::Float);
    image::writeExr(folder.path() / "truth.exr", exr);
    image::writePng(folder.path() / "truth.png", image::Image8(16, 12, 3, 51));
    const auto values = light.values();
    folder.write("p.pfm",
                 "PF\n16 12\n-1\n" + std::string(reinterpret_cast<const char*>(values.data()),
                                                 values.size_bytes()));
    std::string hdr = "#?RADIANCE\n\n-Y 12 +X 16\n";
    for (int i = 0; i < 16 * 12; ++i) hdr += "\x80\x80\x80\x7f";
    folder.write("p.hdr", hdr);
    folder.write("p.ppm", "P6\n16 12\n255\n" + std::string(16 * 12 * 3, '\x33'));
    folder.write("p.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\x10\0\x0c\0\x18\0", 18) +
                              std::string(16 * 12 * 3, '\x33'));
    for (const auto& [made, truth] : {std::pair("p.pfm", "truth.exr"),
                                      {"p.hdr", "truth.exr"},
                                      {"p.hdr", "p.pfm"},
                                      {"p.ppm", "truth.png"},
                                      {"p.tga", "truth.png"},
                                      {"truth.png", "p.ppm"}}) {
        ASSERT_EQ(run(made, truth).exitCode, 0) << made << readFile(dir + "/records.csv");
        EXPECT_EQ(rowsOf(dir, "mse").at(0).value, 0.0) << made;
    }
    const auto images = records::readImages(dir);
    EXPECT_NEAR(image::readPicture(dir + "/" + images[0].exr).linear.at(3, 3, 1), 0.0331F, 1e-4);
    EXPECT_EQ(run("p.pfm", "truth.png").exitCode, 4);
    EXPECT_THAT(readFile(dir + "/records.csv"),
                HasSubstr("image 'result': one of it and its truth is linear, as EXR files are, "
                          "the other sRGB, as PNG files are"));
    const ProcessResult refused = run("p.gif", "truth.png");
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.err, HasSubstr("file is result.gif; allowed: a name that ends in one of "
                                       ".exr, .png, .pfm, "));
}

}  // namespace
}  // namespace gfxrepro::test
