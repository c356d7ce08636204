// Pictures on their way into a page.
#include "runner/report/gallery.h"

#include <gmock/gmock.h>

#include <random>

#include "engine/image/png_io.h"
#include "tests/support/support.h"

namespace gfxrepro::report {
namespace {

/// A picture that compresses to nearly what it has of bytes: three a pixel.
void writeNoise(const std::filesystem::path& file, int sizePx) {
    std::mt19937 random(1);
    image::Image8 picture(sizePx, sizePx, 3);
    for (int y = 0; y < sizePx; ++y) {
        for (int x = 0; x < sizePx; ++x) {
            for (int c = 0; c < 3; ++c) {
                picture.at(x, y, c) = static_cast<std::uint8_t>(random() & 0xFFU);
            }
        }
    }
    image::writePng(file, picture);
}

TEST(Gallery, PicturesInsideAFileAreReducedUntilItCanBeSent) {
    const test::TemporaryFolder run;
    const std::vector<std::filesystem::path> runs = {run.path()};
    EXPECT_EQ(reducedPxOf(runs, 1), 512) << "no pictures";
    writeNoise(run.path() / "images/a.png", 1024);  // 3.1 MB
    records::ImageWriter(run.path()).append({{"case", "t/1", 0, "noise", "images/a.png", "", "t"}});
    EXPECT_EQ(reducedPxOf(runs, 25'000'000), 512);
    EXPECT_EQ(reducedPxOf(runs, 1'000'000), 320);
    EXPECT_EQ(reducedPxOf(runs, 300'000), 192);
    EXPECT_EQ(reducedPxOf(runs, 1), 128);
    const auto widthBy = [&](int reducedPx) {
        const test::TemporaryFolder made;
        return gatherShots({run.path(), made.path(), made.path() / "page.html",
                            GalleryPlace::Embedding::Reduced, reducedPx})
            .at(0)
            .width;
    };
    EXPECT_EQ(widthBy(512), 512);
    EXPECT_EQ(widthBy(192), 192);
}

TEST(Gallery, SaysHowFarItIs) {
    const test::TemporaryFolder run;
    records::ImageWriter writer(run.path());
    for (const char* name : {"a", "b", "c"}) {
        const std::string file = std::string("images/") + name + ".png";
        writeNoise(run.path() / file, 8);
        writer.append({{"case", "t/1", 0, name, file, "", "t"}});
    }
    std::vector<std::size_t> done;
    const auto progress = [&](std::size_t count, std::size_t all) {
        EXPECT_EQ(all, 3U);
        done.push_back(count);
    };
    gatherShots({run.path(), run.path(), run.path() / "report.html"}, progress);
    EXPECT_THAT(done, testing::ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace gfxrepro::report
