// Houses and towers of the city generator, their facades and roofs.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/city/parts.h"

namespace gfxrepro::scene::city_parts {
namespace {

/// What facades are made with.
struct FacadeStyle {
    glm::vec3 wall{0.5F};
    glm::vec3 trim{0.5F};
    glm::vec3 glass{0.1F};
    float bayM = 3.6F;
    float storeyM = 3.6F;
    bool hasLedges = false;
    float recessM = 0.3F;    // of windows; 0: flush with the wall
    std::uint64_t seed = 0;  // of what is behind the panes
};

/// `origin` is its lower left corner seen from outside, `along` its unit direction to the right.
struct Wall {
    glm::vec3 origin, along;
    float widthM, heightM;
};
/// How many parts of about `partM` fit.
int divided(float lengthM, float partM) {
    return std::max(1, static_cast<int>(std::floor(lengthM / partM + 0.5F)));
}

/// The four walls of a box, each seen from outside: +x, −x, +z, −z.
std::array<Wall, 4> wallsOf(const Solid& s) {
    const glm::vec3 size = s.max - s.min;
    return {Wall{{s.max.x, s.min.y, s.max.z}, {0, 0, -1}, size.z, size.y},
            Wall{{s.min.x, s.min.y, s.min.z}, {0, 0, 1}, size.z, size.y},
            Wall{{s.min.x, s.min.y, s.max.z}, {1, 0, 0}, size.x, size.y},
            Wall{{s.max.x, s.min.y, s.min.z}, {-1, 0, 0}, size.x, size.y}};
}

/// A rectangle on a wall, `outM` before it.
void addPatch(MeshBuilder& builder, const Wall& wall, float left, float right, float low,
              float high, float outM = 0.0F) {
    const glm::vec3 base = wall.origin + glm::cross(wall.along, kUp) * outM;
    const glm::vec3 a = base + wall.along * left;
    const glm::vec3 b = base + wall.along * right;
    builder.addQuad(a + kUp * low, b + kUp * low, b + kUp * high, a + kUp * high);
}

/// A bar on a wall without its back: front, two long sides and, where wanted, the ends.
void addBar(MeshBuilder& builder, const Wall& wall, const glm::vec4& leftRightLowHigh, float outM,
            bool hasSides, bool hasTopAndBottom) {
    const glm::vec3 out = glm::cross(wall.along, kUp) * outM;
    const glm::vec4& r = leftRightLowHigh;
    const glm::vec3 a = wall.origin + wall.along * r[0] + kUp * r[2];
    const glm::vec3 b = wall.origin + wall.along * r[1] + kUp * r[2];
    const glm::vec3 c = wall.origin + wall.along * r[1] + kUp * r[3];
    const glm::vec3 d = wall.origin + wall.along * r[0] + kUp * r[3];
    builder.addQuad(a + out, b + out, c + out, d + out);
    if (hasSides) {
        builder.addQuad(a, a + out, d + out, d);
        builder.addQuad(b + out, b, c, c + out);
    }
    if (hasTopAndBottom) {
        builder.addQuad(d + out, c + out, c, d);
        builder.addQuad(a, b, b + out, a + out);
    }
}

/// The hole of a window: the pane and, where it is recessed, four reveals.
void addWindow(Builders& builders, const Wall& wall, const FacadeStyle& style,
               const glm::vec4& leftRightLowHigh) {
    const glm::vec4& r = leftRightLowHigh;
    const glm::vec3 in = glm::cross(wall.along, kUp) * -style.recessM;
    const glm::vec3 a = wall.origin + wall.along * r[0] + kUp * r[2];
    const glm::vec3 b = wall.origin + wall.along * r[1] + kUp * r[2];
    const glm::vec3 c = wall.origin + wall.along * r[1] + kUp * r[3];
    const glm::vec3 d = wall.origin + wall.along * r[0] + kUp * r[3];
    builders.glass.addQuad(a + in, b + in, c + in, d + in);
    if (style.recessM > 0.0F) {
        builders.walls.addQuad(a, b, b + in, a + in);
        builders.walls.addQuad(b, c, c + in, b + in);
        builders.walls.addQuad(c, d, d + in, c + in);
        builders.walls.addQuad(d, a, a + in, d + in);
    }
    if (!style.hasLedges) return;
    builders.walls.setColor(style.trim);
    addBar(builders.walls, wall, {r[0] - 0.15F, r[1] + 0.15F, r[2] - 0.25F, r[2]}, 0.3F, true,
           true);
    builders.walls.setColor(style.wall);
}

/// The lot's rectangle moved inwards.
Solid shrunk(const Solid& solid, float byM) {
    return {solid.min + glm::vec3(byM, 0.0F, byM), solid.max - glm::vec3(byM, 0.0F, byM)};
}

struct FrameFaces {
    bool hasTop, hasBottom, hasInside;
};

/// Walls between heights y of `outer`, as a frame around `inner`: outside always, top, bottom and
/// inside where wanted.
void addFrame(MeshBuilder& builder, const Solid& outer, float thickness, FrameFaces faces) {
    const Solid inner = shrunk(outer, thickness);
    const auto outside = wallsOf(outer);
    const auto inside = wallsOf(inner);
    for (std::size_t i = 0; i < 4; ++i) {
        const Wall& o = outside[i];
        const Wall& n = inside[i];
        const glm::vec3 a = o.origin;
        const glm::vec3 b = o.origin + o.along * o.widthM;
        const glm::vec3 c = n.origin;
        const glm::vec3 d = n.origin + n.along * n.widthM;
        const glm::vec3 up = kUp * o.heightM;
        builder.addQuad(a, b, b + up, a + up);
        if (faces.hasTop) builder.addQuad(a + up, b + up, d + up, c + up);
        if (faces.hasBottom) builder.addQuad(b, a, c, d);
        if (faces.hasInside) builder.addQuad(d, c, c + up, d + up);
    }
}

/// One wall with rows of windows; `glassShare` of a bay's width is window.
void addWindowWall(Builders& builders, const Wall& wall, const FacadeStyle& style, int bays,
                   float glassShare, Random& panes) {
    const int storeys = divided(wall.heightM, style.storeyM);
    const float storeyM = wall.heightM / static_cast<float>(storeys);
    const float bayM = wall.widthM / static_cast<float>(bays);
    const float pierM = 0.5F * bayM * (1.0F - glassShare);  // to each side of a window
    builders.walls.setColor(style.wall);
    float below = 0.0F;
    for (int storey = 0; storey < storeys; ++storey) {
        const float low = (static_cast<float>(storey) + 0.28F) * storeyM;
        const float high = (static_cast<float>(storey) + 0.80F) * storeyM;
        addPatch(builders.walls, wall, 0.0F, wall.widthM, below, low);
        float left = 0.0F;
        for (int bay = 0; bay < bays; ++bay) {
            const float begin = static_cast<float>(bay) * bayM + pierM;
            const float end = static_cast<float>(bay + 1) * bayM - pierM;
            addPatch(builders.walls, wall, left, begin, low, high);
            // Curtains, lamps, reflections: no two windows look the same.
            builders.glass.setColor(style.glass *
                                    (panes.index(9) == 0 ? 2.6F : panes.uniform(0.6F, 1.4F)));
            addWindow(builders, wall, style, {begin, end, low, high});
            left = end;
        }
        addPatch(builders.walls, wall, left, wall.widthM, low, high);
        below = high;
    }
    addPatch(builders.walls, wall, 0.0F, wall.widthM, below, wall.heightM);
}

/// Four walls with windows; on the sides that `isBack` names (+x, −x, +z, −z) fewer of them.
void addWindowWalls(Builders& builders, const Solid& tier, const FacadeStyle& style,
                    const bool (&isBack)[4]) {
    const auto walls = wallsOf(tier);
    Random panes(style.seed, 5);
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const float bayM = style.bayM * (isBack[i] ? 2.6F : 1.0F);
        addWindowWall(builders, walls[i], style, divided(walls[i].widthM, bayM),
                      isBack[i] ? 0.22F : 0.52F, panes);
    }
}

/// Bands of slab and glass around, with thin posts before the glass.
void addRibbonTier(Builders& builders, const Solid& tier, const FacadeStyle& style) {
    constexpr float kRecessM = 0.5F;
    const Solid core = shrunk(tier, kRecessM);
    builders.glass.setColor(style.glass);
    addFrame(builders.glass, core, 0.1F, {false, false, false});

    const float heightM = tier.max.y - tier.min.y;
    const int storeys = divided(heightM, 1.3F * style.storeyM);
    const float storeyM = heightM / static_cast<float>(storeys);
    builders.walls.setColor(style.wall);
    for (int storey = 0; storey <= storeys; ++storey) {
        const float level = tier.min.y + static_cast<float>(storey) * storeyM;
        const float low = std::max(tier.min.y, level - 0.2F * storeyM);
        const float high = std::min(tier.max.y, level + 0.2F * storeyM);
        addFrame(builders.walls, {{tier.min.x, low, tier.min.z}, {tier.max.x, high, tier.max.z}},
                 kRecessM, {true, storey > 0, false});
    }
    builders.walls.setColor(style.trim);
    for (const Wall& wall : wallsOf(core)) {
        const int posts = divided(wall.widthM, 1.6F * style.bayM);
        for (int i = 1; i < posts; ++i) {
            const float at = wall.widthM * static_cast<float>(i) / static_cast<float>(posts);
            addBar(builders.walls, wall, {at - 0.15F, at + 0.15F, 0.0F, wall.heightM}, 0.3F, true,
                   false);
        }
    }
}

/// Glass behind piers that run over the whole height.
void addPierTier(Builders& builders, const Solid& tier, const FacadeStyle& style) {
    constexpr float kDepthM = 0.7F;
    const Solid core = shrunk(tier, kDepthM);
    builders.glass.setColor(style.glass);
    addFrame(builders.glass, core, 0.1F, {false, false, false});
    const float heightM = tier.max.y - tier.min.y;
    const int storeys = divided(heightM, style.storeyM);
    builders.walls.setColor(style.trim);
    for (int storey = 1; storey < storeys; ++storey) {
        const float level =
            tier.min.y + heightM * static_cast<float>(storey) / static_cast<float>(storeys);
        for (const Wall& wall : wallsOf(core)) {
            const float y = level - tier.min.y;
            addBar(builders.walls, wall, {0.0F, wall.widthM, y - 0.5F, y + 0.5F}, 0.25F, false,
                   true);
        }
    }
    builders.walls.setColor(style.wall);
    for (const Wall& wall : wallsOf(core)) {
        const int piers = divided(wall.widthM, 1.3F * style.bayM);
        for (int i = 0; i <= piers; ++i) {
            const float at = wall.widthM * static_cast<float>(i) / static_cast<float>(piers);
            const float half = i == 0 || i == piers ? 0.7F : 0.4F;
            addBar(builders.walls, wall, {at - half, at + half, 0.0F, wall.heightM}, kDepthM, true,
                   false);
        }
    }
    // The cornice closes the piers.
    const Solid cornice{{tier.min.x, tier.max.y - 1.4F, tier.min.z}, tier.max};
    addFrame(builders.walls, cornice, kDepthM, {true, true, false});
}

/// A parapet on the roof's edge and the roof behind it.
void addFlatRoof(Builders& builders, const Solid& tier, const FacadeStyle& style, Random& random) {
    constexpr float kParapetM = 1.0F;
    const Solid parapet{{tier.min.x, tier.max.y, tier.min.z},
                        {tier.max.x, tier.max.y + kParapetM, tier.max.z}};
    builders.walls.setColor(style.trim);
    addFrame(builders.walls, parapet, 0.4F, {true, false, true});
    const float grey = random.uniform(0.16F, 0.42F);
    builders.roofs.setColor({1.05F * grey, grey, 0.94F * grey});
    const Solid inner = shrunk(parapet, 0.4F);
    const float y = tier.max.y;
    builders.roofs.addQuad({inner.min.x, y, inner.max.z}, {inner.max.x, y, inner.max.z},
                           {inner.max.x, y, inner.min.z}, {inner.min.x, y, inner.min.z});
}

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

/// Of the buildings of middle height: windows lie in the wall, with reveals, not flush.
constexpr float kRecessedShare = 1.0F / 3.0F;

void addBlockBuilding(Builders& builders, const Lot& lot, float detail, Random& random) {
    FacadeStyle style = styleOf(oneOf(kWallColors, random), detail, random);
    style.hasLedges = random.index(6) == 0;
    if (random.uniform() >= kRecessedShare) style.recessM = 0.0F;
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

void addBuilding(Builders& builders, const Lot& lot, float detail, std::uint64_t seed) {
    Random random(seed, 1);
    const glm::vec2 size = lot.max - lot.min;
    if (lot.heightM < 12.0F && std::min(size.x, size.y) < 18.0F) {
        addHouse(builders, lot, detail, random);
    } else if (lot.heightM < 36.0F) {
        addBlockBuilding(builders, lot, detail, random);
    } else {
        addTower(builders, lot, detail, random);
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
