#include "techniques/reflection_reuse/pixel_matcher.h"

namespace gfxrepro::reflection_reuse {

Offsets::Offsets(glm::ivec2 sizePx)
    : offset(gl::Texture::make2D(GL_RG16F, sizePx)), steps(gl::Texture::make2D(GL_R8UI, sizePx)) {}

std::size_t Offsets::sizeBytes() const {
    return offset.sizeBytes() + steps.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
