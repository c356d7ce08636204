// The technique `soft_shadows`: chapter 3 of xie2017. See README.md.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runner/technique/technique.h"
#include "techniques/kit/depth_image_renderer.h"
#include "techniques/soft_shadows/light_visibility.h"
#include "techniques/soft_shadows/shadow_casters.h"
#include "techniques/soft_shadows/shadow_errors.h"

namespace gfxrepro::soft_shadows {

/// What is recorded of the reconstructed meshes.
struct MeshCounts {
    std::uint64_t samples = 0, triangles = 0, bytes = 0;
};

enum class Method {
    Geometry,      // shadow maps of the original geometry: the thesis's truth
    NonRedundant,  // Algorithm 5
    Conventional,
    DepthPeeling,
    RayTraced,  // shadow rays
    Pcss,       // percentage-closer soft shadows
    Variance,   // variance soft shadows
};

enum class Timed {
    SoftShadow,
    DepthAndPass,  // the yardstick: depth-only draws and plain passes
};

struct SoftShadowsParams {
    Method method = Method::NonRedundant;
    kit::Redundancy redundancy = kit::Redundancy::Pixel;  // of non-redundant images
    int referenceImages = 4;
    int referenceSizePx = 1024;
    ReconstructionSettings reconstruction;
    float simplifyTo = 1.0F;             // share of the triangles; 1: as reconstructed
    float simplificationError = 0.001F;  // of the box's diagonal
    std::string view;                    // kit::stillCamera()
    AreaLightSettings light;
    int lightGrid = 16;
    SampleMapSettings shadowMap;
    bool hasGround = true;
    float groundSize = 1.5F;  // side, in diagonals of the box
    Timed measured = Timed::SoftShadow;
    bool measuresErrors = true;
    bool tracesTruth = false;
    bool seesFromLight = false;
    bool showsPictures = false;

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit SoftShadowsParams(Params& params);

    /// Whether shadows come from meshes rebuilt from depth images.
    bool reconstructs() const;
    /// Whether shadows are shares of the light, not samples of it.
    bool isFiltered() const { return method == Method::Pcss || method == Method::Variance; }
};

class SoftShadows final : public technique::Technique {
  public:
    explicit SoftShadows(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireScene(const scene::Scene& scene) const override;
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;
    void recordOnce(technique::Recorder& recorder) override;

  private:
    /// Points that the reference images are taken from: the light's corners, then points inside;
    /// for peeling, its centre again and again.
    std::vector<glm::vec3> referencePoints() const;
    void makeReferenceTargets();
    void renderReferenceImages();
    /// What images i and its H are tested against.
    std::vector<const kit::DepthImage*> earlierOf(std::size_t i) const;
    void renderOffsetImages();
    std::vector<ReconstructedMesh> reconstructMeshes();
    std::unique_ptr<ShadowCaster> makeCaster(std::vector<ReconstructedMesh> meshes,
                                             gl::Profiler& profiler);

    HostVisibilityMask measuredMask() const;
    /// Of the light, whatever casts.
    std::shared_ptr<const HostVisibilityMask> sharedTruth(
        const char* name, const std::function<HostVisibilityMask()>& make) const;
    const HostVisibilityMask& geometryTruth();
    const HostVisibilityMask& tracedTruth();
    void recordPicture(technique::Recorder& recorder);
    void recordErrors(technique::Recorder& recorder, const char* truthName,
                      const HostVisibilityMask& truth);
    void recordMeshes(technique::Recorder& recorder) const;
    void recordLightView(technique::Recorder& recorder, const char* name,
                         const glm::vec3& point) const;

    SoftShadowsParams params_;
    const gl::ShaderLibrary* shaders_ = nullptr;
    technique::SharedResults* shared_ = nullptr;
    scene::Scene scene_;  // with its ground
    AreaLight light_;
    std::optional<kit::DrawableScene> drawable_;
    std::optional<SceneCaster> geometry_;
    std::optional<raycast::RayTracer> tracer_;
    Receivers receivers_;
    HostReceivers hostReceivers_;
    std::optional<LightVisibility> visibility_;
    std::optional<FilteredShadows> filtered_;
    VisibilityMask mask_;
    gl::Texture litShares_;  // of filtered shadows
    std::optional<HostVisibilityMask> tracedMask_;
    std::shared_ptr<const HostVisibilityMask> geometryTruth_, tracedTruth_;

    gl::Buffer triangleNormals_;
    std::optional<kit::DepthImageRenderer> renderer_;
    std::optional<Reconstructor> reconstructor_;
    std::vector<kit::DepthImage> images_;        // I of Algorithm 4
    std::vector<kit::DepthImage> seen_;          // conventional ones, for redundancy by visibility
    std::vector<kit::DepthImage> offsetImages_;  // H, hybrid only
    std::unique_ptr<ShadowCaster> caster_;       // what casts in this method
    MeshCounts meshCounts_;
    float simplificationErrorM_ = 0.0F;
};

extern const technique::TechniqueInfo kSoftShadows;

}  // namespace gfxrepro::soft_shadows
