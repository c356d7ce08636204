#include "scenes/city/facades.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfxrepro::scene::city_parts {

namespace {

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

}  // namespace

Solid shrunk(const Solid& solid, float byM) {
    return {solid.min + glm::vec3(byM, 0.0F, byM), solid.max - glm::vec3(byM, 0.0F, byM)};
}

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

}  // namespace gfxrepro::scene::city_parts
