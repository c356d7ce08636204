#include "techniques/shadow_mapping/shaded_view.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"

namespace gfxrepro::shadow_mapping {
namespace {

bool looksUpInVertices(const std::vector<LightKind>& kinds) {
    // A cube's face differs from fragment to fragment.
    for (const LightKind kind : kinds) {
        if (kind == LightKind::Point) return false;
    }
    return !kinds.empty();
}

glm::vec4 placeOf(const Light& light) {
    return light.kind == LightKind::Directional
               ? glm::vec4(-glm::normalize(light.directionWorld), 0.0F)
               : glm::vec4(light.positionWorld, 1.0F);
}

/// Element `index` of a uniform array, where the shader reads it.
template <class T>
void setElement(const gl::Program& program, const char* name, std::size_t index, const T& value) {
    program.setIfActive(fmt::format("{}[{}]", name, index).c_str(), value);
}

}  // namespace

std::size_t ShadedImage::sizeBytes() const {
    return colour.sizeBytes() + shadowTerms.sizeBytes() + positions.sizeBytes() +
           normals.sizeBytes() + depth.sizeBytes();
}

ShadedImage makeShadedImage(const kit::View& view, bool hasTerms) {
    ShadedImage image;
    image.view = view;
    image.colour = gl::Texture::make2D(GL_RGBA16F, view.sizePx);
    image.depth = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, view.sizePx);
    std::vector<const gl::Texture*> targets{&image.colour};
    if (hasTerms) {
        for (gl::Texture* texture : {&image.shadowTerms, &image.positions, &image.normals}) {
            *texture = gl::Texture::make2D(GL_RGBA32F, view.sizePx);
            targets.push_back(texture);
        }
    }
    image.framebuffer = gl::Framebuffer(targets, &image.depth);
    return image;
}

ShadedView::ShadedView(const gl::ShaderLibrary& shaders, const ShadowMapSettings& settings,
                       const Lighting& lighting)
    : shaders_(shaders),
      settings_(settings),
      lighting_(lighting),
      step_(declaredSteps(settings).back()) {}

const gl::Pass& ShadedView::passFor(const Variant& variant) {
    const auto found = passes_.find(variant);
    if (found != passes_.end()) return found->second;
    int viewCount = 0;
    int pointLights = 0;  // a bit each
    for (std::size_t i = 0; i < variant.kinds.size(); ++i) {
        const glm::ivec2 tiles = tileCountOf(variant.kinds[i]);
        viewCount += tiles.x * tiles.y;
        if (variant.kinds[i] == LightKind::Point) pointLights |= 1 << i;
    }
    gl::Defines defines = gpu_scene::attributeDefines();
    defines["LIGHT_COUNT"] = static_cast<int>(variant.kinds.size());
    defines["VIEW_COUNT"] = viewCount;
    defines["POINT_LIGHTS"] = pointLights;
    defines["LOOKUP_IN_VERTEX"] = looksUpInVertices(variant.kinds) ? 1 : 0;
    defines["COMPARES_IN_SHADER"] = step_.comparisons > 0 ? 1 : 0;
    defines["KERNEL"] = kernelSizeOf(settings_.filter);
    defines["FILTER"] = static_cast<int>(settings_.filter);
    defines["kFilterNearest"] = static_cast<int>(Filter::Nearest);
    defines["kFilterBilinear"] = static_cast<int>(Filter::Bilinear);
    defines["kFilterPcss"] = static_cast<int>(Filter::Pcss);
    defines["kFilterVariance"] = static_cast<int>(Filter::Variance);
    defines["TERMS"] = variant.hasTerms ? 1 : 0;
    defines["TEXTURES"] = variant.hasTextures ? 1 : 0;
    defines["ALPHA_TEST"] = variant.isAlphaTested ? 1 : 0;
    defines["FLAT_PARTS"] = variant.hasFlatParts ? 1 : 0;
    return passes_
        .emplace(variant, gl::Pass(shaders_,
                                   {"shadow_mapping/shaded_view.vert.glsl",
                                    "shadow_mapping/shaded_view.frag.glsl"},
                                   defines))
        .first->second;
}

gl::Resources ShadedView::setUp(const gl::Pass& pass, const ShadowMapRenderer& maps,
                                const kit::View& view) const {
    pass.setIfActive("clipFromWorld", view.clipFromWorld());
    pass.setIfActive("eyeWorld", view.eyeWorld);
    pass.setIfActive("ambient", lighting_.ambient);
    pass.setIfActive("diffuse", lighting_.diffuse);
    pass.setIfActive("specular", lighting_.specular);
    pass.setIfActive("shininess", lighting_.shininess);
    pass.setIfActive("epsilon", settings_.bias.constant);
    gl::Resources lookups{};
    std::size_t firstView = 0;
    for (std::size_t i = 0; i < maps.maps().size(); ++i) {
        const ShadowMap& map = maps.maps()[i];
        const Light& light = maps.lights()[i];
        setElement(pass, "lightPlaces", i, placeOf(light));
        setElement(pass, "lightColors", i, light.color);
        setElement(pass, "lightSizes", i, light.size);
        setElement(pass, "firstViews", i, static_cast<int>(firstView));
        lookups.add({fmt::format("shadowMaps[{}]", i), map.lookup()});
        for (std::size_t j = 0; j < map.views.size(); ++j) {
            const LightView& from = map.views[j];
            const glm::ivec2 last = from.tilePx + from.tileSizePx - 1;
            setElement(pass, "lookupFromWorld", firstView + j,
                       from.lookupFromWorld(glm::ivec2(map.depth.size())));
            setElement(pass, "tiles", firstView + j, glm::vec4(from.tilePx, last));
            setElement(pass, "planes", firstView + j,
                       glm::vec4(from.nearM, from.farM, from.texelPerDistance, from.isPerspective));
        }
        firstView += map.views.size();
    }
    return lookups;
}

void ShadedView::render(const kit::DrawableScene& scene, const ShadowMapRenderer& maps,
                        ShadedImage& target) {
    GFXREPRO_ASSERT(maps.steps().back() == step_);
    Variant variant{
        {}, target.hasTerms(), scene.hasTextures(), scene.isAlphaTested(), scene.hasFlatParts()};
    for (const Light& light : maps.lights()) variant.kinds.push_back(light.kind);
    const gl::Pass& pass = passFor(variant);
    applyState(step_);
    target.framebuffer.bind();
    target.framebuffer.clearColour(0, glm::vec4(lighting_.background, 1.0F));
    if (target.hasTerms()) {
        target.framebuffer.clearColour(1, glm::vec4(1.0F));  // where nothing is, nothing is shaded
        target.framebuffer.clearColour(2, glm::vec4(0.0F));
        target.framebuffer.clearColour(3, glm::vec4(0.0F));
    }
    target.framebuffer.clearDepth(1.0F);
    scene.draw(pass, setUp(pass, maps, target.view));
}

}  // namespace gfxrepro::shadow_mapping
