// Lights with shadow maps, and the views that the maps are drawn from.
#pragma once

#include <vector>

#include "engine/raycast/ray_tracer.h"
#include "engine/scene/scene.h"

namespace gfxrepro::shadow_mapping {

enum class LightKind {
    Spot,         // perspective, one view; fovRad is the whole angle
    Directional,  // parallel rays, one view, orthographic, fitted to the scene
    Point,        // six views, the faces of a cube
};

struct Light {
    LightKind kind = LightKind::Spot;
    glm::vec3 positionWorld{0.0F};                // not used by Directional
    glm::vec3 targetWorld{0.0F};                  // Spot: looked at
    glm::vec3 directionWorld{0.0F, -1.0F, 0.0F};  // Directional: along the rays, any length
    float fovRad = 1.0F;                          // Spot
    float nearM = 0.1F;                           // Spot, Point
    float farM = 100.0F;                          // Spot, Point
    glm::vec3 color{1.0F};                        // linear
    /// Width of the light as PCSS has it: metres; Directional: metres a metre of distance.
    float size = 0.0F;

    bool operator==(const Light&) const = default;
};

/// At most this many lights: their shadow terms are the channels of one texture.
constexpr int kMaxLights = 4;

/// Faces of a point light's cube are widened by this many texels, so that a filter reads across a
/// cube's edge without leaving the face: 7 × 7 PCF reaches 3 texels, a bilinear footprint 1.
constexpr int kCubeBorderTexels = 4;

/// A view of a light and its place in the light's map: clip z from −w to w.
struct LightView {
    glm::mat4 clipFromWorld{1.0F};
    glm::ivec2 tilePx{0};  // lower left corner
    glm::ivec2 tileSizePx{0};
    float texelPerDistance = 0.0F;  // a texel's width in metres at clip w = 1
    float nearM = 0.0F;             // along the view's axis
    float farM = 0.0F;
    bool isPerspective = true;

    /// [zju2005] Sec. 4.3: T before the division, (u·w, v·w, window z·w, w), u and v over the whole
    /// map. Departure [zju2005] Sec. 4.3: v grows upwards, and no half texel is added: textures and
    /// pixels agree in GL, the thesis's TexBias is for Direct3D 9.
    glm::mat4 lookupFromWorld(glm::ivec2 mapSizePx) const;
};

/// Tiles of a light's map: 1, or 3 × 2 for a cube (+x −x +y below, −y +z −z above).
glm::ivec2 tileCountOf(LightKind kind);

/// The views of a light with tiles of `sizePx`². Throws Error for a light that has none: position
/// equal to target, an angle outside of (0°, 180°), planes out of order, no direction, values that
/// are not finite, an empty scene, faces too small for their border.
std::vector<LightView> viewsOf(const Light& light, const scene::Box& bounds, int sizePx);

/// Throws Error for a light inside of geometry: every ray from it meets a surface from behind.
void requireOutside(const raycast::RayTracer& tracer, const std::vector<Light>& lights);

/// Lights whose maps hold no vertex of the scene.
int lightsWithoutCaster(const std::vector<Light>& lights, const scene::Scene& scene, int sizePx);

}  // namespace gfxrepro::shadow_mapping
