#include "techniques/reflection_reuse/moved_objects.h"

#include <array>
#include <cstddef>

#include "engine/core/error.h"

namespace gfxrepro::reflection_reuse {

namespace {

/// Boxes grow by this share of the scene's diagonal on all sides: a ray ends on the surface, which
/// often is the box's, give or take rounding.
constexpr float kBoxMargin = 1e-3F;

/// Moved of moved_objects.glsl.
struct Moved {
    glm::vec4 keyCentre;
    glm::vec4 keyHalfSize;
    std::uint32_t object;
    std::uint32_t padding[3];
};
static_assert(offsetof(Moved, object) == 32);
static_assert(sizeof(Moved) == 48);

}  // namespace

MovedObjects::MovedObjects(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx)
    : then_(shaders, {"kit/whole_image.vert.glsl", "reflection_reuse/doubt_moved.frag.glsl"},
            reflections::objectDefines()),
      now_(shaders, {"kit/whole_image.vert.glsl", "reflection_reuse/want_moved.frag.glsl"},
           reflections::objectDefines()),
      doubtful_(gl::Texture::make2D(GL_R8UI, sizePx)),
      framebuffer_(std::array<const gl::Texture*, 1>{&doubtful_}) {}

void MovedObjects::setKeyFrame(const reflections::GpuObjects& objects) {
    keyPoses_.assign(objects.poses().begin(), objects.poses().end());
    keyBounds_.assign(objects.boundsWorld().begin(), objects.boundsWorld().end());
}

bool MovedObjects::find(const reflections::GpuObjects& objects) {
    GFXREPRO_ASSERT_EQ(objects.poses().size(), keyPoses_.size());
    std::vector<Moved> moved;
    for (std::size_t i = 0; i < keyPoses_.size(); ++i) {
        // Without triangles it neither is nor was anywhere.
        if (objects.poses()[i] == keyPoses_[i] || keyBounds_[i].isEmpty()) continue;
        moved.push_back({glm::vec4(keyBounds_[i].centre(), 1.0F),
                         glm::vec4(0.5F * keyBounds_[i].size(), 0.0F),
                         static_cast<std::uint32_t>(i),
                         {}});
    }
    movedCount_ = static_cast<unsigned>(moved.size());
    if (!moved.empty()) moved_ = gl::Buffer::of(moved);
    return !moved.empty();
}

const gl::Texture& MovedObjects::doubtful(const ReflectionDepthImage& key) {
    framebuffer_.bind();
    then_.set("movedCount", movedCount_);
    then_.set("margin", kBoxMargin * key.diagonalM);
    then_.set("missDistance", key.diagonalM);
    then_.use(gl::Resources{{"MovedObjects", moved_}, {"distanceM", key.reflection.distance}}.with(
        key.gbuffer.resourcesFor(then_)));
    wholeImage_.draw();
    return doubtful_;
}

void MovedObjects::want(const reflections::GpuObjects& objects, const reflections::GBuffer& gbuffer,
                        float diagonalM, gl::Texture& wanted) {
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 1>{&wanted});
    framebuffer.bind();
    now_.set("movedCount", movedCount_);
    now_.set("margin", kBoxMargin * diagonalM);
    now_.use(gl::Resources{{"MovedObjects", moved_}}
                 .with(objects.resources())
                 .with(gbuffer.resourcesFor(now_)));
    wholeImage_.draw();
}

std::size_t MovedObjects::sizeBytes() const {
    return doubtful_.sizeBytes() + moved_.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
