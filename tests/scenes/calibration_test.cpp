// What the shipped calibrations came to is what the catalogue and the preset say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>

#include "engine/core/files.h"
#include "engine/core/node.h"
#include "engine/core/text.h"
#include "runner/tables/calibration.h"

namespace gfxrepro {
namespace {

const std::filesystem::path kSource = GFXREPRO_SOURCE_DIR;

Node yaml(const std::filesystem::path& file) {
    return parseYaml(readFile(kSource / "configs" / file), file.string());
}

/// The values of results/calibration/NAME.csv: scene.NAME, view_NAME, light_NAME, resolution and
/// rms.
std::map<std::string, std::string> fitted(const std::string& calibration) {
    std::istringstream csv(readFile(kSource / "results/calibration" / (calibration + ".csv")));
    std::string header, row;
    std::getline(csv, header);
    std::getline(csv, row);
    std::istringstream names(header), values(row);
    std::map<std::string, std::string> found;
    std::string name, value;
    while (std::getline(names, name, ',') && std::getline(values, value, ',')) {
        const bool isFree =
            name.starts_with("scene.") || name.starts_with("view_") || name.starts_with("light_");
        if (isFree || name == "resolution" || name == "rms") found[name] = value;
    }
    return found;
}

/// The same number, or the same word.
void expectSame(const Node& node, const std::string& value, const std::string& name) {
    const auto number = parseDouble(value);
    if (number) {
        EXPECT_EQ(parseDouble(node.text()), number) << name;
    } else {
        EXPECT_EQ(node.text(), value) << name;
    }
}

/// The width of a scene's images in a table whose scenes have different ones.
Node resolutionIn(const std::string& table, const std::string& scene) {
    const Node document = yaml(table);
    const Node& zip = document.find("sweep")->find("zip")->items().at(0);
    const auto& scenes = zip.find("scene")->items();
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (scenes[i].text() == scene) return zip.find("output.width")->items()[i];
    }
    return {};
}

/// The numbers are of shipped tables, the cases of conventional images.
void expectConventional(const Node& calibration, const Node& preset) {
    EXPECT_FALSE(calibration.find("params")) << "the preset says which method";
    EXPECT_EQ(preset.find("params")->find("method")->text(), "conventional");
    // A table beside the calibration is found, too: a copy may mark other cells as fitted.
    for (const auto& [column, target] : calibration.find("fit")->entries()) {
        const std::string table = target.find("table")->text();
        EXPECT_TRUE(table.starts_with("xie2017/table-")) << column;
        EXPECT_TRUE(std::filesystem::exists(kSource / "configs" / table)) << column;
        EXPECT_FALSE(std::filesystem::exists(kSource / "configs/calibration" / table)) << column;
    }
}

class Calibration : public testing::TestWithParam<std::string> {};

TEST_P(Calibration, CatalogueAndPresetHoldWhatWasFitted) {
    const std::map<std::string, std::string> values = fitted(GetParam());
    ASSERT_GE(values.size(), 3U);
    const Node catalogue = yaml("scenes/outdoor/" + GetParam() + ".yaml");
    const Node preset = yaml("presets/depth-sampling.yaml");
    const Node& params = *catalogue.find("sources")->items().at(0).find("params");
    const Node& views = *preset.find("params_by_scene")->find("outdoor/" + GetParam());
    for (const auto& [name, value] : values) {
        if (name == "rms") continue;
        if (name == "resolution") {
            int count = 0;
            for (const char* table : {"table-2", "table-3", "table-4"}) {
                const Node width =
                    resolutionIn(fmt::format("xie2017/{}.yaml", table), "outdoor/" + GetParam());
                if (width.isNull()) continue;
                expectSame(width, value, table);
                ++count;
            }
            EXPECT_EQ(count, GetParam() == "bird_nest" ? 2 : 3) << "figure 9 has the nest";
            continue;
        }
        const bool isOfScene = name.starts_with("scene.");
        const Node* node = isOfScene ? params.find(name.substr(6)) : views.find(name);
        ASSERT_TRUE(node != nullptr) << name;
        expectSame(*node, value, name);
    }
}

TEST_P(Calibration, NumbersAreThoseOfShippedTablesAndOfConventionalImages) {
    expectConventional(yaml("calibration/" + GetParam() + ".yaml"),
                       yaml("presets/depth-sampling-calibration.yaml"));
}

class LightCalibration : public testing::TestWithParam<std::string> {};

TEST_P(LightCalibration, PresetHoldsTheLightThatWasFitted) {
    const Node preset = yaml("presets/soft-shadows.yaml");
    const Node& light = *preset.find("params_by_scene")->find("outdoor/" + GetParam());
    const std::map<std::string, std::string> values = fitted(GetParam() + "-light");
    ASSERT_EQ(values.size(), 4U);
    for (const auto& [name, value] : values) {
        if (name == "rms") continue;
        ASSERT_TRUE(light.find(name)) << name;
        expectSame(*light.find(name), value, name);
    }
}

TEST_P(LightCalibration, NumbersAreThoseOfShippedTablesAndOfConventionalImages) {
    expectConventional(yaml("calibration/" + GetParam() + "-light.yaml"),
                       yaml("presets/soft-shadows-calibration.yaml"));
}

/// Meadows of other triangle counts stand under the light of the one that was fitted.
TEST(LightCalibrationOfMeadows, IsThatOfFigure20) {
    const Node params = *yaml("xie2017/figure-20.yaml").find("params");
    for (const auto& [name, value] : fitted("grass-light")) {
        if (!name.starts_with("light_")) continue;
        ASSERT_TRUE(params.find(name)) << name;
        expectSame(*params.find(name), value, name);
    }
}

/// A best row at an edge of its grid says that a better one may lie beyond: the README tells why
/// not.
TEST(CalibrationGrids, RowsAtAnEdgeAreThoseThatTheReadmeExplains) {
    const std::string readme = readFile(kSource / "configs/calibration/README.md");
    const std::size_t begin = readme.find("Rows that lie at an edge of their grid");
    const std::string list = readme.substr(begin, readme.find("\n\n", begin) - begin);
    for (const auto& entry : std::filesystem::directory_iterator(kSource / "results/calibration")) {
        const std::string name = entry.path().stem();
        std::istringstream csv(readFile(entry.path()));
        std::string header, row;
        std::getline(csv, header);
        std::getline(csv, row);
        ASSERT_TRUE(header.ends_with(",edges")) << name;
        EXPECT_EQ(!row.ends_with(','), list.find('`' + name + '`') != list.npos) << name;
    }
}

/// Whether the preset names it as one that judges nothing.
bool isUnfit(const std::string& preset, const std::string& scene) {
    const Node file = yaml(preset);
    const Node* printed = file.find("printed");
    const Node* unfit = printed ? printed->find("unfit") : nullptr;
    return unfit && std::ranges::any_of(unfit->items(), [&](const Node& each) {
               return each.text() == "outdoor/" + scene;
           });
}

/// A scene judges nothing of the tables whose fit of it failed.
TEST_P(Calibration, ASceneThatCouldNotBeFittedJudgesNothing) {
    EXPECT_EQ(isUnfit("presets/depth-sampling.yaml", GetParam()),
              *parseDouble(fitted(GetParam()).at("rms")) > tables::kFitBound);
}
TEST_P(LightCalibration, ALightThatCouldNotBeFittedJudgesNothing) {
    EXPECT_EQ(isUnfit("presets/soft-shadows.yaml", GetParam()),
              *parseDouble(fitted(GetParam() + "-light").at("rms")) > tables::kFitBound);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Calibration,
                         testing::Values("bird_nest", "grass", "city", "tree"));
INSTANTIATE_TEST_SUITE_P(Scenes, LightCalibration,
                         testing::Values("bird_nest", "grass", "city", "tree"));

}  // namespace
}  // namespace gfxrepro
