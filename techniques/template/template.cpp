#include "techniques/template/template.h"

#include <cmath>
#include <numeric>
#include <optional>

#include "engine/gl/gl.h"
#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/requirements.h"
#include "techniques/kit/view.h"
#include "techniques/kit/whole_image.h"

namespace gfxrepro::template_ {

namespace {

// The methods that are compared: the paper's, its baseline, its ablations.
enum class Method { Gradient, Silhouette };

constexpr Choice<Method> kMethods[] = {
    {Method::Gradient, "gradient", "a horizontal ramp from black to white"},
    {Method::Silhouette, "silhouette", "white where the scene covers a pixel"},
};

class TemplateTechnique : public technique::Technique {
  public:
    // Every parameter is declared here, once: default, meaning, unit and range. No GL, so that
    // `gfxrepro check` validates a config on any machine.
    explicit TemplateTechnique(Params& params)
        : method_(params.getEnum("method", Method::Gradient, kMethods, {"what is drawn"})),
          brightness_(static_cast<float>(
              params.getDouble("brightness", 1.0, {"value of a white pixel", "1", 0.0, 1.0}))),
          hasErrors_(params.getBool("errors", false, {"compares with the truth, on the CPU"})) {
        params.finish();
    }

    // `gfxrepro check` refuses a case without it.
    technique::SceneNeed sceneNeed() const override {
        return method_ == Method::Silhouette ? technique::SceneNeed::Model
                                             : technique::SceneNeed::Nothing;
    }

    // The same, once the scene is read.
    void requireScene(const scene::Scene& scene) const override {
        if (method_ == Method::Silhouette) kit::requireTriangles(scene, "template");
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
        const scene::Scene& scene = *context.scene;
        const float aspect = static_cast<float>(size_.x) / static_cast<float>(size_.y);
        view_ = kit::viewOf(scene::framingCamera(scene.bounds(), aspect), size_);
        mesh_.emplace(scene::flattened(scene));
        if (hasErrors_) rays_.emplace(scene);
        pass_ = gl::Pass(context.shaders,
                         {"template/silhouette.vert.glsl", "template/silhouette.frag.glsl"},
                         gpu_scene::attributeDefines());
    }

    // One measured iteration. Each pass stands in a scope with the paper's step name.
    void render(technique::FrameContext& context) override {
        const gl::GpuScope scope(context.profiler, "draw");
        framebuffer_.bind();
        framebuffer_.clearColour(0, glm::vec4(0.0F));
        glDisable(GL_DEPTH_TEST);  // a pass sets all state that it relies on
        glDisable(GL_CULL_FACE);
        // Buffers and textures are given here by their names in the shaders, such as
        // {{"Areas", areas_}, {"normals", normals_}}: barriers follow, and a missing one is an
        // error.
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
        int wrong = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            wrong += std::abs(values[i] - truth.values()[i]) > kTolerance;
        }
        recorder.share("wrong_pct", wrong, pixels, "pixel");
        // The report lays a truth over the picture that it names.
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
                    method_ == Method::Gradient
                        ? centrePx.x / static_cast<float>(size_.x)
                        : static_cast<float>(rays_->isOccluded(
                              view_.eyeWorld, kit::rayThrough(view_, centrePx), 0.0F, view_.farM));
                truth.at(x, y) = brightness_ * share;
            }
        }
        return truth;
    }

    // Half a level of 8 bits: the device may round the ramp otherwise than the CPU.
    static constexpr float kTolerance = 0.5F / 255.0F;

    Method method_;
    float brightness_;
    bool hasErrors_;

    glm::ivec2 size_{0};
    kit::View view_;
    gl::Texture colour_;
    gl::Framebuffer framebuffer_;
    gl::Pass pass_;
    std::optional<gpu_scene::GpuMesh> mesh_;
    std::optional<raycast::RayTracer> rays_;
    std::optional<kit::WholeImage> wholeImage_;
};

// All that is recorded and timed, in the order in which tables show it; the runner refuses others.
config::Outputs outputs() {
    return {
        {{"mean_brightness", "1", "of all pixels", config::Better::Neither},
         {"wrong_pct", "%", "of all pixels, that are not as in the truth", config::Better::Lower}},
        {{"draw", "the whole picture"}},
        false,
        {"result"}};
}

}  // namespace

const technique::TechniqueInfo kTemplate{
    "template",
    "a technique in miniature: a ramp or a silhouette",
    technique::make<TemplateTechnique>,
    outputs,
};

}  // namespace gfxrepro::template_
