// Step 1 of [zju2005] Sec. 4.1: the scene's depth as each light sees it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gl/program.h"
#include "techniques/kit/drawable_scene.h"
#include "techniques/kit/whole_image.h"
#include "techniques/shadow_mapping/lights.h"

namespace gfxrepro::shadow_mapping {

// What the two steps of shadow mapping do, as data: sets the GL state and the shaders' defines, and
// is [zju2005] Table 4.3.

/// [zju2005] Sec. 4.2 and 4.3.
enum class Storage {
    Standard,  // a 32-bit float colour target holds window z; compared in the shader
    Hardware,  // a depth texture in compare mode; nothing but depth is written
};

enum class DepthFormat { Unorm16, Unorm24, Float32 };

enum class Filter {
    Nearest,
    Bilinear,  // Standard: four comparisons in the shader; Hardware: one filtered fetch
    Pcf,       // the mean of kFilterTexels² comparisons
    Pcss,      // [Fernando 2005], percentage-closer soft shadows
    Variance,  // [Donnelly and Lauritzen 2006]
};

/// Side of the square of texels that Pcf compares and Variance is blurred over: ours.
constexpr int kFilterTexels = 5;

/// What hides the difference between a surface and its own texels in the map; the slope's is that
/// of one comparison, which Pcf takes over its square.
struct Bias {
    float constant = 0.0F;    // ε of [zju2005] Sec. 4.3, in window z (0 … 1)
    float slopeScale = 0.0F;  // times the caster's steepest change of window z a texel
};

struct ShadowMapSettings {
    Storage storage = Storage::Hardware;
    Filter filter = Filter::Nearest;
    int sizePx = 1024;                          // of a view; a point light's map is 3 × 2 of them
    DepthFormat format = DepthFormat::Unorm24;  // of the depth test; Hardware: of the map
    Bias bias = {};
};

/// One step of a method. Fetches and comparisons are those of one light and fragment, in the
/// shader's code: a comparison that a fetch makes by itself is none.
struct StepDeclaration {
    std::string step;    // "depth map", "blur", "shading"
    std::string target;  // "R32F", "DEPTH24", …
    bool colourWrites = false;
    bool depthWrites = false;
    bool fragmentWork = false;  // the program has a fragment stage
    int fetches = 0;
    int comparisons = 0;

    bool operator==(const StepDeclaration&) const = default;
};

/// The steps in order; the first draws the map, the last shades. Throws Error for settings that
/// contradict each other: Variance in Hardware storage, sizes below 1, bias values that are
/// negative or not finite.
std::vector<StepDeclaration> declaredSteps(const ShadowMapSettings& settings);

/// Masks of colour and depth writes as declared; the depth test is on where depth is written.
void applyState(const StepDeclaration& step);

/// Side of the square of texels that a filter compares: the root of the declared fetches.
int kernelSizeOf(Filter filter);

/// A light's map. Standard: window z in R32F. Hardware: a depth texture (compare mode unless the
/// filter reads depths). Variance: mean depth and mean square, RG32F, depth as a share of near …
/// far along the axis.
struct ShadowMap {
    std::vector<LightView> views;
    gl::Texture colour;   // Standard and Variance
    gl::Texture blurred;  // Variance: between the two blurs
    gl::Texture depth;
    gl::Framebuffer framebuffer;
    gl::Framebuffer blurredFramebuffer;
    gl::Framebuffer colourFramebuffer;  // without depth: the second blur

    /// What step 2 fetches from.
    const gl::Texture& lookup() const { return colour.id() != 0 ? colour : depth; }
    std::size_t sizeBytes() const;
};

class ShadowMapRenderer {
  public:
    /// Throws Error as declaredSteps() does.
    ShadowMapRenderer(const gl::ShaderLibrary& shaders, const ShadowMapSettings& settings);

    /// Draws the maps of all lights. Casters are opaque (alpha is not tested) and not culled.
    /// Throws Error for lights without a view (viewsOf) and for more than kMaxLights,
    /// UnsupportedError for maps beyond the device's limits.
    void render(const kit::DrawableScene& scene, std::span<const Light> lights);

    const ShadowMapSettings& settings() const { return settings_; }
    const std::vector<StepDeclaration>& steps() const { return steps_; }
    const std::vector<Light>& lights() const { return lights_; }
    const std::vector<ShadowMap>& maps() const { return maps_; }
    std::size_t sizeBytes() const;

  private:
    ShadowMap makeMap(glm::ivec2 sizePx) const;
    void drawDepth(const kit::DrawableScene& scene, const ShadowMap& map) const;
    void blur(const ShadowMap& map) const;

    ShadowMapSettings settings_;
    std::vector<StepDeclaration> steps_;
    gl::Program depthProgram_;
    std::optional<gl::Pass> blur_;
    kit::WholeImage wholeImage_;
    std::vector<Light> lights_;
    std::vector<ShadowMap> maps_;
};

}  // namespace gfxrepro::shadow_mapping
