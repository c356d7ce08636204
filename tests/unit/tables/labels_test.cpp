// Names of configs in words, wherever a report shows them.
#include "runner/tables/labels.h"

#include <gtest/gtest.h>

#include "runner/tables/table.h"

namespace gfxrepro::test {
namespace {

using namespace tables;

TEST(Labels, ANameIsItsWordsAndTheUnitThatItEndsWith) {
    EXPECT_EQ(shownName("light_grid"), "light grid");
    EXPECT_EQ(shownName("memory_mib"), "memory [MiB]");
    EXPECT_EQ(shownName("reflective_pct"), "reflective [%]");
    EXPECT_EQ(shownName("frame_ms"), "frame [ms]");
    EXPECT_EQ(shownName("outdoor/bird_nest"), "bird nest");
    EXPECT_EQ(shownName("scene.building_height"), "building height");
    EXPECT_EQ(shownName("output.width"), "width of the image [px]");
    EXPECT_EQ(shownName("fps"), "frame rate [fps]");
    EXPECT_EQ(shownName("delta_s"), "delta s");  // no seconds
    EXPECT_EQ(shownName("m"), "m");              // no metres
    EXPECT_EQ(shownName("Two words, as_they are"), "Two words, as_they are");
    EXPECT_EQ(shownName("light_grid", {{"light_grid", "light samples a side"}}),
              "light samples a side");
}

TEST(Labels, AFileOfOnesOwnIsItsName) {
    EXPECT_EQ(shownName("/home/me/my_scan.ply"), "my_scan.ply");
    EXPECT_EQ(shownName("/home/me/my_scan.ply", {{"my_scan.ply", "the scan"}}), "the scan");
    EXPECT_EQ(shownName("/"), "/");
    const auto shown = shownNames({"/a/x.obj", "/b/x.obj", "/b/y.obj"});
    EXPECT_EQ(shown.at("/a/x.obj"), "/a/x.obj");
    EXPECT_EQ(shown.at("/b/y.obj"), "y.obj");
    const auto texts = shownNames({"a_b", "a b", "c_d", "one/model", "other/model"});
    EXPECT_EQ(texts.at("a_b"), "a_b");
    EXPECT_EQ(texts.at("a b"), "a b");
    EXPECT_EQ(texts.at("c_d"), "c d");
    EXPECT_EQ(texts.at("one/model"), "one/model");
    EXPECT_EQ(shownCase("sweep/mine scene=/a/x.obj light_ratio=0.25", "sweep/mine"),
              "x.obj, light ratio 0.25");
}

TEST(Labels, TheRecordedUnitIsThatOfANameWithoutOne) {
    EXPECT_EQ(quantityOf("gpu_time_ms", {}, "ms").text(), "gpu time [ms]");
    EXPECT_EQ(quantityOf("clusters", {}, "cluster").text(), "clusters");
    EXPECT_EQ(quantityOf("vertices", {}, "vertex").text(), "vertices");
    EXPECT_EQ(quantityOf("culled_patches", {}, "patch").text(), "culled patches");
    EXPECT_EQ(quantityOf("flip_mean", {}, "1").text(), "flip mean");
    EXPECT_EQ(quantityOf("frame_rate", {}, "1/s").text(), "frame rate [1/s]");
    EXPECT_EQ(quantityOf("rmse_level", {}, "level").text(), "rmse [level]");
    EXPECT_EQ(quantityOf("draw_ms", {{"draw_ms", "drawing"}}, "ms").text(), "drawing [ms]");
    EXPECT_EQ(quantityOf("memory_mib").with("12.5"), "memory 12.5 MiB");
    EXPECT_EQ(quantityOf("point_mib").with("3.914"), "point memory 3.914 MiB");
    EXPECT_EQ(quantityOf("gpu_memory_mb").text(), "gpu memory [MB]");
    EXPECT_EQ(quantityOf("redundant_pct_image_0", {}, "%").text(), "redundant, image 0 [%]");
    EXPECT_EQ(quantityOf("redundant_pct_image_0", {}, "%").with("0"), "redundant, image 0: 0 %");
    EXPECT_EQ(quantityOf("silhouette_deg").with("20"), "silhouette 20°");
    EXPECT_EQ(quantityOf("light_grid").with("4 / 8"), "light grid 4 / 8");
}

TEST(Labels, AColumnOfSeveralAxesIsItsPartsInWords) {
    const TableColumn column{"draw_ms_non_redundant", "ms", {}, {}, {"draw_ms", "non_redundant"}};
    EXPECT_EQ(quantityOf(column, {{"non_redundant", "non-redundant"}}).text(),
              "draw [ms], non-redundant");
}

TEST(Labels, WhatAClaimAsksIsSaidInTheColumnsWords) {
    const Table table{
        .words = {{"lit_ms", "lighting"}},
        .rowAxes = {"n_lights", "measure"},
        .columns = {{"draw_ms", "ms"}, {"lit_ms", "ms"}, {"flip_mean", "1"}, {"a-b_pct", "%"}},
        .rows = {{{"1", "useful_pct"}, {}, {}}}};
    EXPECT_EQ(inWords("draw_ms / lit_ms in [0.5, 1.5]", table), "draw / lighting in [0.5, 1.5]");
    EXPECT_EQ(inWords("draw_ms/lit_ms < 2", table), "draw/lighting < 2");
    EXPECT_EQ(inWords("draw_ms ≤ 10", table), "draw [ms] ≤ 10");
    EXPECT_EQ(inWords("max(flip_mean, 'a-b_pct') ≤ 1", table), "max(flip mean, a-b) ≤ 1");
    EXPECT_EQ(inWords("lit_ms < draw_ms", table), "lighting < draw");
    EXPECT_EQ(inWords("strictly increasing with n_lights; exponent in [1, 2]", table),
              "strictly increasing with n lights; exponent in [1, 2]");
    EXPECT_EQ(inWords("draw_ms < useful_pct", table), "draw < useful") << "across a row axis";
    EXPECT_EQ(inWords("another_ms < 1'", table), "another_ms < 1'") << "no name of the table";
    EXPECT_EQ(inWords("", table), "");
}

TEST(Labels, AValueInASentenceKeepsItsFolder) {
    EXPECT_EQ(valueInWords("path_1"), "path 1");
    EXPECT_EQ(valueInWords("outdoor/bird_nest"), "outdoor/bird_nest");
    EXPECT_EQ(valueInWords("my_model.glb"), "my_model.glb");
    EXPECT_EQ(valueInWords("MULTI_JITTER"), "MULTI_JITTER") << "as another program writes it";
    EXPECT_EQ(shownName("MULTI_JITTER"), "MULTI_JITTER");
    EXPECT_EQ(shownValue("pattern", "MULTI_JITTER"), "MULTI_JITTER");
    EXPECT_EQ(valueInWords("low_pass", {{"low_pass", "the low-pass filter"}}),
              "the low-pass filter");
}

TEST(Labels, ACaseIsTheValuesOfItsAxes) {
    EXPECT_EQ(shownCase("sweep/mine scene=shapes/torus light_ratio=0.25 method=depth_peeling",
                        "sweep/mine"),
              "torus, light ratio 0.25, depth peeling");
    EXPECT_EQ(shownCase("sweep/mine offset=[1, 2, 3] skirts=true (outdoor/grass@2)", "sweep/mine"),
              "[1, 2, 3], skirts true (outdoor/grass@2)");
    EXPECT_EQ(shownCase("sweep/mine share_pct=20 n=3", "sweep/mine", {{"n", "samples"}}),
              "share 20 %, samples 3");
    EXPECT_EQ(shownCase("sweep/mine", "sweep/mine"), "sweep/mine");
}

}  // namespace
}  // namespace gfxrepro::test
