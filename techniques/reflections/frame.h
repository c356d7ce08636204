// What a frame of both chapters is made of: its parameters, the scene on the device, camera and
// poses, the picture and how far it is from the truth.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/image/image.h"
#include "runner/technique/technique.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflections/embree_tracer.h"

namespace gfxrepro::reflections {

/// By what the reflected colour is mixed into the diffuse one.
enum class Blend {
    Reflectivity,  // s, as Algorithm 6 has it
    Fresnel,       // [xie2017] Sec. 5.4.3: by view, normal and s. Which formula is not said: here
                   // Schlick's, s + (1 − s)(1 − cos θ)⁵, s what is reflected head-on
};

/// rgb = LERP(diffuse, reflected, share) a sample; an output pixel is the mean of its
/// `supersampling`² samples.
class Composite {
  public:
    Composite(const gl::ShaderLibrary& shaders, glm::ivec2 outputSizePx, int supersampling,
              Blend blend = Blend::Reflectivity);
    /// `showsReflectionOnly`: the reflected colour alone, black where nothing reflects ([xie2017]
    /// Fig. 30).
    void render(const GBuffer& gbuffer, const ReflectionTarget& reflection,
                bool showsReflectionOnly = false);
    const gl::Texture& output() const { return output_; }  // RGBA16F, linear
    /// Rows from the top, 3 linear channels; waits for the device.
    image::ImageF read() const;
    std::size_t sizeBytes() const;

  private:
    gl::Pass pass_;
    gl::Texture output_;
    gl::Framebuffer framebuffer_;
    kit::WholeImage wholeImage_;
    int supersampling_;
    Blend blend_;
};

/// Output pixels of which a sample reflects, rows from the top as images have them.
std::vector<std::uint8_t> reflectivePixels(const HostGBuffer& gbuffer, int supersampling);

/// A colour a sample, by its index in the G-buffer; averaged to output pixels, rows from the top.
image::ImageF averagedPicture(const HostGBuffer& gbuffer, int supersampling,
                              const std::function<glm::vec3(std::size_t)>& colorOf);

/// Grey, after the luminance of what a sample shows itself: for what a picture is not about.
glm::vec3 dimmed(const HostGBuffer& gbuffer, std::size_t index);

/// Red, yellow, green, cyan, blue, magenta and red again, at turns of 0 to 1.
glm::vec3 hue(float turn);

/// [xie2017] Fig. 27, 28 and 40: `picture`, a little darker, with marked samples red.
image::ImageF markedPicture(const image::ImageF& picture, const std::vector<std::uint8_t>& marks,
                            const HostGBuffer& gbuffer, int supersampling);

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

/// What the truth's rays make of a frame.
struct TracedPicture {
    image::ImageF picture;

    std::size_t sizeBytes() const { return sizeof(float) * picture.values().size(); }
};

/// Made in setup(); all members live as long as it.
struct Frame {
    Frame(technique::SetupContext& context, const FrameSettings& settings);

    /// The eye's view of the samples at a time of 0 … 1.
    kit::View viewAt(double time) const;
    /// Moves the objects to where they are then, where they move.
    void poseAt(double time);
    glm::ivec2 samplesPx() const { return settings.supersampling * outputSizePx; }

    /// Of objects at rest; drawn for the first tracer that asks for it, of whatever case.
    const EnvironmentMap& environmentMap(technique::SetupContext& context);
    /// Builds the truth's tracer for where the objects are. False: it was.
    bool updateTruth();
    /// The same composite makes a picture of traced rays, so that nothing but the reflections
    /// differs.
    image::ImageF pictureOf(const GBuffer& gbuffer, std::span<const TracedSample> samples);
    /// Of the frame at hand; `host` is what `gbuffer` holds.
    TracedPicture traced(const GBuffer& gbuffer, const HostGBuffer& host);
    /// Records channel_error, channel_error_image, display_flip and display_psnr_db. Gives the
    /// errors of the channels over reflective pixels.
    glm::dvec3 recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                            const image::ImageF& picture, const image::ImageF& truth) const;
    /// "result", with what it shows for its EXR file; `truth` may be empty.
    void recordResult(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                      const image::ImageF& picture, const image::ImageF& truth) const;
    /// "truth", "error", and that times `gain` as "error_<gain>".
    void recordTruth(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                     const image::ImageF& picture, const image::ImageF& truth, int gain) const;
    /// "reflection": what is reflected alone.
    void recordReflection(technique::Recorder& recorder, const GBuffer& gbuffer,
                          const ReflectionTarget& target);
    /// The picture of marked samples, and the view that it shows.
    void recordMarks(technique::Recorder& recorder, const std::string& name,
                     const HostGBuffer& gbuffer, const image::ImageF& picture,
                     const std::vector<std::uint8_t>& marks) const;

    FrameSettings settings;
    glm::ivec2 outputSizePx;
    ReflectiveScene scene;
    GpuObjects objects;
    std::shared_ptr<const EnvironmentMap> map;
    Composite composite;
    std::optional<gl::Profiler> untimed;  // of the truth, where errors are measured
    std::optional<EmbreeTracer> truth;
    PoseWatch truthPoses;
};

/// Of three channels.
double meanOf(const glm::dvec3& channels);

}  // namespace gfxrepro::reflections
