// What a frame of both chapters is made of: its parameters, the scene on the device, camera and
// poses, the picture and how far it is from the truth.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runner/technique/technique.h"
#include "techniques/reflections/composite.h"
#include "techniques/reflections/embree_tracer.h"

namespace gfxrepro::reflections {

struct FrameSettings {
    std::string view;  // a path or camera of the scene; empty: its first path, else first camera
    bool hasMotion = false;
    int supersampling = 1;
    std::optional<float> glossiness;  // of all reflectors, instead of their materials'
    LobeSettings lobe;
    ReflectorRule reflectors;
    TextureFilter textureFilter = TextureFilter::Footprint;
    Blend blend = Blend::Reflectivity;
    bool measuresErrors = true;  // against Embree
    bool showsPictures = false;

    // Each declares the parameters that it is named after.
    void readView(Params& params);
    void readMotionAndSupersampling(Params& params, int defaultSupersampling);
    /// Throws Error for one between -1, which is none, and 0.
    void readGlossiness(Params& params, const std::string& technique);
    void readRoughness(Params& params);
    void readTextureFilter(Params& params);
    void readRays(Params& params);

    /// Throws Error for a scene without triangles, reflectors or the view.
    void requireScene(const scene::Scene& scene) const;
};

/// What a technique of these declares, and beside it what all of them record and time.
config::Outputs withFrameOutputs(config::Outputs own);

/// Made in setup(), with the environment map drawn; all members live as long as it.
struct Frame {
    Frame(technique::SetupContext& context, const FrameSettings& settings);

    /// The eye's view of the samples at a time of 0 … 1.
    kit::View viewAt(double time) const;
    /// Moves the objects to where they are then, where they move.
    void poseAt(double time);
    glm::ivec2 samplesPx() const { return settings.supersampling * outputSizePx; }

    /// The same composite makes a picture of traced rays, so that nothing but the reflections
    /// differs.
    image::ImageF pictureOf(const GBuffer& gbuffer, std::span<const TracedSample> samples);
    /// Records channel_error, channel_error_image, flip_mean and psnr_db. Gives the errors of the
    /// channels over reflective pixels.
    glm::dvec3 recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                            const image::ImageF& picture, const image::ImageF& truth) const;
    /// The picture of marked samples, and the view that it shows.
    void recordMarks(technique::Recorder& recorder, const std::string& name,
                     const HostGBuffer& gbuffer, const image::ImageF& picture,
                     const std::vector<std::uint8_t>& marks) const;

    FrameSettings settings;
    glm::ivec2 outputSizePx;
    ReflectiveScene scene;
    GpuObjects objects;
    EnvironmentMap map;
    Composite composite;
    std::optional<gl::Profiler> untimed;  // of the truth, where errors are measured
    std::optional<EmbreeTracer> truth;
};

/// Of three channels.
double meanOf(const glm::dvec3& channels);

}  // namespace gfxrepro::reflections
