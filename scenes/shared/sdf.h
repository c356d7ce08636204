// Solid shapes as signed distance fields, and their surfaces as closed triangle meshes.
//
// A shape is a list of primitives, added to or cut from what is before them in the list, each with
// a smooth blend. Only +, −, ×, / and square roots are used, which IEEE 754 rounds exactly: the
// same shape gives the same bytes on every machine.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::scene::sdf {

/// A field over points; negative inside. It may change by at most the distance walked (a bound of
/// the true distance), which is what lets a grid skip empty space.
using Field = float (*)(const glm::vec3&);

/// Triangle angles: sine and cosine as polynomials, to 1e-6. Any angle in radians.
float sine(float angleRad);
float cosine(float angleRad);

/// One solid in its own frame (`axes` are its columns in world space, orthonormal).
struct Primitive {
    enum class Kind { Ellipsoid, Capsule, Box, Torus, Custom };

    Kind kind = Kind::Ellipsoid;
    glm::vec3 centre{0.0F};  // capsule: first end
    glm::mat3 axes{1.0F};
    glm::vec3 size{1.0F};  // ellipsoid: radii; box: half sides; torus: (radius, tube, –)
    glm::vec3 span{0.0F};  // capsule: from the first end to the second
    float inverseSquaredSpan = 0.0F;
    float radius = 0.0F;  // capsule: at the first end; box: of the rounded edges
    float endRadius = 0.0F;
    float inverseSlope = 1.0F;  // capsule: what makes the tapered distance a bound
    Field field = nullptr;
    bool isCut = false;
    float blend = 0.0F;

    float distance(const glm::vec3& pointWorld) const;

    /// The same, with its y axis along `direction` (any length).
    Primitive pointing(const glm::vec3& direction) const;
};

Primitive ellipsoid(const glm::vec3& centre, const glm::vec3& radii);
Primitive ball(const glm::vec3& centre, float radius);
/// A ball swept from `a` to `b` while its radius changes.
Primitive capsule(const glm::vec3& a, const glm::vec3& b, float radiusA, float radiusB);
/// Half sides include the rounding.
Primitive box(const glm::vec3& centre, const glm::vec3& halfSides, float rounding = 0.0F);
/// Around the y axis.
Primitive torus(const glm::vec3& centre, float radius, float tubeRadius);
Primitive custom(Field field);

/// Relief that is added to the whole surface: at most `height` high, from noise of this frequency.
struct Relief {
    enum class Kind { None, Bumps, Grooves };
    Kind kind = Kind::None;
    float height = 0.0F;
    float frequency = 1.0F;
    std::uint32_t seed = 0;

    /// In [−height, height].
    float at(const glm::vec3& point) const;
};

class Shape {
  public:
    /// `blend` is the width of the fillet between the new part and what is there.
    Shape& add(Primitive part, float blend = 0.0F);
    Shape& cut(Primitive part, float blend = 0.0F);
    /// add() of the part and of its mirror image in the plane x = 0.
    Shape& addPair(const Primitive& part, float blend = 0.0F);
    Shape& setRelief(const Relief& relief);

    float distance(const glm::vec3& point) const;
    /// By forward differences of this step; `here` is distance(point).
    glm::vec3 gradient(const glm::vec3& point, float here, float step) const;

    /// Stores in `near` what this shape is within `radius` around `centre`: parts that cannot
    /// matter there are left out, all values stay the same to the last bit. False when no surface
    /// is there.
    bool restrictTo(const glm::vec3& centre, float radius, Shape& near) const;

  private:
    std::vector<Primitive> parts_;
    Relief relief_;
};

/// The surface of `shape` within [−extent, extent]³ (it must lie wholly inside): marching
/// tetrahedra on a cubic grid, vertices then moved onto the surface. The result is closed, manifold
/// and faces outwards by construction. Features thinner than the grid may vanish.
Mesh polygonized(const Shape& shape, float extent, float spacing);

}  // namespace gfxrepro::scene::sdf
