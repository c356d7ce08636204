#include "runner/report/images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/support.h"

namespace gfxrepro::report {
namespace {

TEST(Images, AppendedAndRead) {
    const test::TemporaryFolder folder;
    EXPECT_TRUE(readImages(folder.path()).empty());
    const ImageEntry first{"abc", "zju2005/2.1", 0, "surface", "images/a.png", "", "a, \"b\""};
    const ImageEntry second{"abc",          "zju2005/2.1",  1,  "truth",
                            "images/b.png", "images/b.exr", "", "surface"};
    appendImages(folder.path(), {first});
    appendImages(folder.path(), {second});
    EXPECT_THAT(readImages(folder.path()), testing::ElementsAre(first, second));
    ImageEntry again = first;
    again.png = "images/c.png";
    appendImages(folder.path(), {again});
    EXPECT_THAT(readImages(folder.path()), testing::ElementsAre(again, second));
}

TEST(Images, TornLineIsPassedOver) {
    const test::TemporaryFolder folder;
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    appendImages(folder.path(), {entry});
    std::ofstream(folder.path() / "images/index.csv", std::ios::app) << "def,t,0,\"to";
    EXPECT_THAT(readImages(folder.path()), testing::ElementsAre(entry));
    appendImages(folder.path(), {{"def", "t", 0, "n", "images/p", "images/e", "title"}});
    EXPECT_EQ(readImages(folder.path()).size(), 2u);
}

TEST(Images, OlderListsNameNoTruths) {
    const test::TemporaryFolder folder;
    folder.write("images/index.csv",
                 "case,table,frame,name,png,exr,title\na,b,2,n,images/p,images/e,t\n");
    EXPECT_THAT(readImages(folder.path()), testing::ElementsAre(ImageEntry{
                                               "a", "b", 2, "n", "images/p", "images/e", "t", ""}));
    folder.write("images/index.csv", "case,table\na,b\n");
    EXPECT_EQ(test::errorText([&] { readImages(folder.path()); }, folder.path()),
              "DIR/images/index.csv:1: expected the columns "
              "case,table,frame,name,png,exr,title,truth_of, found case,table");
}

TEST(Images, MalformedRowIsAnError) {
    const test::TemporaryFolder folder;
    folder.write("images/index.csv", "case,table,frame,name,png,exr,title\na,b,x,n,p,e,t\n");
    EXPECT_EQ(test::errorText([&] { readImages(folder.path()); }, folder.path()),
              "DIR/images/index.csv:2: column 'frame': expected an integer, found 'x'");
    folder.write("images/index.csv", "case,table,frame,name,png,exr,title,truth_of\na,b\n");
    EXPECT_EQ(test::errorText([&] { readImages(folder.path()); }, folder.path()),
              "DIR/images/index.csv:2: expected 8 columns, found 2");
}

}  // namespace
}  // namespace gfxrepro::report
