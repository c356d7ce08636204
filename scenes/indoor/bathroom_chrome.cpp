#include <array>

#include "scenes/indoor/bathroom_parts.h"
#include "scenes/indoor/parts.h"

namespace gfxrepro::scene::bathroom_parts {

namespace {

using Station = MeshBuilder::Station;

/// Turned about the vertical through `foot`; heights count from it.
void addTurned(MeshBuilder& builder, std::span<const glm::vec2> outline, int pieces, int sides,
               const glm::vec3& foot) {
    indoor::addLathe(builder, indoor::smoothed(outline, pieces), sides, indoor::placed(foot));
}

void addRod(MeshBuilder& builder, const glm::vec3& from, const glm::vec3& to, float radius,
            int sides) {
    const std::array stations{Station{from, radius}, Station{to, radius}};
    builder.addTube(stations, sides, true);
}

}  // namespace

// A tall mixer behind the bowl, its spout reaching over it.
void addBasinTap(MeshBuilder& builder) {
    const glm::vec3 foot(0.058F, kCounterM, kVanityZ);
    constexpr glm::vec2 kBody[] = {{0.000F, 0.000F},  {0.029F, 0.000F}, {0.029F, 0.000F},
                                   {0.029F, 0.010F},  {0.029F, 0.010F}, {0.0215F, 0.012F},
                                   {0.0215F, 0.012F}, {0.0215F, 0.22F}, {0.024F, 0.235F},
                                   {0.024F, 0.262F},  {0.020F, 0.272F}, {0.000F, 0.274F}};
    addTurned(builder, kBody, 30, 28, foot);
    const std::array spout{Station{foot + glm::vec3(0.005F, 0.205F, 0.0F), 0.0145F},
                           Station{foot + glm::vec3(0.05F, 0.232F, 0.0F), 0.0145F},
                           Station{foot + glm::vec3(0.12F, 0.242F, 0.0F), 0.014F},
                           Station{foot + glm::vec3(0.155F, 0.232F, 0.0F), 0.013F},
                           Station{foot + glm::vec3(0.165F, 0.205F, 0.0F), 0.013F}};
    indoor::addBentTube(builder, spout, 26, 20);
    const std::array lever{Station{foot + glm::vec3(0.0F, 0.270F, 0.0F), 0.008F},
                           Station{foot + glm::vec3(0.03F, 0.288F, 0.0F), 0.0065F},
                           Station{foot + glm::vec3(0.085F, 0.312F, 0.0F), 0.0075F}};
    indoor::addBentTube(builder, lever, 12, 14);
}

// A pillar between wall and tub with its spout over the rim, two handles and a hand shower.
void addTubTap(MeshBuilder& builder) {
    const glm::vec3 foot(kTubCentre.x - 0.15F, 0.0F, 0.17F);
    constexpr glm::vec2 kFlange[] = {{0.000F, 0.000F}, {0.045F, 0.000F}, {0.045F, 0.000F},
                                     {0.044F, 0.010F}, {0.030F, 0.018F}, {0.022F, 0.024F}};
    addTurned(builder, kFlange, 10, 28, foot);
    const std::array pillar{Station{foot + glm::vec3(0.0F, 0.01F, 0.0F), 0.020F},
                            Station{foot + glm::vec3(0.0F, 0.55F, 0.0F), 0.020F},
                            Station{foot + glm::vec3(0.0F, 0.86F, 0.0F), 0.020F},
                            Station{foot + glm::vec3(0.0F, 0.95F, 0.035F), 0.019F},
                            Station{foot + glm::vec3(0.0F, 0.985F, 0.12F), 0.018F},
                            Station{foot + glm::vec3(0.0F, 0.96F, 0.22F), 0.018F},
                            Station{foot + glm::vec3(0.0F, 0.89F, 0.26F), 0.017F},
                            Station{foot + glm::vec3(0.0F, 0.85F, 0.262F), 0.017F}};
    indoor::addBentTube(builder, pillar, 44, 18);
    addRod(builder, foot + glm::vec3(-0.11F, 0.74F, 0.0F), foot + glm::vec3(0.11F, 0.74F, 0.0F),
           0.017F, 20);
    for (const float side : {-1.0F, 1.0F}) {
        constexpr glm::vec2 kKnob[] = {{0.000F, 0.000F}, {0.026F, 0.002F}, {0.030F, 0.010F},
                                       {0.030F, 0.034F}, {0.026F, 0.042F}, {0.000F, 0.044F}};
        const glm::mat4 outwards = indoor::placedAlong(foot + glm::vec3(side * 0.105F, 0.74F, 0.0F),
                                                       glm::vec3(side, 0.0F, 0.0F));
        indoor::addLathe(builder, indoor::smoothed(kKnob, 14), 26, outwards);
    }
    // The hand shower stands in its cradle on the pillar, its hose hangs in a loop.
    const std::array grip{Station{foot + glm::vec3(0.055F, 0.70F, 0.028F), 0.010F},
                          Station{foot + glm::vec3(0.055F, 0.80F, 0.030F), 0.011F},
                          Station{foot + glm::vec3(0.055F, 0.885F, 0.034F), 0.011F},
                          Station{foot + glm::vec3(0.055F, 0.92F, 0.050F), 0.018F},
                          Station{foot + glm::vec3(0.055F, 0.925F, 0.075F), 0.026F}};
    indoor::addBentTube(builder, grip, 18, 16);
    const std::array hose{Station{foot + glm::vec3(0.055F, 0.70F, 0.028F), 0.006F},
                          Station{foot + glm::vec3(0.058F, 0.50F, 0.025F), 0.006F},
                          Station{foot + glm::vec3(0.085F, 0.36F, 0.010F), 0.006F},
                          Station{foot + glm::vec3(0.120F, 0.42F, 0.000F), 0.006F},
                          Station{foot + glm::vec3(0.085F, 0.62F, 0.000F), 0.006F},
                          Station{foot + glm::vec3(0.045F, 0.735F, 0.000F), 0.006F}};
    indoor::addBentTube(builder, hose, 34, 7);
    const std::array cradle{Station{foot + glm::vec3(0.0F, 0.80F, 0.0F), 0.007F},
                            Station{foot + glm::vec3(0.055F, 0.80F, 0.018F), 0.007F}};
    builder.addTube(cradle, 10, true);
}

// A ladder on the wall x = 0: rungs in groups, gaps between them for towels.
void addTowelRail(MeshBuilder& builder) {
    constexpr float kX = 0.085F, kLow = 0.35F, kHigh = 1.55F, kHalf = 0.23F;
    for (const float side : {-1.0F, 1.0F}) {
        const float z = kTowelRailZ + side * kHalf;
        const std::array post{
            Station{{kX, kLow, z}, 0.004F}, Station{{kX, kLow + 0.01F, z}, 0.018F},
            Station{{kX, 0.9F, z}, 0.018F}, Station{{kX, kHigh - 0.01F, z}, 0.018F},
            Station{{kX, kHigh, z}, 0.004F}};
        builder.addTube(post, 18, true);
        for (const float y : {kLow + 0.12F, kHigh - 0.12F}) {
            addRod(builder, {0.0F, y, z}, {kX, y, z}, 0.011F, 14);
        }
    }
    constexpr float kRungs[] = {0.42F, 0.48F, 0.54F, 0.60F, 0.74F, 0.80F, 0.86F,
                                0.92F, 1.06F, 1.12F, 1.18F, 1.36F, 1.42F, 1.48F};
    for (const float y : kRungs) {
        addRod(builder, {kX + 0.012F, y, kTowelRailZ - kHalf},
               {kX + 0.012F, y, kTowelRailZ + kHalf}, 0.0105F, 16);
    }
}

// A dish on a stand; concave, so that it magnifies.
void addShavingMirror(MeshBuilder& builder) {
    constexpr glm::vec2 kFoot[] = {
        {0.000F, 0.000F}, {0.062F, 0.000F}, {0.062F, 0.000F}, {0.062F, 0.006F}, {0.052F, 0.012F},
        {0.012F, 0.020F}, {0.0055F, 0.04F}, {0.0055F, 0.16F}, {0.008F, 0.17F},  {0.000F, 0.174F}};
    addTurned(builder, kFoot, 20, 20, kShavingMirror);
    constexpr glm::vec2 kDish[] = {{0.000F, -0.016F}, {0.040F, -0.014F}, {0.085F, -0.004F},
                                   {0.106F, 0.006F},  {0.112F, 0.014F},  {0.110F, 0.020F},
                                   {0.104F, 0.020F},  {0.100F, 0.014F},  {0.080F, 0.0058F},
                                   {0.050F, -0.002F}, {0.025F, -0.005F}, {0.000F, -0.006F}};
    const glm::mat4 facing = indoor::placedAlong(kShavingMirror + glm::vec3(0.014F, 0.285F, -0.01F),
                                                 glm::vec3(1.0F, 0.12F, -0.75F));
    indoor::addLathe(builder, indoor::smoothed(kDish, 26), 36, facing);
    const std::array neck{Station{kShavingMirror + glm::vec3(0.0F, 0.165F, 0.0F), 0.0055F},
                          Station{kShavingMirror + glm::vec3(-0.004F, 0.225F, 0.003F), 0.0055F},
                          Station{kShavingMirror + glm::vec3(0.004F, 0.283F, -0.003F), 0.008F}};
    indoor::addBentTube(builder, neck, 10, 12);
}

void addDispenser(MeshBuilder& builder) {
    constexpr glm::vec2 kBottle[] = {
        {0.000F, 0.000F}, {0.032F, 0.000F}, {0.036F, 0.004F}, {0.037F, 0.012F}, {0.037F, 0.100F},
        {0.034F, 0.118F}, {0.020F, 0.128F}, {0.015F, 0.131F}, {0.015F, 0.150F}, {0.006F, 0.153F},
        {0.006F, 0.172F}, {0.011F, 0.175F}, {0.011F, 0.188F}, {0.000F, 0.190F}};
    addTurned(builder, kBottle, 32, 24, kDispenser);
    const std::array nozzle{Station{kDispenser + glm::vec3(0.0F, 0.182F, 0.0F), 0.0065F},
                            Station{kDispenser + glm::vec3(0.04F, 0.184F, 0.0F), 0.006F},
                            Station{kDispenser + glm::vec3(0.058F, 0.172F, 0.0F), 0.005F}};
    indoor::addBentTube(builder, nozzle, 12, 14);
}

// A bell, its inside as well, on a rod that reaches into the ceiling's rose.
void addPendant(MeshBuilder& builder) {
    constexpr glm::vec2 kBell[] = {
        {0.000F, 0.170F}, {0.030F, 0.168F}, {0.070F, 0.155F}, {0.125F, 0.110F}, {0.160F, 0.040F},
        {0.168F, 0.004F}, {0.168F, 0.004F}, {0.172F, 0.000F}, {0.172F, 0.000F}, {0.166F, 0.042F},
        {0.131F, 0.114F}, {0.075F, 0.161F}, {0.034F, 0.178F}, {0.022F, 0.190F}, {0.020F, 0.225F},
        {0.014F, 0.240F}, {0.004F, 0.246F}};
    // From the inside of the top outwards, down, and up again on the outside: outside on the right.
    indoor::addLathe(builder, indoor::smoothed(kBell, 34), 44, indoor::placed(kPendant));
    addRod(builder, kPendant + glm::vec3(0.0F, 0.24F, 0.0F),
           {kPendant.x, kRoom.y - 0.004F, kPendant.z}, 0.005F, 10);
}

}  // namespace gfxrepro::scene::bathroom_parts
