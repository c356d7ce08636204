// Facades and roofs of the city generator.
#pragma once

#include "scenes/city/parts.h"

namespace gfxrepro::scene::city_parts {

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

/// The lot's rectangle moved inwards.
Solid shrunk(const Solid& solid, float byM);

/// Walls between heights y of `outer`, as a frame around `inner`: outside always, top, bottom and
/// inside where wanted.
struct FrameFaces {
    bool hasTop, hasBottom, hasInside;
};
void addFrame(MeshBuilder& builder, const Solid& outer, float thickness, FrameFaces faces);

/// One wall with rows of windows. `origin` is its lower left corner seen from outside,
/// `along` its unit direction to the right; `glassShare` of a bay's width is window.
struct Wall {
    glm::vec3 origin, along;
    float widthM, heightM;
};
void addWindowWall(Builders& builders, const Wall& wall, const FacadeStyle& style, int bays,
                   float glassShare, Random& panes);

/// Four walls with windows; on the sides that `isBack` names (+x, −x, +z, −z) fewer of them.
void addWindowWalls(Builders& builders, const Solid& tier, const FacadeStyle& style,
                    const bool (&isBack)[4]);
/// Bands of slab and glass around, with thin posts before the glass.
void addRibbonTier(Builders& builders, const Solid& tier, const FacadeStyle& style);
/// Glass behind piers that run over the whole height.
void addPierTier(Builders& builders, const Solid& tier, const FacadeStyle& style);

/// A parapet on the roof's edge and the roof behind it.
void addFlatRoof(Builders& builders, const Solid& tier, const FacadeStyle& style, Random& random);

}  // namespace gfxrepro::scene::city_parts
