#include "techniques/reflections/composite.h"

#include <array>

#include "engine/core/error.h"

namespace gfxrepro::reflections {

Composite::Composite(const gl::ShaderLibrary& shaders, glm::ivec2 outputSizePx, int supersampling,
                     Blend blend)
    : pass_(shaders, {"kit/whole_image.vert.glsl", "reflections/composite.frag.glsl"}),
      output_(gl::Texture::make2D(GL_RGBA16F, outputSizePx)),
      framebuffer_(std::array<const gl::Texture*, 1>{&output_}),
      supersampling_(supersampling),
      blend_(blend) {
    GFXREPRO_ASSERT(supersampling >= 1);
}

void Composite::render(const GBuffer& gbuffer, const ReflectionTarget& reflection,
                       bool showsReflectionOnly) {
    const glm::ivec2 sizePx = glm::ivec2(output_.size()) * supersampling_;
    GFXREPRO_ASSERT(gbuffer.view.sizePx == sizePx);
    GFXREPRO_ASSERT(glm::ivec2(reflection.radiance.size()) == sizePx);
    pass_.set("supersampling", supersampling_);
    pass_.set("showsReflectionOnly", showsReflectionOnly ? 1 : 0);
    pass_.set("hasFresnel", blend_ == Blend::Fresnel ? 1 : 0);
    pass_.use(gl::Resources{{"reflected", reflection.radiance}}.with(gbuffer.resourcesFor(pass_)));
    framebuffer_.bind();
    wholeImage_.draw();
}

image::ImageF Composite::read() const {
    return output_.readImage(3);
}

std::size_t Composite::sizeBytes() const {
    return output_.sizeBytes();
}

}  // namespace gfxrepro::reflections
