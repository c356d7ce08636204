#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>
#include <utility>

#include "scenes/indoor/bathroom_parts.h"
#include "scenes/indoor/parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::bathroom_parts {

namespace {

/// The point of a finely divided outline at v.
glm::vec2 outlineAt(const indoor::Outline& outline, float v) {
    const auto last = static_cast<float>(outline.size() - 1);
    return outline[static_cast<std::size_t>(v * last + 0.5F)];
}

/// An oval body from its outline of (inset from the half axes, height).
void addOvalBody(MeshBuilder& builder, const glm::vec3& centre, const glm::vec2& halfAxes,
                 float squareness, const indoor::Outline& outline, int sides) {
    const auto at = [&](float u, float v) {
        const glm::vec2 point = outlineAt(outline, v);
        const glm::vec2 axes = glm::max(halfAxes - point.x, glm::vec2(0.0F));
        const glm::vec2 xz = ovalAt(u, axes, squareness);
        return centre + glm::vec3(xz.x, point.y, xz.y);
    };
    addLoft(builder, at, {sides, static_cast<int>(outline.size()) - 1, true, glm::vec2(1.0F)});
}

}  // namespace

namespace {

/// Pieces of an outline one after the other, each with its own fineness.
indoor::Outline joined(std::initializer_list<std::pair<std::span<const glm::vec2>, int>> parts) {
    indoor::Outline all;
    for (const auto& [points, pieces] : parts) {
        const indoor::Outline part = indoor::smoothed(points, pieces);
        all.insert(all.end(), part.begin() + (all.empty() ? 0 : 1), part.end());
    }
    return all;
}

}  // namespace

// The rim belongs to the outside; the inside begins where it has turned down.
void addTubOutside(MeshBuilder& builder) {
    constexpr glm::vec2 kWall[] = {{0.150F, 0.000F}, {0.148F, 0.012F}, {0.135F, 0.03F},
                                   {0.100F, 0.130F}, {0.062F, 0.300F}, {0.034F, 0.450F},
                                   {0.014F, 0.540F}};
    constexpr glm::vec2 kRim[] = {{0.014F, 0.540F}, {0.004F, 0.556F},   {0.000F, 0.570F},
                                  {0.006F, 0.584F}, {0.020F, kTubRimM}, {0.034F, 0.585F},
                                  {0.044F, 0.572F}, {0.052F, 0.548F}};
    addOvalBody(builder, kTubCentre, kTubHalf, 0.25F, joined({{kWall, 14}, {kRim, 20}}), 100);
}

void addTubInside(MeshBuilder& builder) {
    constexpr glm::vec2 kOutline[] = {{0.052F, 0.548F}, {0.062F, 0.500F},    {0.080F, 0.420F},
                                      {0.110F, 0.300F}, {0.150F, 0.205F},    {0.210F, 0.150F},
                                      {0.300F, 0.130F}, {kTubHalf.y, 0.124F}};
    addOvalBody(builder, kTubCentre, kTubHalf, 0.25F, indoor::smoothed(kOutline, 36), 100);
}

void addBasin(MeshBuilder& builder) {
    constexpr glm::vec2 kHalf(0.185F, 0.25F);
    constexpr glm::vec2 kOutline[] = {
        {0.085F, 0.000F}, {0.080F, 0.006F}, {0.050F, 0.040F}, {0.020F, 0.090F}, {0.003F, 0.132F},
        {0.000F, 0.142F}, {0.004F, 0.149F}, {0.010F, 0.149F}, {0.015F, 0.142F}, {0.024F, 0.118F},
        {0.048F, 0.070F}, {0.090F, 0.036F}, {0.140F, 0.026F}, {kHalf.x, 0.025F}};
    addOvalBody(builder, kBasinCentre, kHalf, 0.15F, indoor::smoothed(kOutline, 38), 48);
}

// A bow front of two lacquered drawers: half an oval in plan, with a shadow gap between them.
void addVanity(MeshBuilder& builder) {
    constexpr float kTop = kCounterM - 0.035F, kMiddle = 0.5F * (kVanityBottomM + kTop);
    constexpr glm::vec2 kOutline[] = {{kVanityDepthM, kVanityBottomM},
                                      {0.030F, kVanityBottomM},
                                      {0.012F, kVanityBottomM + 0.004F},
                                      {0.004F, kVanityBottomM + 0.014F},
                                      {0.000F, kVanityBottomM + 0.030F},
                                      {0.000F, kMiddle - 0.012F},
                                      {0.003F, kMiddle - 0.005F},
                                      {0.012F, kMiddle - 0.003F},
                                      {0.012F, kMiddle + 0.003F},
                                      {0.003F, kMiddle + 0.005F},
                                      {0.000F, kMiddle + 0.012F},
                                      {0.000F, kTop - 0.024F},
                                      {0.004F, kTop - 0.010F},
                                      {0.012F, kTop},
                                      {0.040F, kTop}};
    const auto at = [&](float u, float v) {
        const glm::vec2 point = kOutline[static_cast<std::size_t>(v * 14.0F + 0.5F)];
        const glm::vec2 axes =
            glm::max(glm::vec2(kVanityDepthM, kVanityHalfM) - point.x, glm::vec2(0.0F));
        // From −90° to 90° seen from above: from the wall at +z around the front to −z.
        const glm::vec2 xz = ovalAt(0.5F * u - 0.25F, axes, 0.55F);
        return glm::vec3(std::max(xz.x, 0.0F), point.y, kVanityZ + xz.y);
    };
    addLoft(builder, at, {56, 14, false, glm::vec2(1.0F)});
}

// Bowl on its foot, seat and lid, and the cistern behind them.
void addToilet(MeshBuilder& builder) {
    struct Section {
        float y, back, front, half;  // distances from the wall, half width
    };
    constexpr Section kSections[] = {
        {0.000F, 0.05F, 0.50F, 0.120F},   {0.012F, 0.045F, 0.51F, 0.125F},
        {0.100F, 0.05F, 0.51F, 0.122F},   {0.220F, 0.05F, 0.56F, 0.140F},
        {0.310F, 0.05F, 0.625F, 0.168F},  {0.360F, 0.05F, 0.645F, 0.178F},
        {0.388F, 0.05F, 0.650F, 0.180F},  {0.396F, 0.055F, 0.645F, 0.176F},
        {0.400F, 0.06F, 0.638F, 0.170F},  {0.404F, 0.06F, 0.645F, 0.176F},
        {0.412F, 0.055F, 0.660F, 0.186F}, {0.432F, 0.055F, 0.660F, 0.186F},
        {0.440F, 0.06F, 0.652F, 0.180F},  {0.446F, 0.10F, 0.600F, 0.140F},
        {0.450F, 0.36F, 0.36F, 0.0F}};
    constexpr int kLast = static_cast<int>(std::size(kSections)) - 1;
    constexpr int kSteps = 3;
    const auto at = [&](float u, float v) {
        const float place = v * static_cast<float>(kLast);
        const int i = std::min(static_cast<int>(place), kLast - 1);
        const float t = place - static_cast<float>(i);
        const Section &a = kSections[i], &b = kSections[i + 1];
        const float back = glm::mix(a.back, b.back, t), front = glm::mix(a.front, b.front, t);
        glm::vec2 xz = ovalAt(u, {0.5F * (front - back), glm::mix(a.half, b.half, t)}, 0.45F);
        // Narrower towards the front, as bowls are.
        if (front > back) xz.y *= 1.0F - 0.14F * (xz.x / (0.5F * (front - back)));
        return glm::vec3(kRoom.x - (0.5F * (front + back) + xz.x), glm::mix(a.y, b.y, t),
                         kToiletZ - xz.y);
    };
    addLoft(builder, at, {52, kLast * kSteps, true, glm::vec2(1.0F)});

    constexpr float kDepth = 0.17F, kHalf = 0.19F, kLow = 0.40F, kHigh = 0.80F;
    // Its lid stands out a little.
    constexpr glm::vec2 kCistern[] = {{0.085F, kLow},           {0.014F, kLow},
                                      {0.006F, kLow + 0.012F},  {0.004F, kLow + 0.04F},
                                      {0.004F, kHigh - 0.060F}, {0.003F, kHigh - 0.045F},
                                      {0.000F, kHigh - 0.035F}, {0.000F, kHigh - 0.014F},
                                      {0.006F, kHigh},          {0.085F, kHigh + 0.004F}};
    const indoor::Outline outline = indoor::smoothed(kCistern, 24);
    const glm::vec3 centre(kRoom.x - 0.5F * kDepth - 0.005F, 0.0F, kToiletZ);
    addOvalBody(builder, centre, {0.5F * kDepth, kHalf}, 0.85F, outline, 40);
}

void addShowerWall(MeshBuilder& builder) {
    constexpr float kArcRad = 1.26F;  // the rest of the quarter is the way in
    constexpr float kInnerM = kShowerRadiusM - kShowerWallM, kHalfM = 0.5F * kShowerWallM;
    constexpr float kTileM = 0.4F;
    constexpr glm::vec2 kCorner(kRoom.x, 0.0F);
    const auto onArc = [&](float angleRad, float radius) {
        return kCorner + radius * glm::vec2(-sdf::cosine(angleRad), sdf::sine(angleRad));
    };
    constexpr float kOutside = kArcRad * kShowerRadiusM, kInside = kArcRad * kInnerM;
    constexpr float kEnd = std::numbers::pi_v<float> * kHalfM;
    constexpr float kLength = kOutside + kEnd + kInside;
    // In plan: along the outside, around the free end, back along the inside.
    const auto plan = [&](float u) {
        const float way = u * kLength;
        if (way <= kOutside) return onArc(way / kShowerRadiusM, kShowerRadiusM);
        if (way >= kOutside + kEnd) return onArc((kLength - way) / kInnerM, kInnerM);
        const float turnRad = (way - kOutside) / kHalfM;
        const glm::vec2 out(-sdf::cosine(kArcRad), sdf::sine(kArcRad));
        const glm::vec2 along(sdf::sine(kArcRad), sdf::cosine(kArcRad));
        return onArc(kArcRad, kInnerM + kHalfM) +
               kHalfM * (out * sdf::cosine(turnRad) + along * sdf::sine(turnRad));
    };
    const auto wall = [&](float u, float v) {
        const glm::vec2 xz = plan(u);
        return glm::vec3(xz.x, v * kShowerHeightM, xz.y);
    };
    addLoft(builder, wall, {72, 12, false, {kLength / kTileM, kShowerHeightM / kTileM}});
    // The top, from the outside to the inside; its end is the half circle of the free end.
    const auto top = [&](float u, float v) {
        const float reach = kOutside + 0.5F * kEnd;
        const glm::vec2 outer = plan(u * reach / kLength);
        const glm::vec2 inner = plan((kLength - u * (kInside + 0.5F * kEnd)) / kLength);
        const glm::vec2 xz = glm::mix(outer, inner, v);
        return glm::vec3(xz.x, kShowerHeightM, xz.y);
    };
    addLoft(builder, top, {36, 1, false, {kOutside / kTileM, kShowerWallM / kTileM}});
}

}  // namespace gfxrepro::scene::bathroom_parts
