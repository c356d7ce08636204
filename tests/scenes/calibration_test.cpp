// What the shipped calibrations came to is what the catalogue and the preset say.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

#include "runner/config/node.h"
#include "runner/core/files.h"

namespace gfxrepro {
namespace {

const std::filesystem::path kSource = GFXREPRO_SOURCE_DIR;

/// The values of results/calibration/SCENE.csv: scene.NAME and view_NAME.
std::map<std::string, double> fitted(const std::string& scene) {
    std::istringstream csv(readFile(kSource / "results/calibration" / (scene + ".csv")));
    std::string header, row;
    std::getline(csv, header);
    std::getline(csv, row);
    std::istringstream names(header), values(row);
    std::map<std::string, double> found;
    std::string name, value;
    while (std::getline(names, name, ',') && std::getline(values, value, ',')) {
        const bool isFree = name.starts_with("scene.") || name.starts_with("view_");
        if (isFree) found[name] = std::stod(value);
    }
    return found;
}

class Calibration : public testing::TestWithParam<const char*> {};

TEST_P(Calibration, CatalogueAndPresetHoldWhatWasFitted) {
    const std::string scene = GetParam();
    const std::map<std::string, double> values = fitted(scene);
    ASSERT_GE(values.size(), 3U);
    const auto entry = kSource / "configs/scenes/outdoor" / (scene + ".yaml");
    const auto preset = kSource / "configs/presets/depth-sampling.yaml";
    const config::Node catalogue = config::parseYaml(readFile(entry), entry.string());
    const config::Node shared = config::parseYaml(readFile(preset), preset.string());
    const config::Node& params = *catalogue.find("sources")->items().at(0).find("params");
    const config::Node& views = *shared.find("params_by_scene")->find("outdoor/" + scene);
    for (const auto& [name, value] : values) {
        const bool isOfScene = name.starts_with("scene.");
        const config::Node* node = isOfScene ? params.find(name.substr(6)) : views.find(name);
        ASSERT_TRUE(node != nullptr) << name;
        EXPECT_EQ(std::stod(node->text()), value) << name;
    }
}

TEST_P(Calibration, NumbersAreThoseOfShippedTablesAndOfConventionalImages) {
    const auto config = kSource / "configs/calibration" / (std::string(GetParam()) + ".yaml");
    const config::Node scene = config::parseYaml(readFile(config), config.string());
    EXPECT_FALSE(scene.find("params")) << "the preset says which method";
    const auto preset = kSource / "configs/presets/depth-sampling-calibration.yaml";
    const config::Node shared = config::parseYaml(readFile(preset), preset.string());
    EXPECT_EQ(shared.find("params")->find("method")->text(), "conventional");
    // A table beside the calibration is found, too: a copy may mark other cells as fitted.
    for (const auto& [column, target] : scene.find("fit")->entries()) {
        const std::string table = target.find("table")->text();
        EXPECT_TRUE(table.starts_with("xie2017/table-")) << column;
        EXPECT_TRUE(std::filesystem::exists(kSource / "configs" / table)) << column;
        EXPECT_FALSE(std::filesystem::exists(config.parent_path() / table)) << column;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Calibration,
                         testing::Values("bird_nest", "grass", "city", "tree"));

}  // namespace
}  // namespace gfxrepro
