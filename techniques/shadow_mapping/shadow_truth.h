// Shadow rays from the visible points to the light, and what a shadow map gets wrong against them.
//
// Visible point p of a pixel: the first drawn surface on the ray through the pixel's centre; its
// normal is the triangle's, turned to the eye. Only points that face the light are compared: the
// others get nothing from it, whatever the map says. Truth: p is lit where nothing lies between p
// and the light. Map: p is lit where its shadow term is at least one half.
//
// A wrong pixel (truth and map differ) is of one class:
//   edge  a true shadow edge is at most `edgeTexels` texels of the map away, counted across the
//         light's rays at p: the truth at a point of p's plane moved so far differs from that at p;
//   acne  else, where the truth is lit and the map is not;
//   leak  else, where the truth is in shadow and the map is lit.
// So wrong = edge + acne + leak. Shares are of the points compared.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/image/image.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/kit/view.h"

namespace gfxrepro::shadow_mapping {

/// A light as shadow rays see it.
struct TruthLight {
    bool isDirectional = false;
    glm::vec3 position{0.0F};          // world; not of directional lights
    glm::vec3 toLight{0.0F, 1.0F, 0};  // unit; of directional lights
    /// Width of a texel of the light's map: in metres where directional, else per metre of distance
    /// along the map's axis.
    float texel = 0.0F;
    /// Unit axis of the map; zero: the six sides of a cube.
    glm::vec3 forward{0.0F};

    /// Unit direction to the light.
    glm::vec3 directionFrom(const glm::vec3& point) const;
    /// Width of a texel at a point, across the light's rays.
    float texelWidthAt(const glm::vec3& point) const;
};

struct VisiblePoint {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};  // of the triangle, turned to the eye
    unsigned triangle = raycast::kNoTriangle;

    bool isSurface() const { return triangle != raycast::kNoTriangle; }
};

/// Of every pixel, rows from the bottom as GL has them.
std::vector<VisiblePoint> visiblePoints(const raycast::RayTracer& tracer, const kit::View& view);

enum class PixelClass : std::uint8_t { NotCompared, Lit, Shadowed, Edge, Acne, Leak };

struct ShadowErrors {
    std::vector<PixelClass> classes;  // Lit and Shadowed are right
    std::vector<std::uint8_t> truth;  // 1 where shadow rays see the light
    std::uint64_t compared = 0, edge = 0, acne = 0, leak = 0;

    std::uint64_t wrong() const { return edge + acne + leak; }
};

class ShadowTruth {
  public:
    /// The tracer lives as long as this. `diagonalM` is the scene's.
    ShadowTruth(const raycast::RayTracer& tracer, float diagonalM)
        : tracer_(tracer), offsetM_(kOffset * diagonalM) {}

    bool isLit(const VisiblePoint& point, const TruthLight& light) const;
    /// `shadowTerms`: one a point, 1 lit, 0 in shadow.
    ShadowErrors compare(const std::vector<VisiblePoint>& points, const TruthLight& light,
                         const std::vector<float>& shadowTerms, float edgeTexels) const;

  private:
    /// Where rays start and end, in diagonals: positions of hits are rounded to about 1e-7, and a
    /// caster nearer than this is missed.
    static constexpr float kOffset = 1e-5F;

    bool isNearEdge(const VisiblePoint& point, const TruthLight& light, bool isPointLit,
                    float edgeTexels) const;
    PixelClass classOf(const VisiblePoint& point, const TruthLight& light, float shadowTerm,
                       float edgeTexels) const;

    const raycast::RayTracer& tracer_;
    float offsetM_;
};

/// Right: grey and dark grey; acne red, leaks green, edges yellow, not compared blue. Rows from the
/// top.
image::ImageF classPicture(const ShadowErrors& errors, glm::ivec2 sizePx);

}  // namespace gfxrepro::shadow_mapping
