// Pictures that programs leave: which part of a picture they are, and in which format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.h"
#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
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

}  // namespace
}  // namespace gfxrepro::test
