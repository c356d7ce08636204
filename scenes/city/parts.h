// Parts of the city generator: what it is made of, one function a kind.
#pragma once

#include <glm/glm.hpp>

#include "engine/core/random.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene::city_parts {

inline constexpr glm::vec3 kUp(0.0F, 1.0F, 0.0F);

/// One builder a material.
struct Builders {
    MeshBuilder ground, walls, glass, roofs, metal, plants;

    std::size_t triangleCount() const {
        return ground.triangleCount() + walls.triangleCount() + glass.triangleCount() +
               roofs.triangleCount() + metal.triangleCount() + plants.triangleCount();
    }
};

/// An upright box, parallel to the axes.
struct Solid {
    glm::vec3 min, max;
};

/// A piece of land with its height limit.
struct Lot {
    glm::vec2 min, max;  // x and z
    float heightM = 10.0F;
    float density = 0.0F;  // 0 at the city's rim, 1 at its centre
};

/// A box whose faces are left out where they cannot be seen.
void addSolid(MeshBuilder& builder, const Solid& solid, bool hasBottom = false);

/// `detail` scales the number of windows, 1 is the usual.
void addBuilding(Builders& builders, const Lot& lot, float detail, std::uint64_t seed);
/// Lawn, paths and trees instead of houses.
void addPark(Builders& builders, const Lot& lot, std::uint64_t seed);

void addWaterTank(Builders& builders, const glm::vec3& base, Random& random);
void addTree(Builders& builders, const glm::vec3& base, float heightM, Random& random);
/// The arm points along `overStreet` (unit).
void addLampPost(Builders& builders, const glm::vec3& base, const glm::vec3& overStreet);
/// `along` is the direction of travel (unit).
void addCar(Builders& builders, const glm::vec3& base, const glm::vec3& along, Random& random);

}  // namespace gfxrepro::scene::city_parts
