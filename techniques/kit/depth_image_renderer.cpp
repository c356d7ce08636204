#include "techniques/kit/depth_image_renderer.h"

#include <fmt/format.h>

#include <array>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::kit {
namespace {

GLenum glFormatOf(DepthFormat format) {
    return format == DepthFormat::Unorm24 ? GL_DEPTH_COMPONENT24 : GL_DEPTH_COMPONENT32F;
}

}  // namespace

std::vector<const DepthImage*> firstOf(const std::vector<DepthImage>& images, std::size_t count) {
    std::vector<const DepthImage*> pointers;
    for (std::size_t i = 0; i < count; ++i) pointers.push_back(&images[i]);
    return pointers;
}

DepthImage::DepthImage(const View& imageView, DepthFormat format)
    : view(imageView),
      shading(gl::Texture::make2D(GL_RGBA8, imageView.sizePx)),
      depth(gl::Texture::make2D(GL_R32F, imageView.sizePx)),
      triangleId(gl::Texture::make2D(GL_R32UI, imageView.sizePx)),
      depthBuffer(gl::Texture::make2D(glFormatOf(format), imageView.sizePx)),
      framebuffer(std::array<const gl::Texture*, 3>{&shading, &depth, &triangleId}, &depthBuffer) {}

std::size_t DepthImage::sizeBytes() const {
    return shading.sizeBytes() + depth.sizeBytes() + triangleId.sizeBytes() +
           depthBuffer.sizeBytes();
}

HostDepthImage readDepthImage(const DepthImage& image) {
    HostDepthImage host;
    host.view = image.view;
    host.shading = image.shading.read<glm::u8vec4>(GL_RGBA, GL_UNSIGNED_BYTE, 1);
    host.depthM = image.depth.read<float>(GL_RED, GL_FLOAT, 1);
    host.triangleId = image.triangleId.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
    return host;
}

image::ImageF shadingPicture(const HostDepthImage& image, const glm::vec3& background) {
    return pictureOf(image.view.sizePx, [&](std::size_t pixel) {
        return image.triangleId[pixel] != 0 ? glm::vec3(image.shading[pixel]) / 255.0F : background;
    });
}

namespace {

/// Outputs in the order of the framebuffer's attachments.
enum Target { kShadingTarget = 0, kDepthTarget = 1, kTriangleIdTarget = 2 };

bool isReversed(DepthFormat format) {
    return format == DepthFormat::ReversedFloat32;
}

/// The view's projection; reversed, with clip z from w (near) to 0 (far). That row is built from
/// the planes: taken from the other projection, it would have that one's rounding errors, which are
/// what reversing is to avoid.
glm::mat4 clipFromView(const View& view, DepthFormat format) {
    glm::mat4 clip = view.clipFromView;
    if (!isReversed(format)) return clip;
    const float range = view.farM - view.nearM;
    clip[0].z = 0.0F;
    clip[1].z = 0.0F;
    clip[2].z = view.nearM / range;
    clip[3].z = view.farM * view.nearM / range;
    return clip;
}

/// From (x·d, y·d, d, 1) of a view's pixels to view space.
glm::mat4 viewFromPixels(const View& view) {
    View own = view;
    own.viewFromWorld = glm::mat4(1.0F);
    return worldFromPixels(own);
}

void clear(const DepthImage& target, DepthFormat format, bool isShaded) {
    constexpr GLuint kNoTriangle[4] = {};
    if (isShaded) target.framebuffer.clearColour(kShadingTarget, glm::vec4(0.0F));
    target.framebuffer.clearColour(kDepthTarget, glm::vec4(0.0F));
    glClearNamedFramebufferuiv(target.framebuffer.id(), GL_COLOR, kTriangleIdTarget, kNoTriangle);
    target.framebuffer.clearDepth(isReversed(format) ? 0.0F : 1.0F);
}

/// What [xie2017] Algorithms 2 and 3 read of the earlier images.
gl::Resources earlierImages(const gl::Pass& pass, const View& view,
                            std::span<const DepthImage* const> earlier, Redundancy redundancy) {
    gl::Resources images{};
    for (std::size_t j = 0; j < earlier.size(); ++j) {
        const DepthImage& image = *earlier[j];
        if (redundancy == Redundancy::Visibility) {
            images.add({fmt::format("earlierDepths[{}]", j), image.depth});
            pass.set(fmt::format("earlierFootprintPerDepth[{}]", j).c_str(),
                     footprintPerDepth(image.view));
        } else {
            images.add({fmt::format("earlierIds[{}]", j), image.triangleId});
        }
        pass.set(fmt::format("earlierFromHere[{}]", j).c_str(), reprojection(view, image.view));
        pass.set(fmt::format("earlierSizePx[{}]", j).c_str(), glm::vec2(image.view.sizePx));
    }
    return images;
}

}  // namespace

DepthImageRenderer::DepthImageRenderer(const gl::ShaderLibrary& shaders, TriangleIds ids,
                                       DepthFormat format)
    : shaders_(shaders), ids_(ids), format_(format) {}

const gl::Pass& DepthImageRenderer::passFor(const Variant& variant) {
    const auto found = passes_.find(variant);
    if (found != passes_.end()) return found->second;
    const bool hasGeometryStage = ids_ == TriangleIds::GeometryShader;
    gl::Defines defines = gpu_scene::attributeDefines();
    defines["ALPHA_TEST"] = variant.isAlphaTested ? 1 : 0;
    defines["EARLIER_COUNT"] = variant.earlierCount;
    defines["FLAT_PARTS"] = variant.hasFlatParts && variant.isShaded ? 1 : 0;
    defines["GEOMETRY_STAGE"] = hasGeometryStage ? 1 : 0;
    defines["SHADED"] = variant.isShaded ? 1 : 0;
    defines["TEXTURES"] = variant.hasTextures ? 1 : 0;
    defines["VISIBILITY_TEST"] = variant.redundancy == Redundancy::Visibility ? 1 : 0;
    defines["kDepthTarget"] = kDepthTarget;
    defines["kShadingTarget"] = kShadingTarget;
    defines["kTriangleIdTarget"] = kTriangleIdTarget;
    std::vector<std::string> files = {"kit/depth_image.vert.glsl", "kit/depth_image.frag.glsl"};
    if (hasGeometryStage) files.push_back("kit/depth_image.geom.glsl");
    return passes_.emplace(variant, gl::Pass(shaders_, files, defines)).first->second;
}

void DepthImageRenderer::render(const DrawableScene& scene, DepthImage& target,
                                std::span<const DepthImage* const> earlier, Redundancy redundancy,
                                Content content) {
    GFXREPRO_ASSERT(earlier.size() <= kMaxEarlierImages);
    const View& view = target.view;
    const bool isShaded = content == Content::All;
    const gl::Pass& pass =
        passFor({static_cast<int>(earlier.size()), redundancy, scene.hasTextures(),
                 scene.isAlphaTested(), scene.hasFlatParts(), isShaded});
    const glm::mat4 clipFromWorld = clipFromView(view, format_) * view.viewFromWorld;
    pass.set("clipFromWorld", clipFromWorld);
    if (isShaded) {
        pass.set("viewFromWorld", view.viewFromWorld);
        pass.set("lightDirectionView",
                 glm::normalize(glm::mat3(view.viewFromWorld) * kLightDirectionWorld));
    }
    pass.setIfActive("viewFromPixels", viewFromPixels(view));

    setNearestWins(isReversed(format_) ? GL_GREATER : GL_LESS);
    clear(target, format_, isShaded);
    target.framebuffer.bind();
    if (isReversed(format_)) glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    const GLboolean writesShading = isShaded ? GL_TRUE : GL_FALSE;
    glColorMaski(kShadingTarget, writesShading, writesShading, writesShading, writesShading);
    scene.draw(pass, earlierImages(pass, view, earlier, redundancy));
    // The defaults, which other passes take for granted.
    glColorMaski(kShadingTarget, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glDepthFunc(GL_LESS);
}

}  // namespace gfxrepro::kit
