// The technique `reflection_reuse`: chapter 5 of xie2017. See README.md.
#pragma once

#include "runner/technique/technique.h"
#include "techniques/reflection_reuse/reuse_renderer.h"
#include "techniques/reflections/frame.h"

namespace gfxrepro::reflection_reuse {

enum class Method {
    Reuse,      // Algorithm 8
    Direct,     // the same by depth alone: what reflects is taken along with its surface
    RayTraced,  // every sample of every frame
};

enum class Tracer {
    Compute,    // on the same GL device
    Embree,     // on the CPU
    Clustered,  // chapter 4: "any tracer that returns radiance and distance" (Sec. 5.1)
};

struct ReuseParams : reflections::FrameSettings {
    Method method = Method::Reuse;
    Tracer tracer = Tracer::Compute;
    int pathFrames = 500;
    int firstFrame = 0;
    ReuseSettings reuse;        // isDirect is set, too
    int exhaustiveSamples = 0;  // searched over their whole reflector; 0: none

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit ReuseParams(Params& params);
};

extern const technique::TechniqueInfo kReflectionReuse;

}  // namespace gfxrepro::reflection_reuse
