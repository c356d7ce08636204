#include "techniques/template/template.h"

#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/random.h"
#include "engine/gl/gl.h"
#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/kit/draws.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/path_view.h"
#include "techniques/kit/requirements.h"
#include "techniques/kit/view.h"
#include "techniques/kit/whole_image.h"

namespace gfxrepro::template_ {

namespace {

// The methods that are compared: the paper's, its baseline, its ablations.
enum class Method { Gradient, Dither, Silhouette };

constexpr Choice<Method> kMethods[] = {
    {Method::Gradient, "gradient", "a horizontal ramp from black to white"},
    {Method::Dither, "dither", "the ramp in black and white, by random thresholds"},
    {Method::Silhouette, "silhouette", "white where the scene covers a pixel"},
};

/// Side of a work group of shaders/dither.comp.glsl.
constexpr GLuint kGroupSize = 8;

class TemplateTechnique : public technique::Technique {
  public:
    // Every parameter is declared here, once: default, meaning, unit and range. No GL, so that
    // `gfxrepro check` validates a config on any machine.
    explicit TemplateTechnique(Params& params)
        : method_(params.getEnum("method", Method::Gradient, kMethods, {"what is drawn"})),
          brightness_(static_cast<float>(
              params.getDouble("brightness", 1.0, {"value of a white pixel", "1", 0.0, 1.0}))),
          tilePx_(params.getInt("tile", 16, {"side of the dither's thresholds", "px", 1, 256})),
          viewName_(params.getText("view", "", {"a path or a camera of the scene"})),
          hasErrors_(params.getBool("errors", false, {"compares with the truth, on the CPU"})) {
        params.finish();
        // What nothing reads under the method that was chosen is refused, not ignored.
        if (method_ != Method::Dither) params.refuseGiven({"tile"}, "'method: dither'");
        if (method_ != Method::Silhouette) params.refuseGiven({"view"}, "'method: silhouette'");
    }

    // `gfxrepro check` refuses a case without it.
    technique::SceneNeed sceneNeed() const override {
        return method_ == Method::Silhouette ? technique::SceneNeed::Model
                                             : technique::SceneNeed::Nothing;
    }

    // The same, once the scene is read.
    void requireScene(const scene::Scene& scene) const override {
        if (method_ != Method::Silhouette) return;
        kit::requireTriangles(scene, "template");
        (void)kit::cameraFor(scene, viewName_, 0, 1, 1.0F);  // a path or a camera that it has
    }

    // Of several frames: else a config has one.
    void requireFrames(int frameCount) const override {
        if (method_ != Method::Silhouette) Technique::requireFrames(frameCount);
    }

    // Compile, allocate, upload. The runner times it as set-up.
    void setup(technique::SetupContext& context) override {
        size_ = context.outputSizePx;
        colour_ = gl::Texture::make2D(GL_R32F, size_);
        const gl::Texture* attachments[] = {&colour_};
        framebuffer_ = gl::Framebuffer(attachments);
        if (method_ == Method::Gradient) {
            pass_ = gl::Pass(context.shaders,
                             {"kit/whole_image.vert.glsl", "template/gradient.frag.glsl"});
            wholeImage_.emplace();
            return;
        }
        if (method_ == Method::Dither) {
            // An input here, as a texture of noise is. Of samples that a number hangs on,
            // `areRandom` of Outputs is true: then each process may have a seed of its own.
            Random random(context.seed);
            std::vector<float> thresholds(static_cast<std::size_t>(tilePx_ * tilePx_));
            for (float& threshold : thresholds) threshold = random.uniform();
            thresholds_ = gl::Buffer::of(thresholds);
            counts_ = gl::Buffer(sizeof(GLuint));
            pass_ = gl::Pass(
                context.shaders, {"template/dither.comp.glsl"},
                {{"GROUP_SIZE", std::to_string(kGroupSize)}, {"TILE_PX", std::to_string(tilePx_)}});
            return;
        }
        scene_ = context.scene;
        mesh_.emplace(scene::flattened(*scene_));
        if (hasErrors_) rays_.emplace(*scene_);
        pass_ = gl::Pass(context.shaders,
                         {"template/silhouette.vert.glsl", "template/silhouette.frag.glsl"},
                         gpu_scene::attributeDefines());
    }

    // One measured iteration. Each pass stands in a scope with the paper's step name.
    void render(technique::FrameContext& context) override {
        if (method_ == Method::Silhouette) {
            const float aspect = static_cast<float>(size_.x) / static_cast<float>(size_.y);
            view_ = kit::viewOf(
                kit::cameraFor(*scene_, viewName_, context.frame, context.frameCount, aspect),
                size_);
        }
        const gl::GpuScope scope(context.profiler, "draw");
        if (method_ == Method::Dither) {
            counts_.clear();
            pass_.set("brightness", brightness_);
            // Buffers and textures go by their names in the shader: barriers follow, and a missing
            // one is an error.
            pass_.dispatch(
                {kit::groupsFor(size_.x, kGroupSize), kit::groupsFor(size_.y, kGroupSize), 1},
                {{"picture", colour_}, {"Thresholds", thresholds_}, {"Counts", counts_}});
            return;
        }
        framebuffer_.bind();
        framebuffer_.clearColour(0, glm::vec4(0.0F));
        glDisable(GL_DEPTH_TEST);  // a pass sets all state that it relies on
        glDisable(GL_CULL_FACE);
        pass_.use({});
        pass_.set("brightness", brightness_);
        if (method_ == Method::Gradient) {
            pass_.set("widthPx", static_cast<float>(size_.x));
            wholeImage_->draw();
        } else {
            pass_.set("clipFromWorld", view_.clipFromWorld());
            mesh_->draw();
        }
    }

    // Read back and report what is had at once, in every process: metrics with their units.
    void record(technique::Recorder& recorder) override {
        const image::ImageF image = colour_.readImage(1);
        const auto values = image.values();
        const double sum = std::accumulate(values.begin(), values.end(), 0.0);
        recorder.metric("mean_brightness", sum / static_cast<double>(values.size()));
        if (method_ == Method::Dither) {
            recorder.metric("white_pixels", counts_.read<GLuint>(1).front(), "draw");
        }
    }

    // Where the picture is the same it has the same errors: images, and what is made of them.
    void recordOnce(technique::Recorder& recorder) override {
        const image::ImageF image = colour_.readImage(1);
        const auto values = image.values();
        const auto pixels = static_cast<double>(values.size());
        const bool hasView = method_ == Method::Silhouette;
        recorder.image("result", image, hasView ? kit::seenFrom(view_) : technique::ImageOptions{});
        if (!hasErrors_) return;
        const image::ImageF truth = this->truth();
        if (method_ != Method::Dither) {  // whose pixels are black or white
            int wrong = 0;
            for (std::size_t i = 0; i < values.size(); ++i) {
                wrong += std::abs(values[i] - truth.values()[i]) > kTolerance;
            }
            recorder.share("wrong_pct", wrong, pixels, "pixel");
        }
        // The report lays a truth over the picture that it names, and the runner takes its errors:
        // it stands in `withTruth` of outputs().
        technique::ImageOptions options =
            hasView ? kit::seenFrom(view_) : technique::ImageOptions{};
        options.truthOf = "result";
        recorder.image("truth", truth, options);
    }

  private:
    /// What the picture should be: the ramp's formula at pixel centres, or the pixels whose ray
    /// through their centre meets the scene. Rows from the top, as images have them.
    image::ImageF truth() const {
        image::ImageF truth(size_.x, size_.y, 1);
        for (int y = 0; y < size_.y; ++y) {
            for (int x = 0; x < size_.x; ++x) {
                const glm::vec2 centrePx(static_cast<float>(x) + 0.5F,
                                         static_cast<float>(size_.y - y) - 0.5F);
                const float share =
                    method_ == Method::Silhouette
                        ? static_cast<float>(rays_->isOccluded(
                              view_.eyeWorld, kit::rayThrough(view_, centrePx), 0.0F, view_.farM))
                        : centrePx.x / static_cast<float>(size_.x);
                truth.at(x, y) = brightness_ * share;
            }
        }
        return truth;
    }

    // Half a level of 8 bits: the device may round the ramp otherwise than the CPU.
    static constexpr float kTolerance = 0.5F / 255.0F;

    Method method_;
    float brightness_;
    int tilePx_;
    std::string viewName_;
    bool hasErrors_;

    glm::ivec2 size_{0};
    const scene::Scene* scene_ = nullptr;
    kit::View view_;
    gl::Texture colour_;
    gl::Framebuffer framebuffer_;
    gl::Pass pass_;
    gl::Buffer thresholds_, counts_;
    std::optional<gpu_scene::GpuMesh> mesh_;
    std::optional<raycast::RayTracer> rays_;
    std::optional<kit::WholeImage> wholeImage_;
};

// All that is recorded and timed, in the order in which tables show it; the runner refuses others.
config::Outputs outputs() {
    config::Outputs outputs;
    outputs.metrics = {
        {"mean_brightness", "1", "of all pixels", config::Better::Neither},
        {"white_pixels", "pixel", "as the shader counts them", config::Better::Neither},
        {"wrong_pct", "%", "of all pixels, that are not as in the truth", config::Better::Lower}};
    outputs.passes = {{"draw", "the whole picture"}};
    outputs.withTruth = {"result"};
    outputs.ofPasses = {"white_pixels"};
    return outputs;
}

}  // namespace

const technique::TechniqueInfo kTemplate{
    "template",
    "a technique in miniature: a ramp, dithered or not, or a silhouette",
    technique::make<TemplateTechnique>,
    outputs,
};

}  // namespace gfxrepro::template_
