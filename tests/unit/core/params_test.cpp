#include "engine/core/params.h"

#include <array>

#include <nlohmann/json.hpp>

#include "tests/support/support.h"

namespace gfxrepro::config {
namespace {

enum class Voxel { Bit, Byte };
constexpr Choice<Voxel> kVoxels[] = {{Voxel::Bit, "bit", "one bit"}, {Voxel::Byte, "byte"}};
constexpr ParamSpec kResolution{"voxels along each axis", "voxels", 8, 1024};

Params paramsOf(std::string_view text) {
    return Params(parseYaml(text, "a.yaml"), "technique 'voxelization'");
}

TEST(Params, ValuesAndDefaults) {
    Params params = paramsOf(
        "{resolution: 64, scale: 2, lit: false, name: 12, up: [0, 1.5, 0], voxel: bit, eye: }");
    EXPECT_EQ(params.getInt("resolution", 256, kResolution), 64);
    EXPECT_EQ(params.getInt("count", 3, {"count"}), 3);
    EXPECT_EQ(params.getDouble("scale", 0.5, {"scale"}), 2.0);
    EXPECT_FALSE(params.getBool("lit", true, {"lit"}));
    EXPECT_EQ(params.getText("name", "x", {"name"}), "12");
    EXPECT_THAT(params.getVector("up", std::array{0.0, 0.0, 1.0}, {"up"}),
                ElementsAre(0.0, 1.5, 0.0));
    EXPECT_EQ(params.getOptionalVector("eye", 3, {"eye"}), std::nullopt);
    EXPECT_EQ(params.getOptionalVector("target", 3, {"target"}), std::nullopt);
    EXPECT_EQ(params.getEnum("voxel", Voxel::Byte, kVoxels, {"voxel"}), Voxel::Bit);
    params.finish();
    EXPECT_EQ(params.resolved().toJson().dump(),
              R"({"resolution":64,"count":3,"scale":2,"lit":false,"name":"12","up":[0,1.5,0],)"
              R"("eye":null,"target":null,"voxel":"bit"})");
    EXPECT_TRUE(params.isGiven("lit"));
    EXPECT_FALSE(params.isGiven("count"));
    EXPECT_FALSE(params.isGiven("eye"));
    EXPECT_EQ(params.locationOf("scale"), (SourceLocation{"a.yaml", 1, 25}));
    EXPECT_EQ(params.locationOf("count"), (SourceLocation{"a.yaml", 1, 1}));
}

TEST(Params, ResolvedValuesReadBackTheSame) {
    const auto declare = [](Params& params) {
        params.getInt("resolution", 256, kResolution);
        params.getText("name", "7", {"name"});
        params.getOptionalVector("eye", 3, {"eye"});
        params.getEnum("voxel", Voxel::Byte, kVoxels, {"voxel"});
        params.finish();
    };
    Params first = paramsOf("");
    declare(first);
    Params again(parseYaml(first.resolved().toJson().dump(), "plan.json"), "t");
    declare(again);
    EXPECT_EQ(again.resolved().toJson().dump(), first.resolved().toJson().dump());
}

TEST(Params, DeclarationsAreListed) {
    Params params = paramsOf("");
    params.getInt("resolution", 256, kResolution);
    params.getDouble("bias", 0, {"bias", "texels", 0});
    params.getVector("up", std::array{0.0, 0.5}, {"up", "", -1, 1});
    params.getOptionalVector("eye", 3, {"eye"});
    params.getEnum("voxel", Voxel::Byte, kVoxels, {"storage"});
    params.getText("tag", "", {"tag"});
    params.getBool("lit", true, {"lit"});
    const auto row = [&](std::size_t i) {
        const KeyInfo& p = params.declared()[i];
        return p.name + "; " + p.type + "; " + p.absent + "; " + p.unit + "; " + p.allowed() +
               "; " + p.doc;
    };
    EXPECT_EQ(row(0), "resolution; integer; 256; voxels; 8 … 1024; voxels along each axis");
    EXPECT_EQ(row(1), "bias; number; 0; texels; at least 0; bias");
    EXPECT_EQ(row(2), "up; vector2; [0, 0.5]; ; -1 … 1; up");
    EXPECT_EQ(row(3), "eye; vector3; null; ; ; eye");
    EXPECT_EQ(row(4), "voxel; choice; byte; ; bit | byte; storage (bit: one bit)");
    EXPECT_EQ(row(5), "tag; text; \"\"; ; ; tag");
    EXPECT_EQ(row(6), "lit; boolean; true; ; true | false; lit");
}

TEST(Params, BadNumbers) {
    const auto asInt = [](const char* value, const ParamSpec& spec) {
        Params params = paramsOf(std::string("\n  resolution: ") + value);
        return errorText([&] { params.getInt("resolution", 256, spec); });
    };
    const std::string head = "a.yaml:2:15: technique 'voxelization': resolution is ";
    EXPECT_EQ(asInt("2000", kResolution), head + "2000; allowed: 8 … 1024 voxels");
    EXPECT_EQ(asInt("256.0", kResolution),
              head + "256.0; allowed: a whole number, 8 … 1024 voxels");
    EXPECT_EQ(asInt("'256'", kResolution),
              head + "\"256\"; allowed: a whole number, 8 … 1024 voxels");
    EXPECT_EQ(asInt("0100", {"x"}), head + "0100; allowed: a whole number");
    EXPECT_EQ(asInt("[1]", {"x"}), head + "[1]; allowed: a whole number");
    EXPECT_EQ(asInt("true", {"x"}), head + "true; allowed: a whole number");
    EXPECT_EQ(asInt("~", {"x"}), head + "empty; allowed: a whole number");
    EXPECT_EQ(asInt("3000000000", {"x"}), head + "3000000000; allowed: -2147483648 … 2147483647");
    EXPECT_EQ(asInt("0", {"x", "", 1}), head + "0; allowed: at least 1");

    Params params = paramsOf("{bias: -1, gain: high, top: 9}");
    EXPECT_EQ(errorText([&] {
                  params.getDouble("bias", 0, {"b", "texels", 0});
              }),
              "a.yaml:1:8: technique 'voxelization': bias is -1; allowed: at least 0 texels");
    EXPECT_EQ(errorText([&] { params.getDouble("gain", 0, {"g"}); }),
              "a.yaml:1:18: technique 'voxelization': gain is high; allowed: a number");
    EXPECT_EQ(
        errorText([&] {
            params.getDouble("top", 0, {"t", "", -std::numeric_limits<double>::infinity(), 4});
        }),
        "a.yaml:1:29: technique 'voxelization': top is 9; allowed: at most 4");
}

TEST(Params, BadTextsListsAndChoices) {
    Params params =
        paramsOf("{voxel: bite, other: [1], lit: yes, up: [1, 2], eye: [1, 2, 30], name: [a]}");
    EXPECT_EQ(errorText([&] { params.getEnum("voxel", Voxel::Bit, kVoxels, {"v"}); }),
              "a.yaml:1:9: technique 'voxelization': voxel is bite; allowed: bit | byte");
    EXPECT_EQ(errorText([&] { params.getEnum("other", Voxel::Bit, kVoxels, {"v"}); }),
              "a.yaml:1:22: technique 'voxelization': other is [1]; allowed: bit | byte");
    EXPECT_EQ(errorText([&] { params.getBool("lit", true, {"l"}); }),
              "a.yaml:1:32: technique 'voxelization': lit is yes; allowed: true | false");
    EXPECT_EQ(errorText([&] {
                  params.getVector("up", std::array{0.0, 0.0, 1.0}, {"u"});
              }),
              "a.yaml:1:41: technique 'voxelization': up is [1, 2]; allowed: a list of 3 numbers");
    EXPECT_EQ(errorText([&] {
                  params.getOptionalVector("eye", 3, {"e", "m", 0, 9});
              }),
              "a.yaml:1:54: technique 'voxelization': eye is [1, 2, 30]; allowed: a list of 3 "
              "numbers, each 0 … 9 m");
    EXPECT_EQ(errorText([&] { params.getText("name", "", {"n"}); }),
              "a.yaml:1:72: technique 'voxelization': name is [a]; allowed: text");
    Params zero = paramsOf(R"({name: "a\0b"})");
    EXPECT_EQ(
        errorText([&] { zero.getText("name", "", {"n"}); }),
        "a.yaml:1:8: technique 'voxelization': name has a byte of 0; allowed: text without one");
    EXPECT_EQ(errorText([] { paramsOf("[1]"); }),
              "a.yaml:1:1: technique 'voxelization': parameters are a list; allowed: a map");
}

TEST(Params, UnknownNamesAreErrors) {
    const auto finish = [](const char* text) {
        return errorText([&] {
            Params params = paramsOf(text);
            params.getInt("resolution", 256, kResolution);
            params.getInt("steps", 1, {"s"});
            params.finish();
        });
    };
    EXPECT_EQ(finish("steps: 2\nresolutoin: 64"),
              "a.yaml:2:1: technique 'voxelization': unknown parameter 'resolutoin'; did you mean "
              "'resolution'?");
    EXPECT_EQ(finish("banana: 1"),
              "a.yaml:1:1: technique 'voxelization': unknown parameter 'banana'; allowed: "
              "resolution, steps");
    EXPECT_EQ(errorText([] { paramsOf("x: 1").finish(); }),
              "a.yaml:1:1: technique 'voxelization': unknown parameter 'x'; it has none");
}

TEST(ParamsDeathTest, MistakesOfTheProgrammerStop) {
    Params params = paramsOf("");
    params.getInt("a", 1, {"a"});
    EXPECT_DEATH(params.getInt("a", 1, {"a"}), "known.name != name");
    EXPECT_DEATH(params.getInt("b", 1, {"b", "", 2, 3}), "isInRange");
}

}  // namespace
}  // namespace gfxrepro::config
