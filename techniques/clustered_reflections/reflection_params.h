// Parameters of clustered_reflections.
#pragma once

#include <optional>
#include <string>

#include "runner/config/params.h"
#include "techniques/clustered_reflections/clustered_tracer.h"

namespace gfxrepro::clustered_reflections {

enum class Method {
    Clustered,       // Algorithm 6
    EnvironmentMap,  // the comparator of Table 12
    ScreenSpace,     // rays marched in the eye's own depth image
    RayTraced,       // on the same GL device
    Embree,          // on the CPU: the truth
};

struct ReflectionParams {
    Method method = Method::Clustered;
    std::string view;  // a path or camera of the scene; empty: its first path, else first camera
    bool hasMotion = false;
    int supersampling = 2;
    std::optional<float> glossiness;  // overrides the materials'
    reflections::LobeSettings lobe;
    reflections::ReflectorRule reflectors;
    reflections::TextureFilter textureFilter = reflections::TextureFilter::Footprint;
    ClusteredSettings clustered;  // camera.diagonalM and camera.lobe are set up with the scene
    float thickness = 0.02F;      // screen space: of what the eye sees, in diagonals of the box
    bool measuresErrors = true;   // against Embree
    std::string errorsOf;         // name of the mesh whose samples' occlusion counts; empty: all
    int convergedRays = 0;        // of a second truth of glossy samples; 0: there is none
    bool showsPictures = false;

    /// Whether there are reflections to look at: not where clusters are only counted.
    bool drawsReflections() const {
        return method != Method::Clustered || clustered.drawing != ImageDrawing::None;
    }

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit ReflectionParams(config::Params& params);
};

}  // namespace gfxrepro::clustered_reflections
