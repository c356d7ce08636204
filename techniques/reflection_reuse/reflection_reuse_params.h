// Parameters of reflection_reuse.
#pragma once

#include <optional>
#include <string>

#include "runner/config/params.h"
#include "techniques/reflection_reuse/reuse_renderer.h"
#include "techniques/reflections/composite.h"
#include "techniques/reflections/surfaces.h"

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

struct ReuseParams {
    Method method = Method::Reuse;
    Tracer tracer = Tracer::Compute;
    std::string view;  // a path or camera of the scene; empty: its first path, else first camera
    int pathFrames = 500;
    int firstFrame = 0;
    bool hasMotion = false;
    int supersampling = 1;
    reflections::Blend blend = reflections::Blend::Fresnel;
    reflections::ReflectorRule reflectors;
    reflections::TextureFilter textureFilter = reflections::TextureFilter::Footprint;
    std::optional<float> glossiness;  // of all reflectors, instead of their materials'
    reflections::LobeSettings lobe;
    ReuseSettings reuse;  // isDirect is set, too
    bool measuresErrors = true;
    bool showsPictures = false;
    bool fitsRecompute = false;
    int exhaustiveSamples = 0;  // searched over their whole reflector; 0: none

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit ReuseParams(config::Params& params);
};

}  // namespace gfxrepro::reflection_reuse
