#include "runner/run/manifest.h"

#include <set>
#include <sstream>
#include <string>

#include "engine/core/json_shape.h"
#include "runner/run/run_directory.h"
#include "tests/support/support.h"

namespace gfxrepro::run {
namespace {

std::string nameIn(const std::string& cpuinfo) {
    std::istringstream stream(cpuinfo);
    return cpuName(stream);
}

TEST(CpuName, IsTheModelOrThePartOfAnArm) {
    EXPECT_EQ(nameIn("processor\t: 0\nmodel\t\t: 1\nmodel name\t: AMD EPYC Processor\n"),
              "AMD EPYC Processor");
    EXPECT_EQ(
        nameIn("processor\t: 0\nBogoMIPS\t: 50.00\nCPU implementer\t: 0x41\n"
               "CPU architecture: 8\nCPU variant\t: 0x3\nCPU part\t: 0xd0c\n\nprocessor : 1\n"),
        "ARM 0x41 0xd0c");
    EXPECT_EQ(nameIn("processor\t: 0\nuarch : x\n"), "unknown");
    EXPECT_EQ(nameIn(""), "unknown");
}

TEST(Manifest, HoldsEachWarningOnce) {
    Json manifest = Json::object();
    addWarnings(manifest, {});
    EXPECT_FALSE(manifest.contains("warnings"));
    addWarnings(manifest, {"gr\xFCn\x1b[2J", "b"});
    addWarnings(manifest, {"b", "c"});
    EXPECT_EQ(manifest.at("warnings"), (Json{"b", "gr\u00FCn?[2J", "c"}));
    std::set<std::string> many;
    for (int i = 0; i < 200; ++i) many.insert("n" + std::to_string(i));
    addWarnings(manifest, many);
    addWarnings(manifest, many);
    EXPECT_EQ(manifest.at("warnings").size(), 101U);
    EXPECT_EQ(manifest.at("warnings").back(), "further ones are not listed");
}

TEST(Manifest, HoldsWhatLoadersWarnedOf) {
    Json manifest = Json::object();
    const SceneUse use{"/a.obj", "real", "a.obj", "0", {"left out: a", "left out: b"}};
    addScenes(manifest, {{use.reference, use}});
    addScenes(manifest, {{use.reference, use}});  // of a run that went on
    EXPECT_EQ(manifest.at("warnings"),
              (Json{"scene '/a.obj': left out: a", "scene '/a.obj': left out: b"}));
    EXPECT_EQ(manifest.at("scenes").at("/a.obj").at("kind"), "real");
}

TEST(Manifest, OfAnEarlierVersionMayHaveMore) {
    const TemporaryFolder folder;
    const auto file = folder.write("manifest.json", R"({
        "commit": "c", "profile": "quick", "device_class": "gpu", "cpu": "CPU", "cores": 2,
        "gl": {"vendor": "v", "renderer": "r", "version": "4.5", "balance": {"x": 1}},
        "invocations": [{"command": "gfxrepro run a.yaml"}], "scenes": {}})");
    EXPECT_EQ(readManifest(file)["gl"]["balance"]["x"], 1);
}

}  // namespace
}  // namespace gfxrepro::run
