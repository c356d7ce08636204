#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/city/facades.h"

namespace gfxrepro::scene::city_parts {

namespace {

constexpr glm::vec3 kWallColors[] = {
    {0.52F, 0.44F, 0.34F}, {0.42F, 0.17F, 0.11F}, {0.60F, 0.57F, 0.52F}, {0.34F, 0.32F, 0.31F},
    {0.55F, 0.36F, 0.22F}, {0.30F, 0.13F, 0.09F}, {0.66F, 0.60F, 0.47F}, {0.38F, 0.42F, 0.45F}};
constexpr glm::vec3 kTowerColors[] = {{0.62F, 0.62F, 0.60F},
                                      {0.26F, 0.29F, 0.33F},
                                      {0.55F, 0.47F, 0.38F},
                                      {0.72F, 0.70F, 0.66F},
                                      {0.20F, 0.17F, 0.16F}};
constexpr glm::vec3 kHouseColors[] = {
    {0.72F, 0.66F, 0.52F}, {0.64F, 0.62F, 0.60F}, {0.55F, 0.28F, 0.18F}, {0.46F, 0.54F, 0.58F}};

template <std::size_t N>
glm::vec3 oneOf(const glm::vec3 (&colors)[N], Random& random) {
    const glm::vec3 color = colors[random.index(static_cast<std::uint32_t>(N))];
    return color * random.uniform(0.85F, 1.12F);
}

FacadeStyle styleOf(const glm::vec3& wall, float detail, Random& random) {
    FacadeStyle style;
    style.wall = wall;
    style.trim = glm::min(wall * random.uniform(0.75F, 1.35F), glm::vec3(0.8F));
    const float tint = random.uniform(0.6F, 1.4F);
    style.glass = tint * glm::vec3(0.06F, 0.10F, 0.14F);
    style.seed = random.next();
    style.bayM = random.uniform(3.6F, 4.8F) / detail;
    style.storeyM = random.uniform(3.7F, 4.5F) / std::clamp(detail, 0.6F, 1.15F);
    return style;
}

/// Machines, stair houses and water tanks on a flat roof, kept from its edge.
void addRoofStructures(Builders& builders, const Solid& tier, bool hasTank, Random& random) {
    const Solid free = shrunk(tier, 1.6F);
    const glm::vec3 size = free.max - free.min;
    if (size.x < 4.0F || size.z < 4.0F) return;
    const float y = tier.max.y;
    // One quarter of the roof each, so that nothing overlaps.
    const unsigned firstQuarter = random.index(4);
    const unsigned used = 1 + random.index(3);
    for (unsigned k = 0; k <= used; ++k) {
        const unsigned quarter = (firstQuarter + k) % 4;
        const glm::vec2 middle(
            free.min.x + size.x * ((quarter & 1U) != 0 ? 0.75F : 0.25F),
            free.min.z + size.z * ((quarter == 1 || quarter == 2) ? 0.75F : 0.25F));
        const float halfZ = size.z * random.uniform(0.10F, 0.20F);
        const glm::vec2 half(size.x * random.uniform(0.10F, 0.20F), halfZ);
        if (k == 0 && hasTank) {
            addWaterTank(builders, {middle.x, y, middle.y}, random);
            continue;
        }
        const float height = k == 0 ? random.uniform(2.6F, 4.0F) : random.uniform(1.0F, 2.2F);
        const float grey = random.uniform(0.25F, 0.6F);
        MeshBuilder& builder = k == 0 ? builders.walls : builders.metal;
        builder.setColor({grey, grey, 0.97F * grey});
        addSolid(builder, {{middle.x - half.x, y, middle.y - half.y},
                           {middle.x + half.x, y + height, middle.y + half.y}});
    }
}

void addHouse(Builders& builders, const Lot& lot, float detail, Random& random) {
    builders.ground.setColor(random.uniform(0.8F, 1.1F) * glm::vec3(0.14F, 0.26F, 0.08F));
    addSolid(builders.ground, {{lot.min.x, 0.2F, lot.min.y}, {lot.max.x, 0.26F, lot.max.y}});

    FacadeStyle style = styleOf(oneOf(kHouseColors, random), detail, random);
    style.bayM = 4.2F / detail;
    const float marginZ = random.uniform(1.5F, 3.0F);
    const glm::vec2 margin(random.uniform(1.5F, 3.0F), marginZ);
    const float eaves = 0.55F * lot.heightM + 0.2F;
    const Solid body{{lot.min.x + margin.x, 0.2F, lot.min.y + margin.y},
                     {lot.max.x - margin.x, eaves, lot.max.y - margin.y}};
    addWindowWalls(builders, body, style, {false, false, false, false});

    // A gable roof; the ridge runs along the longer side.
    const glm::vec3 size = body.max - body.min;
    const bool alongX = size.x > size.z;
    const glm::vec3 ridge = alongX ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 across = alongX ? glm::vec3(0, 0, -1) : glm::vec3(1, 0, 0);
    const float halfRidge = 0.5F * (alongX ? size.x : size.z);
    const float halfWidth = 0.5F * (alongX ? size.z : size.x);
    const float rise = 0.72F * halfWidth;
    glm::vec3 middle = 0.5F * (body.min + body.max);
    middle.y = eaves;
    const glm::vec3 top = middle + glm::vec3(0, rise, 0);
    builders.walls.setColor(style.wall);
    builders.roofs.setColor(random.index(2) == 0 ? glm::vec3(0.36F, 0.11F, 0.06F)
                                                 : glm::vec3(0.17F, 0.16F, 0.17F));
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 end = ridge * (side * halfRidge);
        const glm::vec3 half = glm::cross(glm::vec3(0, 1, 0), ridge) * (side * halfWidth);
        builders.walls.addTriangle(middle + end - half, middle + end + half, top + end);
        const glm::vec3 slope = glm::normalize(across * (side * halfWidth) - glm::vec3(0, rise, 0));
        const glm::vec3 outward =
            glm::normalize(across * (side * rise) + glm::vec3(0, halfWidth, 0));
        const float length = 0.5F * std::sqrt(halfWidth * halfWidth + rise * rise) + 0.35F;
        const glm::mat3 axes(slope, outward, glm::cross(slope, outward));
        builders.roofs.addBox(top + slope * (length - 0.05F) + outward * 0.1F,
                              {length, 0.14F, halfRidge + 0.5F}, axes);
    }
    builders.walls.setColor({0.30F, 0.12F, 0.08F});
    const glm::vec3 chimney =
        middle + ridge * (random.uniform(-0.6F, 0.6F) * halfRidge) + across * (0.4F * halfWidth);
    addSolid(builders.walls, {chimney - glm::vec3(0.45F, 0.0F, 0.45F),
                              chimney + glm::vec3(0.45F, rise + 1.0F, 0.45F)});
}

void addBlockBuilding(Builders& builders, const Lot& lot, const FacadeDetail& detail,
                      Random& random) {
    FacadeStyle style = styleOf(oneOf(kWallColors, random), detail.windows, random);
    style.hasLedges = random.index(6) == 0;
    if (random.uniform() >= detail.recessedShare) style.recessM = 0.0F;
    Solid body{{lot.min.x, 0.2F, lot.min.y}, {lot.max.x, lot.heightM, lot.max.y}};
    // The shop front: a darker storey, with a canopy around.
    const float shopM = 4.5F;
    FacadeStyle shop = style;
    shop.wall = 0.5F * style.trim;
    shop.storeyM = shopM;
    shop.bayM = 1.8F * style.bayM;
    shop.recessM = 0.3F;
    shop.hasLedges = false;
    const Solid base{body.min, {body.max.x, body.min.y + shopM, body.max.z}};
    addWindowWalls(builders, base, shop, {false, false, false, false});
    builders.walls.setColor(style.trim);
    addFrame(builders.walls,
             {{body.min.x - 0.4F, base.max.y - 0.2F, body.min.z - 0.4F},
              {body.max.x + 0.4F, base.max.y + 0.2F, body.max.z + 0.4F}},
             0.4F, {true, true, false});
    body.min.y = base.max.y;

    const bool hasSetback = lot.heightM > 22.0F && random.index(2) == 0;
    Solid upper = body;
    if (hasSetback) {
        body.max.y = std::floor(body.max.y * random.uniform(0.6F, 0.8F));
        upper = shrunk(upper, random.uniform(2.0F, 3.5F));
        upper.min.y = body.max.y;
    }
    bool isBack[4];
    for (bool& side : isBack) side = random.index(3) == 0;
    addWindowWalls(builders, body, style, isBack);
    addFlatRoof(builders, body, style, random);
    if (hasSetback) {
        addWindowWalls(builders, upper, style, isBack);
        addFlatRoof(builders, upper, style, random);
    }
    addRoofStructures(builders, upper, random.index(5) < 3, random);
}

void addTower(Builders& builders, const Lot& lot, float detail, Random& random) {
    FacadeStyle style = styleOf(oneOf(kTowerColors, random), detail, random);
    style.recessM = 0.0F;
    FacadeStyle pane = style;
    pane.glass = glm::vec3(0.16F, 0.26F, 0.33F) * random.uniform(0.5F, 1.3F);
    const unsigned kind = random.index(3);
    const unsigned tiers = 1 + random.index(3);
    Solid tier{{lot.min.x, 0.2F, lot.min.y}, {lot.max.x, 0.0F, lot.max.y}};
    for (unsigned i = 0; i < tiers; ++i) {
        const float share = i + 1 == tiers ? 1.0F
                                           : (static_cast<float>(i) + random.uniform(0.6F, 1.0F)) /
                                                 static_cast<float>(tiers);
        tier.max.y = std::max(lot.heightM * share, tier.min.y + 5.0F);
        if (kind == 0) {
            addRibbonTier(builders, tier, pane);
        } else if (kind == 1) {
            addPierTier(builders, tier, pane);
        } else {
            addWindowWalls(builders, tier, style, {false, false, false, false});
        }
        addFlatRoof(builders, tier, style, random);
        if (i + 1 == tiers) break;
        Solid next = shrunk(tier, random.uniform(1.8F, 3.6F));
        next.min.y = tier.max.y;
        if (next.max.x - next.min.x < 9.0F || next.max.z - next.min.z < 9.0F) break;
        tier = next;
    }
    addRoofStructures(builders, tier, false, random);
    if (lot.heightM > 75.0F && random.index(2) == 0) {
        const glm::vec3 middle = 0.5F * (tier.min + tier.max);
        builders.metal.setColor({0.5F, 0.12F, 0.1F});
        const glm::vec3 foot(middle.x, tier.max.y, middle.z);
        const std::array mast{
            MeshBuilder::Station{foot, 0.45F},
            MeshBuilder::Station{foot + glm::vec3(0, 0.2F * lot.heightM, 0), 0.1F}};
        builders.metal.addTube(mast, 5, true);
    }
}

}  // namespace

void addBuilding(Builders& builders, const Lot& lot, const FacadeDetail& detail,
                 std::uint64_t seed) {
    Random random(seed, 1);
    const glm::vec2 size = lot.max - lot.min;
    if (lot.heightM < 12.0F && std::min(size.x, size.y) < 18.0F) {
        addHouse(builders, lot, detail.windows, random);
    } else if (lot.heightM < 36.0F) {
        addBlockBuilding(builders, lot, detail, random);
    } else {
        addTower(builders, lot, detail.windows, random);
    }
}

void addPark(Builders& builders, const Lot& lot, std::uint64_t seed) {
    Random random(seed, 2);
    builders.ground.setColor({0.12F, 0.27F, 0.07F});
    addSolid(builders.ground, {{lot.min.x, 0.2F, lot.min.y}, {lot.max.x, 0.35F, lot.max.y}});
    const glm::vec2 middle = 0.5F * (lot.min + lot.max);
    builders.ground.setColor({0.45F, 0.38F, 0.27F});
    addSolid(builders.ground,
             {{lot.min.x, 0.35F, middle.y - 1.5F}, {lot.max.x, 0.42F, middle.y + 1.5F}});
    const glm::vec2 size = lot.max - lot.min;
    constexpr int kTreesAcross = 4;
    for (int j = 0; j < kTreesAcross; ++j) {
        for (int i = 0; i < kTreesAcross; ++i) {
            const float row = static_cast<float>(j) + random.uniform(0.2F, 0.8F);
            const float column = static_cast<float>(i) + random.uniform(0.25F, 0.75F);
            const glm::vec2 cell(column * 0.25F, row * 0.25F);
            const glm::vec2 at = lot.min + size * cell;
            if (std::abs(at.y - middle.y) < 2.5F) continue;
            addTree(builders, {at.x, 0.35F, at.y}, random.uniform(6.5F, 12.0F), random);
        }
    }
}

}  // namespace gfxrepro::scene::city_parts
