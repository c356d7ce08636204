// The technique `terrain_tessellation`: zhang2012. See README.md.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "runner/technique/technique.h"
#include "techniques/terrain_tessellation/patch_checks.h"
#include "techniques/terrain_tessellation/terrain_measures.h"
#include "techniques/terrain_tessellation/terrain_renderer.h"
#include "techniques/terrain_tessellation/terrain_views.h"
#include "techniques/terrain_tessellation/tile_selection.h"

namespace gfxrepro::terrain_tessellation {

enum class Method {
    Adaptive,     // the paper's
    Patches,      // the patches as they reach the GPU, two triangles each
    UniformGrid,  // every sample: the truth
    Cdlod,        // morphing grids, no tessellation
};

enum class Culling {
    None,
    Tile,
    TileAndPatch,
};

struct TerrainTessellationParams {
    Method method = Method::Adaptive;
    Culling culling = Culling::TileAndPatch;
    RenderSettings render;
    MetadataSettings metadata;
    float maxTileErrorPx = 1.0F;  // τ
    std::size_t heightBudgetBytes = 0;
    std::string view = "valley";
    bool keepsMetadata = true;
    bool measuresErrors = false;
    bool checksSeams = false;
    bool drawsYardstick = false;
    bool showsPictures = false;
    int supersampling = 1;  // of pictures and errors, along each axis

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit TerrainTessellationParams(Params& params);
};

class TerrainTessellation final : public technique::Technique {
  public:
    explicit TerrainTessellation(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::HeightMap; }
    void requireFrames(int /*frameCount*/) const override {}  // along a path
    void requireScene(const scene::Scene& scene) const override;
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;
    void recordOnce(technique::Recorder& recorder) override;
    const gl::Texture* frameImage() const override { return &target_->colour; }

  private:
    /// Colour and depth that the terrain is drawn into.
    struct Target {
        gl::Texture colour, depth;
        gl::Framebuffer framebuffer;

        explicit Target(glm::ivec2 sizePx);
        void clear() const;
    };
    /// What a target shows, on the host.
    struct Drawn {
        image::ImageF picture;
        DepthMap depths;       // of all that is drawn
        DepthMap upperDepths;  // the underside as if it were background
        std::size_t undersidePixels = 0;
    };
    /// The frame in full resolution.
    struct Truth {
        Drawn drawn;
        image::ImageF picture;  // averaged to output pixels

        std::size_t sizeBytes() const;
    };

    /// The tiles of the last view.
    TileSelection selectTiles() const;
    /// Every visible tile in full resolution.
    TileSelection selectAll() const;
    MorphRanges morphRanges() const;
    void draw(Method method, const TileSelection& selection, const kit::View& view,
              const Target& target);
    /// The frame again, `params_.supersampling` times as large, with the tiles and the factors that
    /// it was drawn with; with the underside of terrain, which frames cull, or without.
    Drawn drawnAgain(Method method, const TileSelection& selection, bool showsUnderside);

    std::shared_ptr<const Truth> truthOfFrame();

    void recordDrawn(technique::Recorder& recorder);
    void recordFactors(technique::Recorder& recorder);
    void recordNetRate(technique::Recorder& recorder, const DrawCounts& counts, double drawS);
    void recordSeams(technique::Recorder& recorder, std::span<const PatchFactors> drawn);
    void recordCulling(technique::Recorder& recorder);
    void recordErrors(technique::Recorder& recorder, const Drawn& drawn, const Truth& truth);

    TerrainTessellationParams params_;
    const scene::Scene* scene_ = nullptr;
    glm::ivec2 sizePx_{0};
    double preprocessMs_ = 0.0;
    const gl::ShaderLibrary* shaders_ = nullptr;
    technique::SharedResults* shared_ = nullptr;
    const gl::DeviceInfo* device_ = nullptr;
    std::optional<TerrainMetadata> metadata_;
    std::optional<TileTree> tree_;
    std::optional<TerrainView> camera_;
    std::optional<DeviceTerrain> terrain_;
    gl::Texture colourMap_;  // of `shading: colour_map` and `generated_map`
    std::optional<TerrainRenderer> renderer_;
    std::optional<TerrainRenderer> yardstick_;  // patches as they come
    std::optional<Target> target_;

    int frameCount_ = 0;
    kit::View view_;  // of the last frame
    TileView tileView_;
    TileSelection selection_;
    std::optional<gl::Profiler> drawTime_;  // of its draw alone: nothing is waited for in a frame
    std::uint64_t loadedTiles_ = 0;         // for the last frame
};

extern const technique::TechniqueInfo kTerrainTessellation;

}  // namespace gfxrepro::terrain_tessellation
