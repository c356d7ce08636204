// The technique `point_splatting`: chapter 3 of zju2005. See README.md.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/point_sampling.h"
#include "runner/technique/technique.h"
#include "techniques/point_splatting/plain_points.h"
#include "techniques/point_splatting/splat_renderer.h"

namespace gfxrepro::point_splatting {

enum class Method {
    Adaptive,  // the thesis's: a filter per patch
    FullEwa,
    Reconstruction,
    LowPass,
    Sprites,      // opaque squares, as QSplat
    PlainPoints,  // one pixel per point
};

/// From where a model is seen: on a turntable, from as far as frames it, or by a camera or along a
/// path of the scene.
struct ViewSettings {
    float distance = 1.0F;  // of the framing camera's
    float rotationRad = 0.0F;
    glm::vec3 lookAt{0.5F};                    // in the model's box
    std::string name = {};                     // of the scene's camera or path; empty: a turntable
    std::optional<glm::vec3> towardsEye = {};  // at no rotation; none: framingCamera()'s own
};

struct PointSplattingParams {
    Method method = Method::Adaptive;
    SplatSettings splats;
    SelectionSettings selection;
    TreeSettings tree;
    ViewSettings view;
    int points = 1'000'000;  // of a surface
    bool keepsModel = true;
    bool measuresErrors = false;
    bool measuresCompression = false;
    bool measuresSpeed = false;
    bool showsPictures = false;

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit PointSplattingParams(Params& params);
};

/// The box seen from `settings.distance` times as far as frames it at no rotation.
scene::Camera turntableCamera(const scene::Box& box, float aspect, const ViewSettings& settings);

/// Linear, multiplied by how much of each pixel is covered.
struct ModelPicture {
    image::ImageF color, coverage;  // of 3 channels and 1

    explicit ModelPicture(const image::ImageF& rgba);
    /// The middle, as much of it as holds what there is, a whole number of times as large: pictures
    /// of one view show the same part. None where twice as large is too large.
    std::optional<image::ImageF> enlarged() const;
};

/// The pixels that one of two pictures covers: means over black would say how much of it there is.
class ModelPixels {
  public:
    ModelPixels(const ModelPicture& a, const ModelPicture& b);
    /// These of an image, in a row; one of black where there are none.
    image::ImageF of(const image::ImageF& image) const;

  private:
    std::vector<std::size_t> pixels_;
};

class PointSplatting final : public technique::Technique {
  public:
    explicit PointSplatting(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireFrames(int /*frameCount*/) const override {}  // along a path
    void requireScene(const scene::Scene& scene) const override;
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;
    void recordOnce(technique::Recorder& recorder) override;
    const gl::Texture* frameImage() const override { return &renderer_->output(); }

  private:
    /// The scene's points, or points of its surface.
    scene::PointCloud takePoints(const scene::Scene& scene);
    scene::Camera cameraAt(int frame, int frameCount) const;
    void draw(gl::Profiler& profiler);
    /// What another way of drawing shows of the last view, `scale` times as large: RGBA.
    image::ImageF drawnWith(const SplatSettings& splats, const SelectionSettings& selection,
                            int scale) const;

    void recordModel(technique::Recorder& recorder) const;
    void recordDrawn(technique::Recorder& recorder) const;
    void recordCompression(technique::Recorder& recorder) const;
    /// The selection alone, without what follows from it: the median of many.
    double selectionMs() const;
    void recordSpeed(technique::Recorder& recorder);
    struct Truth {
        /// All points, uncompressed, by full EWA at many samples a pixel, averaged to pixels.
        ModelPicture boxed;
        ModelPicture filtered;  // as the filter of Eq. (1) has it
        /// By rays, averaged as the first.
        std::optional<ModelPicture> surface;

        std::size_t sizeBytes() const;
    };
    std::shared_ptr<const Truth> truthOfFrame() const;
    void recordModes(technique::Recorder& recorder) const;
    void recordErrors(technique::Recorder& recorder, const ModelPicture& picture,
                      const Truth& truth) const;
    double facingPct() const;

    PointSplattingParams params_;
    std::optional<SourceLocation> pointsAt_;  // of the parameter `points` where given
    const gl::ShaderLibrary* shaders_ = nullptr;
    technique::SharedResults* shared_ = nullptr;
    int frame_ = 0;
    glm::ivec2 sizePx_{0};
    scene::PointRepairs repairs_;
    std::optional<ModelFile> model_;
    double preprocessMs_ = 0.0;
    scene::Box framedBox_;
    scene::Mesh surface_;  // that the points were taken of; empty: not known
    scene::Scene views_;   // the scene's cameras and paths
    std::unique_ptr<PointRenderer> renderer_;
    const SplatRenderer* splats_ = nullptr;  // the same; not of Method::PlainPoints

    PatchView view_;  // of the last frame
    scene::Camera camera_;
    std::vector<DrawnPatch> drawn_;
    SelectionCounts counts_;
};

extern const technique::TechniqueInfo kPointSplatting;

}  // namespace gfxrepro::point_splatting
