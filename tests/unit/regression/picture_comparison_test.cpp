#include "runner/regression/picture_comparison.h"

#include <algorithm>
#include <limits>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "runner/records/images.h"
#include "runner/regression/comparison.h"
#include "tests/support/support.h"

namespace gfxrepro::regression {
namespace {

using image::ImageF;

/// Two runs of one case, and where their comparison goes.
struct Pictures : ::testing::Test {
    /// Records a picture in the run `side`; `params` as its plan says them.
    void record(const std::string& side, const std::string& name, const ImageF& picture,
                const std::string& params = "{}", int frame = 0) {
        const fs::path dir = folder.path() / side;
        const std::string stem = "images/p-1/" + side + "-" + name + std::to_string(frame);
        fs::create_directories(dir / "images/p-1");
        image::ExrImage exr;
        exr.add(picture, picture.channels() == 1 ? std::vector<std::string>{"Y"}
                                                 : std::vector<std::string>{"R", "G", "B"});
        image::writeExr(dir / (stem + ".exr"), exr);
        image::writePng(dir / (stem + ".png"), image::toSrgb8(picture));
        records::ImageWriter(dir).append(
            {{side, "p/1", frame, name, stem + ".png", stem + ".exr", "p/1", "",
              sha256OfFile(dir / (stem + ".png")), sha256OfFile(dir / (stem + ".exr"))}});
        const records::Record row{.caseId = side, .table = "p/1", .technique = "mock"};
        caseParams[side] = params;
        records[side] = {row};
    }
    std::string file(const std::string& side, const std::string& ending) const {
        return folder.path() / side / ("images/p-1/" + side + "-flat0" + ending);
    }
    std::vector<Difference> compared(bool isOneBuild = false) {
        const auto pictures = [&](const std::string& side) {
            return picturesOf(folder.path() / side, records[side], caseParams, unseeded);
        };
        return comparePictures(pictures("a"), pictures("b"),
                               {.isOneBuild = isOneBuild, .folder = folder.path() / "out"});
    }
    Difference only(bool isOneBuild = false) {
        const std::vector<Difference> all = compared(isOneBuild);
        EXPECT_EQ(all.size(), 1U);
        return all.empty() ? Difference{} : all.front();
    }

    gfxrepro::test::TemporaryFolder folder;
    std::map<std::string, std::vector<records::Record>> records;
    CaseParams caseParams;
    std::set<std::string> unseeded;
};

const ImageF kGrey(16, 16, 3, 0.25F);

ImageF withValue(float value) {
    ImageF picture = kGrey;
    picture.at(3, 4, 1) = value;
    return picture;
}

TEST_F(Pictures, EqualOnesAreTheSameAndNothingIsKept) {
    record("a", "flat", kGrey);
    record("b", "flat", kGrey);
    const Difference same = only(true);
    EXPECT_EQ(same.verdict, SeriesVerdict::Same);
    EXPECT_EQ(same.key.title(), "p/1 mock picture/flat");
    EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

TEST_F(Pictures, OneBuildMayNotDifferAtAllAndTwoALittle) {
    record("a", "flat", kGrey);
    record("b", "flat", withValue(0.2505F));
    EXPECT_EQ(only().verdict, SeriesVerdict::Same);
    EXPECT_GT(only().picture->largest, 0.0);
    const Difference strict = only(true);
    EXPECT_EQ(strict.verdict, SeriesVerdict::Changed);
    EXPECT_THAT(strict.reason, HasSubstr(" (0 allowed), largest difference 0.000488 (0 allowed)"));
}

/// Of a program without a seed: as far apart as its own processes are.
TEST_F(Pictures, OneThatEachProcessDrawsAnewTellsNothing) {
    record("a", "flat", kGrey);
    record("a", "flat", withValue(0.5F));  // by the next process
    record("b", "flat", ImageF(16, 16, 3, 0.75F));
    EXPECT_EQ(only(true).verdict, SeriesVerdict::Changed)
        << "a built-in technique, or one with a seed";
    unseeded = {"a", "b"};
    const Difference drawn = only(true);
    EXPECT_EQ(drawn.verdict, SeriesVerdict::CannotTell);
    EXPECT_FALSE(drawn.isAlarm());
    EXPECT_THAT(drawn.reason, HasSubstr("largest difference 0.5 (0 allowed); processes of one side "
                                        "made other pictures, too, and no seed is declared"));
    record("b", "flat", withValue(0.5F));
    EXPECT_EQ(only(true).verdict, SeriesVerdict::Same);
    record("a", "flat", ImageF(8, 8, 3, 0.25F));
    EXPECT_EQ(only(true).verdict, SeriesVerdict::Changed) << "of another size";
}

TEST_F(Pictures, OneThatEachProcessMakesAlikeStillChanges) {
    unseeded = {"a", "b"};
    for (int process = 0; process < 2; ++process) {
        record("a", "flat", kGrey);
        record("b", "flat", ImageF(16, 16, 3, 0.75F));
    }
    const Difference once = only(true);
    EXPECT_EQ(once.verdict, SeriesVerdict::CannotTell);
    EXPECT_THAT(once.reason, HasSubstr("(0 allowed); one process of each side, and no seed is "
                                       "declared; two a side tell whether they differ"));
    records["a"].push_back(records["a"].front());
    records["a"].back().process = 1;
    EXPECT_EQ(only(true).verdict, SeriesVerdict::Changed);
}

TEST_F(Pictures, AChangedOneIsKeptWithTheMapOfDifferences) {
    record("a", "flat", kGrey);
    record("b", "flat", ImageF(16, 16, 3, 0.75F));
    const Difference changed = only();
    EXPECT_TRUE(changed.isAlarm());
    EXPECT_DOUBLE_EQ(changed.picture->largest, 0.5);
    EXPECT_GT(changed.picture->flip, 0.1);
    EXPECT_THAT(changed.reason,
                HasSubstr(" (0.001 allowed), largest difference 0.5 (0.1 allowed)"));
    EXPECT_EQ(changed.evidence, "pictures/p-1/b-flat0");
    const std::string kept = (folder.path() / "out/pictures/p-1/b-flat0").string();
    for (const char* ending : {".png", ".exr"}) {
        EXPECT_EQ(readFile(kept + "-before" + ending), readFile(file("a", ending)));
        EXPECT_EQ(readFile(kept + "-after" + ending), readFile(file("b", ending)));
    }
    EXPECT_EQ(image::readPng8(kept + "-flip.png").width(), 16);
    const Comparison comparison{{changed}};
    EXPECT_THAT(
        markdown(comparison),
        HasSubstr(
            "[before](pictures/p-1/b-flat0-before.png), [after](pictures/p-1/b-flat0-after.png), "
            "[difference](pictures/p-1/b-flat0-flip.png))"));
    EXPECT_THAT(junitXml(comparison), HasSubstr("<failure message=\"changed: FLIP "));
    EXPECT_EQ(smallerIsBetterJson({changed}), "") << "no time";
}

TEST_F(Pictures, ALargeDifferenceOfOneValueIsFoundByItself) {
    record("a", "flat", ImageF(64, 64, 3, 1.0F));
    ImageF firefly(64, 64, 3, 1.0F);
    firefly.at(9, 9, 2) = 2.5F;
    record("b", "flat", firefly);
    const Difference changed = only();
    EXPECT_EQ(changed.verdict, SeriesVerdict::Changed);
    EXPECT_THAT(changed.reason, HasSubstr("largest difference 1.5 (0.1 allowed)"));
}

TEST_F(Pictures, AnotherSizeOrOtherChannelsCannotBeSubtracted) {
    record("a", "flat", kGrey);
    record("b", "flat", ImageF(8, 16, 3, 0.25F));
    EXPECT_EQ(only().reason, "16 × 16 pixels before, 8 × 16 after");
    EXPECT_TRUE(only().isAlarm());
    EXPECT_FALSE(fs::exists(folder.path() / "out/pictures/p-1/b-flat0-flip.png"));
    EXPECT_THAT(markdown({{only()}}), Not(HasSubstr("[difference]")));
    record("b", "flat", ImageF(16, 16, 1, 0.25F));
    EXPECT_EQ(only().reason, "the channels B, G, R before, Y after");
}

TEST_F(Pictures, WhatIsNotFiniteIsAnAlarmUnlessItWasSoBefore) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    record("a", "flat", kGrey);
    record("b", "flat", withValue(kNan));
    EXPECT_EQ(only().verdict, SeriesVerdict::Changed);
    EXPECT_EQ(only().reason, "channel G has a value of 0.25 before, nan after");
    record("a", "flat", withValue(kNan));
    EXPECT_EQ(only(true).verdict, SeriesVerdict::Same);
    ImageF other = withValue(kNan);
    other.at(0, 0, 0) = 1.0F;
    record("b", "flat", other);
    EXPECT_DOUBLE_EQ(only().picture->largest, 0.75) << only().reason;
    EXPECT_EQ(only().verdict, SeriesVerdict::Changed);
}

TEST_F(Pictures, WhatCannotBeReadIsAnAlarmThatNamesTheFile) {
    record("a", "flat", kGrey);
    record("b", "flat", kGrey);
    const std::string whole = readFile(file("b", ".exr"));
    writeFileAtomic(file("b", ".exr"), whole.substr(0, whole.size() / 2));
    const Difference changed = only();
    EXPECT_EQ(changed.verdict, SeriesVerdict::Changed);
    EXPECT_THAT(changed.reason, HasSubstr(file("b", ".exr")));
    fs::remove(file("b", ".exr"));
    EXPECT_EQ(only(true).verdict, SeriesVerdict::Same) << "by their PNG files";
    writeFileAtomic(file("b", ".png"), "no picture");
    EXPECT_THAT(only().reason, HasSubstr(file("b", ".png")));
}

TEST_F(Pictures, ArePairedByCaseNameAndFrameAlsoWithANewParameter) {
    record("a", "flat", kGrey, R"({"n":1})");
    record("b", "flat", kGrey, R"({"n":1,"new":2})");
    EXPECT_EQ(only().verdict, SeriesVerdict::Same);
    record("b", "flat", withValue(0.9F), R"({"n":1,"new":2})", 1);
    record("b", "deep", kGrey, R"({"n":1,"new":2})");
    const std::vector<Difference> all = compared();
    ASSERT_EQ(all.size(), 4U) << "of two frames none is the one of one";
    EXPECT_EQ(all[0].key.pass, "deep, frame 0");
    EXPECT_EQ(all[0].reason, "recorded after only");
    EXPECT_EQ(all[1].key.pass, "flat");
    EXPECT_EQ(all[1].reason, "recorded before only");
    for (const Difference& difference : all) {
        const bool isLost = difference.key.pass == "flat";
        EXPECT_EQ(difference.verdict, isLost ? SeriesVerdict::Lost : SeriesVerdict::Missing);
        EXPECT_EQ(difference.isAlarm(), isLost);
    }
}

TEST_F(Pictures, ALostOneIsAnAlarmUnlessAllOfItsCaseIsLost) {
    record("a", "flat", kGrey);
    records["b"] = records["a"];
    const Difference lost = only();
    EXPECT_EQ(lost.verdict, SeriesVerdict::Lost);
    EXPECT_EQ(lost.reason, "recorded before only");
    const auto with = [&](const std::vector<SeriesVerdict>& others) {
        std::vector<Difference> differences;
        for (const SeriesVerdict verdict : others) {
            SeriesKey key = lost.key;
            key.pass = "";
            key.metric = "n" + std::to_string(differences.size());
            differences.push_back({.key = key, .verdict = verdict});
        }
        addPictures(differences, {lost});
        return std::ranges::find(differences, lost.key, &Difference::key)->verdict;
    };
    EXPECT_EQ(with({}), SeriesVerdict::Lost);
    EXPECT_EQ(with({SeriesVerdict::Lost, SeriesVerdict::Same}), SeriesVerdict::Lost);
    EXPECT_EQ(with({SeriesVerdict::Missing}), SeriesVerdict::Lost);
    EXPECT_EQ(with({SeriesVerdict::Lost, SeriesVerdict::Missing}), SeriesVerdict::Missing);
}

TEST_F(Pictures, ListedOnesThatAreNotThereAreNone) {
    record("a", "flat", kGrey);
    for (const char* ending : {".png", ".exr"}) fs::remove(file("a", ending));
    EXPECT_TRUE(picturesOf(folder.path() / "a", records["a"], caseParams).empty());
    EXPECT_TRUE(picturesOf(folder.path() / "nothing", {}, {}).empty());
}

TEST_F(Pictures, NamesOfARunBecomeNoOtherPlace) {
    record("a", "flat", kGrey);
    record("b", "flat", ImageF(16, 16, 3, 0.75F));
    const std::string hostile = "images/p-1/](http:x) $(y).png";
    fs::copy_file(file("b", ".png"), folder.path() / "b" / hostile);
    records::ImageWriter(folder.path() / "b").append({{"b", "p/1", 0, "flat", hostile, "", "p/1"}});
    EXPECT_EQ(only().evidence, "pictures/p-1/__http_x____y_");
}

}  // namespace
}  // namespace gfxrepro::regression
