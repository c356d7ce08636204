#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/indoor/bathroom_parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::bathroom_parts {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr glm::vec3 kTerracotta(0.62F, 0.25F, 0.15F);
constexpr glm::vec3 kCream(0.80F, 0.74F, 0.64F);
constexpr glm::vec3 kSage(0.33F, 0.44F, 0.36F);

/// A towel over a rung along z: down in front by `frontM`, behind by `backM`.
struct Hanging {
    glm::vec3 rung;                      // middle of the rung's axis
    float widthM, frontM, backM, overM;  // overM: radius of the bend
};

void addHanging(MeshBuilder& builder, const Hanging& towel, int cellsAcross, int cellsDown) {
    const float bend = kPi * towel.overM;
    const float length = towel.frontM + bend + towel.backM;
    const auto at = [&](float u, float v) {
        // v from the front's hem up, over the rung, and down behind.
        const float z = (0.5F - u) * towel.widthM;
        const float way = v * length;
        float x = towel.overM, y = 0.0F, hung = 0.0F;
        if (way < towel.frontM) {
            hung = (towel.frontM - way) / towel.frontM;
            y = way - towel.frontM;
        } else if (way > towel.frontM + bend) {
            x = -towel.overM;
            y = towel.frontM + bend - way;
        } else {
            const float angleRad = (way - towel.frontM) / towel.overM;
            x = towel.overM * sdf::cosine(angleRad);
            y = towel.overM * sdf::sine(angleRad);
        }
        // Slack folds that grow towards the hem, in front only: behind is the wall.
        const float fold = 0.011F * hung * sdf::sine(17.0F * z + 1.0F) +
                           0.006F * hung * sdf::sine(31.0F * z + 2.0F * hung);
        return towel.rung + glm::vec3(x + fold + 0.006F * hung, y, z);
    };
    addCloth(builder, at, 0.013F, cellsAcross, cellsDown);
}

/// A towel folded into three layers, lying; the folds show at +z and −z.
void addFolded(MeshBuilder& builder, const glm::vec3& base, const glm::vec2& halfSize, float layerM,
               float turnRad, int cells) {
    const float straight = 2.0F * halfSize.y, bend = kPi * 0.5F * layerM;
    const float length = 3.0F * straight + 2.0F * bend;
    const float c = sdf::cosine(turnRad), s = sdf::sine(turnRad);
    const auto at = [&](float u, float v) {
        const float way = v * length;
        const int leg = std::min(static_cast<int>(way / (straight + bend)), 2);
        const float along = way - static_cast<float>(leg) * (straight + bend);
        const float sign = leg % 2 == 0 ? 1.0F : -1.0F;
        float y = (static_cast<float>(leg) + 0.5F) * layerM;
        float z = sign * (std::min(along, straight) - halfSize.y);
        if (along > straight) {
            const float angleRad = (along - straight) / (0.5F * layerM);
            y += 0.5F * layerM * (1.0F - sdf::cosine(angleRad));
            z += sign * 0.5F * layerM * sdf::sine(angleRad);
        }
        const float x = (2.0F * u - 1.0F) * halfSize.x;
        return base + glm::vec3(c * x + s * z, y, c * z - s * x);
    };
    addCloth(builder, at, 0.86F * layerM, 4, cells);
}

/// A towel rolled up, lying along x.
void addRoll(MeshBuilder& builder, const glm::vec3& centre, float halfM, float radius) {
    constexpr float kTurns = 3.25F, kCore = 0.2F;
    const float pitch = radius * (1.0F - kCore) / kTurns;
    const auto at = [&](float u, float v) {
        const float angleRad = 2.0F * kPi * kTurns * v - 0.5F * kPi;
        const float r = radius * kCore + pitch * kTurns * v - 0.5F * pitch;
        return centre + glm::vec3((1.0F - 2.0F * u) * halfM, r * sdf::sine(angleRad),
                                  r * sdf::cosine(angleRad));
    };
    addCloth(builder, at, 0.93F * pitch, 2, 38);
}

}  // namespace

void addTowels(MeshBuilder& builder) {
    constexpr float kRailX = 0.097F;
    builder.setColor(kTerracotta);
    addHanging(builder, {{kRailX, 1.18F, kTowelRailZ}, 0.38F, 0.52F, 0.40F, 0.022F}, 20, 24);
    builder.setColor(kCream);
    addHanging(builder, {{kRailX, 1.48F, kTowelRailZ + 0.03F}, 0.28F, 0.21F, 0.15F, 0.022F}, 14,
               12);
    const glm::vec3 stool = kStool + glm::vec3(0.0F, kStoolM, 0.0F);
    builder.setColor(kSage);
    addFolded(builder, stool, {0.105F, 0.075F}, 0.020F, 0.25F, 36);
    builder.setColor(kCream);
    addFolded(builder, stool + glm::vec3(0.0F, 0.0605F, 0.0F), {0.098F, 0.07F}, 0.018F, 0.42F, 36);
    // Laundry in the basket: a crumpled cloth over a heap, its rim tucked in.
    builder.setColor(kCream * 0.95F);
    const auto heap = [](float u, float v) {
        const glm::vec2 xz = ovalAt(u, glm::vec2(0.178F * v), 0.0F);
        const float crumple =
            0.018F * sdf::sine(31.0F * xz.x + 9.0F * xz.y) * sdf::cosine(27.0F * xz.y) +
            0.010F * sdf::sine(60.0F * xz.y - 20.0F * xz.x);
        const float height = 0.475F - 1.6F * (xz.x * xz.x + xz.y * xz.y) + crumple * (1.0F - v * v);
        return kBasket + glm::vec3(xz.x, height, xz.y);
    };
    // From the rim inwards, so that its outside is up.
    addLoft(builder, [&](float u, float v) { return heap(u, 1.0F - v); }, {30, 12, true, {1, 1}});
}

void addRolledTowels(MeshBuilder& builder) {
    constexpr glm::vec3 kColors[] = {kCream, kSage, kTerracotta};
    constexpr float kRadius = 0.062F, kX = kRoom.x - 0.135F;
    const auto add = [&](int color, float z, float y) {
        builder.setColor(kColors[color]);
        addRoll(builder, {kX, y, z}, 0.105F, kRadius);
    };
    const float upper = kShelvesM[1] + kRadius, lower = kShelvesM[0] + kRadius;
    for (int i = 0; i < 4; ++i) add(i % 2, 2.46F + 0.132F * static_cast<float>(i), upper);
    for (int i = 0; i < 3; ++i) {
        add(i % 2 == 0 ? 2 : 0, 2.526F + 0.132F * static_cast<float>(i), upper + 0.114F);
    }
    for (int i = 0; i < 3; ++i) add(i == 1 ? 1 : 2, 2.92F + 0.132F * static_cast<float>(i), lower);
}

// A woven base with tufts: bent three-sided blades.
void addBathMat(MeshBuilder& builder, Random& random) {
    constexpr glm::vec3 kCentre(1.2F, 0.0F, 1.62F);
    constexpr glm::vec2 kHalf(0.44F, 0.26F);
    constexpr int kColumns = 50, kRows = 30;
    builder.setColor(kCream * 0.62F);
    builder.addBox(kCentre + glm::vec3(0.0F, 0.005F, 0.0F), {kHalf.x, 0.005F, kHalf.y});
    for (int j = 0; j < kRows; ++j) {
        for (int i = 0; i < kColumns; ++i) {
            const glm::vec2 cell((static_cast<float>(i) + random.uniform(0.25F, 0.75F)) / kColumns,
                                 (static_cast<float>(j) + random.uniform(0.25F, 0.75F)) / kRows);
            const glm::vec2 xz = (2.0F * cell - 1.0F) * (kHalf - 0.01F);
            const glm::vec3 base = kCentre + glm::vec3(xz.x, 0.009F, xz.y);
            const float turn = random.uniform();
            const glm::vec2 lean = ovalAt(random.uniform(), glm::vec2(0.010F), 0.0F);
            const glm::vec3 tip = base + glm::vec3(lean.x, random.uniform(0.016F, 0.024F), lean.y);
            // A stripe along both ends.
            const bool isStripe = std::abs(std::abs(xz.x) - 0.33F) < 0.03F;
            builder.setColor((isStripe ? kTerracotta : kCream) * random.uniform(0.85F, 1.1F));
            std::array<glm::vec3, 4> positions, normals;
            positions[3] = tip;
            normals[3] = glm::vec3(0.0F, 1.0F, 0.0F);
            for (int k = 0; k < 3; ++k) {
                const glm::vec2 out =
                    ovalAt(turn + static_cast<float>(k) / 3.0F, glm::vec2(1.0F), 0.0F);
                positions[static_cast<std::size_t>(k)] =
                    base + glm::vec3(out.x * 0.0105F, 0.0F, out.y * 0.0105F);
                normals[static_cast<std::size_t>(k)] =
                    glm::normalize(glm::vec3(out.x, 0.9F, out.y));
            }
            constexpr glm::uvec3 kSides[] = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
            builder.addIndexed(positions, normals, kSides);
        }
    }
}

}  // namespace gfxrepro::scene::bathroom_parts
