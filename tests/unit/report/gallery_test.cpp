// Pictures on their way into a page.
#include "runner/report/gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "runner/report/pages.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::report {
namespace {

using claims::ClaimResult;
using claims::Verdict;

/// A picture that compresses to nearly what it has of bytes: three a pixel.
void writeNoise(const fs::path& file, int sizePx, unsigned seed = 1) {
    std::mt19937 random(seed);
    image::Image8 picture(sizePx, sizePx, 3);
    for (const auto [y, x] : test::grid(sizePx, sizePx)) {
        for (int c = 0; c < 3; ++c) {
            picture.at(x, y, c) = static_cast<std::uint8_t>(random() & 0xFFU);
        }
    }
    image::writePng(file, picture);
}

TEST(Gallery, PicturesInsideAFileAreReducedUntilItCanBeSent) {
    const TemporaryFolder run;
    const std::vector<fs::path> runs = {run.path()};
    EXPECT_EQ(reducedPxOf(runs, 1), 512) << "no pictures";
    writeNoise(run.path() / "images/a.png", 1024);  // 3.1 MB
    records::ImageWriter(run.path()).append({{"case", "t/1", 0, "noise", "images/a.png", "", "t"}});
    EXPECT_EQ(reducedPxOf(runs, 25'000'000), 512);
    EXPECT_EQ(reducedPxOf(runs, 1'000'000), 320);
    EXPECT_EQ(reducedPxOf(runs, 300'000), 192);
    EXPECT_EQ(reducedPxOf(runs, 1), 128);
    const auto widthBy = [&](int reducedPx) {
        const TemporaryFolder made;
        return gatherShots({run.path(), made.path(), made.path() / "page.html",
                            GalleryPlace::Embedding::Reduced, reducedPx})
            .at(0)
            .width;
    };
    EXPECT_EQ(widthBy(512), 512);
    EXPECT_EQ(widthBy(192), 192);
}

TEST(Gallery, PicturesThatAreAlikeAreShownByOnesFiles) {
    const TemporaryFolder run;
    records::ImageWriter writer(run.path());
    // Of three cases the pictures are the same, and the truths of two.
    for (const std::string id : {"a", "b", "c"}) {
        const std::string picture = "images/" + id + "-result.png",
                          truth = "images/" + id + "-t.png";
        writeNoise(run.path() / picture, 600);
        writeNoise(run.path() / truth, 600, id == "c" ? 3 : 2);
        writer.append({{id, "t/" + id, 0, "result", picture, "", "case " + id},
                       {id, "t/" + id, 0, "t", truth, "", "case " + id, "result"}});
    }
    const std::vector<Shot> shots =
        gatherShots({run.path(), run.path(), run.path() / "report.html"});
    ASSERT_EQ(shots.size(), 6U);
    const Shot &a = shots[0], &b = shots[2], &c = shots[4];
    EXPECT_EQ(a.thumbnail, b.thumbnail);
    EXPECT_EQ(a.flip, b.flip);
    EXPECT_EQ(a.flipMean, b.flipMean);
    EXPECT_NE(a.flip, c.flip);
    EXPECT_NE(a.flipMean, c.flipMean);
    EXPECT_FALSE(fs::exists(run.path() / "thumbnails/b-result-flip.png"));
    // Each is still its own case's.
    EXPECT_EQ(b.caseId + b.table + b.caseTitle + b.name + b.png + b.truth,
              "bt/bcase bresultimages/b-result.pngt");
    EXPECT_TRUE(shots[1].isTruth() && shots[3].isTruth());
    EXPECT_EQ(shots[1].content, shots[3].content);
    EXPECT_FALSE(a.isTruth() || b.isTruth());
}

TEST(Gallery, LightAboveWhiteLiesInLayers) {
    image::ImageF picture(6, 1, 1, 0.5F);
    const float values[] = {0.5F, 1.0F, 2.0F, 20.0F, 1000.0F, 0.0F};
    std::ranges::copy(values, picture.values().begin());
    const std::vector<image::Image8> layers = lightLayers(picture);
    ASSERT_EQ(layers.size(), 3U) << "16, 256, 4096";
    const image::Image8 first = image::toSrgb8(picture);
    for (int x = 0; x < 6; ++x) {
        float light = image::linearOf(static_cast<float>(first.at(x, 0)) / 255.0F);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const float shown = image::linearOf(static_cast<float>(layers[i].at(x, 0)) / 255.0F);
            light = std::max(light, std::ldexp(shown, kLayerStops * (static_cast<int>(i) + 1)));
        }
        EXPECT_NEAR(light, values[x], 0.015F * values[x]);
        EXPECT_EQ(layers[0].at(x, 0) > 0, values[x] > 1.0F) << "black where the PNG tells";
        EXPECT_EQ(layers[1].at(x, 0) > 0, values[x] > 16.0F);
    }
    EXPECT_TRUE(lightLayers(image::ImageF(2, 2, 3, 1.0F)).empty());
}

TEST(Gallery, PicturesOfOnePngKeepTheirOwnLight) {
    const test::TemporaryFolder run;
    records::ImageWriter writer(run.path());
    std::filesystem::create_directories(run.path() / "images");
    for (const float value : {0.5F, 2.0F, 40.0F}) {
        const std::string stem = fmt::format("images/{}", value);
        image::writePng(run.path() / (stem + ".png"), image::Image8(8, 8, 3, 255));
        image::ExrImage exr;
        exr.add(image::ImageF(8, 8, 3, value), {"R", "G", "B"});
        image::writeExr(run.path() / (stem + ".exr"), exr);
        writer.append({{stem, "t/1", 0, "result", stem + ".png", stem + ".exr", "t"}});
    }
    const auto shots = gatherShots({run.path(), run.path(), run.path() / "report.html"});
    ASSERT_EQ(shots.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(shots[i].light.size(), i);
    for (const std::string& layer : shots[2].light) EXPECT_TRUE(exists(run.path() / layer));
}

TEST(Gallery, SaysHowFarItIs) {
    const TemporaryFolder run;
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
    EXPECT_THAT(done, ElementsAre(1, 2, 3));
}

// Which pictures stand for a document.

ClaimResult claim(const std::string& id, Verdict verdict) {
    return ClaimResult{.id = id, .verdict = verdict, .origin = config::ClaimSpec::Origin::Document};
}

/// A page with pictures at these distances from their truths.
Page pageOf(const std::string& id, const config::Experiment& experiment,
            std::vector<ClaimResult> claims, const std::vector<double>& distances) {
    RunPart part{.experiment = &experiment, .claims = std::move(claims)};
    for (const double distance : distances) {
        Shot shot;
        shot.caseId = id + std::to_string(distance);
        shot.name = shot.baseName = "image";
        shot.truth = "truth";
        shot.flip = "map";
        shot.flipMean = distance;
        part.shots.push_back(shot);
    }
    Page page;
    page.id = id;
    page.parts.push_back(std::move(part));
    return page;
}

std::vector<std::string> namesOf(const std::vector<Page>& pages) {
    std::vector<const Page*> all;
    for (const Page& page : pages) all.push_back(&page);
    std::vector<std::string> names;
    // Pictures are as different as their distances from the truth.
    const auto difference = [](std::size_t, const Shot& a, const Shot& b) {
        return std::abs(a.flipMean - b.flipMean);
    };
    for (const Highlight& one : highlightsOf(all, difference)) {
        names.push_back(one.page->id + ' ' + one.claim->id + ' ' +
                        std::to_string(one.shot->flipMean).substr(0, 3));
    }
    return names;
}

TEST(Highlights, AreThoseOfFurtherClaimsWhereFewPagesHavePictures) {
    const config::Experiment experiment;
    const auto holds = [](const char* id) { return claim(id, Verdict::Holds); };
    const std::vector<Page> pages = {
        pageOf("a", experiment, {holds("A1"), holds("A2"), claim("A3", Verdict::Ambiguous)},
               {0.2, 0.1, 0.3}),
        pageOf("b", experiment, {holds("B1"), claim("B2", Verdict::Fails)}, {0.1, 0.4}),
        pageOf("c", experiment, {holds("C1"), holds("C2")}, {0.5})};
    EXPECT_THAT(namesOf(pages),
                ElementsAre("a A1 0.1", "a A2 0.2", "b B2 0.4", "b B1 0.1", "c C1 0.5"));
}

TEST(Highlights, AreOfSeveralOfAPageThoseThatLookLeastAlike) {
    const config::Experiment experiment;
    const auto holds = [](const char* id) { return claim(id, Verdict::Holds); };
    const std::vector<Page> pages = {
        pageOf("a", experiment, {holds("1"), holds("2")}, {0.10, 0.11}),
        pageOf("b", experiment, {holds("1"), holds("2"), holds("3")}, {0.1, 0.3, 0.6}),
        pageOf("c", experiment, {holds("1"), holds("2")}, {0.2, 0.5}),
        pageOf("d", experiment, {holds("1")}, {0.2})};
    EXPECT_THAT(namesOf(pages),
                ElementsAre("a 1 0.1", "b 1 0.1", "b 3 0.6", "c 1 0.2", "c 2 0.5", "d 1 0.2"));
}

TEST(Highlights, AreOneEachOfSixPages) {
    const config::Experiment experiment;
    std::vector<Page> pages;
    for (const char* id : {"a", "b", "c", "d", "e", "f", "g"}) {
        pages.push_back(pageOf(
            id, experiment, {claim("1", Verdict::Holds), claim("2", Verdict::Holds)}, {0.1, 0.2}));
    }
    EXPECT_THAT(namesOf(pages),
                ElementsAre("a 1 0.1", "b 1 0.1", "c 1 0.1", "d 1 0.1", "e 1 0.1", "f 1 0.1"));
}

}  // namespace
}  // namespace gfxrepro::report
