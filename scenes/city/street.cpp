#include <array>

#include "scenes/city/parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::city_parts {
namespace {

/// The octahedron with each edge halved and pushed out: 32 triangles, smooth normals.
void addFoliage(MeshBuilder& builder, const glm::vec3& centre, const glm::vec3& radii,
                Random& random) {
    std::vector<glm::vec3> normals{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                   {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    std::vector<glm::uvec3> triangles;
    for (unsigned octant = 0; octant < 8; ++octant) {
        const bool isMirrored = ((octant ^ (octant >> 1) ^ (octant >> 2)) & 1U) != 0;
        const glm::uvec3 corner(octant & 1U, 2 + ((octant >> 1) & 1U), 4 + ((octant >> 2) & 1U));
        // Midpoints are kept per octant; those of two octants have the same position.
        const auto first = static_cast<unsigned>(normals.size());
        for (int i = 0; i < 3; ++i) {
            normals.push_back(glm::normalize(normals[corner[i]] + normals[corner[(i + 1) % 3]]));
        }
        const std::array<glm::uvec3, 4> parts{
            glm::uvec3(corner.x, first, first + 2), glm::uvec3(first, corner.y, first + 1),
            glm::uvec3(first + 2, first + 1, corner.z), glm::uvec3(first, first + 1, first + 2)};
        for (const glm::uvec3& t : parts) {
            triangles.push_back(isMirrored ? glm::uvec3(t.x, t.z, t.y) : t);
        }
    }
    const float turnRad = random.uniform(0.0F, 1.5F);
    const float s = sdf::sine(turnRad);
    const float c = sdf::cosine(turnRad);
    std::vector<glm::vec3> positions;
    for (glm::vec3& n : normals) {
        n = glm::vec3(c * n.x + s * n.z, n.y, c * n.z - s * n.x);
        positions.push_back(centre + radii * n);
        n = glm::normalize(n / radii);
    }
    builder.addIndexed(positions, normals, triangles);
}

/// A box that narrows upwards, without a bottom: cabins of cars.
void addTapered(MeshBuilder& builder, const glm::vec3& base, const glm::vec3& along,
                const glm::vec3& halfSize, float shrink) {
    const glm::vec3 side = glm::cross(along, kUp);
    std::array<glm::vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
        const bool isTop = i >= 4;
        const float a = (i % 4 == 1 || i % 4 == 2 ? 1.0F : -1.0F) * halfSize.x;
        const float b = (i % 4 >= 2 ? 1.0F : -1.0F) * halfSize.z;
        const float scale = isTop ? shrink : 1.0F;
        corners[i] = base + along * (a * scale) + side * (b * (isTop ? 0.9F : 1.0F)) +
                     kUp * (isTop ? 2.0F * halfSize.y : 0.0F);
    }
    for (unsigned i = 0; i < 4; ++i) {
        const unsigned j = (i + 1) % 4;
        builder.addQuad(corners[j], corners[i], corners[i + 4], corners[j + 4]);
    }
    builder.addQuad(corners[7], corners[6], corners[5], corners[4]);
}

}  // namespace

void addSolid(MeshBuilder& builder, const Solid& solid, bool hasBottom) {
    const glm::vec3& a = solid.min;
    const glm::vec3& b = solid.max;
    builder.addQuad({a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z});
    builder.addQuad({a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
    builder.addQuad({b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z});
    builder.addQuad({b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z});
    builder.addQuad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z});
    if (hasBottom) {
        builder.addQuad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z});
    }
}

void addWaterTank(Builders& builders, const glm::vec3& base, Random& random) {
    const float radius = random.uniform(1.3F, 1.9F);
    const float legs = random.uniform(1.5F, 3.0F);
    const float height = random.uniform(2.6F, 3.6F);
    builders.metal.setColor({0.16F, 0.15F, 0.15F});
    for (const glm::vec2 side : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const glm::vec3 foot = base + glm::vec3(side.x, 0.0F, side.y) * (0.6F * radius);
        addSolid(builders.metal,
                 {foot - glm::vec3(0.12F, 0.0F, 0.12F), foot + glm::vec3(0.12F, legs, 0.12F)});
    }
    builders.roofs.setColor(random.index(2) == 0 ? glm::vec3(0.28F, 0.15F, 0.07F)
                                                 : glm::vec3(0.20F, 0.14F, 0.10F));
    const glm::vec3 low = base + kUp * legs;
    const std::array drum{MeshBuilder::Station{low, radius},
                          MeshBuilder::Station{low + kUp * height, radius}};
    builders.roofs.addTube(drum, 8, true);
    builders.roofs.setColor({0.13F, 0.12F, 0.12F});
    const std::array hat{
        MeshBuilder::Station{low + kUp * height, 1.12F * radius},
        MeshBuilder::Station{low + kUp * (height + 0.7F * radius), 0.08F * radius}};
    builders.roofs.addTube(hat, 8, true);
}

void addTree(Builders& builders, const glm::vec3& base, float heightM, Random& random) {
    builders.plants.setColor({0.16F, 0.10F, 0.06F});
    const std::array trunk{MeshBuilder::Station{base, 0.2F},
                           MeshBuilder::Station{base + kUp * (0.6F * heightM), 0.12F}};
    builders.plants.addTube(trunk, 4, false);
    const float light = random.uniform(0.7F, 1.3F);
    builders.plants.setColor(light * glm::vec3(0.09F, 0.24F, 0.05F));
    const float alongZ = random.uniform(0.8F, 1.1F);
    const glm::vec3 radii = glm::vec3(0.34F, 0.36F, 0.34F) * heightM *
                            glm::vec3(random.uniform(0.8F, 1.1F), 1.0F, alongZ);
    addFoliage(builders.plants, base + kUp * (0.68F * heightM), radii, random);
}

void addLampPost(Builders& builders, const glm::vec3& base, const glm::vec3& overStreet) {
    builders.metal.setColor({0.10F, 0.12F, 0.12F});
    const glm::vec3 top = base + kUp * 7.0F;
    const std::array pole{MeshBuilder::Station{base, 0.12F}, MeshBuilder::Station{top, 0.07F}};
    builders.metal.addTube(pole, 4, false);
    const std::array arm{MeshBuilder::Station{top - kUp * 0.1F, 0.06F},
                         MeshBuilder::Station{top + overStreet * 1.8F + kUp * 0.2F, 0.05F}};
    builders.metal.addTube(arm, 3, false);
    builders.metal.setColor({0.85F, 0.80F, 0.62F});
    const glm::vec3 head = top + overStreet * 2.0F + kUp * 0.2F;
    addSolid(builders.metal,
             {head - glm::vec3(0.35F, 0.12F, 0.35F), head + glm::vec3(0.35F, 0.12F, 0.35F)}, true);
}

void addCar(Builders& builders, const glm::vec3& base, const glm::vec3& along, Random& random) {
    constexpr glm::vec3 kPaint[] = {{0.55F, 0.03F, 0.03F}, {0.75F, 0.75F, 0.74F},
                                    {0.05F, 0.05F, 0.06F}, {0.06F, 0.13F, 0.42F},
                                    {0.85F, 0.55F, 0.04F}, {0.30F, 0.31F, 0.33F}};
    const bool isVan = random.index(7) == 0;
    const float length = isVan ? 2.9F : random.uniform(2.0F, 2.4F);  // half
    const glm::mat3 axes(along, kUp, glm::cross(along, kUp));
    builders.metal.setColor(kPaint[random.index(6)]);
    const float height = isVan ? 1.0F : 0.38F;
    builders.metal.addBox(base + kUp * (0.3F + height), {length, height, 0.9F}, axes);
    if (isVan) return;
    builders.glass.setColor({0.55F, 0.60F, 0.66F});
    addTapered(builders.glass, base + kUp * (0.3F + 2.0F * height) - along * (0.12F * length),
               along, {0.58F * length, 0.30F, 0.82F}, 0.68F);
}

}  // namespace gfxrepro::scene::city_parts
