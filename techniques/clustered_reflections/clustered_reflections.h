// The technique `clustered_reflections`: chapter 4 of xie2017. See README.md.
#pragma once

#include <string>

#include "runner/technique/technique.h"
#include "techniques/clustered_reflections/clustered_tracer.h"
#include "techniques/reflections/frame.h"

namespace gfxrepro::clustered_reflections {

enum class Method {
    Clustered,       // Algorithm 6
    EnvironmentMap,  // the comparator of Table 12
    ScreenSpace,     // rays marched in the eye's own depth image
    RayTraced,       // on the same GL device
    Embree,          // on the CPU: the truth
};

struct ReflectionParams : reflections::FrameSettings {
    Method method = Method::Clustered;
    ClusteredSettings clustered;  // camera.diagonalM and camera.lobe are set up with the scene
    std::string errorsOf;         // name of the mesh whose samples' occlusion counts; empty: all
    int convergedRays = 0;        // of a second truth of glossy samples; 0: there is none

    /// Whether there are reflections to look at: not where clusters are only counted.
    bool drawsReflections() const {
        return method != Method::Clustered || clustered.drawing != ImageDrawing::None;
    }

    /// Throws Error for scenes without reflectors, and without the one that `errorsOf` names.
    void requireScene(const scene::Scene& scene) const;
    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit ReflectionParams(Params& params);
};

extern const technique::TechniqueInfo kClusteredReflections;

}  // namespace gfxrepro::clustered_reflections
