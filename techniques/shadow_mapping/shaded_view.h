// Step 2 of [zju2005] Sec. 4.1: the scene from the camera, lit where the maps say so.
#pragma once

#include <map>

#include "techniques/kit/picture.h"
#include "techniques/kit/view.h"
#include "techniques/shadow_mapping/shadow_map.h"

namespace gfxrepro::shadow_mapping {

/// [zju2005] Sec. 4.2.2: (ambient + diffuse · shadow) · texture + specular · shadow.
struct Lighting {
    glm::vec3 ambient{0.25F};
    float diffuse = 0.75F;
    float specular = 0.2F;
    float shininess = 32.0F;  // exponent of N·H
    glm::vec3 background = kit::kBackground;
};

/// What the camera sees. The measured frame has colour only; the rest is for errors.
struct ShadedImage {
    kit::View view;
    gl::Texture colour;  // RGBA16F, linear
    gl::Texture
        shadowTerms;  // RGBA32F: light i in channel i, 1 lit, 0 in shadow; empty without terms
    gl::Texture positions;  // RGBA32F: world; w 1 where there is a surface
    gl::Texture normals;    // RGBA32F: the triangle's, unit, turned to the eye
    gl::Texture depth;      // DEPTH_COMPONENT32F, window z
    gl::Framebuffer framebuffer;

    bool hasTerms() const { return shadowTerms.id() != 0; }
    std::size_t sizeBytes() const;
};

ShadedImage makeShadedImage(const kit::View& view, bool hasTerms);

class ShadedView {
  public:
    ShadedView(const gl::ShaderLibrary& shaders, const ShadowMapSettings& settings,
               const Lighting& lighting = {});

    /// Draws with the maps as they are: `maps` has the settings that this was made with.
    void render(const kit::DrawableScene& scene, const ShadowMapRenderer& maps,
                ShadedImage& target);

  private:
    struct Variant {
        std::vector<LightKind> kinds;
        bool hasTerms = false;
        bool hasTextures = false;
        bool isAlphaTested = false;
        bool hasFlatParts = false;
        auto operator<=>(const Variant&) const = default;
    };
    const gl::Pass& passFor(const Variant& variant);
    /// Sets all uniforms; gives the maps.
    gl::Resources setUp(const gl::Pass& pass, const ShadowMapRenderer& maps,
                        const kit::View& view) const;

    const gl::ShaderLibrary& shaders_;
    ShadowMapSettings settings_;
    Lighting lighting_;
    StepDeclaration step_;
    std::map<Variant, gl::Pass> passes_;
};

}  // namespace gfxrepro::shadow_mapping
