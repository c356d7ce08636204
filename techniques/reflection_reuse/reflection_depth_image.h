// A key frame's reflections ([xie2017] Sec. 5.3): what eye and reflected rays sampled.
#pragma once

#include "techniques/reflections/gbuffer.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflection_reuse {

/// B.1 normal and depth and B.2 mirror factor are the G-buffer's, B.3 radiance L_r and B.4 travel
/// distance r the tracer's. Where a ray left the scene, its end counts as the scene's diagonal
/// away.
/// Departure [xie2017] Sec. 5.5.1: it keeps all in two textures of four floats. Here L_r is halves;
/// what positions, and so matches, are made of is floats, too.
struct ReflectionDepthImage {
    reflections::GBuffer gbuffer;
    reflections::ReflectionTarget reflection;
    float diagonalM = 1.0F;

    ReflectionDepthImage(const kit::View& view, float sceneDiagonalM)
        : gbuffer(view), reflection(view.sizePx), diagonalM(sceneDiagonalM) {}
    std::size_t sizeBytes() const { return gbuffer.sizeBytes() + reflection.sizeBytes(); }
};

}  // namespace gfxrepro::reflection_reuse
