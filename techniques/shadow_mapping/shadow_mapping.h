// The technique `shadow_mapping`: chapter 4 of zju2005. See README.md.
#pragma once

#include <optional>
#include <vector>

#include "runner/technique/technique.h"
#include "techniques/shadow_mapping/shaded_view.h"
#include "techniques/shadow_mapping/shadow_truth.h"

namespace gfxrepro::shadow_mapping {

enum class FilterKind { Nearest, Bilinear, Pcf, Pcss, Variance };

enum class LightPlace {
    Orbit,  // around the scene's box
    Scene,  // the scene's own lights
};

struct ShadowMappingParams {
    ShadowMapSettings maps;
    LightKind lightKind = LightKind::Spot;
    LightPlace lightPlace = LightPlace::Orbit;
    int lightCount = 1;
    float lightDistance = 1.2F;  // from the box's centre, in its diagonals
    float azimuthRad = 0.0F;
    float elevationRad = 0.0F;
    float lightSize = 0.0F;  // diameter, in the box's diagonals
    bool isStatic = false;
    bool measuresErrors = false;
    float edgeTexels = 1.5F;
    bool comparesMethods = false;
    bool drawsYardstick = false;
    bool showsPictures = false;

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit ShadowMappingParams(Params& params);

    /// How near a true edge an error counts as one of the edge: edgeTexels and half the filter.
    float edgeReachTexels() const;
};

/// The lights of the parameters for a scene. Throws Error where the scene has too few.
std::vector<Light> makeLights(const ShadowMappingParams& params, const scene::Scene& scene);

/// Throws Error for a light inside of geometry: every ray from it meets a surface from behind.
void requireOutside(const raycast::RayTracer& tracer, const std::vector<Light>& lights);

/// Lights whose maps hold no vertex of the scene.
int lightsWithoutCaster(const std::vector<Light>& lights, const scene::Scene& scene, int sizePx);

/// What shadow rays need to know of a light and its map.
TruthLight truthLight(const Light& light, const scene::Box& bounds, int sizePx);

class ShadowMapping final : public technique::Technique {
  public:
    explicit ShadowMapping(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireScene(const scene::Scene& scene) const override;
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;
    const gl::Texture* frameImage() const override { return &image_->colour; }

  private:
    void recordSteps(technique::Recorder& recorder) const;
    void recordPicture(technique::Recorder& recorder) const;
    void recordErrors(technique::Recorder& recorder, const ShadedImage& image);
    void recordDifference(technique::Recorder& recorder, const ShadedImage& image);

    ShadowMappingParams params_;
    const gl::ShaderLibrary* shaders_ = nullptr;
    std::optional<raycast::RayTracer> tracer_;
    std::optional<kit::DrawableScene> drawable_;
    std::vector<Light> lights_;
    int lightsWithoutCaster_ = 0;
    std::optional<ShadowMapRenderer> maps_;
    std::optional<ShadowMapRenderer> yardstick_;  // depth alone, no bias
    std::optional<ShadedView> shadedView_;
    std::optional<ShadedImage> image_;
};

extern const technique::TechniqueInfo kShadowMapping;

}  // namespace gfxrepro::shadow_mapping
