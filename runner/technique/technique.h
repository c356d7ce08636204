// The contract between the runner and a technique.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/params.h"
#include "engine/gl/device.h"
#include "engine/gl/objects.h"
#include "engine/gl/profiler.h"
#include "engine/gl/program.h"
#include "engine/image/exr_io.h"
#include "engine/scene/scene.h"
#include "runner/config/outputs.h"
#include "runner/technique/shared_results.h"

namespace gfxrepro::technique {

/// Loads scenes by catalogue name or path and keeps them for later cases of the same worker.
class SceneProvider {
  public:
    virtual ~SceneProvider() = default;
    /// The reference lives as long as the case. Throws Error as scene::Catalog does.
    virtual const scene::Scene& load(const std::string& reference) = 0;
};

/// What setup() may use; references live as long as the technique.
struct SetupContext {
    gl::Device& device;
    const gl::ShaderLibrary& shaders;
    SceneProvider& scenes;
    const scene::Scene* scene;  // the case's scene; null when its config names none
    glm::ivec2 outputSizePx;
    std::uint64_t seed;
    gl::Profiler& profiler;
    /// For files that go when the run ends; it need not exist. What one case leaves there others of
    /// the run find.
    std::filesystem::path scratchFolder = {};
    /// Null where each case makes its own: in the timing lane.
    SharedResults* shared = nullptr;
};

/// One measured iteration: frame `frame` of `frameCount`, repeated.
struct FrameContext {
    int frame;
    int frameCount;
    gl::Profiler& profiler;
};

/// The view that an image shows.
struct ImageCamera {
    glm::mat4 viewFromWorld{1.0F};  // looks along −z
    glm::mat4 clipFromView{1.0F};   // x and y from −w to w, y upwards
    float nearM = 0.0F;             // eye distance along the view axis
    float farM = 0.0F;
};

/// What a technique may say of an image besides its pixels.
struct ImageOptions {
    /// The image of the same frame that this one is the truth of: the report shows one on the
    /// other.
    std::string truthOf = {};
    std::optional<ImageCamera> camera = {};
    /// Further channels of the same size, for the EXR file alone: "Z", "N.X", "id", "error.R". Its
    /// attributes go into the file, too.
    image::ExrImage layers = {};
    /// In whose values its errors are taken; null: the image itself. A program's PNG is compared as
    /// it is stored.
    const image::ImageF* stored = nullptr;
};

/// Takes what a technique has to report of the last iteration.
class Recorder {
  public:
    virtual ~Recorder() = default;
    /// `metric` and `pass` as the technique declares them (TechniqueInfo::outputs). A metric may be
    /// given once a pass and frame. `unit`: of what a share is of, which alone is not declared, or
    /// as a program says it; else it is the declared one.
    virtual void metric(std::string_view metric, double value, std::string_view pass = "",
                        std::optional<std::string_view> unit = {}) = 0;
    /// `part` of `whole` as the percentage `metric` ("redundant_pct"), with `whole` as
    /// <metric>_of, from which the report knows how far the share is certain. A share of nothing is
    /// not recorded.
    void share(std::string_view metric, double part, double whole, std::string_view unit,
               std::string_view pass = "");
    /// An image that has a truth (Outputs::withTruth) gets its errors (config::pictureErrors()).
    /// Saved as images/<case>-<name>.exr, with a PNG beside it for the report (linear, shown as
    /// sRGB). 1 to 4 channels.
    virtual void image(std::string_view name, const image::ImageF& image,
                       const ImageOptions& options = {}) = 0;
};

/// A program that had a technique's work to do died of a signal (status `crash`).
class CrashError : public Error {
    using Error::Error;
};

/// … or was killed as the system ran out of memory (status `oom`).
class OutOfMemoryError : public Error {
    using Error::Error;
};

/// A model has triangles or points.
enum class SceneNeed { Nothing, Model, HeightMap };

/// What other processes took, in which a technique has its work done.
struct ProcessUsage {
    double processTimeMs = 0.0;  // CPU time, user and system, in the last render()
    long long peakBytes = 0;     // most that one of them held at once, in all render() so far
    double onceS = 0.0;          // of its time, for what is made once in a run: truths
};

/// A method under measurement with its competitors. Life: constructor (parameters only, no GL) →
/// requireScene → setup → render, repeatedly → record and recordOnce, after the last repeat of a
/// frame. Errors are thrown.
class Technique {
  public:
    virtual ~Technique() = default;
    virtual void setup(SetupContext& context) = 0;
    /// The passes in the paper's order, each in a GpuScope or CpuScope with the paper's step name.
    virtual void render(FrameContext& context) = 0;
    /// What is had at once, and times: of every process of a case.
    virtual void record(Recorder& recorder) = 0;
    /// Pictures, their errors and whatever else takes long and is the same in each process: of the
    /// first of them alone, and of one that drew another picture or has another seed.
    virtual void recordOnce(Recorder& /*recorder*/) {}
    /// What tells whether another process would record the same once; empty where frameImage()
    /// does, or nothing.
    virtual std::string pictureDigest() const { return ""; }
    /// The 2D colour texture (floating point or normalized) that render() left, if there is one: a
    /// blank picture, or one that changes between repeats of a frame, voids their times.
    virtual const gl::Texture* frameImage() const { return nullptr; }
    /// What it asks of the case's scene: known without a device.
    virtual SceneNeed sceneNeed() const { return SceneNeed::Nothing; }
    /// Throws Error for a scene that it cannot take: the case's, or one that a parameter names
    /// (isSceneKey). Known without a device.
    virtual void requireScene(const scene::Scene& /*scene*/) const {}
    /// Throws Error for more frames than it has: one, unless it says otherwise. Known without a
    /// device.
    virtual void requireFrames(int frameCount) const;
    /// Of one that does not work in this process: recorded instead of what this one took.
    virtual std::optional<ProcessUsage> usageElsewhere() const { return std::nullopt; }
    // Of one with a FileCommand.
    /// Throws Error for a file that writeFile() does not write. Known without a device.
    virtual void requireFile(const std::filesystem::path& /*path*/) const {}
    /// Writes what the last render() made of the scene, and returns what there is to say of it.
    virtual std::vector<std::string> writeFile(const std::filesystem::path& /*path*/) { return {}; }
};

/// A command that a technique brings, `gfxrepro NAME SCENE --out FILE`: what it makes of a scene,
/// as a file.
struct FileCommand {
    std::string_view name;
    std::string_view doc;
    std::string_view files;                     // ".npy, .vox or .binvox"
    std::string_view example;                   // a command line
    std::span<const std::string_view> options;  // parameters of the technique
    /// Values of others.
    std::span<const std::pair<std::string_view, std::string_view>> fixed = {};
};

/// What `create` of a TechniqueInfo is.
template <class Own>
std::unique_ptr<Technique> make(Params& params) {
    return std::make_unique<Own>(params);
}

struct TechniqueInfo {
    std::string_view name;
    std::string_view summary;
    /// Null where `createFrom` is not.
    std::unique_ptr<Technique> (*create)(Params& params);
    /// All that record() may give and render() may scope, and setup() where it is said so: nothing
    /// else can be recorded.
    config::Outputs (*outputs)();
    /// Of a technique that is made of a program, as `program` of its config says
    /// (config/external_program.h): what that declares comes to parameters and outputs.
    std::unique_ptr<Technique> (*createFrom)(const Node& program, Params& params) = nullptr;
    /// Its setup() may draw nothing: the device may be none.
    bool isOnCpu = false;
    const FileCommand* fileCommand = nullptr;
};

/// The technique with the program of its config, null for none. Throws Error where it takes one and
/// there is none, or the other way about, and as its constructor does.
std::unique_ptr<Technique> makeTechnique(const TechniqueInfo& info, const Node& program,
                                         Params& params);

/// requireScene() and setup(). Throws Error where the technique needs a scene and the case has
/// none.
void setUp(Technique& technique, SetupContext& context);

/// Whether cases of the technique open a device.
bool needsDevice(const TechniqueInfo& info, const Node& program);

/// What the runner records of every case, whatever the technique.
std::span<const config::MetricInfo> commonMetrics();

/// What a case of the technique records: that, its own, and what its program says. Throws Error
/// where the program declares a metric that is recorded anyway.
config::Outputs outputsOf(const TechniqueInfo& technique, const Node& program = {});

/// Every technique, from techniques/registry.cpp.
std::span<const TechniqueInfo> registeredTechniques();

/// Throws Error with the nearest name when there is none of that name.
const TechniqueInfo& findTechnique(std::span<const TechniqueInfo> techniques, std::string_view name,
                                   const SourceLocation& where);

}  // namespace gfxrepro::technique
