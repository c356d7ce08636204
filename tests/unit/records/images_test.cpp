#include "runner/records/images.h"

#include <fstream>
#include <functional>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "runner/records/records.h"
#include "tests/support/support.h"

namespace gfxrepro::records {
namespace {

using Images = FolderTest;

TEST_F(Images, AppendedAndRead) {
    EXPECT_TRUE(readImages(folder.path()).empty());
    const ImageEntry first{"abc", "zju2005/2.1", 0, "surface", "images/a.png", "", "a, \"b\""};
    const ImageEntry second{"abc",          "zju2005/2.1",  1,  "truth",
                            "images/b.png", "images/b.exr", "", "surface"};
    ImageWriter(folder.path()).append({first});
    ImageWriter(folder.path()).append({second});
    EXPECT_THAT(readImages(folder.path()), ElementsAre(first, second));
    ImageEntry again = first;
    again.png = "images/c.png";
    ImageWriter(folder.path()).append({again});
    EXPECT_THAT(readImages(folder.path()), ElementsAre(again, second));
}

TEST_F(Images, TornLineIsPassedOver) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    ImageWriter(folder.path()).append({entry});
    std::ofstream(folder.path() / "images/index.csv", std::ios::app) << "def,t,0,\"to";
    EXPECT_THAT(readImages(folder.path()), ElementsAre(entry));
    ImageWriter(folder.path()).append({{"def", "t", 0, "n", "images/p", "images/e", "title"}});
    EXPECT_EQ(readImages(folder.path()).size(), 2u);
}

TEST_F(Images, AListStopsBeforeWhatIsNotRead) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    ImageWriter writer(folder.path(), 3);
    writer.append({entry});
    EXPECT_THROW(writer.append({entry, entry}), FullError);
    writer.append({entry});
    EXPECT_THROW(ImageWriter(folder.path(), 3).append({entry}), FullError)
        << "rows of before count";
}

TEST_F(Images, WhatIsNotAsItWasWrittenIsNamed) {
    const auto written = [&](const std::string& name) {
        return sha256OfFile(folder.write(name, name));
    };
    ImageEntry entry{"abc", "t", 0, "n", "images/a.png", "images/a.exr", "title"};
    entry.pngSha256 = written("images/a.png");
    entry.exrSha256 = written("images/a.exr");
    ImageWriter(folder.path()).append({entry});
    EXPECT_THAT(changedImages(folder.path()), IsEmpty());
    folder.write("images/a.png", "another");
    fs::remove(folder.path() / "images/a.exr");
    EXPECT_THAT(changedImages(folder.path()),
                ElementsAre("images/a.png was changed", "images/a.exr is missing"));
}

TEST_F(Images, AListThatIsNoLongerTheWritersIsNotWrittenTo) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    const auto index = folder.path() / "images/index.csv";
    const auto disturbed = [&](const std::function<void(const std::string& whole)>& disturb) {
        fs::remove(index);
        ImageWriter writer(folder.path());
        writer.append({entry});
        writer.requireOurs();
        disturb(readFile(index));
        EXPECT_EQ(errorText([&] { writer.append({}); }, folder.path()),
                  errorText([&] { writer.append({entry}); }, folder.path()));
        return errorText([&] { writer.requireOurs(); }, folder.path());
    };
    const std::string lost =
        "DIR/images/index.csv: was removed, replaced or changed while a run wrote to it: rows are "
        "lost; nothing more is measured into it";
    EXPECT_EQ(disturbed([&](const std::string&) { fs::remove(index); }), lost);
    EXPECT_EQ(disturbed([&](const std::string& whole) { writeFileAtomic(index, whole); }), lost);
    EXPECT_EQ(
        disturbed([&](const std::string& whole) { folder.write("images/index.csv", whole + "x"); }),
        lost);
    EXPECT_EQ(disturbed([&](const std::string&) { folder.write("images/index.csv", ""); }), lost);

    fs::remove(index);
    ImageWriter none(folder.path());
    none.append({});
    EXPECT_FALSE(fs::exists(index));
    folder.write("images/index.csv", "");
    EXPECT_EQ(errorText([&] { none.append({entry}); }, folder.path()),
              "DIR/images/index.csv: was made by another while a run had no images; nothing more "
              "is measured into its folder");
}

TEST_F(Images, ACutHeadIsWrittenAgain) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    for (const char* head : {"", "case,tab"}) {
        folder.write("images/index.csv", head);
        ImageWriter(folder.path()).append({entry});
        EXPECT_THAT(readImages(folder.path()), ElementsAre(entry));
    }
}

TEST_F(Images, OtherColumnsAreAnError) {
    folder.write("images/index.csv", "case,table\na,b\n");
    EXPECT_EQ(
        errorText([&] { readImages(folder.path()); }, folder.path()),
        "DIR/images/index.csv:1: expected the columns "
        "case,table,frame,name,png,exr,title,truth_of,png_sha256,exr_sha256, found case,table");
}

TEST_F(Images, MalformedRowIsAnError) {
    const auto refused = [&](const std::string& text) {
        folder.write("images/index.csv", text);
        return errorText([&] { readImages(folder.path()); }, folder.path());
    };
    const std::string without = "case,table,frame,name,png,exr,title,truth_of";
    const std::string header = without + ",png_sha256,exr_sha256";
    EXPECT_EQ(refused(header + "\na,b,x,n,p,e,t,,s,s\n"),
              "DIR/images/index.csv:2: column 'frame': expected an integer, found 'x'");
    EXPECT_EQ(refused(header + "\na,b\n"), "DIR/images/index.csv:2: expected 10 columns, found 2");
    EXPECT_EQ(refused(without + "\na,b,0,n,images/p.png,,t,\n"),
              "DIR/images/index.csv:1: expected the columns " + header + ", found " + without);
}

}  // namespace
}  // namespace gfxrepro::records
